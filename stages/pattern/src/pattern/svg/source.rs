//! The bytes of a file as a tree of elements, bounded in size.
//!
//! Cost: linear. Limits: UTF-8; 32 MB; a million nodes. Entities of the document's own type
//! declaration are expanded, as Illustrator writes some; depth and number of their expansions are
//! bounded by `roxmltree`, external ones are not read.

use super::damage::{SvgDamage, SvgPlace};
use roxmltree::{Document, Node, ParsingOptions};

const MOST_BYTES: usize = 32 << 20;
const MOST_NODES: u32 = 1_000_000;

/// The text of a file.
pub(super) fn text(bytes: &[u8]) -> Result<&str, SvgDamage> {
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return Err(SvgDamage::Compressed);
    }
    if bytes.len() > MOST_BYTES {
        return Err(SvgDamage::Large { bytes: bytes.len(), most: MOST_BYTES });
    }
    let text = std::str::from_utf8(bytes).map_err(|_| SvgDamage::Encoding)?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// The tree of a text whose first element is an SVG.
pub(super) fn tree(text: &str) -> Result<Document<'_>, SvgDamage> {
    let options = ParsingOptions { allow_dtd: true, nodes_limit: MOST_NODES, entity_resolver: None };
    let tree = Document::parse_with_options(text, options).map_err(|e| match e {
        roxmltree::Error::NodesLimitReached => SvgDamage::Many { what: "nodes", most: MOST_NODES as usize },
        _ => {
            let (words, at) = (e.to_string(), e.pos());
            let what = words.strip_suffix(&format!(" at {at}")).unwrap_or(&words).to_owned();
            SvgDamage::Xml { what: short(&what), line: at.row, column: at.col }
        }
    })?;
    let tag = tree.root_element().tag_name().name();
    if tag != "svg" {
        return Err(SvgDamage::NotSvg { tag: short(tag) });
    }
    Ok(tree)
}

/// Where an element stands in the file.
pub(super) fn place(node: Node<'_, '_>) -> SvgPlace {
    let at = node.document().text_pos_at(node.range().start);
    let tag = node.tag_name().name();
    let element = match node.attribute("id") {
        Some(id) => format!("{tag} \"{}\"", short(id)),
        None => tag.to_owned(),
    };
    SvgPlace { element, line: at.row, column: at.col }
}

/// A value as it stands in a message.
pub(super) fn short(value: &str) -> String {
    value.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).take(40).collect()
}
