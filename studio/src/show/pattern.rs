//! Pieces and seams, of a pattern or of outlines that were cut from photos.

use super::of_panel;
use crate::live::shown::ShownArtifacts;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::artifact::{
    EdgeUse, InnerKind, LinePurpose, Outline, Pattern, Photo, Piece, Point2, Seam, SeamState, polyline_length,
};

/// To a hundredth of a millimetre.
fn at(p: &Point2) -> [f64; 2] {
    [p.x, p.y].map(|x| (1e5 * x).round() / 1e5)
}

fn all(points: &[Point2]) -> Vec<[f64; 2]> {
    points.iter().map(at).collect()
}

/// The pieces of a pattern; photos are those that show them.
pub(super) fn pieces_of_pattern(pattern: &Pattern, photos: &BTreeMap<String, Arc<Photo>>) -> Vec<Value> {
    pattern.pieces.iter().map(|piece| of_piece(piece, photos)).collect()
}

fn of_piece(piece: &Piece, photos: &BTreeMap<String, Arc<Photo>>) -> Value {
    let (points, corners) = piece.outer.points();
    let edge = |(k, edge): (usize, &toile_core::artifact::PieceEdge)| {
        let end = corners.get(k + 1).copied().unwrap_or(0);
        json!({ "name": edge.name, "start": corners[k], "end": end,
            "length": piece.outer.path(k).length(), "kind": edge.curve.word() })
    };
    let line = |l: &toile_core::artifact::PieceLine| json!({ "name": l.name, "purpose": purpose(l.purpose), "points": all(&l.points) });
    let notch = |n: &toile_core::artifact::Notch| Some(at(&piece.path(&n.edge)?.at(n.along)));
    json!({
        "name": piece.name,
        "photo": of_panel(photos, &piece.name).map(|(name, _)| name),
        "points": all(&points),
        "edges": piece.outer.edges.iter().enumerate().map(edge).collect::<Vec<_>>(),
        "corners": corners,
        "lines": piece.lines.iter().map(line).collect::<Vec<_>>(),
        "notches": piece.notches.iter().filter_map(notch).collect::<Vec<_>>(),
        "grain": piece.grain.as_ref().map(|grain| all(grain)),
    })
}

fn purpose(of: LinePurpose) -> &'static str {
    match of {
        LinePurpose::Dart => "dart",
        LinePurpose::Pleat => "pleat",
        LinePurpose::Fold => "fold",
        LinePurpose::Placement => "placement",
        LinePurpose::Cut => "cut",
        LinePurpose::Mark => "mark",
    }
}

/// The outlines with names as pieces.
pub(super) fn pieces_of_outlines(shown: &ShownArtifacts) -> Vec<Value> {
    shown.outlines.iter().map(|(name, outline)| of_outline(name, outline, shown)).collect()
}

fn of_outline(name: &str, outline: &Outline, shown: &ShownArtifacts) -> Value {
    let edge = |e: &toile_core::artifact::Edge| {
        json!({ "name": e.name, "start": e.start, "end": e.end,
            "length": polyline_length(&outline.edge_points(e)), "kind": "polyline" })
    };
    let line = |l: &toile_core::artifact::InnerLine| {
        let purpose = match l.kind {
            InnerKind::Dart => "dart",
            InnerKind::Pleat => "pleat",
            InnerKind::Fold => "fold",
            InnerKind::Placement => "placement",
        };
        json!({ "name": l.name, "purpose": purpose, "points": all(&l.points) })
    };
    json!({
        "name": name,
        "photo": of_panel(&shown.photos, name).map(|(photo, _)| photo),
        "points": all(&outline.outer.points),
        "edges": outline.edges.iter().map(edge).collect::<Vec<_>>(),
        "corners": outline.outer.corners,
        "lines": outline.inner.iter().map(line).collect::<Vec<_>>(),
        "notches": [],
        "grain": null,
    })
}

/// The seams of a pattern.
pub(super) fn seams_of_pattern(pattern: &Pattern, shown: &ShownArtifacts) -> Vec<Value> {
    let one = |used: &EdgeUse| json!({ "piece": used.edge.panel, "edge": used.edge.edge, "reverse": used.reversed });
    let seam = |seam: &toile_core::artifact::PatternSeam| {
        let sides: Vec<Vec<Value>> = seam.sides.iter().map(|side| side.iter().map(one).collect()).collect();
        let first = |side: usize| seam.sides.get(side)?.first().map(|u| u.edge.to_string());
        let by_edges = first(0).zip(first(1)).map(|(a, b)| format!("{a} + {b}"));
        let (gap, state) = sewn(shown, &[Some(seam.name.clone()), by_edges]);
        json!({ "name": seam.name, "kind": seam.kind.word(), "sides": sides, "gap_m": gap, "state": state })
    };
    pattern.seams.iter().map(seam).collect()
}

/// The seams of a sewing plan. The second side runs against the first, as faces that lie on each
/// other do.
pub(super) fn seams_of_plan(shown: &ShownArtifacts) -> Vec<Value> {
    let seam = |seam: &Seam| {
        let side = |edge: &toile_core::artifact::EdgeRef, reverse: bool| json!([{ "piece": edge.panel, "edge": edge.edge, "reverse": reverse }]);
        let sides = [side(&seam.a, false), side(&seam.b, !seam.reversed)];
        let (gap, state) = sewn(shown, &[Some(seam.name())]);
        json!({ "name": seam.name(), "kind": seam.kind.word(), "sides": sides, "gap_m": gap, "state": state })
    };
    shown.plan.iter().flat_map(|plan| &plan.seams).map(seam).collect()
}

/// How far a seam has come in the garment, by one of its names: its widest gap, metres, and a word.
fn sewn(shown: &ShownArtifacts, names: &[Option<String>]) -> (Option<f64>, &'static str) {
    let Some(garment) = &shown.garment else { return (None, "waiting") };
    let seam = names.iter().flatten().find_map(|name| garment.seams.iter().find(|s| s.name == *name));
    let Some(seam) = seam else { return (None, "waiting") };
    let gap = |&[a, b]: &[u32; 2]| (garment.positions[a as usize] - garment.positions[b as usize]).norm();
    let state = if seam.state == SeamState::Closed { "closed" } else { "open" };
    (seam.pairs.iter().map(gap).reduce(f64::max), state)
}
