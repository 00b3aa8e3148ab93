//! Styles: name the outline's edges and keep the seams.
//!
//! A style looks at the shape ([`shape`]) and not only at the corners that were found, so that a
//! missing or an extra corner does no harm ([`naming`]); seams are checked and their edges agree on
//! their divisions in [`sewing`]. [`neckline`] then looks at the photo for what the outline cannot
//! show.

mod block;
mod closed_front;
mod drawn;
mod naming;
mod neck;
mod neckline;
mod replaced;
mod seams;
mod sewing;
mod shape;
#[cfg(test)]
mod tests;
mod tshirt;
mod vest;

pub use block::{Block, BlockStyle, Complete, Fitting, Sides, Waist};
pub use neckline::Neckline;
pub use seams::{SeamEntry, Seams};
pub use tshirt::TShirt;
pub use vest::Vest;

use toile_core::{Registry, StageMeta};

/// The edges that a style of that name gives every panel; none of a style that is not built in.
fn edges_of(style: &str) -> Option<Vec<String>> {
    match style {
        Vest::NAME => Some(naming::edge_names(&vest::HALF)),
        TShirt::NAME => Some(naming::edge_names(&tshirt::HALF)),
        _ => None,
    }
}

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Vest>();
    registry.add::<TShirt>();
    registry.add::<Block>();
    registry.add::<Fitting>();
    registry.add::<Neckline>();
    registry.add::<Seams>();
}
