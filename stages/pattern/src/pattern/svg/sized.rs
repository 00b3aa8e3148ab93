//! One size of a drawing that has a layer or a group for each.
//!
//! The layers and groups of that name are read; of those beside them, in the same layer or group,
//! the others are left out. Cost: one walk of the tree. Limit: what is the same in all sizes must
//! be in the layer of each.

use super::damage::SvgDamage;
use super::drawing::{Local, local, name};
use super::source::short;
use roxmltree::Node;
use std::collections::BTreeSet;
use toile_core::Remarks;

/// Names that an error lists at most.
const MOST_NAMES: usize = 40;

/// Where the groups begin that are not of that size; none where no size is asked for.
///
/// Errors: no group has that name.
pub(super) fn others<'t>(
    root: Node<'t, 't>,
    size: &str,
    told: &mut Remarks,
) -> Result<BTreeSet<usize>, SvgDamage> {
    let size = size.trim();
    if size.is_empty() {
        return Ok(BTreeSet::new());
    }
    let groups = || root.descendants().filter(|n| n.has_tag_name_local("g"));
    let is_size = |n: &Node<'t, 't>| given(n).is_some_and(|name| name.eq_ignore_ascii_case(size));
    let chosen: Vec<Node<'t, 't>> = groups().filter(is_size).collect();
    if chosen.is_empty() {
        let is_layer = |n: &Node<'t, 't>| local(*n, "groupmode") == Some("layer");
        let layered = groups().any(|n| is_layer(&n));
        let listed = groups().filter(|n| if layered { is_layer(n) } else { true });
        return Err(SvgDamage::NoSize { size: short(size), known: unlike(listed.filter_map(|n| given(&n))) });
    }
    let mut left: Vec<Node<'t, 't>> = chosen.iter().flat_map(|n| beside(*n)).collect();
    left.retain(|n| !is_size(n));
    let names = unlike(left.iter().filter_map(given));
    if !names.is_empty() {
        told.notes.push(format!("\"{}\" is read, without {}", short(size), names.join(", ")));
    }
    Ok(left.iter().map(|n| n.range().start).collect())
}

/// The name that a person gave a group.
fn given(n: &Node<'_, '_>) -> Option<String> {
    name(*n).filter(|name| !name.generated).map(|name| name.text)
}

/// The groups that stand where this one does.
fn beside<'t>(n: Node<'t, 't>) -> Vec<Node<'t, 't>> {
    n.parent().into_iter().flat_map(|p| p.children()).filter(|c| c.has_tag_name_local("g")).collect()
}

/// Names in their order, each once.
fn unlike(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for name in names.map(|n| short(&n)) {
        if !out.contains(&name) && out.len() < MOST_NAMES {
            out.push(name);
        }
    }
    out
}
