//! Texturers: garment and photos to a textured model.

mod arms;
mod bleed;
mod crop;
pub(crate) mod edge;
mod fabric_texturer;
mod finish;
mod inside;
mod photo_detail;
mod photo_texturer;
mod plain;
mod relief;
mod shading;
#[cfg(test)]
mod tests;
mod texture_size;
mod variants;
mod view_texturer;
mod weave;

pub use fabric_texturer::{FabricDetail, FabricTexture, FabricTexturer};
pub use photo_texturer::{BodyShown, Light, PhotoDetail, PhotoLight, PhotoTexturer, Unseen, WrongSide};

pub use view_texturer::ViewTexturer;

use toile_core::Registry;
use toile_core::prelude::*;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<PhotoTexturer>();
    registry.add::<FabricTexturer>();
    registry.add::<ViewTexturer>();
}

/// The photo that shows a panel, or its mask: that of its name, or of the last word of its name,
/// such as `front` for `left_sleeve_front`.
pub(crate) fn of_panel<'a, T>(photos: &'a Set<T>, panel: &str) -> Option<&'a T> {
    photos.get(panel).or_else(|| photos.get(panel.rsplit('_').next()?))
}
