//! The draft of a pattern: its blocks' tools, worked out one after the other.
//!
//! A tool whose construction fails fails alone, with what is drawn from it: a file is refused for
//! what its pieces need. Cost: linear in the tools, but for crossings of curves.

mod curves;
mod cuts;
mod darts;
mod drafting;
mod meetings;
mod object;
mod operations;
mod points;
#[cfg(test)]
mod tests;
mod values;

pub(crate) use drafting::{DraftTool, Drafting};
pub(crate) use object::DraftObject;
pub(crate) use values::{Asked, DraftValues, Failed};

use super::fault::SeamlyFault;
use super::source::{attribute, children, number};
use roxmltree::Node;

/// Tools of a file.
const MOST_TOOLS: usize = 10_000;
/// Draft blocks, as Seamly2D and Valentina call them.
pub(crate) const BLOCKS: &[&str] = &["draftBlock", "draw"];

/// The name of a block.
pub(crate) fn block_name<'a>(block: Node<'a, '_>) -> &'a str {
    attribute(block, "name").unwrap_or("")
}

/// Draws the blocks of a pattern.
///
/// Errors: more tools than are read; what is wrong with a tool is kept with the values.
pub(crate) fn drawn(root: Node<'_, '_>, values: DraftValues) -> Result<Drafting, SeamlyFault> {
    let mut draft = Drafting::of(values);
    let tools = |block| children(block, &["calculation"]).flat_map(|n| n.children().filter(Node::is_element));
    for (k, node) in children(root, BLOCKS).flat_map(tools).enumerate() {
        if k == MOST_TOOLS {
            return Err(SeamlyFault::Many { what: "tools", most: MOST_TOOLS });
        }
        draft.ids.extend(results(node));
    }
    for block in children(root, BLOCKS) {
        for node in tools(block) {
            let tool = DraftTool::new(node, block_name(block));
            let made = match node.tag_name().name() {
                "point" => points::point(&mut draft, &tool),
                "arc" => curves::arc(&mut draft, &tool),
                "elArc" => curves::ellipse(&mut draft, &tool),
                "spline" => curves::spline(&mut draft, &tool),
                "operation" => operations::operation(&mut draft, &tool),
                // A line is drawn between points that there are.
                "line" => Ok(()),
                _ => Err(draft.unsupported(&tool)),
            };
            if let Err(why) = made {
                lose(&mut draft, node, why);
            }
        }
    }
    Ok(draft)
}

/// The numbers of the objects that a tool draws.
fn results(node: Node<'_, '_>) -> Vec<u32> {
    let named = ["id", "point1", "point2", "segment1Id", "segment2Id", "segment3Id", "segment4Id"];
    let named = match attribute(node, "type") {
        Some("trueDarts") => &named[..],
        _ => &[named[0], named[3], named[4], named[5], named[6]],
    };
    let mut all: Vec<u32> = named.iter().filter_map(|name| number(node, name)).collect();
    all.extend(destinations(node));
    if cuts::has_parts(node)
        && let Some(id) = number(node, "id")
    {
        all.extend([1, 2].map(|k| id.saturating_add(k)));
    }
    all
}

/// The numbers of the objects that an operation draws.
fn destinations<'a, 't: 'a>(node: Node<'a, 't>) -> impl Iterator<Item = u32> {
    let items = children(node, &["destination"]).flat_map(|n| children(n, &["item"]));
    items.filter_map(|n| number(n, "idObject"))
}

/// Marks what a tool would have drawn.
fn lose(draft: &mut Drafting, node: Node<'_, '_>, why: Failed) {
    for id in results(node) {
        draft.objects.entry(id).or_insert(DraftObject::Failed(why));
    }
    for name in ["name", "name1", "name2"] {
        draft.values.lose(attribute(node, name).unwrap_or(""), why);
    }
    if let Some(suffix) = attribute(node, "suffix") {
        let sources = children(node, &["source"]).flat_map(|n| children(n, &["item"]));
        for id in sources.filter_map(|n| number(n, "idObject")) {
            if let Some(DraftObject::Point { name, .. }) = draft.objects.get(&id) {
                let name = format!("{name}{suffix}");
                draft.values.lose(&name, why);
            }
        }
    }
}
