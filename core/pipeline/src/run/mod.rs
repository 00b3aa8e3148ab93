//! Runs a pipeline: only what the requested outputs need, in file order, sets in parallel.

mod exports;
mod forecast;
mod implicit;
mod improve;
#[cfg(test)]
mod improve_tests;
mod known;
mod node;
mod pixels;
mod recall;
mod record;
mod so_far;
mod steps;
mod tell;
mod unused;
mod value;
mod watch;

pub use forecast::{Outlook, forecast};
pub use implicit::add_implicit;
pub use so_far::SoFar;
pub use watch::{RunWatch, WATCHED, WatchedStage};

use crate::cache::Cache;
use crate::cost::{Expect, Meter, StageCost};
use crate::load::{Pipeline, Reads};
use crate::{Metrics, StageMetrics};
use std::any::Any;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;
use steps::{PipelineRun, StageOutcome};
use toile_core::RunLog;
use toile_core::artifact::{Artifact, Digest, Figures, Kind, OutputFile, OutputFiles};
use toile_core::{ArtifactType, Cancel, Feed, Listener, Node, Remarks, StageError, panics};

/// Options of a run.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Stop after this stage (its id): only it and what it needs are run.
    pub until: Option<String>,
    /// Ids of stages that are run although no requested result depends on them.
    pub also: Vec<String>,
    /// Give every stage's artifacts as files as well.
    pub keep: bool,
    /// Kinds of which the last that the run made is in the record, though nothing else had to read
    /// it from the cache.
    pub load: Vec<Kind>,
    /// Where results of stages are kept and found; none runs everything.
    pub cache: Option<Arc<Cache>>,
    /// Takes all files that stages read, or tried to, whether the run comes to its end or not.
    pub reads: Option<Reads>,
    /// Receives what a failed run had made until then, for inspection.
    pub so_far: Option<SoFar>,
    /// Whether it receives that of a run that was stopped, too.
    pub so_far_of_stopped: bool,
    /// Measures what stages take; none measures nothing but wall time.
    pub meter: Option<Arc<dyn Meter>>,
    /// Predicts what stages take, for the record and the report; without it they hold no
    /// prediction.
    pub expect: Option<Arc<dyn Expect>>,
    /// Is told of every stage as soon as it is done.
    pub watch: Option<Arc<dyn RunWatch>>,
}

/// What a run gives. Nothing is written yet.
#[derive(Debug)]
pub struct RunResult {
    /// Files of the writers, and of `keep`, ready for [`crate::write_files`].
    pub files: Vec<OutputFile>,
    /// The record of every stage with its artifacts; of a run with a cache, only with those that
    /// the run itself had to read.
    pub log: RunLog,
    /// The content of `metrics.json`.
    pub metrics: Metrics,
    /// The digest of what every stage made, by id; none without a cache, and for what has no
    /// digest.
    pub results: Vec<(String, Option<Digest>)>,
    /// What every stage took that ran whole under a meter.
    pub costs: Vec<StageCost>,
}

/// A stage's failure with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunError {
    /// The stage's id; empty where the error is not a stage's.
    pub stage: String,
    /// The panel at work, empty for a stage that is not mapped.
    pub entry: String,
    /// Place in the pipeline file: the parameter at fault, or the stage.
    pub span: Range<usize>,
    /// What went wrong.
    pub error: StageError,
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.stage.as_str(), self.entry.as_str()) {
            ("", _) => write!(f, "{}", self.error),
            (stage, "") => write!(f, "{stage}: {}", self.error),
            (stage, entry) => write!(f, "{stage} ({entry}): {}", self.error),
        }
    }
}

impl std::error::Error for RunError {}

/// Runs `pipeline` in the current rayon pool.
///
/// With a cache, a stage whose result is known is not run, and its result is only read where
/// something needs it. What goes wrong with the cache is a warning of [`Cache::take_warnings`],
/// never an error.
///
/// Errors: the first stage's error in file order; nothing has been written then.
pub fn run(
    pipeline: &Pipeline,
    options: &RunOptions,
    cancel: &Cancel,
    listener: &Arc<dyn Listener>,
) -> Result<RunResult, RunError> {
    let plan = plan(pipeline, options)?;
    let started = Instant::now();
    let cache = options.cache.as_ref();
    let reads = options.reads.as_ref();
    let mut run = PipelineRun {
        pipeline,
        cache,
        cancel,
        listener: listener.clone(),
        reads,
        meter: options.meter.as_deref(),
        expect: options.expect.as_deref(),
        watch: options.watch.clone(),
        steps: Vec::new(),
        undone: BTreeMap::new(),
        so_far: None,
    };
    let judged = unharmed(&mut run, &plan).inspect_err(|error| so_far::leave(&mut run, options, error))?;
    let files = files(&mut run, options)?;
    load(&mut run, &options.load)?;
    if let Some(cache) = cache {
        cache.tidy();
    }
    let metrics = metrics(&run, &judged, started.elapsed().as_secs_f64());
    let results = run.results();
    let costs = run.costs();
    Ok(RunResult { files, log: run.log(run.steps.len()), metrics, results, costs })
}

/// Runs all stages of the plan; a garment that misses limits with the stages that only improve on
/// it, and misses none without them, is given without them. Gives the judgement.
fn unharmed(run: &mut PipelineRun<'_>, plan: &[Option<String>]) -> Result<Vec<Figures>, RunError> {
    stages(run, plan)?;
    let judged = judged(run)?;
    let Some(missed) = judged.iter().find_map(|f| f.shortfalls.first()) else { return Ok(judged) };
    let Some((base, last)) = run.improvements()? else { return Ok(judged) };
    let why = format!(
        "{}; without this the garment keeps all limits, and is shown as `{}` left it",
        missed.message, run.pipeline.nodes[base].id
    );
    let (steps, undone) = (run.steps.clone(), run.undone.clone());
    let listener = std::mem::replace(&mut run.listener, Arc::new(()));
    let watch = run.watch.take();
    run.turn_back(base, last, why);
    let first = run.steps.len();
    let without = stages(run, plan).and_then(|()| self::judged(run));
    (run.listener, run.watch) = (listener, watch);
    match without {
        Ok(without) if without.iter().all(|f| f.shortfalls.is_empty()) => {
            run.tell_again(first);
            run.tell_watch(first)?;
            Ok(without)
        }
        _ => {
            (run.steps, run.undone) = (steps, undone);
            Ok(judged)
        }
    }
}

/// The judgements of the garment.
fn judged(run: &mut PipelineRun<'_>) -> Result<Vec<Figures>, RunError> {
    Ok(run.all()?.into_iter().map(|(_, f)| f).collect())
}

/// Runs all stages of the plan that have not run yet.
fn stages(run: &mut PipelineRun<'_>, plan: &[Option<String>]) -> Result<(), RunError> {
    while let Some(skipped) = plan.get(run.steps.len()) {
        let index = run.steps.len();
        let node = &run.pipeline.nodes[index];
        match skipped {
            None => match unbroken(node, || run.step()) {
                Ok(()) => run.undo_unrest(index)?,
                Err(failure) => run.undo(index, failure)?,
            },
            Some(reason) => run.steps.push(StageOutcome::Skipped(reason.clone())),
        }
        run.tell_watch(index)?;
    }
    Ok(())
}

/// Does a part of a run for a stage; a panic in it is an error that names the stage.
fn unbroken<T>(node: &Node, work: impl FnOnce() -> Result<T, RunError>) -> Result<T, RunError> {
    panics::caught(work).unwrap_or_else(|words| {
        let error = StageError::internal(format!("the runner panicked: {words}")).hint(panics::REPORT);
        Err(RunError { stage: node.id.clone(), entry: String::new(), span: node.span.clone(), error })
    })
}

/// Brings the last artifact of each of these kinds into memory.
fn load(run: &mut PipelineRun<'_>, kinds: &[Kind]) -> Result<(), RunError> {
    for kind in kinds {
        let nodes = run.pipeline.nodes.iter().zip(&run.steps).enumerate().rev();
        let mut ran = nodes.filter(|(_, (_, step))| step.ran().is_some());
        let last = ran.find(|(_, (node, _))| node.card.outputs.iter().any(|o| o.kind == *kind));
        if let Some(index) = last.map(|(index, _)| index) {
            run.ensure_all(index)?;
        }
    }
    Ok(())
}

/// The writers' files and those of stages whose artifacts were requested.
fn files(run: &mut PipelineRun<'_>, options: &RunOptions) -> Result<Vec<OutputFile>, RunError> {
    let mut files: Vec<OutputFile> = written(run)?.into_iter().flat_map(|(_, f)| f.0).collect();
    let nodes = run.pipeline.nodes.iter().enumerate();
    let kept = |id: &str| options.keep || options.until.as_deref() == Some(id);
    let kept: Vec<usize> = nodes.filter(|(_, n)| kept(&n.id)).map(|(i, _)| i).collect();
    for &index in &kept {
        run.ensure_all(index)?;
    }
    let log = run.log(run.steps.len());
    for node in kept.iter().map(|i| &run.pipeline.nodes[*i]) {
        let record = log.stages.iter().filter(|r| r.id == node.id);
        files.extend(unbroken(node, || Ok(record.flat_map(exports::exports).collect::<Vec<_>>()))?);
    }
    Ok(files)
}

/// The writers' files, each with the index of its writer.
///
/// Errors: two stages write a file of the same name; the second is named.
fn written(run: &mut PipelineRun<'_>) -> Result<Vec<(usize, OutputFiles)>, RunError> {
    let all = run.all::<OutputFiles>()?;
    let mut first: BTreeMap<&str, usize> = BTreeMap::new();
    for (node, files) in &all {
        for file in &files.0 {
            if let Some(other) = first.insert(&file.path, *node) {
                return Err(twice(run.pipeline, &file.path, other, *node));
            }
        }
    }
    Ok(all)
}

fn twice(pipeline: &Pipeline, path: &str, first: usize, second: usize) -> RunError {
    let (a, b) = (&pipeline.nodes[first], &pipeline.nodes[second]);
    let error = StageError::invalid(format!("it writes \"{path}\", as `{}` does", a.id))
        .hint("give one of them another `name`, or leave one out");
    RunError { stage: b.id.clone(), entry: String::new(), span: b.span.clone(), error }
}

/// What a run would do: for every stage `None` where it runs, or the reason why it is left out.
///
/// Errors: `until` or one of `also` names no stage of the pipeline.
pub fn plan(pipeline: &Pipeline, options: &RunOptions) -> Result<Vec<Option<String>>, RunError> {
    sound(pipeline)?;
    let find = |name: &String| pipeline.find(name).ok_or_else(|| unknown_stage(pipeline, name));
    let mut asked = sinks(pipeline, options)?;
    asked.extend(options.also.iter().map(find).collect::<Result<Vec<_>, _>>()?);
    let needed = pipeline.needed_for(&asked);
    let reason = || match &options.until {
        Some(until) => format!("not needed until {until}"),
        None => "no requested result depends on it".to_owned(),
    };
    Ok(needed.into_iter().map(|needed| (!needed).then(reason)).collect())
}

/// Refuses a pipeline in which a stage reads from one that stands after it, which no file can say
/// and a program's own changes might.
fn sound(pipeline: &Pipeline) -> Result<(), RunError> {
    for (index, node) in pipeline.nodes.iter().enumerate() {
        for feed in &node.inputs {
            let Feed::Node { node: maker, port } = feed else { continue };
            let is_made = |n: &Node| *maker < index && *port < n.card.outputs.len();
            if !pipeline.nodes.get(*maker).is_some_and(is_made) {
                let error =
                    StageError::internal("it reads what no stage before it makes").hint(panics::REPORT);
                let (stage, span) = (node.id.clone(), node.span.clone());
                return Err(RunError { stage, entry: String::new(), span, error });
            }
        }
    }
    Ok(())
}

/// The stages whose results are requested: `until`, or all that give files (with the judgement),
/// or, in a pipeline without writers, all whose results no stage takes.
fn sinks(pipeline: &Pipeline, options: &RunOptions) -> Result<Vec<usize>, RunError> {
    if let Some(until) = &options.until {
        return match pipeline.nodes.iter().position(|n| n.id == *until) {
            Some(index) => Ok(vec![index]),
            None => Err(unknown_stage(pipeline, until)),
        };
    }
    let gives = |kind| {
        let nodes = pipeline.nodes.iter().enumerate();
        nodes.filter(move |(_, n)| n.card.outputs.iter().any(|o| o.kind == kind)).map(|(i, _)| i)
    };
    let files: Vec<usize> = gives(OutputFiles::KIND).chain(gives(Figures::KIND)).collect();
    match files.is_empty() {
        false => Ok(files),
        true => Ok((0..pipeline.nodes.len()).filter(|&i| pipeline.consumers(i).is_empty()).collect()),
    }
}

fn unknown_stage(pipeline: &Pipeline, name: &str) -> RunError {
    let ids: Vec<&str> = pipeline.nodes.iter().map(|n| n.id.as_str()).collect();
    let near = toile_core::nearest(name, ids.iter().copied())
        .map_or_else(String::new, |n| format!("did you mean `{n}`? "));
    let error = StageError::invalid(format!("there is no stage `{name}` in this pipeline"))
        .hint(format!("{near}its stages are {}", ids.join(", ")));
    RunError { stage: String::new(), entry: String::new(), span: 0..0, error }
}

/// An artifact as its own type.
pub(crate) fn typed<T: ArtifactType>(artifact: &Arc<dyn Artifact>) -> Option<&T> {
    let any: &dyn Any = artifact.as_ref();
    any.downcast_ref()
}

fn metrics(run: &PipelineRun<'_>, judged: &[Figures], wall_s: f64) -> Metrics {
    let steps = || run.pipeline.nodes.iter().zip(&run.steps);
    let ran = steps().enumerate().filter_map(|(i, (node, step))| match step {
        StageOutcome::Skipped(_) => None,
        StageOutcome::Ran(ran) => Some(StageMetrics {
            id: node.id.clone(),
            name: node.card.name.to_owned(),
            wall_s: ran.wall_s,
            cached: ran.cached,
            skipped: None,
            figures: StageMetrics::figure_map(&ran.figures),
            remarks: ran.remarks.clone(),
            used: ran.cost.as_ref().map(|c| c.0),
            predicted: run.expected(i),
        }),
    });
    let skipped = steps().filter_map(|(node, step)| match step {
        StageOutcome::Ran(_) => None,
        StageOutcome::Skipped(reason) => Some(StageMetrics {
            id: node.id.clone(),
            name: node.id.clone(),
            wall_s: 0.0,
            cached: false,
            skipped: Some(reason.clone()),
            figures: Default::default(),
            remarks: Remarks::default(),
            used: None,
            predicted: None,
        }),
    });
    let mut metrics = Metrics {
        pipeline: run.pipeline.name.clone(),
        quality: run.pipeline.quality.clone(),
        wall_s,
        stages: ran.chain(skipped).collect(),
        panels: Default::default(),
        flat: Default::default(),
        garment: None,
        shortfalls: Vec::new(),
    };
    judged.iter().for_each(|figures| metrics.judge(figures));
    metrics
}
