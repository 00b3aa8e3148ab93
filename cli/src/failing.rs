//! How faults of a pipeline file and of a run are shown.

use crate::{Streams, exit};
use serde_json::json;
use toile_core::{ErrorCode, StageError};
use toile_pipeline::{Fault, Faults, Pipeline, RunError};

/// Shows what is wrong with a pipeline file.
pub(crate) fn fail_load(faults: &Faults, json: bool, streams: &mut Streams<'_>) -> u8 {
    match json {
        true => streams.say(json!({ "valid": false, "faults": faults.records() })),
        false => streams.fault(faults),
    }
    exit::INVALID
}

/// Shows a stage's error at its place in the pipeline file.
pub(crate) fn fail_run(pipeline: &Pipeline, e: &RunError, json: bool, streams: &mut Streams<'_>) -> u8 {
    let faults = as_faults(pipeline, e);
    match json {
        true => streams.say(json!({ "error": e.error.code.as_str(), "stage": e.stage, "panel": e.entry,
            "message": e.error.message, "hint": e.error.hint, "detail": e.error.detail, "faults": faults.records() })),
        false => streams.fault(&faults),
    }
    e.error.code.exit_code()
}

/// A stage's error as a fault of the pipeline file, at its place.
pub(crate) fn as_faults(pipeline: &Pipeline, e: &RunError) -> Faults {
    let StageError { code, hint, .. } = &e.error;
    let fault = Fault::new(code.as_str(), e.to_string()).hint(hint.clone());
    let fault = if e.span.is_empty() { fault } else { fault.at(&e.span, code_words(*code)) };
    pipeline.faults(vec![fault])
}

fn code_words(code: ErrorCode) -> &'static str {
    match code {
        ErrorCode::Cancelled => "stopped here",
        ErrorCode::Timeout => "ran out of time here",
        _ => "failed here",
    }
}
