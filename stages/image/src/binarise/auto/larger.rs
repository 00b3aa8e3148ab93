//! Whether a mask is a print on something larger.
//!
//! A random walk from a little outside the mask to the frame's rim ends at the next outline around
//! it. Where the photo has an edge nearly all along that outline, and it holds much more than the
//! mask, the mask is a part of a garment: the print on a white shirt on white. Around a whole
//! garment the walk ends anywhere half-way to the frame, where there is no edge.
//!
//! Cost: one random walk. Limits: on a patterned ground the walk ends at edges of the pattern;
//! these seldom go all around.

use super::super::morphology::dilate;
use super::super::small::SmallPhoto;
use super::contour::support;
use super::grid::{bits, picture};
use super::walker::walk;
use toile_core::prelude::*;

/// How far outside the mask the walk begins, as a share of the longer side.
const BEYOND: f64 = 0.02;
/// From this share of edges on, an outline is one.
const OUTLINE: f64 = 0.85;
/// A print leaves at least this much of its cloth free, as a share of its own area.
const LARGER: f64 = 1.3;

/// The area of what lies around the mask, as a multiple of the mask's; `None` where nothing does.
pub(super) fn larger(
    small: &SmallPhoto,
    mask: &[bool],
    rim: f64,
    cx: &Context,
) -> Result<Option<f64>, StageError> {
    let reach = (BEYOND * small.w.max(small.h) as f64).round() as u32;
    let from = bits(&dilate(&picture(mask, small.w, small.h), reach));
    let around: Vec<bool> = walk(small, &from, rim, cx)?.iter().map(|chance| *chance > 0.5).collect();
    let count = |m: &[bool]| m.iter().filter(|on| **on).count() as f64;
    let times = count(&around) / count(mask).max(1.0);
    Ok((times >= LARGER && support(small, &around) >= OUTLINE).then_some(times))
}
