//! Membrane models: the in-plane energy of a sheet.
//!
//! | model | promises | costs |
//! |---|---|---|
//! | [`StVenantKirchhoff`] | the exact linear-elastic plate in small strain on any mesh, large
//! rotations | one 3 x 2 gradient per triangle |
//! | [`Woven`] | measured warp, weft and shear curves, any direction | the same and two square roots |
//! | [`Springs`] | the classic families; right only along the mesh lines | one square root an edge |

mod springs;
mod stvk;
mod triangles;
mod woven;

#[cfg(test)]
mod tests;

pub use springs::Springs;
pub use stvk::StVenantKirchhoff;
pub use triangles::{Law, Response, Triangles};
pub use woven::Woven;
