//! What a run that failed leaves for a look: what its stages made until then.

use super::exports::exports;
use super::steps::PipelineRun;
use super::{RunError, RunOptions};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError};
use toile_core::artifact::{OutputFile, OutputFiles};
use toile_core::{ArtifactType, Cancel, ErrorCode, Feed, Inputs, Node, PortValue, Remarks};
use toile_core::{Failure, RunLog, StageRecord};

/// Takes what a run that fails has made until then.
///
/// `reason.txt`; the pages of stages that report on a run, with the reason on top; and the
/// artifacts of the stage that failed, with [`RunOptions::keep`] those of all stages. Nothing where
/// no stage had made anything that can be shown. Nothing either where the run was stopped, unless
/// [`RunOptions::so_far_of_stopped`] asks for it: then the artifacts of all stages.
pub type SoFar = Arc<Mutex<Vec<OutputFile>>>;

/// Fills [`RunOptions::so_far`].
pub(super) fn leave(run: &mut PipelineRun<'_>, options: &RunOptions, error: &RunError) {
    let is_stopped = error.error.code == ErrorCode::Cancelled;
    let is_asked = options.so_far_of_stopped || !is_stopped;
    let Some(sink) = options.so_far.as_ref().filter(|_| is_asked) else { return };
    // The stage that was stopped has made nothing; those before it have.
    let keep = options.keep || is_stopped;
    // If something fails here, the user still gets the first error.
    let files = catch_unwind(AssertUnwindSafe(|| files(run, keep, error))).unwrap_or_default();
    *sink.lock().unwrap_or_else(PoisonError::into_inner) = files;
}

fn files(run: &mut PipelineRun<'_>, keep: bool, error: &RunError) -> Vec<OutputFile> {
    let failed = run.steps.len();
    for index in 0..failed {
        // What cannot be brought back is not shown.
        let _ = run.ensure_all(index);
    }
    let node = &run.pipeline.nodes[failed];
    let so_far = record(node, run.so_far.take());
    let mut log = run.report(failed);
    log.stages.push(so_far.clone());
    if log.stages.iter().all(|s| s.outputs.is_empty()) {
        return Vec::new();
    }
    let failure = Failure {
        stage: node.id.clone(),
        message: error.to_string(),
        hint: error.error.hint.clone(),
        detail: error.error.detail.clone(),
    };
    let mut files = vec![reason(&failure)];
    log.failure = Some(failure);
    files.extend(run.pipeline.nodes[failed..].iter().filter(|n| is_page(n)).flat_map(|n| page(run, n, &log)));
    match keep {
        true => files.extend(log.stages.iter().flat_map(exports)),
        false => files.extend(exports(&so_far)),
    }
    files
}

/// The record of the stage that failed.
fn record(node: &Node, so_far: Option<PortValue>) -> StageRecord {
    StageRecord {
        id: node.id.clone(),
        name: node.card.name.to_owned(),
        role: node.card.role,
        params: node.stage.params(),
        wall_s: 0.0,
        outputs: so_far.into_iter().collect(),
        figures: Vec::new(),
        remarks: Remarks::default(),
        used: None,
        predicted: None,
    }
}

fn reason(failure: &Failure) -> OutputFile {
    let hint = failure.hint.iter().map(|h| format!("help: {h}\n"));
    let detail = failure.detail.iter().map(|d| format!("detail: {d}\n"));
    let text: String = std::iter::once(format!("{}\n", failure.message)).chain(hint).chain(detail).collect();
    OutputFile { path: "reason.txt".into(), bytes: text.into_bytes() }
}

/// Whether a stage reports on a run, and on nothing else.
fn is_page(node: &Node) -> bool {
    let gives_files = node.card.outputs.iter().all(|o| o.kind == OutputFiles::KIND);
    gives_files && node.inputs.len() == 1 && matches!(node.inputs[0], Feed::RunLog)
}

fn page(run: &PipelineRun<'_>, node: &Node, log: &RunLog) -> Vec<OutputFile> {
    let inputs = Inputs(vec![Some(PortValue::One(Arc::new(log.clone())))]);
    // The run's own flag may be up.
    let cx = run.context_under(Cancel::new(), node, Arc::new(()));
    let made = node.stage.run_ports(&inputs, &cx).unwrap_or_default();
    let artifacts = made.iter().flat_map(PortValue::entries).map(|(_, artifact)| artifact);
    artifacts.filter_map(super::typed::<OutputFiles>).flat_map(|files| files.0.clone()).collect()
}
