//! Stages that every pipeline gets where it holds what they need, such as the judgement of the
//! garment behind `metrics.json`.

use crate::load::{Pipeline, before_flatteners};
use std::collections::BTreeMap;
use toile_core::artifact::{ArtifactType, OutputFiles};
use toile_core::{Arity, Card, Feed, InPort, Node, Registry, Stage};

/// Adds every implicit stage of the registry whose inputs the pipeline makes and which it does not
/// name itself.
///
/// It is given what is written: the last of a kind on which a writer depends, and only where there
/// is none the last of all. It stands before the stages that report on the run, so that they see
/// its result, as far as what it takes is made before them.
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
    let written = written(pipeline);
    card.inputs
        .iter()
        .map(|port| match maker(pipeline, port, &written) {
            Some(feed) => Some(feed),
            None if port.optional => Some(Feed::Nothing),
            None => None,
        })
        .collect()
}

/// For each stage whether a file that is written depends on it.
fn written(pipeline: &Pipeline) -> Vec<bool> {
    let writes = |n: &Node| n.card.outputs.iter().any(|o| o.kind == OutputFiles::KIND);
    let writers: Vec<usize> = (0..pipeline.nodes.len()).filter(|&i| writes(&pipeline.nodes[i])).collect();
    pipeline.needed_for(&writers)
}

/// The last port that makes a kind; the first where the original is wanted, and what flatteners
/// were given where what was sewn is.
fn maker(pipeline: &Pipeline, wanted: &InPort, written: &[bool]) -> Option<Feed> {
    let makes = |(node, n): (usize, &Node)| {
        let port = n.card.outputs.iter().position(|o| o.kind == wanted.kind)?;
        let is_set = n.card.is_mapped() || n.card.outputs[port].arity == Arity::All;
        (is_set == (wanted.arity != Arity::One)).then_some(Feed::Node { node, port })
    };
    let all = || pipeline.nodes.iter().enumerate();
    let used = || all().filter(|(i, _)| written[*i]);
    let found = match wanted.original {
        true => used().find_map(makes).or_else(|| all().find_map(makes)),
        false => used().rev().find_map(makes).or_else(|| all().rev().find_map(makes)),
    };
    match found {
        Some(Feed::Node { node, port }) if wanted.sewn => {
            let given = |n: usize| pipeline.nodes.get(n).map(|n| (&n.card, &n.inputs));
            let (node, port) = before_flatteners((node, port), wanted.kind, given);
            Some(Feed::Node { node, port })
        }
        found => found,
    }
}

fn insert(pipeline: &mut Pipeline, stage: Box<dyn Stage>, card: Card, inputs: Vec<Feed>) {
    let behind = |feed: &Feed| if let Feed::Node { node, .. } = feed { node + 1 } else { 0 };
    let earliest = inputs.iter().map(behind).max().unwrap_or(0);
    let reports = |n: &Node| n.inputs.contains(&Feed::RunLog);
    let report = pipeline.nodes.iter().skip(earliest).position(reports);
    let at = report.map_or(pipeline.nodes.len(), |i| earliest + i);
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;
    use crate::load::load;
    use crate::load::tests::kit;
    use std::path::Path;
    use toile_core::prelude::*;

    /// Judges the model.
    #[stage(role = Writer)]
    struct Judge {}

    #[stage]
    impl Judge {
        fn run(
            &self,
            #[sewn] _model: &Model,
            _flat: Option<&Model>,
            _cx: &Context,
        ) -> Result<Figures, StageError> {
            Err(StageError::internal("a test stage does nothing"))
        }
    }

    /// Lays flat.
    #[stage(role = Flattener)]
    struct LaidFlat {}

    #[stage]
    impl LaidFlat {
        fn run(&self, _model: &Model, _cx: &Context) -> Result<Model, StageError> {
            Err(StageError::internal("a test stage does nothing"))
        }
    }

    /// The vest with these stages at its end: what feeds the judgement, and what stands around it.
    fn judged(end: &str) -> (String, Vec<String>) {
        let mut registry = kit::registry();
        registry.add::<LaidFlat>();
        registry.add_implicit::<Judge>();
        let text = kit::VEST.replace("Glb(), Report(),", end);
        let mut pipeline = load(&text, "vest.ron", Path::new("."), &registry, &[]).unwrap();
        add_implicit(&mut pipeline, &registry);
        for (i, node) in pipeline.nodes.iter().enumerate() {
            let behind = |f: &Feed| matches!(f, Feed::Node { node, .. } if *node >= i);
            assert!(!node.inputs.iter().any(behind), "{} is fed from behind", node.id);
        }
        let judge = &pipeline.nodes[pipeline.find("Judge").unwrap()];
        let Feed::Node { node, .. } = judge.inputs[0] else { return (String::new(), Vec::new()) };
        let ids = pipeline.nodes.iter().map(|n| n.id.clone());
        (pipeline.nodes[node].id.clone(), ids.skip(10).collect())
    }

    #[test]
    fn what_was_sewn_is_judged_whatever_flatteners_stand_behind() {
        for end in [
            "LaidFlat(), LaidFlat(id: \"again\"), Glb(), Report(),",
            "LaidFlat(), LaidFlat(id: \"again\"), Judge(), Glb(), Report(),",
        ] {
            let (fed, _) = judged(end);
            assert_eq!(fed, "Painter", "{end}");
        }
        let mut registry = kit::registry();
        registry.add::<LaidFlat>();
        registry.add_implicit::<Judge>();
        let text = kit::VEST.replace("Glb(), Report(),", "LaidFlat(), Glb(), Report(),");
        let mut pipeline = load(&text, "vest.ron", Path::new("."), &registry, &[]).unwrap();
        add_implicit(&mut pipeline, &registry);
        let judge = &pipeline.nodes[pipeline.find("Judge").unwrap()];
        let Feed::Node { node, .. } = judge.inputs[1] else { panic!("{:?}", judge.inputs) };
        assert_eq!(pipeline.nodes[node].id, "LaidFlat");
    }

    #[test]
    fn what_is_written_is_judged_before_the_report() {
        let (fed, order) = judged("Glb(), Report(),");
        assert_eq!(fed, "Painter");
        assert_eq!(order, ["Painter", "Glb", "Judge", "Report"]);
    }

    #[test]
    fn what_nothing_writes_is_not_judged_wherever_it_stands() {
        let (fed, order) = judged("Glb(), Report(), Painter(id: \"late\"),");
        assert_eq!(fed, "Painter");
        assert_eq!(order, ["Painter", "Glb", "Judge", "Report", "late"]);
        assert_eq!(judged("Glb(), Painter(id: \"late\"), Report(),").0, "Painter");
    }

    #[test]
    fn what_is_made_and_written_after_the_report_is_judged_after_it() {
        let (fed, order) = judged("Report(), Painter(id: \"late\"), Glb(from: \"late\"),");
        assert_eq!(fed, "late");
        assert_eq!(order, ["Painter", "Report", "late", "Glb", "Judge"]);
    }

    #[test]
    fn without_a_writer_the_last_is_judged() {
        assert_eq!(judged("").0, "Painter");
        assert_eq!(judged("Report(), Painter(id: \"late\"),").0, "late");
    }
}
