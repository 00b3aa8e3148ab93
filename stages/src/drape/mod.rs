//! Drapers: the sewn garment under gravity.

mod spring;
#[cfg(test)]
mod tests;

pub use spring::SpringDraper;
use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<SpringDraper>();
}
