//! What an outline must be before it can be meshed.
//!
//! Finite, with area, counter-clockwise, not crossing itself, holes inside. Crossings are looked
//! for with exact tests among segments that share a cell of a uniform grid; about linear for
//! outlines.

use toile_core::prelude::*;

/// The largest mesh, triangles: about 1 GB of arrays.
const MAX_TRIANGLES: f64 = 5e6;

/// An area below this share of the box's squared diagonal is none.
const NO_AREA: f64 = 1e-9;

/// Refuses an outline that no mesh of edge length `h` (metres) can fill, and says why.
pub(crate) fn outline(outline: &Outline, h: f64) -> Result<(), StageError> {
    outline.check().map_err(|e| StageError::invalid(format!("the outline cannot be meshed: {e}")))?;
    size(outline, h)?;
    crossing(outline)?;
    match outline.holes.iter().position(|hole| !hole.points.iter().all(|p| inside(&outline.outer.points, *p)))
    {
        Some(k) => Err(StageError::invalid(format!("hole {} lies outside the cloth", k + 1))),
        None => Ok(()),
    }
}

fn degenerate(message: impl Into<String>) -> StageError {
    StageError::new(ErrorCode::DegenerateTriangles, message)
}

fn size(outline: &Outline, h: f64) -> Result<(), StageError> {
    if !(h.is_finite() && h > 0.0) {
        let text = "the edge length must be above zero";
        return Err(StageError::new(ErrorCode::InvalidParameter, text).at("edge"));
    }
    let (low, high) = outline.bounds();
    let (span, area) = (high - low, polygon_area(&outline.outer.points));
    if area.abs() <= NO_AREA * span.norm_squared() {
        return Err(degenerate("the outline encloses no area").hint("does it run forth and back on itself?"));
    }
    if area < 0.0 {
        return Err(StageError::invalid("the outline runs clockwise").hint("y points up"));
    }
    if h > span.x.max(span.y) {
        let text = format!("an edge of {} is larger than the panel", Length::m(h));
        return Err(StageError::invalid(text)
            .hint("use a smaller edge, or check the photo's scale")
            .at("edge"));
    }
    let named = outline.edges.iter().map(|e| e.gauge.divisions(h) as f64).sum::<f64>();
    let lines = outline.inner.iter().map(|l| polyline_length(&l.points)).sum::<f64>();
    let holes = outline.holes.iter().map(|l| polyline_length(&l.points)).sum::<f64>();
    let parts = named + (outline.perimeter() + lines + holes) / h + 2.4 * area / (h * h);
    match parts <= MAX_TRIANGLES {
        true => Ok(()),
        false => Err(StageError::invalid(format!(
            "an edge of {} would make {:.0} million triangles, the limit is 5 million",
            Length::m(h),
            parts / 1e6
        ))
        .hint("use a larger edge")
        .at("edge")),
    }
}

fn crossing(outline: &Outline) -> Result<(), StageError> {
    let (mut points, mut segments) = (Vec::new(), Vec::new());
    for lp in std::iter::once(&outline.outer).chain(&outline.holes) {
        let mut kept = lp.points.clone();
        kept.dedup();
        if kept.len() > 1 && kept.first() == kept.last() {
            kept.pop();
        }
        let (from, n) = (points.len() as u32, kept.len() as u32);
        segments.extend((0..n).map(|k| [from + k, from + (k + 1) % n]));
        points.extend(kept);
    }
    match first_crossing(&points, &segments) {
        None => Ok(()),
        Some(p) => Err(degenerate(format!(
            "the outline crosses or touches itself near ({:.1}, {:.1}) mm",
            p.x * 1e3,
            p.y * 1e3
        ))
        .hint("look at the outline's picture; a smoother mask helps")),
    }
}

/// Where the first two segments meet that share no point.
pub(crate) fn first_crossing(points: &[Point2], segments: &[[u32; 2]]) -> Option<Point2> {
    let at = |v: u32| points[v as usize];
    let longest = segments.iter().map(|s| (at(s[1]) - at(s[0])).norm()).sum::<f64>() / segments.len() as f64;
    let cell = (2.0 * longest).max(1e-12);
    let mut cells: Vec<((i64, i64), u32)> = Vec::new();
    for (k, s) in segments.iter().enumerate() {
        let (a, b) = (at(s[0]), at(s[1]));
        // A long segment is entered piece by piece, or its box would fill the grid.
        let pieces = ((b - a).norm() / cell).ceil().max(1.0);
        for i in 0..pieces as usize {
            let (p, q) = (a + (b - a) * (i as f64 / pieces), a + (b - a) * ((i + 1) as f64 / pieces));
            let index = |x: f64, widen: f64| (x / cell + widen).floor() as i64;
            for y in index(p.y.min(q.y), -1e-6)..=index(p.y.max(q.y), 1e-6) {
                let row = index(p.x.min(q.x), -1e-6)..=index(p.x.max(q.x), 1e-6);
                cells.extend(row.map(|x| ((y, x), k as u32)));
            }
        }
    }
    cells.sort_unstable();
    cells.dedup();
    let meets = |cell: &[((i64, i64), u32)]| {
        let pairs = cell.iter().enumerate().flat_map(|(i, a)| cell[i + 1..].iter().map(move |b| (a.1, b.1)));
        pairs.filter(|&(i, j)| clash(points, segments[i as usize], segments[j as usize])).min()
    };
    let first = cells.chunk_by(|a, b| a.0 == b.0).filter_map(meets).min()?;
    Some(at(segments[first.1 as usize][0]))
}

fn clash(points: &[Point2], s: [u32; 2], t: [u32; 2]) -> bool {
    let at = |v: u32| points[v as usize];
    match s.iter().find(|v| t.contains(v)) {
        Some(&v) => {
            let other = |s: [u32; 2]| at(if s[0] == v { s[1] } else { s[0] });
            let (a, b) = (other(s), other(t));
            orient(at(v), a, b) == 0.0 && (a - at(v)).dot(&(b - at(v))) > 0.0
        }
        None => meet(s.map(at), t.map(at)),
    }
}

/// True where two closed segments share a point.
fn meet([a, b]: [Point2; 2], [c, d]: [Point2; 2]) -> bool {
    let sides = [orient(a, b, c), orient(a, b, d), orient(c, d, a), orient(c, d, b)];
    let apart = |s: f64, t: f64| (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0);
    let within = |p: Point2, a: Point2, b: Point2| {
        let between = |p: f64, a: f64, b: f64| p >= a.min(b) && p <= a.max(b);
        between(p.x, a.x, b.x) && between(p.y, a.y, b.y)
    };
    (apart(sides[0], sides[1]) && apart(sides[2], sides[3]))
        || (sides[0] == 0.0 && within(c, a, b))
        || (sides[1] == 0.0 && within(d, a, b))
        || (sides[2] == 0.0 && within(a, c, d))
        || (sides[3] == 0.0 && within(b, c, d))
}

/// Positive where a, b, c turn left; the sign is exact (Shewchuk 1997).
pub(crate) fn orient(a: Point2, b: Point2, c: Point2) -> f64 {
    let coord = |p: Point2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Even-odd, half-open in y so that a vertex on the line counts once.
fn inside(polygon: &[Point2], p: Point2) -> bool {
    let n = polygon.len();
    let crosses = |i: &usize| {
        let (a, b) = (polygon[*i], polygon[(*i + 1) % n]);
        (a.y <= p.y) != (b.y <= p.y) && (orient(a, b, p) > 0.0) == (b.y > a.y)
    };
    (0..n).filter(crosses).count() % 2 == 1
}
