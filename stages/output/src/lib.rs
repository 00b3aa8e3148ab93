//! From a garment to what leaves the program: a folder a role, a file a stage.
//!
//! ```text
//! garment --texturer--> model --writer--> files
//! garment --flattener--> pattern --writer--> files
//! ```

mod file_names;
pub mod fit;
pub mod flat;
pub mod render;
pub mod texture;
pub mod write;

use toile_core::Registry;

/// Adds this crate's stages.
pub fn register(registry: &mut Registry) {
    flat::register(registry);
    fit::register(registry);
    texture::register(registry);
    write::register(registry);
}
