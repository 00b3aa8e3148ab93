//! Placement: flat panels into space around the body.

mod arrange;
mod depth;
mod fit;
mod lift;
mod panels;
mod pose_garment;
mod sew;
mod subdivide;
mod transfer;
mod whole;

pub use arrange::Arrange;
pub use lift::Lift;
pub use panels::Place;
pub use pose_garment::PoseGarment;
pub use subdivide::Subdivide;
pub use transfer::Transfer;

use toile_core::{Migration, Registry};

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Place>();
    registry.add::<Arrange>();
    registry.add::<Transfer>();
    registry.add::<Subdivide>();
    registry.add::<PoseGarment>();
    registry.migrate(Migration::stage("Refine", "Subdivide"));
    registry.migrate(Migration::stage("Carry", "Transfer"));
    registry.migrate(Migration::renamed("Place", "ease", "start_offset"));
}

#[cfg(test)]
mod tests;
