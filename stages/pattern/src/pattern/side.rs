//! A stretch of an outline as curves, and outlines of such stretches.
//!
//! A [`Side`] keeps every curve as it was drawn. [`Side::curve`] makes one edge of it: itself where
//! it is one curve, else points that are near enough for its length to be right to [`NEAR`]. Cost:
//! microseconds per curve. Limits: sides are split by the angle at which curves meet, not within a
//! curve.

use crate::mesh::crossing::first_crossing;
use toile_core::prelude::*;

/// Outlines are split where they turn by more than this, degrees.
pub(super) const CORNER: f64 = 25.0;
/// Joined curves become chords, whose length is less than that of the curves by at most this share.
const NEAR: f64 = 5e-7;
/// Chords are halved no further than this, metres.
const SHORTEST: f64 = 1e-4;
/// Chords are halved no more often than this.
const HALVINGS: u32 = 12;

/// A stretch of an outline with its name; lengths in metres.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Side {
    pub name: String,
    pub start: Point2,
    /// Curves that follow each other, each with its end.
    pub parts: Vec<(EdgeCurve, Point2)>,
}

impl Side {
    /// Straight from point to point; at least one point.
    pub(super) fn polyline(name: String, points: &[Point2]) -> Self {
        let parts = points[1..].iter().map(|p| (EdgeCurve::Line, *p)).collect();
        Side { name, start: points[0], parts }
    }

    pub(super) fn end(&self) -> Point2 {
        self.parts.last().map_or(self.start, |(_, end)| *end)
    }

    /// Moves its end there.
    pub(super) fn end_at(&mut self, p: Point2) {
        if let Some((_, end)) = self.parts.last_mut() {
            *end = p;
        }
    }

    fn paths(&self) -> impl Iterator<Item = EdgePath> {
        let starts = std::iter::once(self.start).chain(self.parts.iter().map(|(_, end)| *end));
        starts.zip(&self.parts).map(|(start, (curve, end))| EdgePath::new(start, *end, curve))
    }

    pub(super) fn length(&self) -> f64 {
        self.paths().map(|p| p.length()).sum()
    }

    /// Points to draw it by, both ends included.
    pub(super) fn points(&self) -> Vec<Point2> {
        let inner = self.paths().flat_map(|p| p.points().split_off(1));
        std::iter::once(self.start).chain(inner).collect()
    }

    /// With every point moved; `mirrors` where that turns left into right.
    pub(super) fn moved(&self, to: impl Fn(Point2) -> Point2 + Copy, mirrors: bool) -> Self {
        let part = |(curve, end): &(EdgeCurve, Point2)| (curve.moved(to, mirrors), to(*end));
        Side { name: self.name.clone(), start: to(self.start), parts: self.parts.iter().map(part).collect() }
    }

    /// From its end to its start.
    pub(super) fn turned(&self) -> Self {
        let ends = std::iter::once(self.start).chain(self.parts.iter().map(|(_, end)| *end));
        let parts = ends.zip(&self.parts).map(|(start, (curve, _))| (curve.turned(), start));
        let mut parts: Vec<_> = parts.collect();
        parts.reverse();
        Side { name: self.name.clone(), start: self.end(), parts }
    }

    /// Both as one, under its own name.
    pub(super) fn joined(&self, next: &Side) -> Self {
        Side { parts: [self.parts.as_slice(), &next.parts].concat(), ..self.clone() }
    }

    /// The directions in which it starts and ends.
    pub(super) fn directions(&self) -> [Vector2; 2] {
        let first = self.parts.first().map_or_else(Vector2::zeros, |(c, end)| starts(self.start, c, *end));
        let back = self.turned();
        let last = back.parts.first().map_or_else(Vector2::zeros, |(c, end)| starts(back.start, c, *end));
        [first, -last]
    }

    /// It as the curve of one edge.
    pub(super) fn curve(&self) -> EdgeCurve {
        if let [(curve, _)] = &self.parts[..] {
            return curve.clone();
        }
        let mut points = Vec::new();
        for (path, (curve, end)) in self.paths().zip(&self.parts) {
            match curve {
                EdgeCurve::Line => {}
                EdgeCurve::Polyline { points: inner } => points.extend(inner),
                EdgeCurve::Quadratic { .. } | EdgeCurve::Cubic { .. } | EdgeCurve::Arc { .. } => {
                    finely(&path, [0.0, path.length()], HALVINGS, &mut points);
                }
            }
            points.push(*end);
        }
        points.pop();
        EdgeCurve::Polyline { points }
    }
}

/// Points between two lengths of a path, halved until their chords are nearly as long as it.
fn finely(path: &EdgePath, [from, to]: [f64; 2], left: u32, out: &mut Vec<Point2>) {
    let length = to - from;
    let middle = f64::midpoint(from, to);
    let [a, b, c] = [from, middle, to].map(|s| path.at(s));
    // Two chords miss a quarter of what one misses.
    let missed = (length - (b - a).norm() - (c - b).norm()) * 4.0;
    if left == 0 || length <= SHORTEST || missed.max(length - (c - a).norm()) <= NEAR * length {
        return;
    }
    finely(path, [from, middle], left - 1, out);
    out.push(b);
    finely(path, [middle, to], left - 1, out);
}

/// The direction in which a curve leaves its start: towards the first of its points that lies
/// elsewhere.
fn starts(start: Point2, curve: &EdgeCurve, end: Point2) -> Vector2 {
    let towards = |points: &[Point2]| {
        let all = points.iter().chain([&end]).map(|p| p - start);
        all.into_iter().find(|d| d.norm() > 1e-7).unwrap_or_else(|| end - start)
    };
    match curve {
        EdgeCurve::Line => end - start,
        EdgeCurve::Quadratic { control } => towards(&[*control]),
        EdgeCurve::Cubic { controls } => towards(controls),
        EdgeCurve::Polyline { points } => towards(points),
        // Half the arc's angle from its chord, to the right where it turns to the left.
        EdgeCurve::Arc { bulge } => nalgebra::Rotation2::new(-2.0 * bulge.atan()) * (end - start),
    }
}

/// Whether one stretch goes on smoothly in the other, to that many degrees.
pub(super) fn smooth(one: &Side, other: &Side, degrees: f64) -> bool {
    let (u, v) = (one.directions()[1], other.directions()[0]);
    u.perp(&v).atan2(u.dot(&v)).abs() <= degrees.to_radians()
}

/// The curves of a closed line, of which there are two at least: one that comes back to its start
/// is halved.
fn halved(start: Point2, parts: &[(EdgeCurve, Point2)]) -> Vec<(EdgeCurve, Point2)> {
    let [(EdgeCurve::Cubic { controls: [b, c] }, d)] = parts else { return parts.to_vec() };
    let middle = |p: &Point2, q: &Point2| nalgebra::center(p, q);
    let (ab, bc, cd) = (middle(&start, b), middle(b, c), middle(c, d));
    let (abc, bcd) = (middle(&ab, &bc), middle(&bc, &cd));
    vec![
        (EdgeCurve::Cubic { controls: [ab, abc] }, middle(&abc, &bcd)),
        (EdgeCurve::Cubic { controls: [bcd, cd] }, *d),
    ]
}

/// A closed line split where it turns; two parts at least where it has two curves or one that can
/// be halved, none where it has no curve.
pub(super) fn split(start: Point2, parts: &[(EdgeCurve, Point2)]) -> Vec<Side> {
    let parts = halved(start, parts);
    let n = parts.len();
    let one = |k: usize| {
        let from = if k == 0 { start } else { parts[k - 1].1 };
        Side { name: String::new(), start: from, parts: vec![parts[k].clone()] }
    };
    let all: Vec<Side> = (0..n).map(one).collect();
    let mut stops: Vec<usize> = (0..n).filter(|&k| !smooth(&all[(k + n - 1) % n], &all[k], CORNER)).collect();
    if stops.len() < 2 && n > 0 {
        stops = vec![0, n / 2];
    }
    let m = stops.len();
    let side = |k: usize| {
        let (from, to) = (stops[k], stops[(k + 1) % m]);
        let count = (to + n - from - 1) % n + 1;
        let mut side = all[from].clone();
        (1..count).for_each(|i| side = side.joined(&all[(from + i) % n]));
        Side { name: format!("edge_{k}"), ..side }
    };
    (0..m).map(side).collect()
}

/// The points of a loop, not repeating the first.
pub(super) fn points(sides: &[Side]) -> Vec<Point2> {
    let without_end = |s: &Side| {
        let mut points = s.points();
        points.pop();
        points
    };
    sides.iter().flat_map(without_end).collect()
}

/// What an outline of a piece must not be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum NotSimple {
    /// It encloses less than the least area.
    NoArea,
    /// It crosses itself there, as it was drawn, y up, metres.
    Crosses(Point2),
}

/// Errors: an outline of less area than `least`, square metres, or one that crosses itself. `turn`
/// is the cosine and the sine of the angle by which it was turned.
pub(super) fn check_simple(sides: &[Side], least: f64, turn: Vector2) -> Result<(), NotSimple> {
    let points = points(sides);
    let n = points.len() as u32;
    if n < 3 || polygon_area(&points).abs() < least {
        return Err(NotSimple::NoArea);
    }
    let segments: Vec<[u32; 2]> = (0..n).map(|i| [i, (i + 1) % n]).collect();
    let Some([_, other]) = first_crossing(&points, &segments) else { return Ok(()) };
    let p = points[other];
    Err(NotSimple::Crosses(Point2::new(turn.x * p.x + turn.y * p.y, turn.x * p.y - turn.y * p.x)))
}

/// The loop turned counter-clockwise.
pub(super) fn counter_clockwise(mut sides: Vec<Side>) -> Vec<Side> {
    if polygon_area(&points(&sides)) < 0.0 {
        sides.reverse();
        sides.iter_mut().for_each(|s| *s = s.turned());
    }
    sides
}

/// The loop as a piece keeps it.
pub(super) fn pattern_loop(sides: &[Side]) -> PatternLoop {
    PatternLoop {
        corners: sides.iter().map(|s| s.start).collect(),
        edges: sides.iter().map(|s| PieceEdge { name: s.name.clone(), curve: s.curve() }).collect(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn p(x: f64, y: f64) -> Point2 {
        Point2::new(x, y)
    }

    /// A quarter of a circle of that radius about the origin, as a cubic that misses it by no more
    /// than some micrometres.
    fn quarter(r: f64) -> (EdgeCurve, Point2) {
        let k = 0.552_284_75 * r;
        (EdgeCurve::Cubic { controls: [p(r, k), p(k, r)] }, p(0.0, r))
    }

    #[test]
    fn joined_curves_keep_their_length_to_a_millionth() {
        let (a, end) = quarter(0.2);
        let (b, last) = (EdgeCurve::Cubic { controls: [p(-0.1, 0.2), p(-0.3, 0.3)] }, p(-0.3, 0.5));
        let side = Side { name: "cap".into(), start: p(0.2, 0.0), parts: vec![(a, end), (b, last)] };
        let edge = EdgePath::new(side.start, side.end(), &side.curve());
        assert!((edge.length() / side.length() - 1.0).abs() < 1e-6, "{} {}", edge.length(), side.length());
        assert_eq!(side.turned().turned(), side);
        assert!((side.turned().length() - side.length()).abs() < 1e-12);
    }

    #[test]
    fn a_loop_is_split_at_corners_and_not_where_curves_go_on() {
        let (curve, end) = quarter(0.2);
        let goes_on = (EdgeCurve::Cubic { controls: [p(-0.1, 0.2), p(-0.2, 0.2)] }, p(-0.3, 0.1));
        let sides = split(p(0.2, 0.0), &[(curve, end), goes_on, (EdgeCurve::Line, p(0.2, 0.0))]);
        let parts: Vec<(&str, usize)> = sides.iter().map(|s| (s.name.as_str(), s.parts.len())).collect();
        assert_eq!(parts, [("edge_0", 2), ("edge_1", 1)]);
        assert_eq!(sides[1].curve(), EdgeCurve::Line);
        let clockwise: Vec<Side> = sides.iter().rev().map(Side::turned).collect();
        assert_eq!(counter_clockwise(clockwise), sides);
        assert_eq!(split(p(0.2, 0.0), &[]), []);
    }
}
