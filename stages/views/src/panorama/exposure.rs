//! A gain for each photo, so that neighbours are equally bright where they overlap.
//!
//! Method: the gains with the least sum over the pairs of the squared difference of their mean
//! levels, which stay near one (Brown, Lowe 2007). Levels are taken as they stand, not as light.

use nalgebra::{DMatrix, DVector};

/// Standard deviation of mean levels, grey levels, and that of gains.
const LEVELS: f64 = 10.0;
const GAINS: f64 = 0.1;
/// A photo is brightened or darkened by at most this factor.
const MOST: f64 = 3.0;

/// Mean levels of two photos, by their numbers, over what both show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PhotoOverlap {
    pub(super) photos: [usize; 2],
    pub(super) means: [f64; 2],
    /// Pixels, relative to the other pairs.
    pub(super) weight: f64,
}

/// A factor for the levels of each of `count` photos; all one where they cannot be told.
pub(super) fn gains(count: usize, overlaps: &[PhotoOverlap]) -> Vec<f64> {
    let (mut matrix, mut right) = (DMatrix::<f64>::zeros(count, count), DVector::<f64>::zeros(count));
    for PhotoOverlap { photos: [i, j], means: [a, b], weight } in overlaps {
        if *i >= count || *j >= count || !(a.is_finite() && b.is_finite() && *weight > 0.0) {
            continue;
        }
        let of_levels = weight / (LEVELS * LEVELS);
        matrix[(*i, *i)] += of_levels * a * a;
        matrix[(*j, *j)] += of_levels * b * b;
        matrix[(*i, *j)] -= of_levels * a * b;
        matrix[(*j, *i)] -= of_levels * a * b;
        for k in [*i, *j] {
            matrix[(k, k)] += weight / (GAINS * GAINS);
            right[k] += weight / (GAINS * GAINS);
        }
    }
    let solved = matrix.cholesky().map(|c| c.solve(&right));
    match solved {
        Some(gains) if gains.iter().all(|g| g.is_finite()) => {
            gains.iter().map(|g| g.clamp(1.0 / MOST, MOST)).collect()
        }
        _ => vec![1.0; count],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dark_photo_is_brightened_and_its_neighbours_darkened() {
        let overlap = |photos, means| PhotoOverlap { photos, means, weight: 1.0 };
        let found = gains(3, &[overlap([0, 1], [120.0, 90.0]), overlap([1, 2], [90.0, 120.0])]);
        let means = [120.0 * found[0], 90.0 * found[1], 120.0 * found[2]];
        assert!((means[0] - means[1]).abs() < 12.0 && (means[0] - means[2]).abs() < 1e-9, "{means:?}");
        assert!(found[0] < 1.0 && found[1] > 1.0);
    }

    #[test]
    fn what_cannot_be_told_is_left_alone() {
        assert_eq!(gains(2, &[]), [1.0; 2]);
        assert_eq!(
            gains(2, &[PhotoOverlap { photos: [0, 1], means: [f64::NAN, 3.0], weight: 1.0 }]),
            [1.0; 2]
        );
    }
}
