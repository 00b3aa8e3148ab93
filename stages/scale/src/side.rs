//! One side of a rectangle, measured in the photo.
//!
//! Profiles across the side are taken along it; the colour's slope on each (a derivative of a
//! Gaussian, Canny, 1986) has peaks, placed between samples by a parabola. The line that most peaks
//! lie on is found by votes over its two end offsets (Hough, 1962), then fitted by least squares
//! with Tukey's weights (1974).
//!
//! Cost: about 0.1 ms a side of 100 profiles.

use crate::pixels::{Rgb, colour};
use image::RgbImage;
use nalgebra::{Point2, Vector2};

/// A measured side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeasuredSide {
    /// Where the line passes the start and the end of the side.
    pub(crate) a: Point2<f64>,
    pub(crate) b: Point2<f64>,
    /// Share of the profiles whose peak lies on the line.
    pub(crate) coverage: f64,
    /// Scatter of the peaks about the line, photo pixels.
    pub(crate) spread: f64,
    /// Standard error of the line's offset, photo pixels.
    pub(crate) error: f64,
    /// Median slope on the line, grey levels a step.
    pub(crate) slope: f64,
}

/// How a side is looked at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SideSampling {
    /// Distance of samples across the side, pixels.
    pub(crate) step: f64,
    /// Samples to each side of it.
    pub(crate) reach: usize,
    /// Share of the side that is left out at each end.
    pub(crate) inset: f64,
    /// Profiles at most.
    pub(crate) most: usize,
}

/// A peak of a profile.
#[derive(Debug, Clone, Copy)]
struct Peak {
    /// Place along the side, 0 to 1.
    t: f64,
    /// Offset to the side's left, steps.
    u: f64,
    slope: f64,
}

/// Slopes below this many grey levels a step are noise.
const NOISE: f64 = 0.9;
/// Peaks of a profile that are kept.
const PEAKS: usize = 3;

/// The line near the side from `a` to `b`; `None` where no line is seen.
pub(crate) fn side(
    photo: &RgbImage,
    a: Point2<f64>,
    b: Point2<f64>,
    look: &SideSampling,
) -> Option<MeasuredSide> {
    let length = (b - a).norm();
    let count = ((length / look.step) as usize).clamp(6, look.most);
    let normal = across(a, b)?;
    let mut peaks = Vec::with_capacity(count * PEAKS);
    for n in 0..count {
        let t = look.inset + (1.0 - 2.0 * look.inset) * (n as f64 + 0.5) / count as f64;
        let at = a + (b - a) * t;
        profile(photo, at, normal, (b - a) / length.max(1e-9), look, |u, slope| {
            peaks.push(Peak { t, u, slope })
        });
    }
    let start = vote(&peaks, look, count)?;
    fit(&peaks, start, count, look).map(|f| f.side(a, b, normal, look.step))
}

/// Unit vector across the side, to its left where y grows downwards.
pub(crate) fn across(a: Point2<f64>, b: Point2<f64>) -> Option<Vector2<f64>> {
    let d = (b - a).try_normalize(1e-6)?;
    Some(Vector2::new(-d.y, d.x))
}

/// The peaks of the slope across a place.
fn profile(
    photo: &RgbImage,
    at: Point2<f64>,
    normal: Vector2<f64>,
    along: Vector2<f64>,
    look: &SideSampling,
    mut found: impl FnMut(f64, f64),
) {
    let slopes = slopes(photo, at, normal, along, look);
    let mut peaks: Vec<(f64, f64)> = Vec::new();
    for i in 1..slopes.len() - 1 {
        let [l, m, r] = [slopes[i - 1], slopes[i], slopes[i + 1]];
        if m >= l && m > r && m > NOISE {
            let shift = 0.5 * (l - r) / (l - 2.0 * m + r).min(-1e-9);
            peaks.push((i as f64 - 1.0 - look.reach as f64 + shift.clamp(-0.5, 0.5), m));
        }
    }
    peaks.sort_by(|a, b| b.1.total_cmp(&a.1));
    peaks.iter().take(PEAKS).for_each(|(u, slope)| found(*u, *slope));
}

/// Derivative of a Gaussian of 1.2 steps.
const KERNEL: [f32; 3] = [0.245, 0.173, 0.0533];

/// Sizes of the colour's slope at offsets -reach - 1 to reach + 1.
fn slopes(
    photo: &RgbImage,
    at: Point2<f64>,
    normal: Vector2<f64>,
    along: Vector2<f64>,
    look: &SideSampling,
) -> Vec<f64> {
    let half = look.reach as isize + 4;
    let line: Vec<Rgb> = (-half..=half)
        .map(|i| {
            let p = at + normal * (i as f64 * look.step);
            let [q, r] = [-0.5, 0.5].map(|s| p + along * (s * look.step));
            let (c, d) = (colour(photo, q.x, q.y), colour(photo, r.x, r.y));
            std::array::from_fn(|n| 0.5 * (c[n] + d[n]))
        })
        .collect();
    (3..line.len() - 3)
        .map(|i| {
            let slope =
                |c: usize| (1..4).map(|d| KERNEL[d - 1] * (line[i + d][c] - line[i - d][c])).sum::<f32>();
            f64::from((0..3).map(|c| slope(c).powi(2)).sum::<f32>().sqrt())
        })
        .collect()
}

/// End offsets of the line that most peaks are near, steps.
fn vote(peaks: &[Peak], look: &SideSampling, count: usize) -> Option<(f64, f64)> {
    let reach = 2 * look.reach as isize;
    // A quarter of the profiles tells the line; the fit uses all of them.
    let every = (count / 32).max(1);
    let few: Vec<Peak> = thin(peaks, every);
    let strong = median(few.iter().map(|p| p.slope).collect())?;
    let (mut best, mut most) = (None, 0.0);
    for i in -reach..=reach {
        for j in -reach..=reach {
            let (p, q) = (i as f64 / 2.0, j as f64 / 2.0);
            let votes: f64 = few.iter().map(|k| voice(k, p, q, strong)).sum();
            // Of equal lines, the one nearest to where it was looked for.
            let votes = votes * (1.0 - 0.15 * (p.abs() + q.abs()) / look.reach as f64);
            if votes > most {
                (best, most) = (Some((p, q)), votes);
            }
        }
    }
    best
}

/// Peaks of every so many profiles.
fn thin(peaks: &[Peak], every: usize) -> Vec<Peak> {
    let mut n = 0;
    let mut last = f64::NAN;
    let mut keep = Vec::new();
    for p in peaks {
        if p.t != last {
            last = p.t;
            n += 1;
        }
        if n % every == 0 {
            keep.push(*p);
        }
    }
    keep
}

/// How much a peak speaks for a line.
fn voice(peak: &Peak, p: f64, q: f64, strong: f64) -> f64 {
    let off = (peak.u - (p + (q - p) * peak.t)).abs();
    (1.0 - off).max(0.0) * (peak.slope / strong).min(2.0)
}

/// A fitted line in steps.
#[derive(Debug, Clone, Copy)]
struct LineFit {
    p: f64,
    q: f64,
    coverage: f64,
    spread: f64,
    error: f64,
    slope: f64,
}

impl LineFit {
    /// The side whose ends the offsets are from; `step` in pixels.
    fn side(&self, a: Point2<f64>, b: Point2<f64>, normal: Vector2<f64>, step: f64) -> MeasuredSide {
        let (coverage, slope) = (self.coverage, self.slope);
        let (a, b) = (a + normal * (self.p * step), b + normal * (self.q * step));
        MeasuredSide { a, b, coverage, slope, spread: self.spread * step, error: self.error * step }
    }
}

/// Least squares with Tukey's weights from a start.
fn fit(peaks: &[Peak], start: (f64, f64), count: usize, look: &SideSampling) -> Option<LineFit> {
    let (mut p, mut q) = start;
    let mut scale = 0.5;
    let mut near = Vec::new();
    for _ in 0..6 {
        near = nearest(peaks, p, q);
        (p, q) = weighted(&near, p, q, 3.0 * scale)?;
        let offs = near.iter().map(|k| (k.u - (p + (q - p) * k.t)).abs()).collect();
        scale = (1.48 * median(offs)?).clamp(0.08, 0.6);
    }
    let on: Vec<&Peak> = near.iter().filter(|k| (k.u - (p + (q - p) * k.t)).abs() < 1.0).collect();
    let squares: f64 = on.iter().map(|k| (k.u - (p + (q - p) * k.t)).powi(2)).sum();
    let spread = (squares / on.len().max(1) as f64).sqrt();
    // Neighbouring profiles share pixels: one in three counts.
    let error = spread.max(0.05) / (on.len() as f64 / 3.0).max(1.0).sqrt();
    let slope = median(on.iter().map(|k| k.slope).collect())?;
    let reach = look.reach as f64 + 1.0;
    let kept = p.abs() <= reach && q.abs() <= reach;
    kept.then_some(LineFit { p, q, coverage: on.len() as f64 / count as f64, spread, error, slope })
}

/// Of each profile the peak that is nearest to the line.
fn nearest(peaks: &[Peak], p: f64, q: f64) -> Vec<Peak> {
    let off = |k: &Peak| (k.u - (p + (q - p) * k.t)).abs();
    let mut near: Vec<Peak> = Vec::new();
    for k in peaks {
        match near.last_mut() {
            Some(last) if last.t == k.t => {
                if off(k) < off(last) {
                    *last = *k;
                }
            }
            _ => near.push(*k),
        }
    }
    near
}

/// One step of the fit: end offsets from the peaks within `reach` of the line.
fn weighted(near: &[Peak], p: f64, q: f64, reach: f64) -> Option<(f64, f64)> {
    let (mut s, mut st, mut stt, mut su, mut stu) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for k in near {
        let off = (k.u - (p + (q - p) * k.t)) / reach;
        let w = if off.abs() < 1.0 { (1.0 - off * off).powi(2) } else { 0.0 };
        s += w;
        st += w * k.t;
        stt += w * k.t * k.t;
        su += w * k.u;
        stu += w * k.t * k.u;
    }
    let determinant = s * stt - st * st;
    (determinant > 1e-9).then(|| {
        let slope = (s * stu - st * su) / determinant;
        let start = (su - slope * st) / s;
        (start, start + slope)
    })
}

pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Share of the profiles beyond the corner `from`, up to `to`, whose peak continues the line as
/// strongly as `slope`.
pub(crate) fn continues(
    photo: &RgbImage,
    from: Point2<f64>,
    to: Point2<f64>,
    look: &SideSampling,
    slope: f64,
) -> f64 {
    let Some(normal) = across(from, to) else { return 0.0 };
    let length = (to - from).norm();
    let count = ((length / look.step) as usize).clamp(4, look.most.max(4));
    let mut on = 0;
    for n in 0..count {
        let at = from + (to - from) * ((n as f64 + 0.5) / count as f64);
        let mut seen = false;
        profile(photo, at, normal, (to - from) / length, look, |u, s| {
            seen |= u.abs() < 1.0 && s > 0.4 * slope
        });
        on += usize::from(seen);
    }
    on as f64 / count as f64
}
