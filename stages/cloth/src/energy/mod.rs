//! Energies: what every solver asks of a model, the models, and their sums over a mesh.
//!
//! | file | energy |
//! |---|---|
//! | `membrane/` | what a sheet resists in its plane |
//! | `bending/` | what it resists when it is folded |
//! | `band` | elastic bands |
//! | `gravity`, `load`, `air` | weight, dead loads, one step of the air's drag |
//!
//! Contact, friction and seam closing forces depend on the state of the solver and are in
//! `statics/forces`.

mod air;
mod band;
pub mod bending;
mod check;
mod cloth;
mod element;
mod gravity;
mod load;
pub mod membrane;
mod models;
mod places;
mod potential;
mod seam_spring;
mod strain_limit;
mod subset;

#[cfg(test)]
mod tests;

pub use air::{Air, AirDrag, AirStep, carried, mobility};
pub use band::{Band, Bands};
pub use check::{gradient_error, hessian_error};
pub use cloth::{Clamp, Cloth};
pub use element::{Assembled, Blocks, Element, add_block_of};
pub use gravity::Gravity;
pub use load::DeadLoad;
pub use models::{Bending, Membrane, Models};
pub use places::Places;
pub use potential::{Energy, Projection, Resistance, matrix_of, total_gradient, total_value, write_matrix};
pub use seam_spring::SeamSprings;
pub use strain_limit::StrainLimit;
pub use subset::Subset;
pub use toile_geometry::Vec3;
