//! Edge detectors: photo and mask to a closed sub-pixel outline.

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(_registry: &mut Registry) {}
