//! The shift between two pictures to a fraction of a pixel.
//!
//! Method: the shift `s`, a gain and an offset with the least sum of squares of
//! `b(p - s) - gain a(p) - offset`, linearised with the slopes of `a` and solved again and again
//! (Lucas, Kanade 1981, inverse compositional: Baker, Matthews 2004). What differs much weighs less
//! (Huber 1964), so that what moves between the photos does not pull. Cost: one pass over the
//! overlap a step.

use crate::picture::Plane;
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use toile_core::{Context, StageError};

/// Steps on one level.
const STEPS: usize = 20;
/// A step shorter than this is the last, px.
const SMALL_PX: f64 = 2e-3;
/// Differences beyond so many standard deviations weigh less.
const HUBER: f64 = 1.345;

/// How two pictures fit at a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fit {
    /// `a(p) = b(p - shift)`.
    pub(super) shift: [f64; 2],
    /// Correlation of the two over the overlap, -1 to 1.
    pub(super) likeness: f64,
    /// Share of `a` that both show.
    pub(super) overlap: f64,
    /// Root of the mean square difference, grey levels, after gain and offset.
    pub(super) residual: f64,
}

/// Sums over the overlap: normal equations, and moments of the levels.
#[derive(Clone, Copy)]
struct Sums {
    matrix: SMatrix<f64, 4, 4>,
    right: SVector<f64, 4>,
    /// Count; sums of a, b, aa, bb, ab.
    moments: SVector<f64, 6>,
}

impl Sums {
    fn zero() -> Sums {
        Sums { matrix: SMatrix::zeros(), right: SVector::zeros(), moments: SVector::zeros() }
    }
}

/// Refines a shift on one level; none where too little overlaps or the picture has no detail there.
///
/// # Errors
/// When the run has been stopped.
pub(super) fn refined(
    a: &Plane,
    b: &Plane,
    start: [f64; 2],
    least_overlap: f64,
    cx: &Context,
) -> Result<Option<Fit>, StageError> {
    let mut shift = start;
    let (mut line, mut sigma) = ([1.0, 0.0], f64::INFINITY);
    for _ in 0..STEPS {
        cx.check()?;
        let sums = sums(a, b, shift, line, sigma);
        let Some(fit) = fit(&sums, a, shift).filter(|f| f.overlap >= least_overlap) else { return Ok(None) };
        let Some(solved) = sums.matrix.cholesky().map(|c| c.solve(&sums.right)) else { return Ok(None) };
        let [ex, ey, gain, offset] = <[f64; 4]>::from(solved);
        if !solved.iter().all(|v| v.is_finite()) || gain < 0.05 {
            return Ok(None);
        }
        // A step is at most a pixel and a half: the slopes say nothing of what is farther.
        let step = [ex / gain, ey / gain].map(|e| e.clamp(-1.5, 1.5));
        shift = [shift[0] + step[0], shift[1] + step[1]];
        (line, sigma) = ([gain, offset], fit.residual.max(0.5));
        if step[0].hypot(step[1]) < SMALL_PX {
            break;
        }
    }
    Ok(fit(&sums(a, b, shift, line, sigma), a, shift).filter(|f| f.overlap >= least_overlap))
}

/// How two pictures fit at a shift, as it is.
pub(super) fn fits(a: &Plane, b: &Plane, shift: [f64; 2]) -> Option<Fit> {
    fit(&sums(a, b, shift, [1.0, 0.0], f64::INFINITY), a, shift)
}

/// How the pictures fit at a shift; none where they have no detail.
fn fit(sums: &Sums, a: &Plane, shift: [f64; 2]) -> Option<Fit> {
    let [n, sa, sb, saa, sbb, sab] = <[f64; 6]>::from(sums.moments);
    if n < 16.0 {
        return None;
    }
    let (va, vb, cov) = (saa - sa * sa / n, sbb - sb * sb / n, sab - sa * sb / n);
    if !(va > n * 1e-3 && vb > n * 1e-3) {
        return None;
    }
    let likeness = cov / (va * vb).sqrt();
    let residual = ((vb - cov * cov / va).max(0.0) / n).sqrt();
    Some(Fit { shift, likeness, overlap: n / (a.width * a.height) as f64, residual })
}

/// Rows in parallel, their sums in order.
fn sums(a: &Plane, b: &Plane, shift: [f64; 2], line: [f64; 2], sigma: f64) -> Sums {
    let rows: Vec<Sums> = (0..a.height).into_par_iter().map(|y| row(a, b, y, shift, line, sigma)).collect();
    rows.iter().fold(Sums::zero(), |sum, r| Sums {
        matrix: sum.matrix + r.matrix,
        right: sum.right + r.right,
        moments: sum.moments + r.moments,
    })
}

fn row(a: &Plane, b: &Plane, y: usize, shift: [f64; 2], [gain, offset]: [f64; 2], sigma: f64) -> Sums {
    let mut sums = Sums::zero();
    let by = y as f64 - shift[1];
    if !(by >= 0.0 && by <= b.height as f64 - 1.0) || y == 0 || y + 1 >= a.height {
        return sums;
    }
    let first = shift[0].max(1.0).ceil() as usize;
    let last = (shift[0] + b.width as f64).min(a.width as f64 - 1.0).max(0.0) as usize;
    for x in first..last {
        let k = y * a.width + x;
        let around = [k, k - 1, k + 1, k - a.width, k + a.width];
        if !around.iter().all(|k| a.seen[*k]) {
            continue;
        }
        let Some(there) = b.at(x as f64 - shift[0], by) else { continue };
        let [here, left, right, above, below] = around.map(|k| f64::from(a.levels[k]));
        let there = f64::from(there);
        let design = SVector::<f64, 4>::new((right - left) / 2.0, (below - above) / 2.0, here, 1.0);
        let off = (there - gain * here - offset).abs();
        let weight = if off > HUBER * sigma { HUBER * sigma / off } else { 1.0 };
        sums.matrix += weight * design * design.transpose();
        sums.right += weight * there * design;
        sums.moments += SVector::from([1.0, here, there, here * here, there * there, here * there]);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panorama::tests::noise;
    use proptest::prelude::*;

    fn part(x: f64, y: f64, gain: f32) -> Plane {
        let levels =
            (0..90 * 120).map(|k| 20.0 + gain * noise(f64::from(k % 120) + x, f64::from(k / 120) + y));
        Plane { width: 120, height: 90, levels: levels.collect(), seen: vec![true; 90 * 120] }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn a_shift_is_found_whatever_the_exposure(
            x in -60.0f64..60.0, y in -20.0f64..20.0, dx in -0.9f64..0.9, dy in -0.9f64..0.9, gain in 0.6f32..1.6,
        ) {
            let (a, b) = (part(0.0, 0.0, 1.0), part(x, y, gain));
            let fit = refined(&a, &b, [x + dx, y + dy], 0.1, &Context::quiet()).unwrap().unwrap();
            let off = (fit.shift[0] - x).hypot(fit.shift[1] - y);
            prop_assert!(off < 0.03, "off by {off}");
            prop_assert!(fit.likeness > 0.99, "{fit:?}");
        }
    }

    #[test]
    fn what_does_not_overlap_or_has_no_detail_fits_nowhere() {
        let cx = Context::quiet();
        assert_eq!(refined(&part(0.0, 0.0, 1.0), &part(0.0, 0.0, 1.0), [500.0, 0.0], 0.1, &cx), Ok(None));
        assert_eq!(refined(&part(0.0, 0.0, 0.0), &part(0.0, 0.0, 0.0), [3.0, 0.0], 0.1, &cx), Ok(None));
        assert_eq!(refined(&part(0.0, 0.0, 1.0), &part(9.0, 0.0, 1.0), [f64::NAN, 0.0], 0.1, &cx), Ok(None));
    }
}
