//! Stitchers: sew the placed panels.

mod spring;
#[cfg(test)]
mod tests;

pub use spring::SpringStitcher;
use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<SpringStitcher>();
}
