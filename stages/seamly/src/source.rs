//! The bytes of a file as a tree of elements, bounded in size, and what attributes say.
//!
//! Cost: linear. Limits: [`MOST_BYTES`], [`MOST_NODES`]; a declaration of a document's own type is
//! refused.

use super::fault::{SeamlyFault, ToolPlace};
use roxmltree::{Document, Node, ParsingOptions};

const MOST_BYTES: usize = 32 << 20;
const MOST_NODES: u32 = 500_000;

/// The text of a file.
pub(crate) fn text(bytes: &[u8]) -> Result<&str, SeamlyFault> {
    if bytes.len() > MOST_BYTES {
        return Err(SeamlyFault::Large { bytes: bytes.len(), most: MOST_BYTES });
    }
    let text = std::str::from_utf8(bytes).map_err(|_| SeamlyFault::Encoding)?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// The tree of a text.
pub(crate) fn tree(text: &str) -> Result<Document<'_>, SeamlyFault> {
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, entity_resolver: None };
    Document::parse_with_options(text, options).map_err(|e| match e {
        roxmltree::Error::NodesLimitReached => {
            SeamlyFault::Many { what: "elements", most: MOST_NODES as usize }
        }
        _ => {
            let (words, at) = (e.to_string(), e.pos());
            let what = words.strip_suffix(&format!(" at {at}")).unwrap_or(&words).to_owned();
            SeamlyFault::Xml { what: short(&what), line: at.row, column: at.col }
        }
    })
}

/// A value as it stands in a message.
pub(crate) fn short(value: &str) -> String {
    value.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).take(60).collect()
}

/// The elements of that name right below another.
pub(crate) fn children<'a, 't: 'a>(
    of: Node<'a, 't>,
    tags: &'static [&'static str],
) -> impl Iterator<Item = Node<'a, 't>> {
    of.children().filter(move |n| n.is_element() && tags.contains(&n.tag_name().name()))
}

/// The text of the first element of that name right below another, where there is some.
pub(crate) fn words(of: Node<'_, '_>, tag: &'static str) -> Option<String> {
    let found = of.children().find(|n| n.is_element() && n.tag_name().name() == tag)?;
    found.text().map(|t| t.trim().to_owned()).filter(|t| !t.is_empty())
}

/// An attribute that is not empty.
pub(crate) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    node.attribute(name).map(str::trim).filter(|v| !v.is_empty())
}

/// Whether an attribute says yes.
pub(crate) fn says(node: Node<'_, '_>, name: &str) -> Option<bool> {
    match attribute(node, name)? {
        "true" | "1" => Some(true),
        "false" | "0" => Some(false),
        _ => None,
    }
}

/// A number of an object.
pub(crate) fn number(node: Node<'_, '_>, name: &str) -> Option<u32> {
    attribute(node, name)?.parse().ok()
}

/// The line of an element, from 1.
pub(crate) fn line(node: Node<'_, '_>) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

/// Where a tool stands in its block.
pub(crate) fn place(node: Node<'_, '_>, block: &str) -> ToolPlace {
    let id = attribute(node, "id").map_or_else(String::new, |id| format!(" {}", short(id)));
    let name = attribute(node, "name").or_else(|| attribute(node, "name1"));
    let name = name.map_or_else(String::new, |name| format!(" \"{}\"", short(name)));
    let kind = match attribute(node, "type") {
        Some(kind) => format!(" ({} {})", node.tag_name().name(), short(kind)),
        None => format!(" ({})", node.tag_name().name()),
    };
    ToolPlace { block: block.to_owned(), tool: format!("tool{id}{name}{kind}"), line: line(node) }
}
