//! Every decision of a pipeline, in the order of its stages.

use super::unasked::unasked;
use super::{Decision, Turn};
use crate::cost::{Foreseen, foresee};
use crate::load::Pipeline;
use crate::{RunError, RunOptions, plan};
use serde::{Deserialize, Serialize};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use toile_core::{Cancel, Context, Known};

/// A decision with the stage that it is of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageDecision {
    /// The stage's id.
    pub stage: String,
    /// The decision.
    #[serde(flatten)]
    pub decision: Decision,
}

impl StageDecision {
    /// What the user writes to turn it round, but for the option's own name:
    /// `stages.StaticEquilibrium.speed=0.01`.
    ///
    /// `path` is where overrides reach the stage.
    pub fn words(&self, path: &str) -> String {
        match &self.decision.turn {
            Turn::Param { name, value } => format!("--set '{path}.{name}={value}'"),
            Turn::Also => format!("--also {}", self.stage),
        }
    }
}

/// All decisions of a run of the pipeline. Nothing is run.
///
/// What `until` cuts off is the user's own decision, and none of these. A stage whose rules panic
/// has none.
///
/// Errors: `until` or one of `also` names no stage of the pipeline.
pub fn decisions(pipeline: &Pipeline, options: &RunOptions) -> Result<Vec<StageDecision>, RunError> {
    let plan = plan(pipeline, options)?;
    let sizes = foresee(pipeline, &|_, _| None);
    let runs: Vec<bool> = plan.iter().map(Option::is_none).collect();
    let mut all = Vec::new();
    for (index, (node, skipped)) in pipeline.nodes.iter().zip(&plan).enumerate() {
        let of_stage = match skipped {
            Some(_) if options.until.is_some() => Vec::new(),
            Some(reason) => vec![unasked(reason)],
            None => told(pipeline, index, &runs, &sizes),
        };
        all.extend(of_stage.into_iter().map(|decision| StageDecision { stage: node.id.clone(), decision }));
    }
    Ok(all)
}

fn told(pipeline: &Pipeline, index: usize, runs: &[bool], sizes: &[Foreseen]) -> Vec<Decision> {
    let node = &pipeline.nodes[index];
    let cx = Context::new(&node.id, &pipeline.base, Cancel::new(), Arc::new(()));
    let known = Known { given: &sizes[index].given, nodes: &pipeline.nodes, index, runs, cx: &cx };
    catch_unwind(AssertUnwindSafe(|| node.stage.decisions(&known))).unwrap_or_default()
}
