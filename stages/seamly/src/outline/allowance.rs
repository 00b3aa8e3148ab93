//! Seam allowances of a piece: its own width, and other widths before and after a node.
//!
//! A node that says nothing has the width of the piece. Formulas name that `CurrentSeamAllowance`.

use super::super::draft::{Asked, Drafting};
use super::super::fault::ToolPlace;
use super::super::source::{attribute, says};
use kurbo::Point;
use roxmltree::Node;

/// How formulas call the width of the piece.
const OWN_WIDTH: [&str; 2] = ["CurrentSeamAllowance", "currentSeamAllowance"];

/// The width of the seam allowance at a node that has another than its piece, in the unit of the
/// pattern.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeAllowance {
    /// Where the node lies.
    pub at: Point,
    /// The width at the end of the edge before it, at least 0; none where it is that of the piece.
    pub before: Option<f64>,
    /// The width at the start of the edge after it, at least 0; none where it is that of the piece.
    pub after: Option<f64>,
}

/// The width of a piece's seam allowance, as far as it can be worked out; none where it has none.
pub(super) fn of_piece(node: Node<'_, '_>, place: &ToolPlace, draft: &mut Drafting) -> Option<f64> {
    let has = says(node, "seamAllowance").or_else(|| says(node, "supplement"));
    let formula = attribute(node, "width").filter(|_| has == Some(true))?;
    let asked = Asked { place, attribute: "width", formula };
    draft.values.value(asked).ok().filter(|width| *width > 0.0)
}

/// The widths of a node at a place; none where both are that of the piece.
pub(super) fn of_node(
    node: Node<'_, '_>,
    at: Point,
    own: f64,
    place: &ToolPlace,
    draft: &mut Drafting,
) -> Option<NodeAllowance> {
    OWN_WIDTH.iter().for_each(|name| draft.values.set((*name).to_owned(), own));
    let mut width = |name: &'static str| {
        let formula = attribute(node, name).filter(|f| !OWN_WIDTH.contains(f))?;
        // Below 0 it is that of the piece, too.
        draft.values.value(Asked { place, attribute: name, formula }).ok().filter(|width| *width >= 0.0)
    };
    let (before, after) = (width("before"), width("after"));
    (before.is_some() || after.is_some()).then_some(NodeAllowance { at, before, after })
}
