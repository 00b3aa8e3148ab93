//! Divides an outline and its inner lines into the segments that every mesh must contain.
//!
//! Method: each named edge is cut into `gauge.divisions(h)` parts of equal arc length, which is the
//! contract by which two edges that are sewn together get equal vertex counts. A stretch without a
//! name (an outline that no style has named, a hole) runs from corner to corner, or all the way
//! round, and is cut ever finer until its chords stay within half of [`CHORD_TOLERANCE`]. Corners
//! inside a stretch and the feet of inner lines are kept as vertices: the division nearest to each
//! slides onto it, so that the count stays.
//! Cost: linear in the points of the outline, times the number of inner lines' ends.
//! Limits: the count of a named edge is never changed, so an outline rougher than its gauge says
//! leaves the tolerance; [`Division::deviation`] tells by how much.

use super::check::show;
use super::crossing::first_crossing;
use super::polyline::{Polyline, place};
use toile_core::StageError;
use toile_core::prelude::*;

/// An end of an inner line this near to the outline (in edge lengths) is meant to lie on it.
const SNAP: f64 = 0.05;

/// An inner line keeps its own corners that turn more than this (degrees).
const INNER_CORNER: f64 = 20.0;

/// A closed stretch without corners has at least this many parts, so that it stays a loop with
/// blunt angles.
const LEAST_CLOSED: usize = 6;

/// The segments that a mesh of an outline must contain.
#[derive(Debug, Clone, Default)]
pub(crate) struct Division {
    /// Vertices on the outline, then those on inner lines alone.
    pub points: Vec<Point2>,
    /// The outer loop, then the holes.
    pub loops: Vec<Vec<u32>>,
    /// Named edges as chains.
    pub edges: Vec<PanelEdge>,
    /// Inner lines as chains.
    pub chains: Vec<InnerChain>,
    /// The farthest that a chord leaves the true outline, metres.
    pub deviation: f64,
    /// The edge (or `the outline`) where it does.
    pub deviates: String,
    /// The first vertices of the stretches, ascending, and whether each has no name.
    pub stretches: Vec<(u32, bool)>,
}

impl Division {
    /// Segments of the loops.
    pub(crate) fn loop_segments(&self) -> Vec<[u32; 2]> {
        let closed = |l: &Vec<u32>| {
            let n = l.len();
            (0..n).map(|k| [l[k], l[(k + 1) % n]]).collect::<Vec<_>>()
        };
        self.loops.iter().flat_map(closed).collect()
    }

    /// Segments of the inner lines.
    pub(crate) fn chain_segments(&self) -> Vec<[u32; 2]> {
        self.chains.iter().flat_map(|c| c.vertices.windows(2).map(|w| [w[0], w[1]])).collect()
    }

    /// Segments of loops and inner lines.
    pub(crate) fn segments(&self) -> Vec<[u32; 2]> {
        [self.loop_segments(), self.chain_segments()].concat()
    }
}

/// A stretch of a loop between two of its points.
struct Stretch<'a> {
    name: Option<&'a str>,
    gauge: Option<Gauge>,
    line: Polyline,
    /// Arc lengths that must become vertices.
    marks: Vec<f64>,
    closed: bool,
}

/// Divides an outline that has been checked, at a target edge length `h` (metres). The k-th stretch
/// is cut `finer[k]` times as fine if it has no name (1 where the list is too short).
pub(crate) fn divide(outline: &Outline, h: f64, finer: &[usize]) -> Result<Division, StageError> {
    let mut loops = stretches(outline);
    let lines = inner_lines(outline, &mut loops, h);
    let mut division = Division { deviates: "the outline".into(), ..Division::default() };
    for stretches in &loops {
        add_loop(&mut division, stretches, h, finer)?;
    }
    for (line, marks, n) in &lines {
        add_line(&mut division, line, marks, *n, h);
    }
    check_division(&division, h)?;
    Ok(division)
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

/// The inner lines with their ends laid onto what they touch, their marks and their counts; what
/// they touch on the outline becomes a mark there.
fn inner_lines<'a>(
    outline: &'a Outline,
    loops: &mut [Vec<Stretch<'_>>],
    h: f64,
) -> Vec<((&'a InnerLine, Polyline), Vec<f64>, usize)> {
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
    let counts = line_counts(outline, &lines, &marks, h);
    let named = outline.inner.iter().zip(lines);
    named.zip(marks).zip(counts).map(|((l, m), n)| (l, m, n)).collect()
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

/// How many parts each inner line gets. The two legs of a dart end on one point and are sewn to
/// each other, so they get the count of the longer.
fn line_counts(outline: &Outline, lines: &[Polyline], marks: &[Vec<f64>], h: f64) -> Vec<usize> {
    let dart = |i: usize| outline.inner[i].kind == InnerKind::Dart;
    let ends = |i: usize| [lines[i].points[0], lines[i].points[lines[i].points.len() - 1]];
    let touch =
        |i: usize, j: usize| ends(i).iter().any(|p| ends(j).iter().any(|q| (p - q).norm() <= SNAP * h));
    let own: Vec<usize> =
        (0..lines.len()).map(|i| fine_enough(&lines[i], &marks[i], 1 + marks[i].len(), h)).collect();
    let pair = |i: usize| {
        let legs = (0..lines.len()).filter(|&j| dart(i) && dart(j) && touch(i, j));
        legs.map(|j| own[j]).fold(own[i], usize::max)
    };
    (0..lines.len()).map(pair).collect()
}

/// The least count, no less than `least`, whose parts are at most `h` long and whose chords stay
/// within half of the tolerance.
fn fine_enough(line: &Polyline, marks: &[f64], least: usize, h: f64) -> usize {
    let length = line.length();
    // Parts shorter than an eighth are no longer a matter of curvature but of a missed corner.
    let most = ((8.0 * length / h).ceil() as usize).max(least);
    let mut n = ((length / h - 1e-9).ceil() as usize).clamp(least, most);
    while n < most && line.deviation(&place(length, n, marks)) > 0.5 * CHORD_TOLERANCE * h {
        n = (n + n.div_ceil(10)).min(most);
    }
    n
}

fn add_loop(
    division: &mut Division,
    stretches: &[Stretch<'_>],
    h: f64,
    finer: &[usize],
) -> Result<(), StageError> {
    let first = division.points.len() as u32;
    let mut vertices: Vec<u32> = Vec::new();
    let mut chains = Vec::new();
    for s in stretches {
        let start = division.points.len() as u32;
        let times = finer.get(division.stretches.len()).copied().unwrap_or(1);
        division.stretches.push((start, s.name.is_none()));
        let arcs = stretch_arcs(s, h, times)?;
        let deviation = s.line.deviation(&arcs);
        if deviation > division.deviation {
            division.deviation = deviation;
            division.deviates = s.name.map_or("the outline".into(), |n| format!("edge \"{n}\""));
        }
        division.points.extend(arcs[..arcs.len() - 1].iter().map(|&a| s.line.at(a)));
        let end = division.points.len() as u32;
        vertices.extend(start..end);
        chains.extend(s.name.map(|name| (name, start, end)));
    }
    let close = |v: u32| if v as usize == division.points.len() { first } else { v };
    let edge = |(name, start, end): (&str, u32, u32)| PanelEdge {
        name: name.to_owned(),
        vertices: (start..=end).map(close).collect(),
    };
    division.edges.extend(chains.into_iter().map(edge));
    division.loops.push(vertices);
    Ok(())
}

/// The arc lengths of a stretch's vertices, both ends included.
fn stretch_arcs(s: &Stretch<'_>, h: f64, finer: usize) -> Result<Vec<f64>, StageError> {
    let least = if s.closed { LEAST_CLOSED } else { 1 }.max(s.marks.len() + 1);
    let n = match s.gauge {
        Some(gauge) => gauge.divisions(h),
        None => finer * fine_enough(&s.line, &s.marks, least, h),
    };
    if n < s.marks.len() + 1 {
        let name = s.name.unwrap_or("outline");
        return Err(StageError::invalid(format!(
            "edge \"{name}\" is divided into {n} at an edge of {}, too few for its corners and inner lines",
            show(h)
        ))
        .hint("use a smaller edge")
        .at("edge"));
    }
    Ok(place(s.line.length(), n, &s.marks))
}

fn add_line(division: &mut Division, (line, path): &(&InnerLine, Polyline), marks: &[f64], n: usize, h: f64) {
    let arcs = place(path.length(), n, marks);
    let last = arcs.len() - 1;
    let mut vertices = Vec::with_capacity(arcs.len());
    for (k, &arc) in arcs.iter().enumerate() {
        let p = path.at(arc);
        let joint = k == 0 || k == last || marks.contains(&arc);
        let reach = if joint { SNAP * h } else { 0.0 };
        let known = division.points.iter().position(|q| (q - p).norm() <= reach);
        vertices.push(known.unwrap_or(division.points.len()) as u32);
        if known.is_none() {
            division.points.push(p);
        }
    }
    division.chains.push(InnerChain { name: line.name.clone(), kind: line.kind, vertices });
}

fn check_division(division: &Division, h: f64) -> Result<(), StageError> {
    let segments = division.segments();
    let Some([_, j]) = first_crossing(&division.points, &segments) else { return Ok(()) };
    let on_loops = division.loop_segments().len();
    let p = division.points[segments[j][0] as usize];
    let place = format!("near ({:.1}, {:.1}) mm", p.x * 1e3, p.y * 1e3);
    let error = |text: String| StageError::new(ErrorCode::DegenerateTriangles, text);
    match j.checked_sub(on_loops) {
        None => Err(error(format!("at an edge of {} the divided outline crosses itself {place}", show(h)))
            .hint("use a smaller edge")
            .at("edge")),
        Some(k) => {
            let mut before = 0;
            let owner = division.chains.iter().find(|c| {
                before += c.vertices.len() - 1;
                k < before
            });
            let name = owner.map_or("", |c| c.name.as_str());
            Err(error(format!("inner line \"{name}\" crosses the outline or another line {place}"))
                .hint("inner lines may meet the outline and each other at their ends only"))
        }
    }
}
