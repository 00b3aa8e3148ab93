//! A piece as often as it is cut.

use toile_core::Remarks;
use toile_core::prelude::*;

/// Copies of one piece.
pub(super) const MOST_COPIES: usize = 12;

/// The piece as often as it is cut: as drawn, and mirrored.
pub(super) fn copies(piece: Piece, drawn: usize, turned: usize, told: &mut Remarks) -> Vec<Piece> {
    let name = piece.name.clone();
    match (drawn, turned) {
        (0, 0) => told.warnings.push(format!("piece \"{name}\" is cut 0 times: left out")),
        (1, 0) => {}
        _ => told
            .notes
            .push(format!("piece \"{name}\" is cut {drawn} times as drawn and {turned} times mirrored")),
    }
    let named = |mut p: Piece, k: usize, word: &str| {
        p.name = if k == 0 { format!("{name}{word}") } else { format!("{name}{word}_{}", k + 1) };
        p
    };
    let plain = (0..drawn).map(|k| named(piece.clone(), k, ""));
    plain.chain((0..turned).map(|k| named(mirrored(&piece), k, "_mirrored"))).collect()
}

/// The piece for the other side of the body.
pub(crate) fn mirrored(p: &Piece) -> Piece {
    let to = |q: Point2| Point2::new(-q.x, q.y);
    let turned = |l: &PatternLoop| {
        let n = l.corners.len();
        let edge =
            |e: &PieceEdge| PieceEdge { name: e.name.clone(), curve: e.curve.moved(to, true).turned() };
        PatternLoop {
            corners: (0..n).map(|k| to(l.corners[(n - k) % n])).collect(),
            edges: l.edges.iter().rev().map(edge).collect(),
        }
    };
    let line = |l: &PieceLine| PieceLine { points: l.points.iter().map(|q| to(*q)).collect(), ..l.clone() };
    let notch = |n: &Notch| {
        let length = p.path(&n.edge).map_or(n.along, |e| e.length());
        Notch { along: (length - n.along).max(0.0), ..n.clone() }
    };
    Piece {
        outer: turned(&p.outer),
        holes: p.holes.iter().map(turned).collect(),
        lines: p.lines.iter().map(line).collect(),
        notches: p.notches.iter().map(notch).collect(),
        drill_holes: p.drill_holes.iter().map(|q| to(*q)).collect(),
        grain: p.grain.map(|g| g.map(to)),
        ..p.clone()
    }
}
