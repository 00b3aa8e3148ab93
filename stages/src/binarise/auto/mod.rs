//! The binariser that knows when it is wrong.
//!
//! Six methods, most of which share neither model nor start, look at the photo at a reduced size (`methods`): a graph cut,
//! the ground's colours, a split of colours in two, the distance to the rim's colours, a random walk that sees edges alone, and a graph cut from that walk's end.
//! For each mask `evidence` asks how far others agree with it, how much of its contour lies on an edge of the photo, and how
//! alike its halves are. The best is taken: thin parts without a mirror image are taken off it (`thin`), its boundary is cut
//! at twice the size and set at the photo's own, and a strip of ground between hem and frame is found (`frame`). The product of
//! the evidence is the confidence. Below the least that is asked for, and where the mask looks like a print on something
//! larger (`larger`), the photo is refused with a picture of the doubt (`doubt`).
//!
//! Agreement of independent methods tells far more than any method knows of itself.
//!
//! Cost: 0.2 to 0.5 s for any photo. Limits: where all methods take the same part of a garment for ground and the photo has
//! an edge there (sleeves of the ground's colour on a body of another), the mask passes.

mod choose;
mod colour_split;
mod contour;
mod doubt;
mod evidence;
mod frame;
mod grid;
mod ground_distance;
mod larger;
mod methods;
mod symmetry;
#[cfg(test)]
mod tests;
mod thin;
mod walker;

use super::finish::{Finish, mask_of, no_garment};
use super::graph_cut::GraphCut;
use super::refine::refine;
use super::small::Small;
use choose::{Choice, choose};
use contour::bare_along_frame;
use doubt::{cut_by_frame, refuse};
use grid::picture;
use image::GrayImage;
use methods::methods;
use toile_core::prelude::*;

/// Takes the best of several methods' masks, and refuses the photo where they leave doubt.
///
/// The default for photos of any ground. Tells its confidence in the mask, 0 to 1; a photo that is refused comes with a picture
/// that shows where the methods disagree, and one thing to try. The frame's rim must show ground, its middle the garment.
/// Transparent pixels are ground.
#[stage(
    role = Binariser,
    source = "Boykov and Jolly, 2001; Grady, 2006; Otsu, 1979",
    example = "Auto(confidence: 0.3)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Auto {
    /// The least confidence in a mask that is taken; 0 takes the best mask whatever the doubt.
    #[param(default = 0.4, min = 0.0, max = 1.0)]
    pub confidence: f64,
    /// The longer side at which the last cut is made; methods are compared at half of it.
    #[param(default = 400, min = 128, max = 2000, unit = "px", trades)]
    pub size: u32,
    /// Holes up to this share of the garment's area are filled.
    #[param(default = 1.0, min = 0.0, max = 1.0)]
    pub holes: f64,
    /// The garment may touch the frame over this share of the photo's shorter side.
    #[param(default = 0.05, min = 0.0, max = 4.0)]
    pub touch: f64,
}

#[stage]
impl Auto {
    pub(crate) fn run(&self, photo: &Photo, cx: &Context) -> Result<Mask, StageError> {
        // How far it may touch the frame is told here, in this stage's own words.
        let settings = Finish { open: 0, close: 0, holes: self.holes, touch: f64::INFINITY };
        mask_of(photo, settings, cx, || self.mask(photo, cx))
    }

    /// The mask at the photo's size, before it is finished.
    fn mask(&self, photo: &Photo, cx: &Context) -> Result<GrayImage, StageError> {
        let small = Small::of(photo, self.size / 2);
        let large = Small::of(photo, self.size);
        cx.check()?;
        let found = methods(&small, cx)?;
        cx.progress(0.6, "methods compared");
        let Some(choice) = choose(&small, &large, &found, cx)? else {
            return Err(no_garment(photo, "no method parts it from the ground along the frame"));
        };
        let Choice { coarse, evidence, larger, .. } = &choice;
        let confidence = if larger.is_some() { 0.0 } else { evidence.confidence() };
        cx.figure("confidence", confidence, "");
        cx.figure("agreement", evidence.agreement, "");
        cx.figure("edges", 100.0 * evidence.support, "% of the outline");
        cx.figure("symmetry", evidence.symmetry, "");
        let fine = GraphCut::default().fine(&large, coarse, cx)?;
        let mut mask = refine(photo, &large, &fine, cx)?;
        frame::without_strips(&mut mask, photo);
        if confidence < self.confidence {
            return Err(refuse(photo, &small, &found, &choice, confidence, cx));
        }
        self.whole(&mask, photo, bare_along_frame(&large, &fine), cx)?;
        Ok(mask)
    }

    /// Refuses a garment that the frame cuts. `bare` is the length of what ends beside the frame without an edge, as a share
    /// of the shorter side.
    fn whole(&self, mask: &GrayImage, photo: &Photo, bare: f64, cx: &Context) -> Result<(), StageError> {
        let regions = super::regions::Regions::of(mask);
        let frame = regions.by_size().first().map_or(0, |&i| regions.pieces[i].frame);
        let (w, h) = mask.dimensions();
        let share = bare + frame as f64 / f64::from(w.min(h));
        match share > self.touch {
            true => Err(cut_by_frame(photo, mask, share, cx)),
            false => Ok(()),
        }
    }
}

/// What each method finds, at a reduced size, for tools that compare them.
///
/// # Errors
/// Cancelled.
pub fn candidates(photo: &Photo, cx: &Context) -> Result<Vec<(&'static str, GrayImage)>, StageError> {
    let small = Small::of(photo, 200);
    let found = methods(&small, cx)?;
    Ok(found.into_iter().map(|f| (f.name, picture(&f.mask, small.w, small.h))).collect())
}
