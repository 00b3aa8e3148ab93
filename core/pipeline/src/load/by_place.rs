//! Gives stages the parameters that follow from their place, and those that stages behind them ask
//! for, where the file leaves them out.

use super::fields_of;
use std::collections::BTreeMap;
use toile_core::{Node, Registry, needed_for};

/// Asks each stage in turn, after all that stand before it, and makes it anew where that sets a
/// parameter.
pub(super) fn settle(nodes: &mut [Node], text: &str, registry: &Registry) {
    for index in 0..nodes.len() {
        let by_place = nodes[index].stage.by_place(nodes, index);
        let like = by_place.like.and_then(|k| nodes.get(k)).filter(|n| n.card.name == nodes[index].card.name);
        let mut params = like.map(|n| fields_of(&n.stage.params())).unwrap_or_default();
        params.extend(by_place.set.into_iter().map(|(name, value)| (name.to_owned(), value)));
        params.extend(asked(nodes, index));
        if params.is_empty() {
            continue;
        }
        let node = &mut nodes[index];
        let written: BTreeMap<String, String> = node
            .params
            .iter()
            .filter_map(|(name, place)| Some((name.clone(), text.get(place.clone())?.to_owned())))
            .collect();
        params.extend(written);
        let arguments: Vec<String> = params.iter().map(|(name, value)| format!("{name}: {value}")).collect();
        if let Ok(stage) = registry.make(&node.card, &format!("({})", arguments.join(", "))) {
            node.stage = stage;
        }
    }
}

/// What the stages that stage `index` feeds ask of it; of two that ask for the same, the first.
fn asked(nodes: &[Node], index: usize) -> BTreeMap<String, String> {
    let mut params = BTreeMap::new();
    for (k, node) in nodes.iter().enumerate().skip(index + 1) {
        for (name, value) in node.stage.asks() {
            let has = nodes[index].card.params.iter().any(|p| p.name == name);
            if has && needed_for(nodes, &[k]).get(index) == Some(&true) {
                params.entry(name.to_owned()).or_insert(value);
            }
        }
    }
    params
}
