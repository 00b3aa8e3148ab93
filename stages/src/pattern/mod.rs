//! Sewing patterns from files: what takes the place of photos, outlines and a style.

mod garment_code;

pub use garment_code::GarmentCode;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<GarmentCode>();
}
