//! The pattern of outlines that were named without one: their edges as they run.

use super::{EdgeCurve, EdgeUse, Pattern, PatternLoop, PatternSeam, Piece, PieceEdge};
use crate::artifact::{Edge, EdgeRef, Outline, Point2, Seam};
use std::collections::BTreeMap;

impl Pattern {
    /// The pattern of outlines, and of the seams between their edges. Its pieces stand nowhere yet.
    pub fn of_outlines<'a>(
        name: &str,
        outlines: impl IntoIterator<Item = (&'a str, &'a Outline)>,
        seams: &[Seam],
    ) -> Pattern {
        let piece = |(name, o): (&str, &Outline)| Piece {
            name: name.to_owned(),
            outer: outer(o),
            ..Piece::default()
        };
        let pieces = outlines.into_iter().map(piece).collect();
        Pattern { name: name.to_owned(), pieces, seams: named_apart(seams.iter().map(seam).collect()) }
    }
}

impl EdgeCurve {
    /// Straight from point to point; the ends belong to the corners.
    pub fn through(points: &[Point2]) -> EdgeCurve {
        match points {
            [] | [_] | [_, _] => EdgeCurve::Line,
            [_, inner @ .., _] => EdgeCurve::Polyline { points: inner.to_vec() },
        }
    }
}

/// The outer loop of an outline, edge by edge; in two where it has no names.
fn outer(outline: &Outline) -> PatternLoop {
    let points = &outline.outer.points;
    if outline.edges.is_empty() {
        let half = points.len() / 2;
        let edge = |name: &str, points: &[Point2]| PieceEdge {
            name: name.into(),
            curve: EdgeCurve::through(points),
        };
        let rest: Vec<Point2> = points[half..].iter().chain(&points[..1]).copied().collect();
        return PatternLoop {
            corners: vec![points[0], points[half]],
            edges: vec![edge("edge_1", &points[..=half]), edge("edge_2", &rest)],
        };
    }
    let edge =
        |e: &Edge| PieceEdge { name: e.name.clone(), curve: EdgeCurve::through(&outline.edge_points(e)) };
    PatternLoop {
        corners: outline.edges.iter().map(|e| points[e.start]).collect(),
        edges: outline.edges.iter().map(edge).collect(),
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
