//! Bodies: made from measurements or read from a file.

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(_registry: &mut Registry) {}
