//! Runs one stage: once, or once for each entry of its named sets.

use super::pixels::of_the_file;
use crate::file_hash::file_hash;
use crate::load::texts_of;
use crate::made::EntryResult;
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use toile_core::artifact::Digest;
use toile_core::{Context, Inputs, Node, PortValue, StageError, panics};

/// A failure with the entry at work.
pub(super) type EntryFailure = (String, StageError);

/// The figure that says how much work a stage took: steps over all of its vertices.
pub(super) const WORK: &str = "work";

/// The entry that people take a photo of first; the back is often its mirror image, and fails with
/// it.
const FRONT: &str = "front";

/// Runs a stage for some entries, in parallel; the front's failure counts, else the first in their
/// order.
pub(super) fn run_entries(
    node: &Node,
    jobs: Vec<(String, Inputs)>,
    cx: &Context,
) -> Result<Vec<EntryResult>, EntryFailure> {
    let runs: Vec<Result<EntryResult, EntryFailure>> =
        jobs.into_par_iter().map(|(entry, inputs)| run_entry(node, entry, &inputs, cx)).collect();
    let front = runs.iter().position(|r| matches!(r, Err((entry, _)) if entry == FRONT));
    match front {
        Some(k) => runs.into_iter().skip(k).collect(),
        None => runs.into_iter().collect(),
    }
}

fn run_entry(node: &Node, entry: String, inputs: &Inputs, cx: &Context) -> Result<EntryResult, EntryFailure> {
    let own = cx.for_entry(&entry);
    let outcome = guarded(node, inputs, &own);
    let mut reads = own.take_reads();
    reads.extend(named_files(node, cx));
    cx.absorb_reads(&reads);
    match outcome {
        Err(e) => {
            cx.take_over(own.take_so_far());
            Err((entry, e))
        }
        Ok(outputs) => {
            if own.work_so_far() > 0.0 {
                own.figure(WORK, own.work_so_far(), "steps");
            }
            let (figures, remarks) = (own.take_figures(), own.take_remarks());
            Ok(EntryResult { entry, outputs, figures, remarks, reads })
        }
    }
}

/// The files that a plugin's stage is given by name: it reads them on its own side of the border,
/// and one built for ABI 1.0 cannot tell which.
fn named_files(node: &Node, cx: &Context) -> Vec<(String, Option<Digest>)> {
    if node.card.plugin.is_none() {
        return Vec::new();
    }
    let texts = texts_of(&node.stage.params()).into_iter().filter(|t| !t.is_empty());
    texts.filter_map(|t| file_hash(&cx.resolve(&t)).map(|hash| (t, Some(hash)))).collect()
}

/// A stage that panics is a bug of the stage, not the end of the program.
fn guarded(node: &Node, inputs: &Inputs, cx: &Context) -> Result<Vec<PortValue>, StageError> {
    match catch_unwind(AssertUnwindSafe(|| node.stage.run_ports(inputs, cx))) {
        Ok(outcome) => outcome.and_then(checked).map(|made| of_the_file(inputs, made)),
        Err(payload) if payload.is::<StageError>() => {
            Err(payload.downcast::<StageError>().map_or_else(|_| StageError::internal(""), |e| *e))
        }
        Err(payload) => Err(StageError::internal(format!("the stage panicked: {}", panics::words(payload)))
            .hint(panics::REPORT)),
    }
}

/// A stage that gives what cannot be is named here, not where a later stage stumbles over it.
fn checked(made: Vec<PortValue>) -> Result<Vec<PortValue>, StageError> {
    for value in &made {
        for (name, artifact) in value.entries() {
            artifact.check().map_err(|fault| {
                let of = if name.is_empty() { String::new() } else { format!(" \"{name}\"") };
                StageError::internal(format!("its {}{of} cannot be used: {fault}", artifact.kind()))
                    .hint("this is a bug of the stage, please report it to its author")
            })?;
        }
    }
    Ok(made)
}
