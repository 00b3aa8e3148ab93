//! An outline of which one edge runs otherwise.

use super::sewing::own_gauge;
use toile_core::prelude::*;

/// The outline with an edge's inner points replaced.
pub(super) fn replaced(outline: &Outline, edge: &Edge, inner: &[Point2]) -> Outline {
    let n = outline.outer.points.len();
    // The loop begins where the edge ends.
    let moved = |i: usize| (i + n - edge.end) % n;
    let kept = moved(edge.start) + 1;
    let mut cut = outline.clone();
    cut.outer.points = (0..kept).map(|k| outline.outer.points[(edge.end + k) % n]).collect();
    cut.outer.points.extend(inner);
    if !outline.lies.is_empty() {
        cut.lies = cut.outer.points.iter().map(|p| outline.lying(*p)).collect();
    }
    cut.outer.corners = outline.outer.corners.iter().map(|&c| moved(c)).filter(|&c| c < kept).collect();
    cut.outer.corners.sort_unstable();
    for e in &mut cut.edges {
        (e.start, e.end) = (moved(e.start), moved(e.end));
    }
    let gauge = cut.edge(&edge.name).map(|e| own_gauge(&cut, e));
    if let (Some(gauge), Some(e)) = (gauge, cut.edges.iter_mut().find(|e| e.name == edge.name)) {
        e.gauge = gauge;
    }
    cut
}
