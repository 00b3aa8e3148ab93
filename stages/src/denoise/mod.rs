//! Denoisers: photo to photo.

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(_registry: &mut Registry) {}
