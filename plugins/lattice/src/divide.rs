//! Outline and inner lines as the segments that the mesh must contain.
//!
//! Method: a named edge is cut into `gauge.divisions(h)` parts of equal arc length, the contract by
//! which two edges that are sewn together get equal counts. A stretch without a name runs from
//! corner to corner and takes its own gauge. Corners inside a stretch and the feet of inner lines
//! are kept: the division nearest to each slides onto it, so that the count stays. Cost: linear in
//! the outline, times the inner lines' ends. Limits: a named edge that is rougher than its gauge
//! says is followed no better than its count allows.

use crate::check::first_crossing;
use toile_core::prelude::*;

/// An end of an inner line this near to another line (in edge lengths) is meant to lie on it.
const SNAP: f64 = 0.05;
/// A closed stretch has at least this many parts, so that it stays a loop.
const LEAST_CLOSED: usize = 6;
/// An inner line keeps its corners that turn more than this (degrees).
const INNER_CORNER: f64 = 20.0;

/// The segments of a mesh-to-be.
#[derive(Debug, Default)]
pub(crate) struct MeshSegments {
    /// Vertices on the loops, then those on inner lines alone.
    pub(crate) points: Vec<Point2>,
    /// The outer loop counter-clockwise, then the holes clockwise.
    pub(crate) loops: Vec<Vec<u32>>,
    /// Named edges.
    pub(crate) edges: Vec<PanelEdge>,
    /// Inner lines.
    pub(crate) chains: Vec<InnerChain>,
}

impl MeshSegments {
    /// Segments of the loops, the cloth on their left.
    pub(crate) fn loop_segments(&self) -> Vec<[u32; 2]> {
        let closed = |l: &Vec<u32>| (0..l.len()).map(|k| [l[k], l[(k + 1) % l.len()]]).collect::<Vec<_>>();
        self.loops.iter().flat_map(closed).collect()
    }

    /// Segments of loops and inner lines.
    pub(crate) fn segments(&self) -> Vec<[u32; 2]> {
        let chains = self.chains.iter().flat_map(|c| c.vertices.windows(2).map(|w| [w[0], w[1]]));
        self.loop_segments().into_iter().chain(chains).collect()
    }
}

/// A polyline by arc length, with the places that must become vertices.
struct MarkedStretch {
    name: Option<String>,
    points: Vec<Point2>,
    arc: Vec<f64>,
    gauge: Gauge,
    closed: bool,
    /// Arc lengths, ascending, ends left out.
    marks: Vec<f64>,
}

impl MarkedStretch {
    fn new(name: Option<&str>, points: Vec<Point2>, corners: &[usize], gauge: Option<Gauge>) -> Self {
        let mut arc = vec![0.0];
        points.windows(2).for_each(|w| arc.push(arc[arc.len() - 1] + (w[1] - w[0]).norm()));
        let marks = corners.iter().map(|&k| arc[k]).collect();
        let gauge = gauge.unwrap_or_else(|| Gauge::of(&points, corners));
        let closed = points.first() == points.last();
        MarkedStretch { name: name.map(str::to_owned), points, arc, gauge, closed, marks }
    }

    fn length(&self) -> f64 {
        self.arc[self.arc.len() - 1]
    }

    /// The point at an arc length; the polyline's own, bit for bit, where there is one.
    fn at(&self, s: f64) -> Point2 {
        let k = self.arc.partition_point(|a| *a < s).min(self.arc.len() - 1);
        if k == 0 || self.arc[k] == s {
            return self.points[k];
        }
        let t = (s - self.arc[k - 1]) / (self.arc[k] - self.arc[k - 1]);
        self.points[k - 1] + (self.points[k] - self.points[k - 1]) * t
    }

    /// Distance to `p` and the arc length of the closest point.
    fn nearest(&self, p: Point2) -> (f64, f64) {
        let on = |k: usize| {
            let (a, d) = (self.points[k], self.points[k + 1] - self.points[k]);
            let t = ((p - a).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            ((p - (a + d * t)).norm(), self.arc[k] + t * (self.arc[k + 1] - self.arc[k]))
        };
        (0..self.points.len() - 1).map(on).fold((f64::INFINITY, 0.0), |b, d| if d.0 < b.0 { d } else { b })
    }

    /// Takes a place that must become a vertex; one near an end or another mark is already there.
    fn mark(&mut self, s: f64, slack: f64) -> f64 {
        let ends = [0.0, self.length()];
        if let Some(&m) = ends.iter().chain(&self.marks).find(|m| (**m - s).abs() <= slack) {
            return m;
        }
        self.marks.push(s);
        self.marks.sort_by(f64::total_cmp);
        s
    }

    /// Arc lengths of its vertices at an edge length `h`.
    fn cut(&self, h: f64) -> Result<Vec<f64>, StageError> {
        let least = self.marks.len() + 1;
        let n = self.gauge.divisions(h);
        let n = match &self.name {
            None => n.max(least).max(if self.closed { LEAST_CLOSED } else { 1 }),
            Some(_) if n >= least => n,
            Some(name) => {
                let text =
                    format!("edge \"{name}\" is divided into {n}, too few for its corners and inner lines");
                return Err(StageError::invalid(text).hint("use a smaller edge").at("edge"));
            }
        };
        Ok(place(self.length(), n, &self.marks))
    }
}

/// `n` equal parts of `length`, but that the division nearest to each mark slides onto it.
fn place(length: f64, n: usize, marks: &[f64]) -> Vec<f64> {
    let mut stops = vec![(0, 0.0)];
    for (k, &mark) in marks.iter().enumerate() {
        let nearest = (mark / length * n as f64).round() as usize;
        stops.push((nearest.clamp(stops[k].0 + 1, n - (marks.len() - k)), mark));
    }
    stops.push((n, length));
    let mut arcs = vec![0.0];
    for w in stops.windows(2) {
        let ((i, a), (j, b)) = (w[0], w[1]);
        arcs.extend((1..j - i).map(|k| a + (b - a) * (k as f64 / (j - i) as f64)));
        arcs.push(b);
    }
    arcs
}

/// Divides a checked outline at an edge length `h` (metres).
pub(crate) fn divide(outline: &Outline, h: f64) -> Result<MeshSegments, StageError> {
    let mut loops: Vec<Vec<MarkedStretch>> = vec![outer(outline)];
    loops.extend(outline.holes.iter().map(|hole| pieces(&clockwise(hole), &hole_stops(hole))));
    let lines = lines(outline, &mut loops, h);
    let mut division = MeshSegments::default();
    for stretches in &loops {
        add_loop(&mut division, stretches, h)?;
    }
    for (line, stretch) in outline.inner.iter().zip(&lines) {
        add_line(&mut division, line, stretch, h)?;
    }
    match first_crossing(&division.points, &division.segments()) {
        None => Ok(division),
        Some(p) => Err(StageError::new(
            ErrorCode::DegenerateTriangles,
            format!(
                "at an edge of {} the divided outline or an inner line crosses another near ({:.1}, {:.1}) mm",
                Length::m(h),
                p.x * 1e3,
                p.y * 1e3
            ),
        )
        .hint("use a smaller edge; inner lines may meet the outline and each other at their ends only")
        .at("edge")),
    }
}

fn clockwise(hole: &Loop) -> Vec<Point2> {
    let mut points = hole.points.clone();
    if polygon_area(&points) > 0.0 {
        points.reverse();
    }
    points
}

fn hole_stops(hole: &Loop) -> Vec<usize> {
    let n = hole.points.len();
    let turned = polygon_area(&hole.points) > 0.0;
    let mut stops: Vec<usize> = hole.corners.iter().map(|&c| if turned { n - 1 - c } else { c }).collect();
    stops.sort_unstable();
    stops
}

/// The points of a closed loop from one index to another, round its end; all the way where they are
/// the same.
fn walk(points: &[Point2], from: usize, to: usize) -> Vec<Point2> {
    let n = points.len();
    (0..=(to + n - from - 1) % n + 1).map(|k| points[(from + k) % n]).collect()
}

/// Unnamed stretches between stops.
fn pieces(points: &[Point2], stops: &[usize]) -> Vec<MarkedStretch> {
    let stops = if stops.is_empty() { &[0] } else { stops };
    let next = stops.iter().cycle().skip(1);
    let piece = |(&a, &b): (&usize, &usize)| MarkedStretch::new(None, walk(points, a, b), &[], None);
    stops.iter().zip(next).map(piece).filter(|s| s.length() > 0.0).collect()
}

/// The outer loop: named edges in their order, unnamed stretches where they leave a gap.
fn outer(outline: &Outline) -> Vec<MarkedStretch> {
    let (points, corners) = (&outline.outer.points, &outline.outer.corners);
    let n = points.len();
    let mut edges: Vec<&Edge> = outline.edges.iter().collect();
    edges.sort_by_key(|e| e.start);
    if edges.is_empty() {
        return pieces(points, corners);
    }
    // Corners strictly between two indices, as offsets from the first.
    let between = |from: usize, to: usize| {
        let span = (to + n - from - 1) % n + 1;
        let mut inner: Vec<usize> =
            corners.iter().map(|c| (c + n - from) % n).filter(|&k| k > 0 && k < span).collect();
        inner.sort_unstable();
        inner
    };
    let mut out = Vec::new();
    for (k, e) in edges.iter().enumerate() {
        let inner = between(e.start, e.end);
        out.push(MarkedStretch::new(Some(&e.name), walk(points, e.start, e.end), &inner, Some(e.gauge)));
        let next = edges[(k + 1) % edges.len()].start;
        if next != e.end {
            let mut stops = vec![e.end];
            stops.extend(between(e.end, next).iter().map(|k| (e.end + k) % n));
            stops.push(next);
            let gap = stops.windows(2).map(|w| MarkedStretch::new(None, walk(points, w[0], w[1]), &[], None));
            out.extend(gap.filter(|s| s.length() > 0.0));
        }
    }
    out
}

/// Inner lines with their ends laid onto what they touch, which gets a mark there.
fn lines(outline: &Outline, loops: &mut [Vec<MarkedStretch>], h: f64) -> Vec<MarkedStretch> {
    let slack = SNAP * h;
    let mut all: Vec<Vec<Point2>> = outline.inner.iter().map(|l| l.points.clone()).collect();
    for points in &mut all {
        let last = points.len() - 1;
        for k in [0, last] {
            let nearest = loops.iter_mut().flatten().map(|s| (s.nearest(points[k]), s));
            if let Some(((d, s), stretch)) = nearest.min_by(|a, b| a.0.0.total_cmp(&b.0.0))
                && d <= slack
            {
                let s = stretch.mark(s, slack);
                points[k] = stretch.at(s);
            }
        }
    }
    let own = outline.inner.iter().map(|l| l.gauge);
    let mut lines: Vec<MarkedStretch> =
        all.into_iter().zip(own).map(|(p, g)| inner_stretch(p, h, g)).collect();
    let ends: Vec<[Point2; 2]> = lines.iter().map(|l| [l.points[0], l.points[l.points.len() - 1]]).collect();
    for (i, line) in lines.iter_mut().enumerate() {
        for end in ends.iter().enumerate().filter(|(j, _)| *j != i).flat_map(|(_, e)| e) {
            let (d, s) = line.nearest(*end);
            if d <= slack {
                line.mark(s, slack);
            }
        }
    }
    share_darts(outline, &mut lines, &ends, slack);
    lines
}

fn inner_stretch(points: Vec<Point2>, h: f64, gauge: Option<Gauge>) -> MarkedStretch {
    let joint = |k: &usize| {
        let (u, v) = (points[*k] - points[k - 1], points[k + 1] - points[*k]);
        u.perp(&v).atan2(u.dot(&v)).abs() > INNER_CORNER.to_radians() || u.norm().min(v.norm()) >= h / 2.0
    };
    let corners: Vec<usize> = (1..points.len() - 1).filter(joint).collect();
    MarkedStretch::new(None, points, &corners, gauge)
}

/// Two legs of a dart meet in a point and are sewn to each other: both take what either needs.
fn share_darts(outline: &Outline, lines: &mut [MarkedStretch], ends: &[[Point2; 2]], slack: f64) {
    let dart = |i: usize| outline.inner[i].kind == InnerKind::Dart;
    let own: Vec<Gauge> = lines.iter().map(|l| l.gauge).collect();
    for i in (0..lines.len()).filter(|&i| dart(i)) {
        let touches = |j: &usize| ends[i].iter().any(|p| ends[*j].iter().any(|q| (p - q).norm() <= slack));
        for j in (0..own.len()).filter(|&j| j != i && dart(j)).filter(touches) {
            lines[i].gauge = lines[i].gauge.shared(&own[j]);
        }
    }
}

fn add_loop(division: &mut MeshSegments, stretches: &[MarkedStretch], h: f64) -> Result<(), StageError> {
    let first = division.points.len() as u32;
    let mut named = Vec::new();
    for s in stretches {
        let (start, arcs) = (division.points.len() as u32, s.cut(h)?);
        division.points.extend(arcs[..arcs.len() - 1].iter().map(|&a| s.at(a)));
        named.extend(s.name.as_ref().map(|name| (name, start, division.points.len() as u32)));
    }
    let end = division.points.len() as u32;
    let close = |v: u32| if v == end { first } else { v };
    division.edges.extend(named.into_iter().map(|(name, start, end)| PanelEdge {
        name: name.clone(),
        vertices: (start..=end).map(close).collect(),
    }));
    division.loops.push((first..end).collect());
    Ok(())
}

fn add_line(
    division: &mut MeshSegments,
    line: &InnerLine,
    s: &MarkedStretch,
    h: f64,
) -> Result<(), StageError> {
    let arcs = s.cut(h)?;
    let last = arcs.len() - 1;
    let mut vertices = Vec::with_capacity(arcs.len());
    for (k, &arc) in arcs.iter().enumerate() {
        let p = s.at(arc);
        let joint = k == 0 || k == last || s.marks.contains(&arc);
        let reach = if joint { SNAP * h } else { 0.0 };
        let known = division.points.iter().position(|q| (q - p).norm() <= reach);
        vertices.push(known.unwrap_or(division.points.len()) as u32);
        if known.is_none() {
            division.points.push(p);
        }
    }
    division.chains.push(InnerChain { name: line.name.clone(), kind: line.kind, vertices });
    Ok(())
}
