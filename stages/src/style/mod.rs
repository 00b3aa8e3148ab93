//! Styles: name the outline's edges and keep the seams.

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(_registry: &mut Registry) {}
