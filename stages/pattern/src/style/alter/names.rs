//! Finds what an alteration names, and says what there is where it is not there.

use toile_core::nearest;
use toile_core::prelude::*;

/// The number of the piece of that name.
pub(super) fn piece(pattern: &Pattern, name: &str) -> Result<usize, StageError> {
    pattern.pieces.iter().position(|p| p.name == name).ok_or_else(|| {
        let known: Vec<&str> = pattern.pieces.iter().map(|p| p.name.as_str()).collect();
        let hint = match nearest(name, known.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("the pieces are {}", known.join(", ")),
        };
        StageError::invalid(format!("there is no piece \"{name}\"")).hint(hint)
    })
}

/// The number of the piece, and of the edge of its outline.
pub(super) fn edge(pattern: &Pattern, edge: &EdgeRef) -> Result<(usize, usize), StageError> {
    let p = piece(pattern, &edge.panel)?;
    let of = &pattern.pieces[p];
    let found = of.edge_number(&edge.edge);
    found.map(|k| (p, k)).ok_or_else(|| {
        let known: Vec<&str> = of.outer.edges.iter().map(|e| e.name.as_str()).collect();
        let hint = match nearest(&edge.edge, known.iter().copied()) {
            Some(near) => format!("did you mean \"{}.{near}\"?", of.name),
            None => format!("its edges are {}", known.join(", ")),
        };
        StageError::invalid(format!("the piece \"{}\" has no edge \"{}\"", of.name, edge.edge)).hint(hint)
    })
}

/// The number of a corner, where the piece has it.
pub(super) fn corner(piece: &Piece, corner: usize) -> Result<usize, StageError> {
    if corner < piece.outer.corners.len() {
        return Ok(corner);
    }
    let starts: Vec<String> =
        piece.outer.edges.iter().enumerate().map(|(k, e)| format!("{k} ({})", e.name)).collect();
    Err(StageError::invalid(format!("the piece \"{}\" has no corner {corner}", piece.name))
        .hint(format!("its corners, each with the edge that starts there, are {}", starts.join(", "))))
}

/// The name of an edge on the other side of the body.
pub(super) fn other_side(name: &str) -> String {
    match Hand::split(name) {
        (stem, Some(hand)) => hand.other().name(stem),
        _ => name.to_owned(),
    }
}
