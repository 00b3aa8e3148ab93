//! What stages find wrong before anything runs.

use super::{Fault, Faults, Pipeline};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use toile_core::artifact::Digest;
use toile_core::{Cancel, Context, Node, Placed, Stage, StageError, panics};

/// Files with the digest of the content that was read, none where there was no such file; a run
/// fills it in while it goes on.
pub type Reads = Arc<Mutex<BTreeMap<PathBuf, Option<Digest>>>>;

/// Asks every stage of which `runs` says that it will run; all that they find wrong comes out at
/// once, each at its place.
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

/// What the stages warn of before anything runs, each at its place; nothing of a stage whose check
/// panics.
pub(crate) fn warnings(pipeline: &Pipeline) -> Vec<Fault> {
    (0..pipeline.nodes.len())
        .flat_map(|index| asked(pipeline, index, None, |stage, placed| stage.warnings(placed)))
        .collect()
}

fn of_stage(pipeline: &Pipeline, index: usize, reads: Option<&Reads>) -> Vec<Fault> {
    asked(pipeline, index, reads, |stage, placed| stage.faults(placed))
}

fn asked(
    pipeline: &Pipeline,
    index: usize,
    reads: Option<&Reads>,
    ask: impl Fn(&dyn Stage, &Placed<'_>) -> Vec<StageError>,
) -> Vec<Fault> {
    let node: &Node = &pipeline.nodes[index];
    let cx = Context::new(&node.id, &pipeline.base, Cancel::new(), Arc::new(()));
    let placed = Placed { nodes: &pipeline.nodes, index, cx: &cx };
    let errors = panics::caught(|| ask(node.stage.as_ref(), &placed)).unwrap_or_default();
    if let Some(reads) = reads {
        let seen = cx.take_reads().into_iter().map(|(path, hash)| (pipeline.base.join(path), hash));
        reads.lock().unwrap_or_else(PoisonError::into_inner).extend(seen);
    }
    errors.iter().map(|e| pipeline.fault(node, e)).collect()
}
