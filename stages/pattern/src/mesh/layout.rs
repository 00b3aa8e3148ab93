//! The stretches of an outline and its inner lines, as they lie before anything is divided.
//!
//! A stretch is a named edge, or what lies between two corners where there are no names. What must
//! become a vertex whatever the division is marked on it: corners inside it, the feet of inner
//! lines. Cost: linear in the points of the outline, times the number of inner lines' ends.

use super::polyline::Polyline;
use toile_core::prelude::*;

/// An end of an inner line this near to the outline (in edge lengths) is meant to lie on it.
pub(crate) const SNAP: f64 = 0.05;

/// An inner line keeps its own corners that turn more than this (degrees).
const INNER_CORNER: f64 = 20.0;

/// A closed stretch without corners has at least this many parts, so that it stays a loop with
/// blunt angles.
const LEAST_CLOSED: usize = 6;

/// A stretch of a loop between two of its points.
pub(crate) struct Stretch<'a> {
    /// The named edge's name.
    pub name: Option<&'a str>,
    /// What a named edge and its partner agree upon.
    pub gauge: Option<Gauge>,
    /// Its points.
    pub line: Polyline,
    /// Arc lengths that must become vertices.
    pub marks: Vec<f64>,
    /// Whether it ends where it starts.
    pub closed: bool,
}

impl Stretch<'_> {
    /// The least number of parts that keeps its marks and, if it is closed, a loop.
    pub(crate) fn least(&self) -> usize {
        if self.closed { LEAST_CLOSED } else { 1 }.max(self.marks.len() + 1)
    }
}

/// An inner line, its ends laid onto what they touch.
pub(crate) struct Line<'a> {
    /// Its name and purpose.
    pub inner: &'a InnerLine,
    /// Its points.
    pub path: Polyline,
    /// Arc lengths that must become vertices.
    pub marks: Vec<f64>,
}

/// The stretches of the loops, outer first, and the inner lines.
pub(crate) struct Layout<'a> {
    /// Each loop in its mesh direction: outer counter-clockwise, holes clockwise.
    pub loops: Vec<Vec<Stretch<'a>>>,
    /// Darts, pleats, folds.
    pub lines: Vec<Line<'a>>,
    /// Edge length that snapping distances are measured in, metres.
    pub h: f64,
}

impl<'a> Layout<'a> {
    /// Of an outline that has been checked, for edges of about `h` (metres).
    pub(crate) fn of(outline: &'a Outline, h: f64) -> Self {
        let mut loops = stretches(outline);
        let lines = inner_lines(outline, &mut loops, h);
        Layout { loops, lines, h }
    }

    /// All stretches, loop by loop.
    pub(crate) fn stretches(&self) -> impl Iterator<Item = &Stretch<'a>> {
        self.loops.iter().flatten()
    }

    /// The legs of darts that meet leg `i`, itself among them; none for other lines.
    pub(crate) fn legs(&self, i: usize) -> Vec<usize> {
        let dart = |i: usize| self.lines[i].inner.kind == InnerKind::Dart;
        let ends = |i: usize| {
            let points = &self.lines[i].path.points;
            [points[0], points[points.len() - 1]]
        };
        let touch =
            |j: usize| ends(i).iter().any(|p| ends(j).iter().any(|q| (p - q).norm() <= SNAP * self.h));
        (0..self.lines.len()).filter(|&j| dart(i) && dart(j) && touch(j)).collect()
    }
}

/// The loops' stretches, each loop in its mesh direction: outer counter-clockwise, holes clockwise.
fn stretches(outline: &Outline) -> Vec<Vec<Stretch<'_>>> {
    let outer = match outline.edges.is_empty() {
        true => between_corners(&outline.outer),
        false => named_stretches(outline),
    };
    let hole = |h: &Loop| match polygon_area(&h.points) > 0.0 {
        true => between_corners(&reversed(h)),
        false => between_corners(h),
    };
    std::iter::once(outer).chain(outline.holes.iter().map(hole)).collect()
}

fn reversed(lp: &Loop) -> Loop {
    let n = lp.points.len();
    let corners = lp.corners.iter().rev().filter(|&&c| c < n).map(|c| n - 1 - c).collect();
    Loop { points: lp.points.iter().rev().copied().collect(), corners }
}

/// The points of a loop from one index to another, going on over its end; all the way round
/// where both are the same.
fn walk(lp: &Loop, start: usize, end: usize) -> Vec<Point2> {
    let n = lp.points.len();
    let count = (end + n - start - 1) % n + 1;
    (0..=count).map(|k| lp.points[(start + k) % n]).collect()
}

fn between_corners<'a>(lp: &Loop) -> Vec<Stretch<'a>> {
    let mut corners: Vec<usize> = lp.corners.iter().copied().filter(|&c| c < lp.points.len()).collect();
    corners.sort_unstable();
    corners.dedup();
    unnamed(lp, &corners)
}

/// Unnamed stretches from each of the indices to the next, and round to the first.
fn unnamed<'a>(lp: &Loop, stops: &[usize]) -> Vec<Stretch<'a>> {
    let stops = if stops.is_empty() { &[0] } else { stops };
    let next = stops.iter().cycle().skip(1);
    let stretch = |(&a, &b): (&usize, &usize)| Stretch {
        name: None,
        gauge: None,
        line: Polyline::new(walk(lp, a, b)),
        marks: Vec::new(),
        closed: a == b,
    };
    stops.iter().zip(next).map(stretch).filter(|s| s.line.length() > 0.0).collect()
}

/// Named edges in their order round the loop, and unnamed stretches where they leave a gap.
fn named_stretches(outline: &Outline) -> Vec<Stretch<'_>> {
    let mut edges: Vec<&Edge> = outline.edges.iter().collect();
    edges.sort_by_key(|e| e.start);
    let mut out = Vec::new();
    for (k, e) in edges.iter().enumerate() {
        let line = Polyline::new(outline.edge_points(e));
        let marks = corner_marks(outline, e, &line);
        let (name, gauge) = (Some(e.name.as_str()), Some(e.gauge));
        out.push(Stretch { name, gauge, line, marks, closed: e.start == e.end });
        let next = edges[(k + 1) % edges.len()].start;
        if next != e.end {
            out.extend(gap(&outline.outer, e.end, next));
        }
    }
    out
}

/// Corners that lie inside a named edge.
fn corner_marks(outline: &Outline, edge: &Edge, line: &Polyline) -> Vec<f64> {
    let n = outline.outer.points.len();
    let offset = |&c: &usize| (c + n - edge.start) % n;
    let last = line.points.len() - 1;
    let mut offsets: Vec<usize> =
        outline.outer.corners.iter().filter(|&&c| c < n).map(offset).filter(|&k| k > 0 && k < last).collect();
    offsets.sort_unstable();
    offsets.into_iter().map(|k| line.arc[k]).collect()
}

/// The loop from `start` to `end`, cut at its corners.
fn gap<'a>(lp: &Loop, start: usize, end: usize) -> Vec<Stretch<'a>> {
    let n = lp.points.len();
    let span = (end + n - start) % n;
    let mut stops: Vec<usize> = lp.corners.iter().filter(|&&c| c < n).map(|c| (c + n - start) % n).collect();
    stops.retain(|&k| k > 0 && k < span);
    stops.extend([0, span]);
    stops.sort_unstable();
    stops.dedup();
    let piece = |w: &[usize]| Stretch {
        name: None,
        gauge: None,
        line: Polyline::new(walk(lp, (start + w[0]) % n, (start + w[1]) % n)),
        marks: Vec::new(),
        closed: false,
    };
    stops.windows(2).map(piece).filter(|s| s.line.length() > 0.0).collect()
}

/// The inner lines with their ends laid onto what they touch, and their marks; what they touch on
/// the outline becomes a mark there.
fn inner_lines<'a>(outline: &'a Outline, loops: &mut [Vec<Stretch<'_>>], h: f64) -> Vec<Line<'a>> {
    let mut lines: Vec<Vec<Point2>> = outline.inner.iter().map(|l| l.points.clone()).collect();
    for points in &mut lines {
        let last = points.len() - 1;
        for k in [0, last] {
            if let Some(foot) = land_on_loops(points[k], loops, h) {
                points[k] = foot;
            }
        }
    }
    let lines: Vec<Polyline> = lines.into_iter().map(Polyline::new).collect();
    let marks = (0..lines.len()).map(|i| line_marks(&lines, i, h)).collect::<Vec<_>>();
    let named = outline.inner.iter().zip(lines).zip(marks);
    named.map(|((inner, path), marks)| Line { inner, path, marks }).collect()
}

/// Where the end of an inner line meets the outline, which gets a mark there.
fn land_on_loops(p: Point2, loops: &mut [Vec<Stretch<'_>>], h: f64) -> Option<Point2> {
    let nearest = loops.iter_mut().flatten().map(|s| (s.line.nearest(p), s));
    let ((distance, arc), stretch) = nearest.min_by(|a, b| a.0.0.total_cmp(&b.0.0))?;
    if distance > SNAP * h {
        return None;
    }
    let length = stretch.line.length();
    // Near an end or another mark the line starts there: two vertices so close make needles.
    let near =
        [0.0, length].into_iter().chain(stretch.marks.iter().copied()).find(|m| (m - arc).abs() <= SNAP * h);
    let arc = near.unwrap_or(arc);
    if near.is_none() {
        stretch.marks.push(arc);
        stretch.marks.sort_by(f64::total_cmp);
    }
    Some(stretch.line.at(arc))
}

/// Corners of an inner line, and the places where other lines end on it.
fn line_marks(lines: &[Polyline], i: usize, h: f64) -> Vec<f64> {
    let line = &lines[i];
    let mut marks = line.joints(INNER_CORNER.to_radians(), h / 2.0);
    let others = lines.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, l)| l);
    for end in others.flat_map(|l| [l.points[0], l.points[l.points.len() - 1]]) {
        let (distance, arc) = line.nearest(end);
        let clear = |m: f64| (m - arc).abs() > SNAP * h;
        if distance <= SNAP * h && clear(0.0) && clear(line.length()) && marks.iter().all(|&m| clear(m)) {
            marks.push(arc);
        }
    }
    marks.sort_by(f64::total_cmp);
    marks
}
