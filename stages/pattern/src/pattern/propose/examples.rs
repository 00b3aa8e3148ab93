//! Garments of a few pieces and what is proposed for them.

#![allow(clippy::unwrap_used)]

use super::{ProposedSeam, proposed_seams};
use toile_core::prelude::*;

/// A piece of straight edges, `edge_0` from the first corner to the second, millimetres.
fn piece(name: &str, corners: &[[f64; 2]]) -> Piece {
    let edge = |k: usize| PieceEdge { name: format!("edge_{k}"), curve: EdgeCurve::Line };
    Piece {
        name: name.to_owned(),
        outer: PatternLoop {
            corners: corners.iter().map(|[x, y]| Point2::new(x * 1e-3, y * 1e-3)).collect(),
            edges: (0..corners.len()).map(edge).collect(),
        },
        ..Piece::default()
    }
}

/// Half a skirt with two darts: `edge_0` is the hem, `edge_1` and `edge_9` are the sides, `edge_3`
/// and `edge_4`, `edge_6` and `edge_7` the legs of darts.
fn half(name: &str, depth: f64) -> Piece {
    let top = 600.0;
    piece(
        name,
        &[
            [-260.0, 0.0],
            [260.0, 0.0],
            [230.0, top],
            [130.0, top],
            [120.0, top - depth],
            [110.0, top],
            [-110.0, top],
            [-120.0, top - depth],
            [-130.0, top],
            [-230.0, top],
        ],
    )
}

fn words(found: &[ProposedSeam], kind: SeamKind) -> Vec<&str> {
    let mut all: Vec<&str> =
        found.iter().filter(|f| f.seam.kind == kind).map(|f| f.seam.name.as_str()).collect();
    all.sort_unstable();
    all
}

#[test]
fn a_skirt_is_sewn_at_its_darts_and_from_front_to_back_at_its_sides() {
    let found = proposed_seams(&[half("front", 90.0), half("back", 130.0)]);
    assert_eq!(
        words(&found, SeamKind::Dart),
        [
            "back.edge_3 + back.edge_4",
            "back.edge_6 + back.edge_7",
            "front.edge_3 + front.edge_4",
            "front.edge_6 + front.edge_7",
        ]
    );
    assert_eq!(
        words(&found, SeamKind::Matched),
        ["front.edge_1 + back.edge_9", "front.edge_9 + back.edge_1"]
    );
}

#[test]
fn pieces_without_size_and_garments_without_pieces_are_sewn_to_nothing() {
    assert!(proposed_seams(&[]).is_empty());
    let speck = piece("speck", &[[0.0, 0.0], [0.0, 0.0], [0.0, 0.0]]);
    let found = proposed_seams(&[speck.clone(), speck, half("front", 90.0)]);
    assert!(found.iter().all(|p| !p.seam.name.contains("speck")), "{found:?}");
}

#[test]
fn where_an_edge_is_longer_than_a_hundred_metres_nothing_is_proposed() {
    let mut back = half("back", 130.0);
    back.outer.corners.iter_mut().for_each(|p| p.x *= 1e9);
    let curve = |at: f64| Point2::new(at * 1e9, 0.3);
    back.outer.edges[1].curve = EdgeCurve::Cubic { controls: [curve(0.3), curve(0.2)] };
    assert!(proposed_seams(&[half("front", 90.0), back]).is_empty());
}

#[test]
fn a_drawing_of_many_short_edges_is_answered() {
    // Twenty discs of ninety edges each, and two stars: any edge fits any other one.
    let round = |sides: usize, radii: [f64; 2]| -> Vec<[f64; 2]> {
        let at = |k: usize| {
            let (sin, cos) = (k as f64 / sides as f64 * std::f64::consts::TAU).sin_cos();
            [cos * radii[k % 2], sin * radii[k % 2]]
        };
        (0..sides).map(at).collect()
    };
    let mut pieces: Vec<Piece> =
        (0..20).map(|k| piece(&format!("disc_{k}"), &round(90, [200.0, 200.0]))).collect();
    for k in 0..2 {
        pieces.push(piece(&format!("star_{k}"), &round(48, [200.0, 120.0])));
    }
    assert!(proposed_seams(&pieces).len() < 1_000);
}
