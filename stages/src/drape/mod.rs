//! Drapers: the sewn garment under gravity.

mod again;
mod asleep;
mod central_differences;
mod implicit_euler;
mod mixed_precision;
mod models;
mod motion;
mod projective;
mod rest;
mod spring;
#[cfg(test)]
mod tests;
mod xpbd;

pub use central_differences::CentralDifferences;
pub use implicit_euler::ImplicitEuler;
pub use mixed_precision::Precision;
pub use models::{Bending, Membrane};
pub use motion::InTime;
pub use projective::Projective;
pub use rest::{Proof, Rest};
pub use spring::SpringDraper;
use toile_core::Registry;
pub use xpbd::Xpbd;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Rest>();
    registry.add::<ImplicitEuler>();
    registry.add::<Xpbd>();
    registry.add::<Projective>();
    registry.add::<CentralDifferences>();
    registry.add::<SpringDraper>();
}
