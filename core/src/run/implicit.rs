//! Stages that every pipeline gets where it holds what they need, such as the judgement of the
//! garment behind `metrics.json`.

use crate::pipeline::{Feed, Node, Pipeline};
use crate::{Arity, Card, InPort, Registry, Stage};
use std::collections::BTreeMap;

/// Adds every implicit stage of the registry whose inputs the pipeline makes and which it does not
/// name itself. It stands before the stages that report on the run, so that they see its result.
pub fn add_implicit(pipeline: &mut Pipeline, registry: &Registry) {
    for make in registry.implicit() {
        let stage = make();
        let card = stage.card();
        if pipeline.nodes.iter().any(|n| n.card.name == card.name) {
            continue;
        }
        if let Some(inputs) = feeds(pipeline, &card) {
            insert(pipeline, stage, card, inputs);
        }
    }
}

/// What feeds each of the card's ports; `None` where a needed one has nothing.
fn feeds(pipeline: &Pipeline, card: &Card) -> Option<Vec<Feed>> {
    card.inputs
        .iter()
        .map(|port| match maker(pipeline, port) {
            Some(feed) => Some(feed),
            None if port.optional => Some(Feed::Nothing),
            None => None,
        })
        .collect()
}

/// The last port that makes a kind; the first where the original is wanted.
fn maker(pipeline: &Pipeline, wanted: &InPort) -> Option<Feed> {
    let makes = |(node, n): (usize, &Node)| {
        let port = n.card.outputs.iter().position(|o| o.kind == wanted.kind)?;
        let is_set = n.card.is_mapped() || n.card.outputs[port].arity == Arity::All;
        (is_set == (wanted.arity != Arity::One)).then_some(Feed::Node { node, port })
    };
    let mut nodes = pipeline.nodes.iter().enumerate();
    if wanted.original { nodes.find_map(makes) } else { nodes.rev().find_map(makes) }
}

fn insert(pipeline: &mut Pipeline, stage: Box<dyn Stage>, card: Card, inputs: Vec<Feed>) {
    let reports = |n: &Node| n.inputs.contains(&Feed::RunLog);
    let at = pipeline.nodes.iter().position(reports).unwrap_or(pipeline.nodes.len());
    for feed in pipeline.nodes[at..].iter_mut().flat_map(|n| &mut n.inputs) {
        if let Feed::Node { node, .. } = feed
            && *node >= at
        {
            *node += 1;
        }
    }
    let id = card.name.to_owned();
    pipeline
        .nodes
        .insert(at, Node { id, stage, card, span: 0..0, place: 0..0, params: BTreeMap::new(), inputs });
}
