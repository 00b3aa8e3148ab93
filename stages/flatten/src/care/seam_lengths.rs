//! How long the two sides of a seam are, and how long they should be.
//!
//! A seam's target is the mean of its two flat sides, together with those of the seams that are its
//! mirror images, all weighted alike.

use super::flat_length;
use crate::flatteners::Flattening;
use crate::islands::SurfaceSeam;

/// The two sides of a seam, in the unit of the garment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeamLengths {
    /// Before.
    pub before: [f64; 2],
    /// After.
    pub after: [f64; 2],
}

impl SeamLengths {
    /// How far the sides differ, as a share of their mean.
    #[must_use]
    pub fn mismatch(sides: [f64; 2]) -> f64 {
        2.0 * (sides[0] - sides[1]).abs() / (sides[0] + sides[1]).max(f64::MIN_POSITIVE)
    }
}

/// Seams of left and right whose lengths differ by more than this share are not mirror images.
const MIRRORED_SEAM: f64 = 0.25;

/// The length that each seam should get: the mean of its sides, and of those of the seams that are
/// its mirror images.
pub(super) fn seam_targets(seams: &[SurfaceSeam], flats: &[Flattening], alike: &[[usize; 2]]) -> Vec<f64> {
    let means = seams.iter().map(|s| side_lengths(s, flats)).map(|[a, b]| (a + b) / 2.0);
    let means: Vec<f64> = means.collect();
    // The lowest seam of each group stands for it.
    let mut group: Vec<usize> = (0..means.len()).collect();
    let like = |[i, j]: &&[usize; 2]| (means[*i] - means[*j]).abs() <= MIRRORED_SEAM * means[*i];
    for &[i, j] in alike.iter().filter(like) {
        let (low, high) = (group[i].min(group[j]), group[i].max(group[j]));
        group.iter_mut().filter(|g| **g == high).for_each(|g| *g = low);
    }
    let mean_of = |g: usize| {
        let members: Vec<f64> = group.iter().zip(&means).filter(|(h, _)| **h == g).map(|(_, m)| *m).collect();
        members.iter().sum::<f64>() / members.len() as f64
    };
    group.iter().map(|&g| mean_of(g)).collect()
}

/// The lengths of both sides.
pub(super) fn side_lengths(seam: &SurfaceSeam, flats: &[Flattening]) -> [f64; 2] {
    [&seam.a, &seam.b].map(|c| flat_length(&c.vertices, &flats[c.piece].points))
}

/// Chains of a piece with the lengths that they should get.
pub(super) fn sides_of(piece: usize, seams: &[SurfaceSeam], targets: &[f64]) -> Vec<(Vec<u32>, f64)> {
    let mut sides = Vec::new();
    for (seam, &target) in seams.iter().zip(targets) {
        let of = [&seam.a, &seam.b].into_iter().filter(|c| c.piece == piece && target > 0.0);
        sides.extend(of.map(|c| (c.vertices.clone(), target)));
    }
    sides
}
