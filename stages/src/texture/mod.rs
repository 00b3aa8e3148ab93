//! Texturers: garment and photos to a textured model.

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(_registry: &mut Registry) {}
