//! What stages find wrong before anything runs.

use super::Reads;
use crate::load::{Fault, Faults, Pipeline};
use std::sync::{Arc, PoisonError};
use toile_core::{Cancel, Context, Node, Placed, panics};

/// Asks every stage of which `runs` says that it will run; all that they find wrong comes out at once, each at its place.
///
/// A stage whose check panics is asked no further: its run says what is the matter.
///
/// The files that they look at are added to `reads`.
///
/// Errors: the faults.
pub fn faults(
    pipeline: &Pipeline,
    runs: impl Fn(usize) -> bool,
    reads: Option<&Reads>,
) -> Result<(), Faults> {
    let asked = (0..pipeline.nodes.len()).filter(|i| runs(*i));
    let found: Vec<Fault> = asked.flat_map(|index| of_stage(pipeline, index, reads)).collect();
    if found.is_empty() { Ok(()) } else { Err(pipeline.faults(found)) }
}

fn of_stage(pipeline: &Pipeline, index: usize, reads: Option<&Reads>) -> Vec<Fault> {
    let node: &Node = &pipeline.nodes[index];
    let cx = Context::new(&node.id, &pipeline.base, Cancel::new(), Arc::new(()));
    let placed = Placed { nodes: &pipeline.nodes, index, cx: &cx };
    let errors = panics::caught(|| node.stage.faults(&placed)).unwrap_or_default();
    if let Some(reads) = reads {
        let seen = cx.take_reads().into_iter().map(|(path, hash)| (pipeline.base.join(path), hash));
        reads.lock().unwrap_or_else(PoisonError::into_inner).extend(seen);
    }
    errors.iter().map(|e| pipeline.fault(node, e)).collect()
}
