//! Prepared scenes: garments that come placed, with seams, pins and a body.

mod read;
#[cfg(test)]
mod tests;

pub use read::Scene;
use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Scene>();
}
