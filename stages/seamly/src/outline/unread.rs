//! What pieces have that is not read, by name.

use super::super::source::{attribute, children, says, short};
use roxmltree::Node;
use std::collections::BTreeMap;

/// Elements of a piece that are read.
const READ: [&str; 7] = ["nodes", "node", "data", "grainline", "iPaths", "mirrorLine", "patternInfo"];
/// Elements of a piece that are not, as messages call them.
const ELEMENTS: [(&str, &str); 3] =
    [("pins", "pins"), ("csa", "seam allowances along paths"), ("placeLabels", "place labels")];
/// How the attributes of a node begin that say what a notch looks like.
const NOTCHES: [&str; 3] = ["notch", "passmark", "manualPassmark"];

/// Kinds of what is not read, each with the pieces that have it.
#[derive(Debug, Default)]
pub(super) struct UnreadElement(BTreeMap<String, Vec<String>>);

impl UnreadElement {
    /// Looks at a piece with its nodes.
    pub(super) fn look(&mut self, piece: Node<'_, '_>, name: &str, nodes: &[Node<'_, '_>]) {
        for element in piece.children().filter(|n| n.is_element()) {
            let tag = element.tag_name().name();
            let is_empty = !element.has_children() && element.attributes().len() == 0;
            match ELEMENTS.iter().find(|(known, _)| *known == tag) {
                Some((_, what)) if !is_empty => self.add((*what).to_owned(), name),
                None if !READ.contains(&tag) => self.add(format!("elements \"{}\"", short(tag)), name),
                _ => {}
            }
        }
        let mut labels = children(piece, &["data", "patternInfo"]);
        if labels.any(|n| says(n, "visible").or_else(|| says(n, "enabled")) == Some(true)) {
            self.add("labels".to_owned(), name);
        }
        if nodes.iter().any(|n| has_form(*n)) {
            self.add("depth and form of notches".to_owned(), name);
        }
        if nodes.iter().any(|n| attribute(*n, "angle").is_some_and(|kind| kind != "0")) {
            self.add("corners of seam allowances".to_owned(), name);
        }
    }

    fn add(&mut self, what: String, piece: &str) {
        let pieces = self.0.entry(what).or_default();
        if pieces.iter().all(|p| p != piece) {
            pieces.push(piece.to_owned());
        }
    }

    /// All of it in one sentence; none where everything is read.
    pub(super) fn told(self) -> Option<String> {
        let named =
            |pieces: &[String]| pieces.iter().map(|p| format!("\"{p}\"")).collect::<Vec<_>>().join(", ");
        let kinds: Vec<String> = self.0.iter().map(|(what, of)| format!("{what} of {}", named(of))).collect();
        (!kinds.is_empty()).then(|| format!("left out: {}", kinds.join("; ")))
    }
}

/// Whether a node that is a notch says what it looks like.
fn has_form(node: Node<'_, '_>) -> bool {
    let is = says(node, "notch").or_else(|| says(node, "passmark")) == Some(true);
    let says_form = |name: &str| {
        NOTCHES.iter().any(|begin| name.strip_prefix(begin).is_some_and(|rest| !rest.is_empty()))
    };
    is && node.attributes().any(|a| says_form(a.name()))
}
