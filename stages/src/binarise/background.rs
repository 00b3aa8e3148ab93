//! Colour distance to the ground that is seen along the frame.
//!
//! The rim's colours, in CIE Lab, are fitted by a mixture of Gaussians, so that a rug, floor boards or a
//! printed blanket may have many colours; modes that hold little of the rim are dropped. Each pixel's
//! distance to the nearest mode, in that mode's standard deviations, is parted by Otsu's threshold on its
//! logarithm. What is darker than a mode but of its hue counts as its shadow. Then closing, the largest
//! piece, its holes.
//!
//! All this is done at a reduced size; the boundary is set again at the photo's own size (`refine`).
//!
//! Cost: one pass over the photo, and some 50 ms at 400 px. Limits: a garment with the ground's colours
//! has holes that reach its edge; `GraphCut` goes on from here.

use super::finish::{Finish, cut_out, finish, has_pixels, no_garment};
use super::mixture::Mixture;
use super::morphology::{close, open};
use super::otsu::otsu;
use super::refine::refine;
use super::regions::Regions;
use super::small::{Lab, Small};
use image::GrayImage;
use toile_core::prelude::*;

/// Takes for garment what differs in colour from the ground along the frame.
///
/// For patterned grounds and for garments of the ground's lightness: a red tee on a rug, where grey
/// levels fail. The frame's rim must show ground. Transparent pixels are ground.
#[stage(
    role = Binariser,
    source = "Orchard and Bouman, 1991; Otsu, 1979",
    example = "Background(modes: 6)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Background {
    /// How many colours the ground may have.
    #[param(default = 6, min = 1, max = 16)]
    modes: u32,
    /// Width of the rim that is taken for ground, as a share of the shorter side.
    #[param(default = 0.03, min = 0.005, max = 0.2)]
    rim: f64,
    /// How much of a darkening is put down to shadow: 0 for none, 1 for all.
    #[param(default = 0.5, min = 0.0, max = 1.0)]
    shadow: f64,
    /// The longer side at which colours are compared.
    #[param(default = 400, min = 64, max = 2000, unit = "px", trades)]
    size: u32,
    /// Holes up to this share of the garment's area are filled.
    #[param(default = 1.0, min = 0.0, max = 1.0)]
    holes: f64,
    /// The garment may touch the frame over this share of the photo's shorter side.
    #[param(default = 0.05, min = 0.0, max = 4.0)]
    touch: f64,
}

#[stage]
impl Background {
    pub(crate) fn run(&self, photo: &Photo, cx: &Context) -> Result<Mask, StageError> {
        has_pixels(photo)?;
        let settings = Finish { open: 0, close: 0, holes: self.holes, touch: self.touch };
        if let Some(mask) = cut_out(photo) {
            return finish(mask, photo, settings, cx);
        }
        let small = Small::of(photo, self.size);
        cx.check()?;
        let mask = background(&small, self.modes as usize, self.rim, self.shadow)
            .ok_or_else(|| no_garment(photo, "it has the colours of the frame's rim all over"))?;
        cx.progress(0.5, "ground and garment parted");
        finish(refine(photo, &small, &mask, cx)?, photo, settings, cx)
    }
}

/// Modes of the ground that hold less of the rim than this are no ground.
pub(super) const LEAST_MODE: f64 = 0.02;

/// Distances, in standard deviations, between which the threshold is sought: nearer is noise,
/// further is another colour on any account.
const THRESHOLDS: (f64, f64) = (3.0, 10.0);

/// Radius of the opening and closing at the reduced size, pixels for each 400 of its longer side.
const CLEAN: f64 = 3.0;

/// The garment in a small picture; `None` where all of it has the rim's colours.
pub(super) fn background(small: &Small, modes: usize, rim: f64, shadow: f64) -> Option<Vec<bool>> {
    let distances = distances(small, modes, rim, shadow)?;
    let threshold = threshold(small, &distances)?;
    let raw: Vec<bool> = distances.iter().map(|d| *d > threshold).collect();
    clean(small, &raw)
}

/// Width of the rim at the reduced size, pixels.
pub(super) fn rim_width(small: &Small, rim: f64) -> usize {
    ((small.w.min(small.h) as f64 * rim).round() as usize).max(1)
}

/// Each pixel's distance to the ground's nearest colour.
fn distances(small: &Small, modes: usize, rim: f64, shadow: f64) -> Option<Vec<f64>> {
    let colours: Vec<Lab> = small.rim(rim_width(small, rim)).into_iter().map(|i| small.lab[i]).collect();
    let ground = Mixture::fit(&colours, modes, LEAST_MODE)?;
    let distance = |(c, seen): (&Lab, &bool)| if *seen { ground.shaded_distance(c, shadow) } else { 0.0 };
    Some(small.lab.iter().zip(&small.seen).map(distance).collect())
}

/// Otsu's threshold on the logarithm of the distances.
fn threshold(small: &Small, distances: &[f64]) -> Option<f64> {
    const STEPS: f64 = 50.0;
    let level = |d: f64| (((1.0 + d).ln() * STEPS) as usize).min(255);
    let mut bins = [0u64; 256];
    distances.iter().zip(&small.seen).filter(|(_, s)| **s).for_each(|(d, _)| bins[level(*d)] += 1);
    let found = otsu(&bins)?;
    let threshold = ((f64::from(found.threshold) + 1.0) / STEPS).exp() - 1.0;
    Some(threshold.clamp(THRESHOLDS.0, THRESHOLDS.1))
}

/// Closing, opening, the largest piece, all its holes.
pub(super) fn clean(small: &Small, raw: &[bool]) -> Option<Vec<bool>> {
    let radius = (CLEAN * small.w.max(small.h) as f64 / 400.0).round() as u32;
    let bytes = raw.iter().map(|on| if *on { 255 } else { 0 }).collect();
    let mask = GrayImage::from_raw(small.w as u32, small.h as u32, bytes)?;
    let mask = open(&close(&mask, radius), radius);
    let regions = Regions::of(&mask);
    let largest = *regions.by_size().first()?;
    let mask = super::finish::fill_holes(regions.paint(|i, _| i == largest), 1.0);
    Some(mask.as_raw().iter().map(|v| *v != 0).collect())
}
