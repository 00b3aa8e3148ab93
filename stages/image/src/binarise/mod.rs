//! Binarisers: photo to mask.
//!
//! | stage | looks at | for |
//! |---|---|---|
//! | `Global` | grey levels against a fixed threshold | a studio that never changes |
//! | `Otsu` | grey levels against the threshold that parts them best | a plain ground |
//! | `Local` | grey levels against their surroundings | a plain ground in uneven light |
//! | `Background` | colour against the colours along the frame | rugs, wood, patterns |
//! | `Difference` | colour against the same ground without the garment | a camera on a stand |
//! | `GraphCut` | colour models and edges together | the hardest photos |
//!
//! All share what comes after (`finish`): clean-up, one piece, its holes, and the errors for no
//! garment and a garment cut by the frame; of two garments the larger is kept, which is told. All
//! take transparent pixels as ground; a picture whose ground was cut away has its mask already
//! (`cut_out`).

mod auto;
mod background;
mod beside;
mod cut;
mod cut_out;
mod difference;
mod finish;
mod global;
mod graph_cut;
mod local;
mod marked;
mod marks;
mod mixture;
mod morphology;
mod otsu;
mod refine;
mod regions;
mod small;
#[cfg(test)]
mod tests;
mod tone;

pub use auto::{Auto, candidates};
pub use background::Background;
pub use difference::Difference;
pub use finish::{CleanUp, fill_holes, finish, mask_of, no_garment};
pub use global::{Global, global};
pub use graph_cut::GraphCut;
pub use local::{Local, LocalMethod, local};
pub use marks::PhotoPlace;
pub use morphology::{MAX_RADIUS, close, dilate, erode, open};
pub use otsu::{Otsu, Split, otsu};
pub use regions::{MaskPiece, Regions};
pub use small::{Lab, lab};
pub(crate) use tone::OPAQUE;
pub use tone::{Polarity, histogram, luma};

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry
        .add::<Otsu>()
        .add::<Global>()
        .add::<Local>()
        .add::<Background>()
        .add::<GraphCut>()
        .add::<Auto>()
        .add::<Difference>();
}
