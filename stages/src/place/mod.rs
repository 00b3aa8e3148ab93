//! Placement: flat panels into space around the body.

mod arrange;
mod carry;
mod depth;
mod fit;
mod lift;
mod panels;
mod refine;
mod sew;
mod whole;

pub use arrange::Arrange;
pub use carry::Carry;
pub use lift::Lift;
pub use panels::Place;
pub use refine::Refine;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Place>();
    registry.add::<Arrange>();
    registry.add::<Carry>();
    registry.add::<Refine>();
}

#[cfg(test)]
mod tests;
