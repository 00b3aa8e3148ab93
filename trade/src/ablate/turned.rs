//! A pipeline with one of its decisions turned round.

use crate::knobs::source::{Source, path_of};
use toile_core::StageError;
use toile_core::decide::Turn;
use toile_pipeline::decide::{StageDecision, decisions};
use toile_pipeline::{Override, Pipeline, RunOptions};

/// A decision with the pipeline that it is turned round in.
pub(super) struct Turned {
    pub(super) decided: StageDecision,
    /// The option that turns it round; no two decisions have the same.
    pub(super) by: String,
    pub(super) pipeline: Pipeline,
    /// Stages that run though nothing asks for them.
    pub(super) also: Vec<String>,
}

/// Every decision of a run of the pipeline up to a stage, each turned round.
///
/// Errors: there is none; an override that does not load.
pub(super) fn all_turned(
    source: &Source<'_>,
    pipeline: &Pipeline,
    until: Option<&str>,
) -> Result<Vec<Turned>, StageError> {
    let run = RunOptions { until: until.map(str::to_owned), ..RunOptions::default() };
    let decided = decisions(pipeline, &run).map_err(|e| e.error)?;
    if decided.is_empty() {
        return Err(StageError::invalid("nothing is left out or simplified in this pipeline")
            .hint("`toile explain` shows the decisions of a pipeline"));
    }
    decided.into_iter().map(|d| turned(source, pipeline, d)).collect()
}

fn turned(source: &Source<'_>, pipeline: &Pipeline, decided: StageDecision) -> Result<Turned, StageError> {
    let path = path_to(source, pipeline, &decided.stage);
    let (more, also) = match &decided.decision.turn {
        Turn::Param { name, value } => {
            (vec![Override { path: format!("{path}.{name}"), value: value.clone() }], Vec::new())
        }
        Turn::Also => (Vec::new(), vec![decided.stage.clone()]),
    };
    let pipeline = source.load(&more).map_err(|faults| StageError::internal(faults.to_string()))?;
    Ok(Turned { by: decided.words(&path), decided, pipeline, also })
}

/// Where overrides reach a stage.
pub(crate) fn path_to(source: &Source<'_>, pipeline: &Pipeline, stage: &str) -> String {
    let node = pipeline.nodes.iter().find(|n| n.id == stage);
    node.map_or_else(|| format!("stages.{stage}"), |n| path_of(source, pipeline, n))
}
