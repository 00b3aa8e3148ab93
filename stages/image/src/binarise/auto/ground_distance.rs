//! Otsu's split of each pixel's distance to the colours along the frame.
//!
//! The ground's colours are a mixture of Gaussians fitted to the frame's rim alone; distances are
//! in standard deviations of the nearest. Nothing is asked of the frame's middle, so that trousers,
//! whose legs leave the middle free, are no trouble.
//!
//! Cost: one fit and a look at every small pixel. Limits: a shadow is as far from its ground as
//! cloth is.

use super::super::background::{LEAST_MODE, rim_width};
use super::super::mixture::Mixture;
use super::super::otsu::otsu;
use super::super::small::SmallPhoto;

/// What is further than this is as good as infinitely far, standard deviations.
const FAR: f64 = 12.0;

/// What is far from the rim's colours; `None` where all is alike.
pub(super) fn ground_distance(small: &SmallPhoto, modes: usize, rim: f64) -> Option<Vec<bool>> {
    let at_rim: Vec<bool> = (0..small.lab.len()).map(|i| small.depth(i) < rim_width(small, rim)).collect();
    let ground = Mixture::fit(&small.colours(&at_rim), modes, LEAST_MODE)?;
    let level = |i: usize| (255.0 * (ground.distance(&small.lab[i]) / FAR).min(1.0)) as u8;
    let levels: Vec<u8> = (0..small.lab.len()).map(level).collect();
    let mut bins = [0u64; 256];
    levels.iter().zip(&small.seen).filter(|(_, seen)| **seen).for_each(|(v, _)| bins[usize::from(*v)] += 1);
    let threshold = otsu(&bins)?.threshold;
    Some(levels.iter().zip(&small.seen).map(|(v, seen)| *seen && *v > threshold).collect())
}
