//! The runs of an ablation.

use super::outline;
use super::record::{Ablation, Change, Row, SCHEME, Verdict};
use crate::errors::compare;
use crate::ladder::error;
use crate::measure::{Bench, Missed, Ran};
use crate::record::{Machine, today};
use crate::slot::{Source, path_of};
use crate::store::{digest, garment_digest};
use std::time::Duration;
use toile_core::decide::{Decided, Turn, decisions};
use toile_core::pipeline::{Override, Pipeline};
use toile_core::{RunOptions, StageError};

/// What is asked.
#[derive(Clone)]
pub struct Options {
    /// Rounds.
    pub repeats: usize,
    /// Longest run with a decision turned round.
    pub limit: Option<Duration>,
    /// How runs are made.
    pub bench: Bench,
}

/// How far an ablation is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// Runs that are done.
    pub done: usize,
    /// Runs in all.
    pub all: usize,
    /// The run that begins, in words.
    pub what: String,
}

impl Step {
    fn before(&self, what: &str) -> Step {
        Step { what: what.to_owned(), ..self.clone() }
    }
}

impl std::fmt::Display for Step {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "run {} of {}: {}", self.done + 1, self.all, self.what)
    }
}

/// A decision with the pipeline that it is turned round in, and what came of it so far.
struct Turned {
    row: Row,
    pipeline: Pipeline,
    also: Vec<String>,
}

/// Runs the pipeline as decided and with each decision turned round.
///
/// Errors: no decision there is to turn round; the pipeline fails as it is; an override that does not load; stopped by the
/// user.
pub fn ablate(
    source: &Source<'_>,
    pipeline: &Pipeline,
    options: &Options,
    tell: &mut dyn FnMut(Step),
) -> Result<Ablation, StageError> {
    let run = RunOptions { until: options.bench.until.clone(), ..RunOptions::default() };
    let decided = decisions(pipeline, &run).map_err(|e| e.error)?;
    if decided.is_empty() {
        return Err(StageError::invalid("nothing is left out or simplified in this pipeline")
            .hint("`toile explain` shows the decisions of a pipeline"));
    }
    let mut turned =
        decided.into_iter().map(|d| turned(source, pipeline, d)).collect::<Result<Vec<_>, StageError>>()?;
    let mut cpu_s = Vec::new();
    let mut step = Step { done: 0, all: options.repeats * (1 + turned.len()), what: String::new() };
    for _ in 0..options.repeats {
        tell(step.before("as decided"));
        let own = options.bench.run(pipeline, None, None).map_err(error)?;
        cpu_s.push(own.cpu_s);
        step.done += 1;
        for t in &mut turned {
            // What failed once is not run again, and counts as done.
            if t.row.failed.is_none() {
                tell(step.before(&t.row.turned));
                one_turn(t, &own, options)?;
            }
            step.done += 1;
        }
    }
    Ok(Ablation {
        scheme: SCHEME,
        toile: env!("CARGO_PKG_VERSION").to_owned(),
        pipeline: pipeline.name.clone(),
        file: pipeline.file.clone(),
        base: digest(pipeline, &[]),
        date: today(),
        machine: Machine::here(),
        until: options.bench.until.clone(),
        cpu_s,
        rows: turned.into_iter().map(judged).collect(),
    })
}

/// The pipeline with a decision turned round.
fn turned(source: &Source<'_>, pipeline: &Pipeline, decided: Decided) -> Result<Turned, StageError> {
    let path = path_to(source, pipeline, &decided.stage);
    let (more, also) = match &decided.decision.turn {
        Turn::Param { name, value } => {
            (vec![Override { path: format!("{path}.{name}"), value: value.clone() }], Vec::new())
        }
        Turn::Also => (Vec::new(), vec![decided.stage.clone()]),
    };
    let row = Row {
        turned: decided.words(&path),
        decided,
        cpu_s: Vec::new(),
        saved_s: Vec::new(),
        change: None,
        failed: None,
        verdict: Verdict::Needed,
    };
    let pipeline = source.load(&more).map_err(|faults| StageError::internal(faults.to_string()))?;
    Ok(Turned { row, pipeline, also })
}

/// Where overrides reach a stage.
pub(crate) fn path_to(source: &Source<'_>, pipeline: &Pipeline, stage: &str) -> String {
    let node = pipeline.nodes.iter().find(|n| n.id == stage);
    node.map_or_else(|| format!("stages.{stage}"), |n| path_of(source, pipeline, n))
}

/// One run with a decision turned round, beside the run of the same round as decided.
fn one_turn(t: &mut Turned, own: &Ran, options: &Options) -> Result<(), StageError> {
    match options.bench.run_also(&t.pipeline, &t.also, options.limit) {
        Ok(ran) => {
            t.row.cpu_s.push(ran.cpu_s);
            t.row.saved_s.push(ran.cpu_s - own.cpu_s);
            let change = changed(own, &ran)?;
            t.row.change.get_or_insert(change);
        }
        Err(Missed::Cancelled) => return Err(error(Missed::Cancelled)),
        Err(Missed::Failed(e)) => t.row.failed = Some(e.message),
        Err(Missed::OverLimit(seconds)) => t.row.failed = Some(format!("stopped after {seconds:.0} s")),
    }
    Ok(())
}

fn changed(own: &Ran, turned: &Ran) -> Result<Change, StageError> {
    let errors = compare(turned, own)?;
    let crossings = |ran: &Ran| ran.figures.as_ref().and_then(|f| f.garment.self_crossings);
    Ok(Change {
        same_bits: garment_digest(&own.garment) == garment_digest(&turned.garment),
        distance_mm: errors.distance_mm,
        outline_mm: outline::distance(&own.garment, &turned.garment).into(),
        texture_levels: errors.texture_levels,
        crossings: [crossings(own), crossings(turned)],
    })
}

fn judged(t: Turned) -> Row {
    let change = t.row.change.filter(|_| t.row.failed.is_none());
    let verdict = Verdict::of(change.as_ref(), t.row.decided.decision.tolerance, &t.row.saved_s);
    Row { change, verdict, ..t.row }
}
