//! Whatever is sewn is what is written: the last pattern of every shipped pipeline has the outlines
//! of its panels.

use std::any::Any;
use std::sync::Arc;
use toile_core::artifact::{Artifact, ArtifactType, Panel, Pattern, polygon_area};
use toile_core::{Cancel, Listener};
use toile_pipeline::{RunOptions, load, run};

/// Lengths differ by no more than this, metres; areas by as much along the whole outline.
const SAME: f64 = 5e-4;

fn typed<T: 'static>(artifact: &Arc<dyn Artifact>) -> Option<&T> {
    let any: &dyn Any = artifact.as_ref();
    any.downcast_ref()
}

/// The pieces that were compared in a shipped pipeline, and how they differ.
fn compared(name: &str) -> (usize, Vec<String>) {
    let registry = toile::registry();
    let file = toile_tests::pipeline(name);
    let text = std::fs::read_to_string(&file).unwrap();
    let pipeline = load(&text, &file, &toile_tests::root().join("pipelines"), &registry, &[]).unwrap();
    let makes = |kind| move |n: &&toile_core::Node| n.card.outputs.iter().any(|o| o.kind == kind);
    let Some(mesher) = pipeline.nodes.iter().find(makes(Panel::KIND)) else { return (0, Vec::new()) };
    if !pipeline.nodes.iter().take_while(|n| n.id != mesher.id).any(|n| makes(Pattern::KIND)(&n)) {
        return (0, Vec::new());
    }
    // What is drawn may be made by a stage that the mesher does not wait for.
    let drawing =
        pipeline.nodes.iter().take_while(|n| n.id != mesher.id).filter(|n| makes(Pattern::KIND)(n)).last();
    let also = drawing.map(|n| n.id.clone()).into_iter().collect();
    let options = RunOptions { until: Some(mesher.id.clone()), also, ..RunOptions::default() };
    let listener: Arc<dyn Listener> = Arc::new(());
    let result = run(&pipeline, &options, &Cancel::new(), &listener).unwrap();
    let entries = || result.log.stages.iter().flat_map(|r| &r.outputs).flat_map(|value| value.entries());
    let pattern = entries().filter_map(|(_, a)| typed::<Pattern>(a)).next_back().unwrap();
    let panels = entries().filter_map(|(name, a)| Some((name, typed::<Panel>(a)?)));
    let mut differ = Vec::new();
    let mut count = 0;
    for (panel, sewn) in panels {
        count += 1;
        let Some(piece) = pattern.piece(panel) else {
            differ.push(format!("{name}: no piece \"{panel}\" is drawn"));
            continue;
        };
        let length: f64 = (0..piece.outer.edges.len()).map(|k| piece.outer.path(k).length()).sum();
        let area = polygon_area(&piece.outer.points().0)
            - piece.holes.iter().map(|h| polygon_area(&h.points().0).abs()).sum::<f64>();
        if (length - sewn.outline_length).abs() > SAME * piece.outer.edges.len() as f64
            || (area - sewn.outline_area).abs() > SAME * length
        {
            differ.push(format!(
                "{name}, {panel}: drawn {length:.4} m around and {area:.5} m2, sewn {:.4} m and {:.5} m2",
                sewn.outline_length, sewn.outline_area
            ));
        }
    }
    (count, differ)
}

#[test]
fn every_shipped_pipeline_draws_what_it_sews() {
    let all: Vec<(usize, Vec<String>)> = toile_tests::PIPELINES.iter().map(|name| compared(name)).collect();
    let differ: Vec<&String> = all.iter().flat_map(|(_, differ)| differ).collect();
    assert!(differ.is_empty(), "{differ:#?}");
    // Photos, GarmentCode, SVG: pieces of all of them were looked at.
    assert!(all.iter().filter(|(count, _)| *count > 0).count() >= 15, "{all:?}");
}
