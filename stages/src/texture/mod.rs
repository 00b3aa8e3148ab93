//! Texturers: garment and photos to a textured model.

mod bleed;
mod crop;
#[cfg(test)]
pub(crate) mod fixture;
mod inside;
pub(crate) mod parts;
mod photo_texturer;
#[cfg(test)]
mod tests;
mod texture_size;

pub use photo_texturer::{BodyShown, Light, PhotoTexturer};

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<PhotoTexturer>();
}
