//! The shift between two pictures to a fraction of a pixel.
//!
//! Method: the shift `s`, a gain and an offset with the least sum of squares of
//! `b(p - s) - gain a(p) - offset`, linearised with the slopes of `a` and solved again and again
//! (Lucas, Kanade 1981, inverse compositional: Baker, Matthews 2004). What differs much weighs less
//! (Huber 1964), so that what moves between the photos does not pull. Cost: one pass over the
//! overlap a step.

use crate::picture::GreyPlane;
use nalgebra::{Matrix4, Vector4};
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
pub(super) struct ShiftFit {
    /// `a(p) = b(p - shift)`.
    pub(super) shift: [f64; 2],
    /// Correlation of the two over the overlap, -1 to 1.
    pub(super) likeness: f64,
    /// Share of `a` that both show.
    pub(super) overlap: f64,
    /// Root of the mean square difference, grey levels, after gain and offset.
    pub(super) residual: f64,
}

/// Sums over the overlap.
#[derive(Clone, Copy)]
struct FitSums {
    /// The upper half of the normal equations' matrix, row by row, then their right side.
    normal: [f64; 14],
    /// Count; sums of a, b, aa, bb, ab.
    moments: [f64; 6],
}

impl FitSums {
    const ZERO: FitSums = FitSums { normal: [0.0; 14], moments: [0.0; 6] };

    fn plus(mut self, other: &FitSums) -> FitSums {
        self.normal.iter_mut().zip(&other.normal).for_each(|(a, b)| *a += b);
        self.moments.iter_mut().zip(&other.moments).for_each(|(a, b)| *a += b);
        self
    }

    /// Shift, gain and offset.
    fn solved(&self) -> Option<[f64; 4]> {
        let [a, b, c, d, e, f, g, h, i, j, right @ ..] = self.normal;
        let matrix = Matrix4::new(a, b, c, d, b, e, f, g, c, f, h, i, d, g, i, j);
        let solved = matrix.cholesky()?.solve(&Vector4::from(right));
        solved.iter().all(|v| v.is_finite()).then(|| solved.into())
    }
}

/// Refines a shift on one level; none where too little overlaps or the picture has no detail there.
///
/// # Errors
/// When the run has been stopped.
pub(super) fn refined(
    a: &GreyPlane,
    b: &GreyPlane,
    start: [f64; 2],
    least_overlap: f64,
    cx: &Context,
) -> Result<Option<ShiftFit>, StageError> {
    let mut shift = start;
    let (mut line, mut sigma) = ([1.0, 0.0], f64::INFINITY);
    for _ in 0..STEPS {
        cx.check()?;
        let sums = sums(a, b, shift, line, sigma);
        let Some(fit) = fit(&sums, a, shift).filter(|f| f.overlap >= least_overlap) else { return Ok(None) };
        let Some([ex, ey, gain, offset]) = sums.solved().filter(|s| s[2] >= 0.05) else { return Ok(None) };
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
pub(super) fn fits(a: &GreyPlane, b: &GreyPlane, shift: [f64; 2]) -> Option<ShiftFit> {
    fit(&sums(a, b, shift, [1.0, 0.0], f64::INFINITY), a, shift)
}

/// How the pictures fit at a shift; none where they have no detail.
fn fit(sums: &FitSums, a: &GreyPlane, shift: [f64; 2]) -> Option<ShiftFit> {
    let [n, sa, sb, saa, sbb, sab] = sums.moments;
    if n < 16.0 {
        return None;
    }
    let (va, vb, cov) = (saa - sa * sa / n, sbb - sb * sb / n, sab - sa * sb / n);
    if !(va > n * 1e-3 && vb > n * 1e-3) {
        return None;
    }
    let likeness = cov / (va * vb).sqrt();
    let residual = ((vb - cov * cov / va).max(0.0) / n).sqrt();
    Some(ShiftFit { shift, likeness, overlap: n / (a.width * a.height) as f64, residual })
}

/// Rows in parallel, their sums in order.
fn sums(a: &GreyPlane, b: &GreyPlane, shift: [f64; 2], line: [f64; 2], sigma: f64) -> FitSums {
    let rows: Vec<FitSums> =
        (0..a.height).into_par_iter().map(|y| row(a, b, y, shift, line, sigma)).collect();
    rows.iter().fold(FitSums::ZERO, |sum, row| sum.plus(row))
}

fn row(
    a: &GreyPlane,
    b: &GreyPlane,
    y: usize,
    shift: [f64; 2],
    [gain, offset]: [f64; 2],
    sigma: f64,
) -> FitSums {
    let mut sums = FitSums::ZERO;
    let by = y as f64 - shift[1];
    if !(by >= 0.0 && by < b.height as f64 - 1.0) || y == 0 || y + 1 >= a.height || !shift[0].is_finite() {
        return sums;
    }
    // Between the pixels of `b` every place of the row lies alike.
    let (v, u) = ((by - by.floor()) as f32, (-shift[0] - (-shift[0]).floor()) as f32);
    let (above, to_b) = (by as usize * b.width, (-shift[0]).floor().clamp(-1e9, 1e9) as i64);
    let first = (-to_b).max(1) as usize;
    let last = (b.width as i64 - 1 - to_b).clamp(0, a.width as i64 - 1) as usize;
    for x in first..last {
        let k = y * a.width + x;
        let around = [k, k - 1, k + 1, k - a.width, k + a.width];
        let there = above + (x as i64 + to_b) as usize;
        let corners = [there, there + 1, there + b.width, there + b.width + 1];
        if !around.iter().all(|k| a.seen[*k]) || !corners.iter().all(|k| b.seen[*k]) {
            continue;
        }
        let [p, q, r, s] = corners.map(|k| b.levels[k]);
        let (top, bottom) = (p + (q - p) * u, r + (s - r) * u);
        let there = f64::from(top + (bottom - top) * v);
        let [here, left, right, above, below] = around.map(|k| f64::from(a.levels[k]));
        let (gx, gy) = ((right - left) / 2.0, (below - above) / 2.0);
        let off = (there - gain * here - offset).abs();
        let w = if off > HUBER * sigma { HUBER * sigma / off } else { 1.0 };
        let (wx, wy, wh, wt) = (w * gx, w * gy, w * here, w * there);
        let terms = [
            wx * gx,
            wx * gy,
            wx * here,
            wx,
            wy * gy,
            wy * here,
            wy,
            wh * here,
            wh,
            w,
            wt * gx,
            wt * gy,
            wt * here,
            wt,
        ];
        sums.normal.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        let terms = [1.0, here, there, here * here, there * there, here * there];
        sums.moments.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
    }
    sums
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::panorama::tests::noise;
    use proptest::prelude::*;

    fn part(x: f64, y: f64, gain: f32) -> GreyPlane {
        let levels =
            (0..90 * 120).map(|k| 20.0 + gain * noise(f64::from(k % 120) + x, f64::from(k / 120) + y));
        GreyPlane { width: 120, height: 90, levels: levels.collect(), seen: vec![true; 90 * 120] }
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
