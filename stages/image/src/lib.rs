//! From photos to outlines: a folder a role, a file a stage.
//!
//! ```text
//! Photos --denoiser--> photo --binariser--> mask --edge detector--> outline
//! ```

pub mod binarise;
pub mod denoise;
pub mod edges;
pub mod grid;
pub mod photo;

use toile_core::Registry;

/// Adds this crate's stages.
pub fn register(registry: &mut Registry) {
    photo::register(registry);
    denoise::register(registry);
    binarise::register(registry);
    edges::register(registry);
}
