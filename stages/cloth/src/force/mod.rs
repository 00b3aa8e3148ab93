//! Energies: what every implicit solver asks of a model, and the assembly of small elements into forces and matrices.

mod air;
mod assemble;
mod check;
mod energy;
mod gravity;
mod load;

#[cfg(test)]
mod tests;

pub use air::{Air, AirDrag, AirStep, carried, mobility};
pub use assemble::{Assembled, Element};
pub use check::{gradient_error, hessian_error};
pub use energy::{Energy, Projection, Vec3, matrix_of, total_gradient, total_value};
pub use gravity::Gravity;
pub use load::DeadLoad;
