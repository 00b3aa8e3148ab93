//! The bytes of a file as a tree of elements, bounded in size.
//!
//! The letters are in the encoding that is asked for, else that of the byte order mark, else that
//! of the XML declaration, else UTF-8. Cost: linear. Limits: 32 MB; a million nodes. Entities of
//! the document's own type declaration are expanded, as Illustrator writes some; depth and number
//! of their expansions are bounded by `roxmltree`, external ones are not read.

use super::super::letters::{decoded, encoding};
use super::damage::{SvgDamage, SvgPlace};
use encoding_rs::{Encoding, UTF_8};
use roxmltree::{Document, Node, ParsingOptions};
use std::borrow::Cow;

const MOST_BYTES: usize = 32 << 20;
const MOST_NODES: u32 = 1_000_000;

/// The XML declaration stands within the first bytes.
const DECLARATION: usize = 200;

/// The text of a file, whose letters are in `asked`, or as the file says where that is empty.
pub(super) fn text<'b>(bytes: &'b [u8], asked: &str) -> Result<Cow<'b, str>, SvgDamage> {
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return Err(SvgDamage::Compressed);
    }
    if bytes.len() > MOST_BYTES {
        return Err(SvgDamage::Large { bytes: bytes.len(), most: MOST_BYTES });
    }
    if !asked.trim().is_empty() {
        return decoded(bytes, asked).map(Cow::Owned).map_err(SvgDamage::Letters);
    }
    if let Some((found, _)) = Encoding::for_bom(bytes) {
        return whole(found, bytes).ok_or(SvgDamage::Encoding);
    }
    match declared(bytes) {
        // Programs save as UTF-8 and leave the declaration as it was.
        Some(name) if encoding(&name).is_none_or(|e| e == UTF_8) || std::str::from_utf8(bytes).is_ok() => {
            whole(UTF_8, bytes).ok_or(SvgDamage::Encoding)
        }
        Some(name) => encoding(&name)
            .and_then(|found| whole(found, bytes))
            .ok_or_else(|| SvgDamage::SaidEncoding { name: short(&name) }),
        None => whole(UTF_8, bytes).ok_or(SvgDamage::Encoding),
    }
}

/// The text without its byte order mark; none where some of it is no text in that encoding.
fn whole<'b>(found: &'static Encoding, bytes: &'b [u8]) -> Option<Cow<'b, str>> {
    let (text, wrong) = found.decode_with_bom_removal(bytes);
    (!wrong).then_some(text)
}

/// The encoding that the XML declaration names.
fn declared(bytes: &[u8]) -> Option<String> {
    let head = String::from_utf8_lossy(bytes.get(..DECLARATION).unwrap_or(bytes)).into_owned();
    let head = head.trim_start().strip_prefix("<?xml")?.split("?>").next()?.to_owned();
    let value = head.split_once("encoding")?.1.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    value[1..].split_once(quote).map(|(name, _)| name.to_owned())
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
