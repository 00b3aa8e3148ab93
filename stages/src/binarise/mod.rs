//! Binarisers: photo to mask.

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(_registry: &mut Registry) {}
