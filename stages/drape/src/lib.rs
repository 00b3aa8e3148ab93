//! From panels around a body to a sewn garment at rest: a folder a role, a file a stage.
//!
//! ```text
//! garment, body --collider, stitcher, draper--> garment at rest --measure--> metrics
//! ```

pub mod collide;
pub mod drape;
pub mod engine;
pub mod fabric;
pub mod measure;
pub mod scene;
pub mod stitch;

use toile_core::Registry;

/// Adds this crate's stages.
pub fn register(registry: &mut Registry) {
    fabric::register(registry);
    scene::register(registry);
    collide::register(registry);
    stitch::register(registry);
    drape::register(registry);
    measure::register(registry);
}
