//! Placement: flat panels into space around the body.

mod depth;
mod fit;
mod lift;
mod panels;
mod sew;

pub use lift::Lift;
pub use panels::Place;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Place>();
}

#[cfg(test)]
mod tests;
