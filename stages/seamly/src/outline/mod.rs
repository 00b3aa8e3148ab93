//! The pieces of a pattern: outlines through points and along curves of the draft, and what is
//! drawn on them.
//!
//! A piece's nodes name objects of the block's modeling, which stand for those of the draft
//! ([`model`]); [`path`] joins them, [`piece`] reads the rest, [`allowance`] the widths of seam
//! allowances; [`unread`] names what is not read.

mod allowance;
mod loops;
mod model;
mod path;
mod piece;
#[cfg(test)]
mod tests;
mod unread;

pub use allowance::NodeAllowance;
pub use path::{DraftedPath, OutlinePart};
pub use piece::{DraftedPiece, InnerPath, PieceFold};

use super::draft::{BLOCKS, Drafting, Failed, block_name};
use super::fault::SeamlyFault;
use super::source::{children, says};
use model::Modeling;
use roxmltree::Node;
use std::collections::BTreeSet;
use unread::UnreadElement;

/// Pieces of a file.
const MOST_PIECES: usize = 500;
/// Nodes of all pieces together.
const MOST_NODES: usize = 20_000;

/// The pieces of a pattern that are laid out; what else is told.
///
/// Errors: all that is wrong with what they need.
pub(crate) fn pieces(
    root: Node<'_, '_>,
    draft: &mut Drafting,
    metres: f64,
    notes: &mut Vec<String>,
) -> Result<Vec<DraftedPiece>, Vec<SeamlyFault>> {
    let model = Modeling::of(root);
    let (mut out, mut failed, mut left_out) = (Vec::new(), BTreeSet::new(), Vec::new());
    let (mut count, mut unread) = (0, UnreadElement::default());
    for block in children(root, BLOCKS) {
        let listed = children(block, &["pieces", "details"]).flat_map(|n| children(n, &["piece", "detail"]));
        for node in listed {
            count += node.descendants().filter(|n| n.has_tag_name("node")).count();
            if out.len() + left_out.len() >= MOST_PIECES {
                return Err(vec![SeamlyFault::Many { what: "pieces", most: MOST_PIECES }]);
            }
            if count > MOST_NODES {
                return Err(vec![SeamlyFault::Many { what: "nodes of pieces", most: MOST_NODES }]);
            }
            if says(node, "inLayout") == Some(false) {
                left_out.push(format!("\"{}\"", piece::name(node)));
                continue;
            }
            unread.look(node, &piece::name(node), &piece::path_nodes(node));
            match piece::piece(node, block_name(block), &model, draft, metres) {
                Ok(piece) => out.push(piece),
                Err(Failed(why)) => {
                    failed.insert(why);
                    failed.extend(piece::causes(node, &model, draft));
                }
            }
        }
    }
    if !left_out.is_empty() {
        notes.push(format!("pieces that are not laid out are left out: {}", left_out.join(", ")));
    }
    notes.extend(unread.told());
    if !failed.is_empty() {
        return Err(failed.into_iter().filter_map(|k| draft.values.faults.get(k).cloned()).collect());
    }
    if out.is_empty() { Err(vec![SeamlyFault::NoPieces]) } else { Ok(out) }
}
