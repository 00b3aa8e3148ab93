//! From the mask's staircase to the operator's edge, at a fraction of a pixel.
//!
//! Method: the boundary is smoothed by a pixel or two; from each of its points the operator's
//! answer is sampled along the normal, the best edge within reach is taken, and its place is found
//! by a parabola (ridges) or a straight line (zero crossings) through the samples around it.
//! Offsets that leave the median of their neighbours are dropped. Where nothing is seen the mask's
//! own half-way crossing stays. Cost: about 1 us a boundary point.

use super::operator::{Accept, OperatorResponse};
use rayon::prelude::*;
use toile_core::artifact::{Point2, Vector2};

/// Smoothing of the staircase, boundary points (about pixels): a staircase's steps are this long on
/// gentle slopes, and more would pull corners in beyond the search.
const BASE_SIGMA: f64 = 1.6;
/// Smoothing before the normals are taken: longer, because a normal is a derivative.
const NORMAL_SIGMA: f64 = 3.0;
/// Distance between samples along the normal, pixels.
const STEP: f64 = 0.5;
/// Neighbours on each side whose median an offset is compared with.
const NEIGHBOURS: usize = 10;
/// Greatest difference from that median, pixels.
const OUTLIER: f64 = 0.8;

/// A boundary moved onto the operator's edges.
pub(crate) struct Refined {
    /// Closed loop, pixels, y up.
    pub(crate) points: Vec<Point2>,
    /// The share of points at which an edge was seen.
    pub(crate) seen: f64,
}

/// Moves a crack loop (pixels, y up) onto the edges within `reach` pixels.
pub(crate) fn refine(cracks: &[Point2], response: &OperatorResponse, reach: f64) -> Refined {
    let base = smooth_closed(cracks, BASE_SIGMA);
    let normals = normals(&smooth_closed(cracks, NORMAL_SIGMA));
    let raw: Vec<Option<f64>> =
        base.par_iter().zip(&normals).map(|(&p, &n)| offset(response, p, n, reach)).collect();
    let kept: Vec<Option<f64>> = (0..raw.len()).into_par_iter().map(|i| without_outlier(&raw, i)).collect();
    let seen = kept.iter().flatten().count() as f64 / kept.len().max(1) as f64;
    let points = (0..base.len()).map(|i| base[i] + normals[i] * kept[i].unwrap_or(0.0)).collect();
    Refined { points, seen }
}

/// Gaussian smoothing of a closed polyline along its index.
pub(crate) fn smooth_closed(points: &[Point2], sigma: f64) -> Vec<Point2> {
    let n = points.len();
    let reach = ((3.0 * sigma).ceil() as usize).min(n / 2);
    let weight = |d: usize| (-((d * d) as f64) / (2.0 * sigma * sigma)).exp();
    let total: f64 = 1.0 + 2.0 * (1..=reach).map(weight).sum::<f64>();
    (0..n)
        .map(|i| {
            let pair = |d: usize| points[(i + d) % n].coords + points[(i + n - d) % n].coords;
            let sum = (1..=reach).fold(points[i].coords, |sum, d| sum + pair(d) * weight(d));
            Point2::from(sum / total)
        })
        .collect()
}

/// Unit normals to the right of the direction of travel (outwards of a counter-clockwise loop).
fn normals(points: &[Point2]) -> Vec<Vector2> {
    let n = points.len();
    (0..n)
        .map(|i| {
            let t = points[(i + 1) % n] - points[(i + n - 1) % n];
            Vector2::new(t.y, -t.x).try_normalize(1e-12).unwrap_or_else(Vector2::zeros)
        })
        .collect()
}

/// How far along the normal the best edge lies, if any is within reach.
fn offset(response: &OperatorResponse, p: Point2, normal: Vector2, reach: f64) -> Option<f64> {
    let steps = (reach / STEP).ceil() as i64;
    let at = |k: i64| k as f64 * STEP;
    match response {
        OperatorResponse::Ridge { signal, accept, centre } => {
            let shift = Vector2::new(-centre, *centre);
            let samples: Vec<f64> =
                (-steps - 1..=steps + 1).map(|k| signal.sample(p + normal * at(k) + shift)).collect();
            best_peak(&samples, |i, value| {
                let t = at(i as i64 - steps - 1);
                match accept {
                    Accept::Above(level) => value >= *level,
                    Accept::Marked(edges) => edges.greatest_near(p + normal * t) > 0.0,
                }
            })
            .map(|i| (i - (steps + 1) as f64) * STEP)
        }
        OperatorResponse::ZeroCrossing { signal, least } => {
            let samples: Vec<f64> = (-steps..=steps).map(|k| signal.sample(p + normal * at(k))).collect();
            best_crossing(&samples, least * STEP).map(|i| (i - steps as f64) * STEP)
        }
    }
}

/// Nearer edges win over slightly stronger ones: the weight falls to a half at the end of the
/// reach.
fn nearness(i: f64, count: usize) -> f64 {
    let middle = (count - 1) as f64 / 2.0;
    1.0 - 0.5 * ((i - middle) / middle).powi(2)
}

/// The place (in samples) of the strongest accepted peak.
fn best_peak(samples: &[f64], accepted: impl Fn(usize, f64) -> bool) -> Option<f64> {
    let mut best: Option<(f64, f64)> = None;
    for (i, w) in samples.windows(3).enumerate() {
        let [a, b, c] = [w[0], w[1], w[2]];
        if b <= 0.0 || b < a || b <= c || !accepted(i + 1, b) {
            continue;
        }
        let strength = b * nearness((i + 1) as f64, samples.len());
        if best.is_none_or(|(s, _)| strength > s) {
            // Top of the parabola through the three samples; the curvature is negative here.
            best = Some((strength, (i + 1) as f64 + 0.5 * (a - c) / (a - 2.0 * b + c)));
        }
    }
    best.map(|(_, place)| place)
}

/// The place (in samples) of the steepest zero crossing that changes by at least `least`.
fn best_crossing(samples: &[f64], least: f64) -> Option<f64> {
    let mut best: Option<(f64, f64)> = None;
    for (i, w) in samples.windows(2).enumerate() {
        let change = (w[1] - w[0]).abs();
        if (w[0] < 0.0) == (w[1] < 0.0) || change < least {
            continue;
        }
        let place = i as f64 + w[0] / (w[0] - w[1]);
        let strength = change * nearness(place, samples.len());
        if best.is_none_or(|(s, _)| strength > s) {
            best = Some((strength, place));
        }
    }
    best.map(|(_, place)| place)
}

/// The offset of a point, unless it leaves the median of those around it.
fn without_outlier(offsets: &[Option<f64>], i: usize) -> Option<f64> {
    let n = offsets.len();
    let reach = NEIGHBOURS.min(n / 2);
    let mut around: Vec<f64> = (0..=2 * reach).filter_map(|k| offsets[(i + n + k - reach) % n]).collect();
    around.sort_by(f64::total_cmp);
    let median = *around.get(around.len() / 2)?;
    // An edge seen here and there only is no edge.
    let common = 3 * around.len() > 2 * reach;
    offsets[i].filter(|d| common && (d - median).abs() <= OUTLIER)
}
