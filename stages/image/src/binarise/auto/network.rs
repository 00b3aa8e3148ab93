//! What a small network sees of the garment: a method of its own, and what a colour alone leaves
//! open.
//!
//! The network (`toile_recognise`) gives each place of the photo a probability to be garment, at
//! some hundredth of the photo's width. A graph cut that begins with it, and to which it gives the
//! odds of each pixel beside its colour, sets the boundary on the photo's edges. It shares no
//! colour model's start and no random walk with the other methods: it has learnt what garments look
//! like, and knows no colour of this photo. Cost: 40 ms, and a graph cut.

use super::super::small::SmallPhoto;
use super::evidence::overlap;
use toile_core::prelude::*;
use toile_recognise::SeenGarment;

/// What the network's odds count beside those of a pixel's colour: neighbouring pixels repeat each
/// other.
const WEIGHT: f64 = 1.0;
/// The network's odds are never further from even, as a natural logarithm.
const MOST: f64 = 6.0;

/// The intersection over union from which on a mask is what the network sees.
const AGREES: f64 = 0.88;

/// What the network sees in a photo.
pub(super) fn seen(photo: &Photo) -> Result<SeenGarment, StageError> {
    let threads = rayon::current_num_threads();
    toile_recognise::see(&photo.pixels, threads)
        .map_err(|e| StageError::internal(format!("the network: {e}")))
}

/// The photo at a reduced size with the odds of its pixels, ln.
pub(super) fn with_odds(small: SmallPhoto, seen: &SeenGarment) -> SmallPhoto {
    let odds = |p: &f32| {
        let p = f64::from(*p).clamp(1e-6, 1.0 - 1e-6);
        WEIGHT * (p / (1.0 - p)).ln().clamp(-MOST, MOST)
    };
    let odds = seen.mask(small.w, small.h).iter().map(odds).collect();
    SmallPhoto { odds: Some(odds), ..small }
}

/// The garment as the network alone sees it.
pub(super) fn garment(small: &SmallPhoto, seen: &SeenGarment) -> Vec<bool> {
    seen.mask(small.w, small.h).iter().map(|p| *p > 0.5).collect()
}

/// Whether a mask is what the network sees but for its border, so that the network may have a say
/// in where that runs.
pub(super) fn agrees(mask: &[bool], garment: &[bool]) -> bool {
    overlap(mask, garment) >= AGREES
}
