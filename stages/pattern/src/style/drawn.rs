//! The pattern of outlines that were cut anew.
//!
//! A stage that changes outlines after they were cut from a pattern changes the pattern with them,
//! so that what is written is what is sewn. Edges that stay keep their curves; those that change
//! become the points of the outline.

use toile_core::prelude::*;

/// The pattern with the edges of its pieces as the outlines have them, where these are no more what
/// they were `before`.
///
/// # Errors
/// An edge that changed and is not one edge of the pattern.
pub(super) fn redrawn(
    pattern: &Pattern,
    before: &Set<Outline>,
    outlines: &Set<Outline>,
) -> Result<Pattern, StageError> {
    let mut drawn = pattern.clone();
    for (name, outline) in outlines.iter() {
        let Some(was) = before.get(name).filter(|was| was.outer != outline.outer) else { continue };
        let piece = drawn.pieces.iter_mut().find(|p| p.name == name).ok_or_else(|| no_edge(name, None))?;
        for edge in &outline.edges {
            let points = outline.edge_points(edge);
            if was.edge(&edge.name).is_some_and(|e| was.edge_points(e) == points) {
                continue;
            }
            let k = piece.edge_number(&edge.name).ok_or_else(|| no_edge(name, Some(&edge.name)))?;
            let next = (k + 1) % piece.outer.corners.len();
            piece.outer.corners[k] = points[0];
            piece.outer.corners[next] = points[points.len() - 1];
            piece.outer.edges[k].curve = EdgeCurve::through(&points);
            let length = piece.outer.path(k).length();
            piece
                .notches
                .iter_mut()
                .filter(|n| n.edge == edge.name)
                .for_each(|n| n.along = n.along.min(length));
        }
    }
    Ok(drawn)
}

fn no_edge(piece: &str, edge: Option<&str>) -> StageError {
    let what = match edge {
        Some(edge) => format!(
            "edge \"{edge}\" of the outline \"{piece}\" was cut anew, and the pattern has no such edge"
        ),
        None => format!("the outline \"{piece}\" was cut anew, and the pattern has no such piece"),
    };
    StageError::invalid(what)
        .hint("put the stage that makes the pattern right before the one that cuts its necks")
}
