//! Drapers: the sewn garment under gravity.

mod rest;
mod spring;
#[cfg(test)]
mod tests;

pub use rest::Rest;
pub use spring::SpringDraper;
use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Rest>();
    registry.add::<SpringDraper>();
}
