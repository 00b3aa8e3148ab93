//! Stitchers: sew the placed panels.

mod spring;
#[cfg(test)]
mod tests;

pub use spring::SpringStitcher;
use toile_core::{Migration, Registry};

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<SpringStitcher>();
    registry.migrate(Migration::removed(
        "SpringStitcher",
        "tugs",
        "seams that are stuck are pulled harder by themselves",
    ));
}
