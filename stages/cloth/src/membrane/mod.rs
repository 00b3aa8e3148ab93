//! What a sheet resists in its plane.
//!
//! | model | promises | costs |
//! |---|---|---|
//! | [`StVenantKirchhoff`] | the exact linear-elastic plate in small strain on any mesh, large rotations | one 3 x 2 gradient a triangle |
//! | [`Woven`] | measured warp, weft and shear curves, any direction | the same and two square roots |
//! | [`Springs`] | the classic families; right only along the mesh lines | one square root an edge |

mod law;
mod springs;
mod stvk;
mod woven;

#[cfg(test)]
mod tests;

pub use law::{Law, Tangent, Triangles};
pub use springs::Springs;
pub use stvk::StVenantKirchhoff;
pub use woven::Woven;
