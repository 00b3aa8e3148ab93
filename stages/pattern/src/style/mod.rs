//! Styles: name the outline's edges and keep the seams.
//!
//! A template of the garment is laid over the outline and names its edges. [`block`] cuts the
//! pieces along the template, [`outline`] along the outline itself. Seams between outlines are
//! checked, and their edges agree on their divisions, in [`sewing`]. [`neckline`] then looks at the
//! photo for what the outline cannot show, and [`unpick`] leaves seams open.

mod alter;
mod block;
mod closed_front;
mod drawn;
mod neckline;
mod outline;
mod replaced;
mod seams;
mod sewing;
#[cfg(test)]
mod tests;
mod unpick;

pub use alter::{Alter, Alteration};
pub use block::{Block, BlockStyle, Complete, Fitting, PhotoLandmark, Sides, Waist, landmarks, seen_styles};
pub(crate) use block::{TRUNK_BOTTOM, TRUNK_TOP};
pub use neckline::Neckline;
pub use outline::{Outline, OutlineStyle};
pub use seams::{SeamEntry, Seams};
pub use unpick::Unpick;

use toile_core::{Migration, Registry};

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Outline>();
    registry.add::<Block>();
    registry.add::<Fitting>();
    registry.add::<Neckline>();
    registry.add::<Seams>();
    registry.add::<Unpick>();
    registry.add::<Alter>();
    registry.migrate(Migration::joined("Vest", "Outline", "style: Vest"));
    registry.migrate(Migration::joined("TShirt", "Outline", "style: TShirt"));
}
