//! Placement: flat panels into space around the body.

mod arrange;
mod pose_garment;
mod sew;
mod subdivide;
mod transfer;
mod whole;

pub use arrange::{Arrange, HandPlace, KeyPoint, undecided};
pub use pose_garment::PoseGarment;
pub use subdivide::Subdivide;
pub use transfer::Transfer;

use toile_core::{Migration, Registry};

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Arrange>();
    registry.add::<Transfer>();
    registry.add::<Subdivide>();
    registry.add::<PoseGarment>();
    registry.migrate(Migration::stage("Refine", "Subdivide"));
    registry.migrate(Migration::stage("Carry", "Transfer"));
    registry.migrate(Migration::stage("Place", "Arrange"));
    for parameter in ["ease", "start_offset", "lift", "raise"] {
        let why = "pieces start flat, 4 cm off the trunk and as high as their shoulder seams need";
        registry.migrate(Migration::removed("Place", parameter, why));
    }
}

#[cfg(test)]
mod tests;
