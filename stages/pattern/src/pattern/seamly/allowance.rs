//! What a pattern says of seam allowances, in words: outlines are seam lines.

use super::super::side::Side;
use toile_core::Remarks;
use toile_core::prelude::*;
use toile_seamly::{DraftedPiece, NodeAllowance};

/// Nodes lie on the end of an edge that are this near to it, metres.
const NEAR: f64 = 1e-6;

/// The widths of a piece's seam allowance: its own, and those of edges that have others. Its sides
/// are as they are drafted, not yet turned.
pub(super) fn widths(piece: &DraftedPiece, sides: &[Side], name: &str, metres: f64) -> Option<String> {
    let own = piece.allowance?;
    let mm = |width: f64| format!("{:.1}", width * metres * 1e3);
    let mut out = format!("{} mm of \"{name}\"", mm(own));
    let is_at = |node: &NodeAllowance, p: Point2| {
        (Point2::new(node.at.x * metres, node.at.y * metres) - p).norm() <= NEAR
    };
    let at = |p: Point2| piece.node_allowances.iter().find(|node| is_at(node, p));
    for side in sides {
        let start = at(side.start).and_then(|node| node.after).unwrap_or(own);
        let end = at(side.end()).and_then(|node| node.before).unwrap_or(own);
        let inner = side.parts.split_last().map_or(&[][..], |(_, inner)| inner);
        let changes = inner.iter().any(|(_, p)| at(*p).is_some());
        if (start, end) == (own, own) && !changes {
            continue;
        }
        let range = if mm(start) == mm(end) { mm(start) } else { format!("{} to {}", mm(start), mm(end)) };
        let within = if changes { " with others between" } else { "" };
        out += &format!(", {range} mm{within} at its \"{}\"", side.name);
    }
    Some(out)
}

/// Tells what is left out of seam allowances.
pub(super) fn tell(drafted: &[DraftedPiece], widths: &[String], told: &mut Remarks) {
    if !widths.is_empty() {
        told.notes.push(format!(
            "outlines are seam lines; seam allowances are left out, give them to the writer as `seam_allowance` and `hem_allowance`: {}",
            widths.join("; ")
        ));
    }
    for piece in drafted.iter().filter(|p| p.built_in) {
        told.warnings.push(format!(
            "{}: its seam allowance is within its outline, and the outline is sewn: the garment is larger by it",
            piece.place
        ));
    }
}
