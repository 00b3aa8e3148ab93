//! The pattern of outlines: what is sewn, as a tailor draws it.
//!
//! A stage that changes outlines after they were cut from a pattern changes the pattern with them,
//! so that what is written is what is sewn. Edges that stay keep their curves; those that change
//! become the points of the outline.

use std::collections::BTreeMap;
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
            piece.outer.edges[k].curve = through(&points);
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

/// The pattern of outlines that were named without one: their edges as they run, and the seams of
/// the plan.
pub(super) fn of_outlines(outlines: &Set<Outline>, plan: Option<&SewingPlan>) -> Pattern {
    let pieces = outlines.iter().map(|(name, outline)| Piece {
        name: name.to_owned(),
        outer: outer(outline),
        ..Piece::default()
    });
    let seams = plan.map_or(&[][..], |plan| &plan.seams).iter().map(seam).collect();
    Pattern { name: "outlines".into(), pieces: pieces.collect(), seams: named_apart(seams) }
}

/// The outer loop of an outline, edge by edge; in two where it has no names.
fn outer(outline: &Outline) -> PatternLoop {
    let points = &outline.outer.points;
    if outline.edges.is_empty() {
        let half = points.len() / 2;
        let edge = |name: &str, points: &[Point2]| PieceEdge { name: name.into(), curve: through(points) };
        let rest: Vec<Point2> = points[half..].iter().chain(&points[..1]).copied().collect();
        return PatternLoop {
            corners: vec![points[0], points[half]],
            edges: vec![edge("edge_1", &points[..=half]), edge("edge_2", &rest)],
        };
    }
    let edge = |e: &Edge| PieceEdge { name: e.name.clone(), curve: through(&outline.edge_points(e)) };
    PatternLoop {
        corners: outline.edges.iter().map(|e| points[e.start]).collect(),
        edges: outline.edges.iter().map(edge).collect(),
    }
}

/// Straight from point to point, ends left out.
fn through(points: &[Point2]) -> EdgeCurve {
    match points {
        [] | [_] | [_, _] => EdgeCurve::Line,
        [_, inner @ .., _] => EdgeCurve::Polyline { points: inner.to_vec() },
    }
}

fn seam(s: &Seam) -> PatternSeam {
    let side = |edge: &EdgeRef, reversed: bool| vec![EdgeUse { edge: edge.clone(), reversed }];
    let name = format!("{} of {}", s.a.edge, s.a.panel);
    PatternSeam { name, kind: s.kind, sides: vec![side(&s.a, false), side(&s.b, !s.reversed)] }
}

/// Seams of one name are numbered.
fn named_apart(mut seams: Vec<PatternSeam>) -> Vec<PatternSeam> {
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    for seam in &mut seams {
        let n = taken.entry(seam.name.clone()).and_modify(|n| *n += 1).or_insert(1);
        if *n > 1 {
            seam.name = format!("{} {n}", seam.name);
        }
    }
    seams
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
