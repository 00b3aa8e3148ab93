//! A run under way: stage by stage, each from the cache where its result is known (`known`), and
//! what lies in the cache only brought into memory once something needs it (`recall`).

use super::node::{EntryFailure, run_entries};
use super::value::HeldValue;
use super::watch::RunWatch;
use super::{RunError, typed};
use crate::cache::{Cache, CacheAnswer, Fed, Ingredients, Parts, RUN_SO_FAR};
use crate::cost::{Expect, Meter, Predicted, Size, StageCost, Used};
use crate::load::{Pipeline, Reads};
use crate::made::EntryResult;
use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError};
use std::time::Instant;
use toile_core::artifact::{Digest, Measure};
use toile_core::{
    Arity, ArtifactType, Cancel, Context, Contract, Feed, Inputs, Listener, Node, PortValue, Remarks,
    StageError,
};

/// What became of a stage.
#[derive(Clone)]
pub(super) enum StageOutcome {
    /// Left out, with the reason.
    Skipped(String),
    /// Run, or found in the cache.
    Ran(RanStage),
}

impl StageOutcome {
    /// The result of a stage that was not left out.
    pub(super) fn ran(&self) -> Option<&RanStage> {
        match self {
            StageOutcome::Ran(ran) => Some(ran),
            StageOutcome::Skipped(_) => None,
        }
    }
}

/// A stage that gave its result.
#[derive(Clone)]
pub(super) struct RanStage {
    pub(super) outputs: Vec<HeldValue>,
    pub(super) wall_s: f64,
    /// True while nothing of it had to be run.
    pub(super) cached: bool,
    pub(super) figures: Vec<Measure>,
    pub(super) remarks: Remarks,
    /// What it took and how much it made, where it ran whole under a meter.
    pub(super) cost: Option<(Used, Size)>,
}

/// A run up to some stage.
pub(super) struct PipelineRun<'a> {
    pub(super) pipeline: &'a Pipeline,
    pub(super) cache: Option<&'a Arc<Cache>>,
    pub(super) cancel: &'a Cancel,
    pub(super) listener: Arc<dyn Listener>,
    pub(super) reads: Option<&'a Reads>,
    pub(super) meter: Option<&'a dyn Meter>,
    pub(super) expect: Option<&'a dyn Expect>,
    pub(super) watch: Option<Arc<dyn RunWatch>>,
    pub(super) steps: Vec<StageOutcome>,
    /// Improving stages that pass on what they are given; the one that failed with what to report
    /// to the user.
    pub(super) undone: BTreeMap<usize, Option<String>>,
    /// What the stage that failed had come to.
    pub(super) so_far: Option<PortValue>,
}

impl PipelineRun<'_> {
    /// Gives the next stage its result.
    pub(super) fn step(&mut self) -> Result<(), RunError> {
        let index = self.steps.len();
        let node = &self.pipeline.nodes[index];
        let cx = self.context(node, self.listener.clone());
        cx.progress(0.0, "");
        let started = Instant::now();
        cx.check().map_err(|e| located(self.pipeline, node, (String::new(), e)))?;
        if self.undone.contains_key(&index) {
            let ran = self.passed_on(index)?;
            self.steps.push(StageOutcome::Ran(ran));
            return Ok(());
        }
        let searches = self.search(index).map_err(|e| located(self.pipeline, node, e))?;
        self.tell(node, &searches);
        let missing = searches.iter().filter(|s| matches!(s.found, CacheAnswer::Miss(_)));
        let missing: Vec<String> = missing.map(|s| s.entry.clone()).collect();
        let whole = missing.len() == searches.len() && !missing.is_empty();
        let (made, used) = self.make(index, &missing, &cx)?;
        let cost = used.filter(|_| whole).map(|used| (used, sizes(&made)));
        let mut ran = self.ran(node, searches, made, &cx);
        ran.cost = cost;
        cx.progress(1.0, "");
        ran.wall_s = started.elapsed().as_secs_f64();
        self.steps.push(StageOutcome::Ran(ran));
        Ok(())
    }

    pub(super) fn context(&self, node: &Node, listener: Arc<dyn Listener>) -> Context {
        self.context_under(self.cancel.clone(), node, listener)
    }

    /// A context that another flag stops than that of the run.
    pub(super) fn context_under(&self, cancel: Cancel, node: &Node, listener: Arc<dyn Listener>) -> Context {
        let cx = Context::new(&node.id, &self.pipeline.base, cancel, listener);
        let index = self.pipeline.find(&node.id).unwrap_or_default();
        cx.with_memo(self.cache.map(|cache| Parts::of(cache, &node.card)))
            .with_allowance(self.allowance(index))
    }

    /// What every stage took.
    pub(super) fn costs(&self) -> Vec<StageCost> {
        let cost = |(node, step): (&Node, &StageOutcome)| match step {
            StageOutcome::Ran(RanStage { cost: Some((used, made)), .. }) => {
                Some(StageCost { stage: node.id.clone(), used: *used, made: made.clone() })
            }
            _ => None,
        };
        self.pipeline.nodes.iter().zip(&self.steps).filter_map(cost).collect()
    }

    /// What a stage was expected to take, if it ran whole. Nothing is predicted for a run that
    /// found in the cache all that a cache can hold, because it measures nothing new.
    pub(super) fn expected(&self, index: usize) -> Option<Predicted> {
        let ran_whole =
            |step: &StageOutcome| matches!(step, StageOutcome::Ran(RanStage { cost: Some(_), .. }));
        let kept =
            |node: &Node| self.cache.is_none() || node.card.contracts.contains(&Contract::Deterministic);
        let mut steps = self.pipeline.nodes.iter().zip(&self.steps);
        let is_news = steps.any(|(node, step)| ran_whole(step) && kept(node));
        let expect = self.expect.filter(|_| is_news && self.steps.get(index).is_some_and(ran_whole))?;
        expect.expected(self.pipeline, index)
    }

    /// Runs a stage for some of its entries, and says what that took.
    pub(super) fn make(
        &mut self,
        index: usize,
        entries: &[String],
        cx: &Context,
    ) -> Result<(Vec<EntryResult>, Option<Used>), RunError> {
        let node = &self.pipeline.nodes[index];
        if entries.is_empty() {
            return Ok((Vec::new(), None));
        }
        for (port, feed) in node.card.inputs.iter().zip(&node.inputs) {
            match feed {
                Feed::Nothing => {}
                Feed::RunLog => self.ensure_before(index)?,
                Feed::Node { node: maker, port: output } => {
                    let some = (port.arity == Arity::Each).then_some(entries);
                    self.ensure(*maker, *output, some)?;
                }
            }
        }
        let jobs = entries.iter().map(|e| (e.clone(), self.inputs(index, e))).collect();
        self.meter.iter().for_each(|m| m.start());
        let made = run_entries(node, jobs, cx);
        let used = self.meter.map(Meter::stop);
        self.note_reads(cx.take_reads());
        self.so_far = cx.take_so_far().filter(|_| made.is_err());
        made.map(|made| (made, used)).map_err(|e| located(self.pipeline, node, e))
    }

    /// Reports which files were read, where that is requested.
    pub(super) fn note_reads(&self, files: impl IntoIterator<Item = (String, Option<Digest>)>) {
        if let Some(reads) = self.reads {
            let full = files.into_iter().map(|(path, hash)| (self.pipeline.base.join(path), hash));
            reads.lock().unwrap_or_else(PoisonError::into_inner).extend(full);
        }
    }

    /// The inputs of one run, all of which are in memory.
    fn inputs(&self, index: usize, entry: &str) -> Inputs {
        let node = &self.pipeline.nodes[index];
        let value = |(port, feed): (&toile_core::InPort, &Feed)| match feed {
            Feed::Nothing => None,
            Feed::RunLog => Some(PortValue::One(Arc::new(self.report(index)))),
            Feed::Node { node, port: output } => {
                let one = (port.arity == Arity::Each).then_some(entry);
                self.held(*node, *output)?.value(one)
            }
        };
        Inputs(node.card.inputs.iter().zip(&node.inputs).map(value).collect())
    }

    pub(super) fn held(&self, node: usize, port: usize) -> Option<&HeldValue> {
        match self.steps.get(node)? {
            StageOutcome::Ran(ran) => ran.outputs.get(port),
            StageOutcome::Skipped(_) => None,
        }
    }

    pub(super) fn ingredients(&self, index: usize, entry: &str) -> Ingredients {
        let node = &self.pipeline.nodes[index];
        let fed = |(port, feed): (&toile_core::InPort, &Feed)| match feed {
            Feed::Nothing => (String::new(), Fed::Nothing),
            Feed::RunLog => (RUN_SO_FAR.to_owned(), self.log_hash(index).map_or(Fed::Unknown, Fed::One)),
            Feed::Node { node, port: output } => {
                let one = (port.arity == Arity::Each).then_some(entry);
                let value = match self.held(*node, *output) {
                    // What feeds an optional port may itself have been given nothing.
                    None => Fed::Nothing,
                    Some(held) => held.fed(one),
                };
                (self.pipeline.nodes[*node].id.clone(), value)
            }
        };
        let inputs = node.card.inputs.iter().zip(&node.inputs).map(fed).collect();
        Ingredients::of(node, entry, inputs)
    }

    /// The names of the sets on the mapped ports, which must all be the same; one empty name for a
    /// stage that is not mapped.
    pub(super) fn entries(&self, index: usize) -> Result<Vec<String>, EntryFailure> {
        let node = &self.pipeline.nodes[index];
        if !node.card.is_mapped() {
            return Ok(vec![String::new()]);
        }
        let ports = node.card.inputs.iter().zip(&node.inputs).filter(|(p, _)| p.arity == Arity::Each);
        let mut sets = ports.filter_map(|(port, feed)| match feed {
            Feed::Node { node, port: output } => Some((port.kind, self.held(*node, *output)?.names()?)),
            _ => None,
        });
        let Some((first_kind, names)) = sets.next() else { return Ok(Vec::new()) };
        for (kind, other) in sets {
            if other != names {
                let message = format!(
                    "the {first_kind}s are named {} but the {kind}s {}",
                    names.join(", "),
                    other.join(", ")
                );
                return Err((String::new(), StageError::invalid(message)));
            }
        }
        Ok(names)
    }

    /// All artifacts of a type with the index of their stage, which are brought into memory first.
    pub(super) fn all<T: ArtifactType + Clone>(&mut self) -> Result<Vec<(usize, T)>, RunError> {
        let mut all = Vec::new();
        for index in 0..self.steps.len() {
            let outputs = &self.pipeline.nodes[index].card.outputs;
            for port in (0..outputs.len()).filter(|p| outputs[*p].kind == T::KIND) {
                self.ensure(index, port, None)?;
                let value = self.held(index, port).and_then(|held| held.value(None));
                let made = value.iter().flat_map(PortValue::entries).filter_map(|(_, a)| typed::<T>(a));
                all.extend(made.map(|a| (index, a.clone())));
            }
        }
        Ok(all)
    }
}

/// How much was made, all entries and ports together.
fn sizes(made: &[EntryResult]) -> Size {
    let ports = |m: &EntryResult| m.outputs.iter().fold(Size::new(), |all, v| all.joined(&v.size()));
    made.iter().fold(Size::new(), |sum, m| sum.plus(&ports(m)))
}

/// A failure with its place in the pipeline file.
fn located(pipeline: &Pipeline, node: &Node, (entry, error): EntryFailure) -> RunError {
    let span = pipeline.given(node, &error).unwrap_or_else(|| node.span.clone());
    RunError { stage: node.id.clone(), entry, span, error }
}
