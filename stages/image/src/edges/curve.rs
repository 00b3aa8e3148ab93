//! Closed curves by arc length: even sampling, and smoothing that keeps corners.
//!
//! Method: between two corners the curve is smoothed by local parabolas (Savitzky and Golay, 1964,
//! in the weighted form of Cleveland, *Robust locally weighted regression*, 1979) over the arc
//! length, with one robust round that takes the weight off points that leave the curve. Windows
//! never reach across a corner, and the corner's exact point is pinned. A local parabola does not
//! shrink curves, as a moving mean does. Cost: window length times curve length. Limits: detail
//! shorter than the window is smoothed away.

use super::refine::smooth_closed;
use rayon::prelude::*;
use toile_core::artifact::{Loop, Point2, Vector2};

/// A corner of a closed curve.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CurveCorner {
    /// Arc length at which the curve passes it.
    pub(crate) at: f64,
    /// The exact point.
    pub(crate) point: Point2,
    /// Signed turn, radians, positive to the left.
    pub(crate) turn: f64,
}

/// A closed curve sampled at even steps.
#[derive(Debug, Clone)]
pub(crate) struct Closed {
    pub(crate) points: Vec<Point2>,
    pub(crate) step: f64,
}

impl Closed {
    /// Samples a closed polyline at steps of about `step`. Arc length is measured on a slightly
    /// smoothed copy, so that noise does not make the curve longer.
    pub(crate) fn sample(points: &[Point2], step: f64) -> Option<Closed> {
        let n = points.len();
        let quiet = smooth_closed(points, 1.0);
        let mut along = vec![0.0];
        for i in 0..n {
            along.push(along[i] + (quiet[(i + 1) % n] - quiet[i]).norm());
        }
        let length = along[n];
        let count = (length / step).round() as usize;
        if n < 8 || count < 8 || !length.is_finite() {
            return None;
        }
        let step = length / count as f64;
        let mut i = 0;
        let place = |k: usize| {
            let s = k as f64 * step;
            while i + 1 < n && along[i + 1] <= s {
                i += 1;
            }
            let t = (s - along[i]) / (along[i + 1] - along[i]).max(f64::MIN_POSITIVE);
            points[i] + (points[(i + 1) % n] - points[i]) * t.clamp(0.0, 1.0)
        };
        Some(Closed { points: (0..count).map(place).collect(), step })
    }

    pub(crate) fn length(&self) -> f64 {
        self.points.len() as f64 * self.step
    }

    /// The point at an arc length, which may lie outside one turn.
    pub(crate) fn at(&self, s: f64) -> Point2 {
        let n = self.points.len();
        let x = (s / self.step).rem_euclid(n as f64);
        let i = (x as usize).min(n - 1);
        self.points[i] + (self.points[(i + 1) % n] - self.points[i]) * (x - i as f64)
    }
}

/// How much is smoothed, in the curve's units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Smoothing {
    /// Half the width of the window.
    pub(crate) window: f64,
    /// The stretch next to a corner that is not trusted.
    pub(crate) gap: f64,
    /// Distance of the points that are given back.
    pub(crate) spacing: f64,
}

/// A corner weighs as much as so many curve points: it was fitted to two whole arms.
const CORNER_WEIGHT: f64 = 40.0;

/// A stretch between corners: places and points, with weights.
struct CurveStretch {
    data: Vec<(f64, Point2, f64)>,
    length: f64,
    closed: bool,
}

/// The smoothed curve with its corners, evenly spaced between them.
pub(crate) fn smooth(curve: &Closed, corners: &[CurveCorner], scale: Smoothing) -> Loop {
    let mut out = Loop::default();
    if corners.is_empty() {
        let stretch = whole(curve, scale);
        out.points = even(&smoothed(&stretch, scale), scale.spacing, true);
        return out;
    }
    for (k, from) in corners.iter().enumerate() {
        let to = &corners[(k + 1) % corners.len()];
        let stretch = between(curve, from, to, scale);
        let mut line = smoothed(&stretch, scale);
        if let Some(first) = line.first_mut() {
            *first = from.point;
        }
        if let Some(last) = line.last_mut() {
            *last = to.point;
        }
        out.corners.push(out.points.len());
        out.points.extend(even(&line, scale.spacing, false));
    }
    out
}

/// The whole curve, with a window's length of it repeated on both sides.
fn whole(curve: &Closed, scale: Smoothing) -> CurveStretch {
    let (n, reach) = (curve.points.len() as i64, (scale.window / curve.step).ceil() as i64);
    let at = |i: i64| (i as f64 * curve.step, curve.points[i.rem_euclid(n) as usize], 1.0);
    CurveStretch { data: (-reach..n + reach).map(at).collect(), length: curve.length(), closed: true }
}

fn between(curve: &Closed, from: &CurveCorner, to: &CurveCorner, scale: Smoothing) -> CurveStretch {
    let total = curve.length();
    let span = match (to.at - from.at).rem_euclid(total) {
        s if s < curve.step => total,
        s => s,
    };
    let first = (from.at / curve.step).ceil() as i64;
    let n = curve.points.len() as i64;
    let gap = scale.gap.min(span / 3.0);
    let inner = (0..n)
        .map(|k| {
            ((first + k) as f64 * curve.step - from.at, curve.points[(first + k).rem_euclid(n) as usize])
        })
        .filter(|(s, _)| (gap..=span - gap).contains(s))
        .map(|(s, p)| (s, p, 1.0));
    let ends = [(0.0, from.point, CORNER_WEIGHT), (span, to.point, CORNER_WEIGHT)];
    let mut data: Vec<_> = ends[..1].iter().copied().chain(inner).collect();
    data.push(ends[1]);
    CurveStretch { data, length: span, closed: false }
}

/// Points of the stretch at steps of half the spacing, both ends included.
fn smoothed(stretch: &CurveStretch, scale: Smoothing) -> Vec<Point2> {
    let count = ((2.0 * stretch.length / scale.spacing).ceil() as usize).max(2);
    let weights = robust_weights(stretch, scale.window);
    (0..=count)
        .into_par_iter()
        .map(|k| local(stretch, &weights, stretch.length * k as f64 / count as f64, scale.window))
        .collect()
}

/// Weights that take points off that leave the curve (Tukey's biweight, at six times the median
/// distance).
fn robust_weights(stretch: &CurveStretch, window: f64) -> Vec<f64> {
    let plain: Vec<f64> = stretch.data.iter().map(|d| d.2).collect();
    let residuals: Vec<f64> =
        stretch.data.par_iter().map(|d| (local(stretch, &plain, d.0, window) - d.1).norm()).collect();
    let mut sorted = residuals.clone();
    sorted.sort_by(f64::total_cmp);
    let limit = (6.0 * sorted[sorted.len() / 2]).max(1e-9);
    let biweight = |r: f64| (1.0 - (r / limit).min(1.0).powi(2)).powi(2);
    plain.iter().zip(&residuals).map(|(w, &r)| if *w > 1.0 { *w } else { w * biweight(r) + 1e-6 }).collect()
}

/// The value at `s` of the parabola fitted to the points in a window about it. The window grows at
/// the ends of a stretch, so that it always holds about as many points.
fn local(stretch: &CurveStretch, weights: &[f64], s: f64, window: f64) -> Point2 {
    let beyond = match stretch.closed {
        true => 0.0,
        false => (window - s).max(0.0).max(window - (stretch.length - s)),
    };
    let reach = window + 0.5 * beyond;
    let data = &stretch.data;
    let low = data.partition_point(|d| d.0 < s - reach);
    let high = data.partition_point(|d| d.0 <= s + reach);
    let mut m = [0.0; 5];
    let mut r = [Vector2::zeros(); 3];
    for (d, weight) in data[low..high].iter().zip(&weights[low..high]) {
        let u = (d.0 - s) / reach;
        // Tricube kernel.
        let mut power = weight * (1.0 - u.abs().powi(3)).max(0.0).powi(3);
        for (j, sum) in m.iter_mut().enumerate() {
            *sum += power;
            if j < 3 {
                r[j] += d.1.coords * power;
            }
            power *= u;
        }
    }
    // A trace of ridge keeps the system solvable where a window holds two points only.
    let e = 1e-9 * m[0];
    let system = nalgebra::Matrix3::new(m[0], m[1], m[2], m[1], m[2] + e, m[3], m[2], m[3], m[4] + e);
    let nearest = || data[low.min(data.len() - 1)].1;
    let Some(c) = system.cholesky() else { return nearest() };
    let value = |k: usize| c.solve(&nalgebra::Vector3::new(r[0][k], r[1][k], r[2][k])).x;
    let p = Point2::new(value(0), value(1));
    if p.x.is_finite() && p.y.is_finite() { p } else { nearest() }
}

/// A polyline divided evenly at about `spacing`, without its last point. A closed one repeats its
/// first point at its end.
fn even(line: &[Point2], spacing: f64, closed: bool) -> Vec<Point2> {
    let mut line = line.to_vec();
    let first = line[0];
    if let (true, Some(last)) = (closed, line.last_mut()) {
        *last = first;
    }
    let length: f64 = line.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    let count = ((length / spacing).round() as usize).max(1);
    let (mut i, mut passed) = (0, 0.0);
    let place = |k: usize| {
        let s = length * k as f64 / count as f64;
        loop {
            let piece = (line[i + 1] - line[i]).norm();
            if s <= passed + piece || i + 2 >= line.len() {
                let t = if piece > 0.0 { ((s - passed) / piece).clamp(0.0, 1.0) } else { 0.0 };
                return line[i] + (line[i + 1] - line[i]) * t;
            }
            passed += piece;
            i += 1;
        }
    };
    (0..count).map(place).collect()
}
