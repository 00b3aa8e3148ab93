//! What a run would find in the cache and what it would run, and why, without running anything.

use super::known::{CacheSearch, held};
use super::steps::{PipelineRun, RanStage, StageOutcome};
use super::value::{ArtifactSlot, HeldValue, gather};
use super::{RunError, RunOptions, plan};
use crate::cache::{Cache, CacheAnswer, Cause, LastMade, Miss};
use crate::load::Pipeline;
use std::sync::Arc;
use toile_core::RunLog;
use toile_core::artifact::ArtifactType;
use toile_core::{Cancel, Contract, Listener, Node, Remarks};

/// What would become of one stage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outlook {
    /// The stage's id.
    pub stage: String,
    /// Why no requested result needs it, if so.
    pub skipped: Option<String>,
    /// Every run of it: the entry (empty where it is not mapped) and, where it would run again,
    /// why. Causes end with the inputs that are as before.
    pub entries: Vec<(String, Option<Vec<Cause>>)>,
}

impl Outlook {
    /// True where some of it would run.
    pub fn runs(&self) -> bool {
        self.entries.iter().any(|(_, causes)| causes.is_some())
    }
}

/// Says of every stage what a run with this cache would do.
///
/// Errors: `until` names no stage; sets whose names differ.
pub fn forecast(
    pipeline: &Pipeline,
    options: &RunOptions,
    cache: &Arc<Cache>,
) -> Result<Vec<Outlook>, RunError> {
    let (cancel, listener): (Cancel, Arc<dyn Listener>) = (Cancel::new(), Arc::new(()));
    let plan = plan(pipeline, options)?;
    let mut run = PipelineRun {
        pipeline,
        cache: Some(cache),
        cancel: &cancel,
        listener,
        reads: None,
        meter: None,
        expect: None,
        watch: None,
        steps: Vec::new(),
        undone: Default::default(),
        so_far: None,
    };
    let mut outlooks = Vec::new();
    for (node, skipped) in pipeline.nodes.iter().zip(plan) {
        let mut outlook = Outlook { stage: node.id.clone(), skipped, entries: Vec::new() };
        let step = match &outlook.skipped {
            Some(reason) => StageOutcome::Skipped(reason.clone()),
            None => {
                let (entries, outputs) = look(&run, node, cache)?;
                outlook.entries = entries;
                let (figures, remarks) = (Vec::new(), Remarks::default());
                StageOutcome::Ran(RanStage {
                    outputs,
                    wall_s: 0.0,
                    cached: true,
                    figures,
                    remarks,
                    cost: None,
                })
            }
        };
        run.steps.push(step);
        outlooks.push(outlook);
    }
    Ok(outlooks)
}

type Entries = Vec<(String, Option<Vec<Cause>>)>;

fn look(run: &PipelineRun<'_>, node: &Node, cache: &Cache) -> Result<(Entries, Vec<HeldValue>), RunError> {
    let index = run.steps.len();
    let searches = run.search(index).map_err(|(entry, error)| RunError {
        stage: node.id.clone(),
        entry,
        span: node.span.clone(),
        error,
    })?;
    if searches.is_empty() {
        // Which entries there are is not known before the stages ahead have run for the first time.
        let unknown = node.card.outputs.iter().map(|_| HeldValue::Unknown).collect();
        return Ok((vec![(String::new(), Some(vec![Cause::NeverRun]))], unknown));
    }
    let (mut entries, mut outputs) = (Vec::new(), Vec::new());
    for search in searches {
        let last = cache.last(run.pipeline, &node.id, &search.entry);
        let (causes, made) = match &search.found {
            CacheAnswer::Hit(manifest) => (None, held(node, None, Some(manifest))),
            CacheAnswer::Miss(miss) => {
                (Some(causes(run, node, &search, miss, last.as_ref())), unmade(node, last.as_ref()))
            }
        };
        outputs.push((search.entry.clone(), made));
        entries.push((search.entry, causes));
    }
    let outputs = match node.card.is_mapped() {
        true => gather(&node.card, &outputs),
        false => outputs.pop().map(|(_, made)| made).unwrap_or_default(),
    };
    Ok((entries, outputs))
}

fn causes(
    run: &PipelineRun<'_>,
    node: &Node,
    search: &CacheSearch,
    miss: &Miss,
    last: Option<&LastMade>,
) -> Vec<Cause> {
    if !node.card.contracts.contains(&Contract::Deterministic) {
        return vec![Cause::NotDeterministic];
    }
    let mut causes = match miss {
        Miss::Unknown => Vec::new(),
        Miss::Files(paths) => paths.iter().cloned().map(Cause::File).collect(),
        Miss::Pruned => vec![Cause::Pruned],
        Miss::Damaged(why) => vec![Cause::Damaged(why.clone())],
    };
    let Some(last) = last else {
        return if causes.is_empty() { vec![Cause::NeverRun] } else { causes };
    };
    let differs = last.compare(&search.ingredients, &run.pipeline.base);
    let unlike = |c: &Cause| !causes.contains(c);
    let differs: Vec<Cause> = differs.into_iter().filter(unlike).collect();
    causes.extend(differs);
    let same = |c: &Cause| matches!(c, Cause::Input { same: true, .. });
    if causes.iter().all(same) {
        // All is as in the last run, of which nothing is left.
        causes.insert(0, Cause::Pruned);
    }
    causes
}

/// Outputs that have yet to be made; sets have the names that they had last.
fn unmade(node: &Node, last: Option<&LastMade>) -> Vec<HeldValue> {
    let port = |(i, out): (usize, &toile_core::OutPort)| {
        let names = last.and_then(|l| l.sets.get(i)?.as_ref());
        match (out.kind == RunLog::KIND, names) {
            (false, Some(names)) => HeldValue::Set(
                out.kind,
                names.iter().map(|n| (n.clone(), ArtifactSlot::unknown(out.kind))).collect(),
            ),
            _ if node.card.is_mapped() => HeldValue::One(ArtifactSlot::unknown(out.kind)),
            _ => HeldValue::Unknown,
        }
    };
    node.card.outputs.iter().enumerate().map(port).collect()
}
