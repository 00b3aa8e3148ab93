//! Which of the closed lines of a group are outlines of pieces, and which lie on one.
//!
//! Method: in a group of one piece every line that begins within a larger one lies on it. Where a
//! group, a layer or the whole file holds several pieces, they may touch and overlap: there a line
//! lies on another if it lies wholly within it, and is not filled like it, as what is drawn over
//! something else is. A rectangle around all other lines, of which several are outlines, is a
//! frame. Cost: lines squared, times the points of [`SAMPLES`]. Limits: a piece that lies wholly
//! within another and is not filled is taken for a line on it, which the caller reports.

use super::outlined::Outlined;
use crate::mesh::predicates::inside;
use roxmltree::Node;
use toile_core::prelude::*;

/// Points of a line that are looked at.
const SAMPLES: usize = 48;
/// Points of all lines together to which they are thinned.
const POINTS: usize = 60_000;
/// Points of each line at least to which it is thinned.
const LEAST_POINTS: usize = 64;
/// Points of each line at most to which it is thinned.
const MOST_POINTS: usize = 1024;
/// What lies as near to an outline as this touches it, metres.
const TOUCHES: f64 = 1e-3;

/// Closed lines of a group by what they are.
pub(super) struct Chosen<'d, 't> {
    pub pieces: Vec<Outlined<'d, 't>>,
    /// Those that lie on a piece.
    pub within: Vec<Outlined<'d, 't>>,
    /// Those around all pieces.
    pub frames: Vec<Outlined<'d, 't>>,
}

/// The largest of a part of FreeSewing.
pub(super) fn largest<'d, 't>(mut all: Vec<Outlined<'d, 't>>) -> Chosen<'d, 't> {
    let largest = (0..all.len()).max_by(|&i, &j| all[i].area.total_cmp(&all[j].area));
    let pieces = largest.map(|k| all.remove(k)).into_iter().collect();
    Chosen { pieces, within: all, frames: Vec::new() }
}

/// Those of a group that lie on no other of them; `is_sheet` where the group may hold many pieces.
pub(super) fn outermost<'d, 't>(all: Vec<Outlined<'d, 't>>, is_sheet: bool) -> Chosen<'d, 't> {
    let begins_on = |i: usize, j: usize| all[j].area > all[i].area && all[j].has(all[i].polygon[0]);
    let alone = |on: &dyn Fn(usize, usize) -> bool, i: usize| (0..all.len()).all(|j| j == i || !on(i, j));
    let several = (0..all.len()).filter(|&i| alone(&begins_on, i)).count() > 1;
    let kinds: Vec<NestedKind> = match is_sheet || several {
        true => sheet(&all),
        false => (0..all.len())
            .map(|i| if alone(&begins_on, i) { NestedKind::Piece } else { NestedKind::Within })
            .collect(),
    };
    let mut chosen = Chosen { pieces: Vec::new(), within: Vec::new(), frames: Vec::new() };
    for (outline, kind) in all.into_iter().zip(kinds) {
        match kind {
            NestedKind::Piece => chosen.pieces.push(outline),
            NestedKind::Within => chosen.within.push(outline),
            NestedKind::Frame => chosen.frames.push(outline),
        }
    }
    chosen
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum NestedKind {
    Piece,
    Within,
    Frame,
}

/// What the lines of a sheet of several pieces are.
fn sheet(all: &[Outlined<'_, '_>]) -> Vec<NestedKind> {
    let boxes: Vec<(Point2, Point2)> = all.iter().map(|o| bounds(&o.polygon)).collect();
    let most = (POINTS / all.len().max(1)).clamp(LEAST_POINTS, MOST_POINTS);
    let thin: Vec<Vec<Point2>> = all.iter().map(|o| thinned(&o.polygon, most)).collect();
    // Which lines lie wholly within which; the later is drawn over the earlier.
    let within = |i: usize, j: usize| {
        let (a, b) = (boxes[i], boxes[j]);
        let fits = a.0 >= b.0 - Vector2::repeat(TOUCHES) && a.1 <= b.1 + Vector2::repeat(TOUCHES);
        i != j && all[j].area > all[i].area && fits && lies_in(&thin[i], &thin[j])
    };
    let over = |i: usize, j: usize| {
        let fills = [i, j].map(|k| fill(all[k].shape.node));
        i > j && fills[0].is_some() && fills[0] == fills[1]
    };
    let on: Vec<Vec<usize>> =
        (0..all.len()).map(|i| (0..all.len()).filter(|&j| within(i, j)).collect()).collect();
    let inner = |i: usize, but: Option<usize>| on[i].iter().any(|&j| Some(j) != but && !over(i, j));
    let frame = (0..all.len()).find(|&j| {
        let others = || (0..all.len()).filter(move |&i| i != j);
        is_box(all[j].polygon.as_slice(), boxes[j])
            && others().all(|i| on[i].contains(&j))
            && others().filter(|&i| !inner(i, Some(j))).count() > 1
    });
    let kind = |i: usize| match (Some(i) == frame, inner(i, frame)) {
        (true, _) => NestedKind::Frame,
        (false, true) => NestedKind::Within,
        (false, false) => NestedKind::Piece,
    };
    (0..all.len()).map(kind).collect()
}

fn bounds(polygon: &[Point2]) -> (Point2, Point2) {
    let first = polygon.first().copied().unwrap_or_else(Point2::origin);
    polygon.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)))
}

/// Whether a polygon fills its box.
fn is_box(polygon: &[Point2], (lo, hi): (Point2, Point2)) -> bool {
    let size = hi - lo;
    (polygon_area(polygon).abs() - size.x * size.y).abs() <= 1e-6 * size.x * size.y
}

/// A polygon with every so manieth of its points.
fn thinned(polygon: &[Point2], most: usize) -> Vec<Point2> {
    polygon.iter().step_by(polygon.len().div_ceil(most).max(1)).copied().collect()
}

/// Whether one line lies within another or touches it from within.
fn lies_in(a: &[Point2], b: &[Point2]) -> bool {
    let corner_and_middle = |k: usize| {
        let (p, q) = (a[k], a[(k + 1) % a.len()]);
        [p, nalgebra::center(&p, &q)]
    };
    let mut points = (0..a.len()).step_by(a.len().div_ceil(SAMPLES).max(1)).flat_map(corner_and_middle);
    points.all(|p| inside(b, p) || distance(p, b) <= TOUCHES) && inner_point(a).is_some_and(|p| inside(b, p))
}

/// The distance of a point from a closed polygon's line.
fn distance(p: Point2, polygon: &[Point2]) -> f64 {
    let n = polygon.len();
    let to = |k: usize| {
        let (a, b) = (polygon[k], polygon[(k + 1) % n]);
        let d = b - a;
        let t = ((p - a).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (p - (a + d * t)).norm()
    };
    (0..n).map(to).fold(f64::INFINITY, f64::min)
}

/// A point well within a polygon: in the middle of the widest stretch of a level line through it.
fn inner_point(polygon: &[Point2]) -> Option<Point2> {
    let (lo, hi) = bounds(polygon);
    let n = polygon.len();
    // Not through the middle, where corners often lie.
    let y = lo.y + (hi.y - lo.y) * 0.4871;
    let mut xs: Vec<f64> = (0..n)
        .filter_map(|k| {
            let (a, b) = (polygon[k], polygon[(k + 1) % n]);
            ((a.y > y) != (b.y > y)).then(|| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
        })
        .collect();
    xs.sort_by(f64::total_cmp);
    let widest = xs.chunks_exact(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    let p = Point2::new(f64::midpoint(widest[0], widest[1]), y);
    inside(polygon, p).then_some(p)
}

/// The colour with which an element is filled, as it says itself.
fn fill<'t>(node: Node<'t, 't>) -> Option<&'t str> {
    let by_style = node.attribute("style").and_then(|style| {
        style
            .split(';')
            .filter_map(|d| d.split_once(':'))
            .find(|(name, _)| name.trim() == "fill")
            .map(|(_, v)| v)
    });
    by_style
        .or_else(|| node.attribute("fill"))
        .map(str::trim)
        .filter(|fill| !matches!(*fill, "none" | "transparent"))
}
