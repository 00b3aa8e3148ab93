//! Open polylines measured by arc length.

use super::predicates::distance_to_segment;
use toile_core::artifact::{CHORD_TOLERANCE, Point2};

/// A polyline with the arc length of each of its points.
#[derive(Debug, Clone)]
pub(crate) struct Polyline {
    /// Points from start to end.
    pub points: Vec<Point2>,
    /// Arc length of each point, from 0.
    pub arc: Vec<f64>,
}

impl Polyline {
    /// From at least two points.
    pub(crate) fn new(points: Vec<Point2>) -> Self {
        let mut arc = Vec::with_capacity(points.len());
        let mut length = 0.0;
        for (k, p) in points.iter().enumerate() {
            length += if k > 0 { (p - points[k - 1]).norm() } else { 0.0 };
            arc.push(length);
        }
        Polyline { points, arc }
    }

    /// Its whole length.
    pub(crate) fn length(&self) -> f64 {
        self.arc[self.arc.len() - 1]
    }

    /// The point at an arc length; the polyline's own point, bit for bit, where there is one.
    pub(crate) fn at(&self, arc: f64) -> Point2 {
        let k = self.arc.partition_point(|&a| a < arc).min(self.arc.len() - 1);
        if k == 0 || self.arc[k] == arc {
            return self.points[k];
        }
        let t = (arc - self.arc[k - 1]) / (self.arc[k] - self.arc[k - 1]);
        self.points[k - 1] + (self.points[k] - self.points[k - 1]) * t
    }

    /// Distance and arc length of its point closest to `p`.
    pub(crate) fn nearest(&self, p: Point2) -> (f64, f64) {
        let on = |k: usize| {
            let (distance, t) = distance_to_segment(p, self.points[k], self.points[k + 1]);
            (distance, self.arc[k] + t * (self.arc[k + 1] - self.arc[k]))
        };
        let segments = (0..self.points.len() - 1).map(on);
        segments.fold((f64::INFINITY, 0.0), |best, d| if d.0 < best.0 { d } else { best })
    }

    /// Arc lengths of the inner points where it turns more than `angle` (radians), or that stand at
    /// least `apart` (metres) from both neighbours: a polygon's corners, however blunt.
    pub(crate) fn joints(&self, angle: f64, apart: f64) -> Vec<f64> {
        let joint = |k: &usize| {
            let (u, v) = (self.points[*k] - self.points[k - 1], self.points[k + 1] - self.points[*k]);
            u.perp(&v).atan2(u.dot(&v)).abs() > angle || u.norm().min(v.norm()) >= apart
        };
        (1..self.points.len() - 1).filter(joint).map(|k| self.arc[k]).collect()
    }

    /// The farthest that it leaves the chords between the given arc lengths.
    pub(crate) fn deviation(&self, arcs: &[f64]) -> f64 {
        arcs.windows(2).map(|w| self.sag(w[0], w[1])).fold(0.0, f64::max)
    }

    /// The farthest that it leaves the chord between two arc lengths.
    pub(crate) fn sag(&self, from: f64, to: f64) -> f64 {
        let (a, b) = (self.at(from), self.at(to));
        let first = self.arc.partition_point(|s| *s <= from);
        let last = self.arc.partition_point(|s| *s < to).max(first);
        self.points[first..last].iter().map(|p| distance_to_segment(*p, a, b).0).fold(0.0, f64::max)
    }
}

/// Arc lengths that cut `length` by `shares` (ascending, in any unit, both ends included), but that
/// the division nearest to each mark slides onto it and its neighbours follow evenly.
///
/// There must be more parts than marks, which are ascending and inside.
pub(crate) fn place(length: f64, shares: &[f64], marks: &[f64]) -> Vec<f64> {
    let n = shares.len() - 1;
    let mut stops = vec![(0, 0.0)];
    for (k, &mark) in marks.iter().enumerate() {
        let (least, most) = (stops[k].0 + 1, n - (marks.len() - k));
        stops.push((nearest(shares, mark / length * shares[n]).clamp(least, most), mark));
    }
    stops.push((n, length));
    let mut arcs = vec![0.0];
    for w in stops.windows(2) {
        let ((i, a), (j, b)) = (w[0], w[1]);
        let part = shares[j] - shares[i];
        arcs.extend((i + 1..j).map(|k| a + (b - a) * ((shares[k] - shares[i]) / part)));
        arcs.push(b);
    }
    arcs
}

/// The share nearest to `x`; of two as near the greater.
fn nearest(shares: &[f64], x: f64) -> usize {
    let k = shares.partition_point(|s| *s <= x).clamp(1, shares.len() - 1);
    if x - shares[k - 1] < shares[k] - x { k - 1 } else { k }
}

/// The shares of `n` equal parts.
pub(crate) fn even(n: usize) -> Vec<f64> {
    (0..=n).map(|k| k as f64).collect()
}

/// The shares with each part cut into `times` equal ones.
pub(crate) fn finer(shares: &[f64], times: usize) -> Vec<f64> {
    let part =
        |w: &[f64]| (0..times).map(|k| w[0] + (w[1] - w[0]) * (k as f64 / times as f64)).collect::<Vec<_>>();
    shares.windows(2).flat_map(part).chain(shares.last().copied()).collect()
}

/// The least count, no less than `least`, whose parts are at most `h` long and whose chords stay
/// within half of the tolerance.
pub(crate) fn fine_enough(line: &Polyline, marks: &[f64], least: usize, h: f64) -> usize {
    let length = line.length();
    // Parts shorter than an eighth are no longer a matter of curvature but of a missed corner.
    let most = ((8.0 * length / h).ceil() as usize).max(least);
    let mut n = ((length / h - 1e-9).ceil() as usize).clamp(least, most);
    while n < most && line.deviation(&place(length, &even(n), marks)) > 0.5 * CHORD_TOLERANCE * h {
        n = (n + n.div_ceil(10)).min(most);
    }
    n
}
