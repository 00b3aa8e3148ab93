//! Runs a pipeline: only what the asked outputs need, in file order, sets in parallel.

mod implicit;
mod node;

pub use implicit::add_implicit;

use crate::artifact::{Artifact, Figures, OutputFile, OutputFiles, RunLog, StageRecord};
use crate::pipeline::{Feed, Pipeline};
use crate::{ArtifactType, Cancel, Context, Inputs, Listener, Metrics, PortValue, StageError, StageMetrics};
use std::any::Any;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// What is asked of a run.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Stop after this stage (its id): only it and what it needs are run.
    pub until: Option<String>,
    /// Give every stage's artifacts as files as well.
    pub keep: bool,
}

/// What a run gives. Nothing is written yet.
#[derive(Debug)]
pub struct RunResult {
    /// Files of the writers, and of `keep`, ready for [`crate::write_files`].
    pub files: Vec<OutputFile>,
    /// The record of every stage with its artifacts.
    pub log: RunLog,
    /// The content of `metrics.json`.
    pub metrics: Metrics,
}

/// A stage's failure with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunError {
    /// The stage's id.
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
        match self.entry.as_str() {
            "" => write!(f, "{}: {}", self.stage, self.error),
            entry => write!(f, "{} ({entry}): {}", self.stage, self.error),
        }
    }
}

impl std::error::Error for RunError {}

/// Runs `pipeline` in the current rayon pool.
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
    let mut run = Run { pipeline, outputs: Vec::new(), log: RunLog::default(), files: Vec::new() };
    run.log.pipeline = pipeline.name.clone();
    for (index, skipped) in plan.into_iter().enumerate() {
        let made = match skipped {
            None => run.step(index, cancel, listener)?,
            Some(reason) => run.skip(index, reason),
        };
        run.outputs.push(made);
    }
    Ok(run.finish(started.elapsed().as_secs_f64(), options))
}

/// What a run would do: for every stage `None` where it runs, or the reason why it is left out.
///
/// Errors: `until` names no stage of the pipeline.
pub fn plan(pipeline: &Pipeline, options: &RunOptions) -> Result<Vec<Option<String>>, RunError> {
    let needed = pipeline.needed_for(&sinks(pipeline, options)?);
    let reason = || match &options.until {
        Some(until) => format!("not needed until {until}"),
        None => "nothing asked for depends on it".to_owned(),
    };
    Ok(needed.into_iter().map(|needed| (!needed).then(reason)).collect())
}

/// The stages that something asks for: `until`, or all that give files (with the judgement), or,
/// in a pipeline without writers, all that nobody consumes.
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
    let error = StageError::invalid(format!("there is no stage `{name}` in this pipeline"))
        .hint(format!("its stages are {}", ids.join(", ")));
    RunError { stage: name.to_owned(), entry: String::new(), span: 0..0, error }
}

/// A run under way.
struct Run<'a> {
    pipeline: &'a Pipeline,
    outputs: Vec<Vec<PortValue>>,
    log: RunLog,
    files: Vec<OutputFile>,
}

impl Run<'_> {
    fn step(
        &mut self,
        index: usize,
        cancel: &Cancel,
        listener: &Arc<dyn Listener>,
    ) -> Result<Vec<PortValue>, RunError> {
        let node = &self.pipeline.nodes[index];
        let cx = Context::new(&node.id, &self.pipeline.base, cancel.clone(), listener.clone());
        cx.progress(0.0, "");
        let started = Instant::now();
        let inputs = Inputs(node.inputs.iter().map(|feed| self.fed_by(feed)).collect());
        let outcome =
            cx.check().map_err(|e| (String::new(), e)).and_then(|()| node::run_node(node, &inputs, &cx));
        let made = outcome.map_err(|(entry, error)| {
            let span = error.param.and_then(|p| node.params.get(p)).unwrap_or(&node.span).clone();
            RunError { stage: node.id.clone(), entry, span, error }
        })?;
        cx.progress(1.0, "");
        let (figures, warnings) = cx.take_notes();
        self.collect_files(&made);
        self.log.stages.push(StageRecord {
            id: node.id.clone(),
            name: node.card.name.to_owned(),
            role: node.card.role,
            params: node.stage.params(),
            wall_s: started.elapsed().as_secs_f64(),
            outputs: made.clone(),
            figures,
            warnings,
        });
        Ok(made)
    }

    fn skip(&mut self, index: usize, reason: String) -> Vec<PortValue> {
        self.log.skipped.push((self.pipeline.nodes[index].id.clone(), reason));
        Vec::new()
    }

    fn fed_by(&self, feed: &Feed) -> Option<PortValue> {
        match feed {
            Feed::Nothing => None,
            Feed::RunLog => Some(PortValue::One(Arc::new(self.log.clone()))),
            Feed::Node { node, port } => self.outputs.get(*node)?.get(*port).cloned(),
        }
    }

    fn collect_files(&mut self, made: &[PortValue]) {
        for artifact in made.iter().flat_map(PortValue::entries).map(|(_, a)| a) {
            if let Some(files) = typed::<OutputFiles>(artifact) {
                self.files.extend(files.0.iter().cloned());
            }
        }
    }

    fn finish(mut self, wall_s: f64, options: &RunOptions) -> RunResult {
        let metrics = metrics(&self.log, wall_s);
        let kept = |r: &&StageRecord| options.keep || options.until.as_deref() == Some(r.id.as_str());
        let exports: Vec<OutputFile> = self.log.stages.iter().filter(kept).flat_map(exports).collect();
        self.files.extend(exports);
        RunResult { files: self.files, log: self.log, metrics }
    }
}

/// An artifact as its own type.
pub(crate) fn typed<T: ArtifactType>(artifact: &Arc<dyn Artifact>) -> Option<&T> {
    let any: &dyn Any = artifact.as_ref();
    any.downcast_ref()
}

fn metrics(log: &RunLog, wall_s: f64) -> Metrics {
    let ran = log.stages.iter().map(|r| StageMetrics {
        id: r.id.clone(),
        name: r.name.clone(),
        wall_s: r.wall_s,
        cached: false,
        skipped: None,
        figures: StageMetrics::figure_map(&r.figures),
        warnings: r.warnings.clone(),
    });
    let skipped = log.skipped.iter().map(|(id, reason)| StageMetrics {
        id: id.clone(),
        name: id.clone(),
        wall_s: 0.0,
        cached: false,
        skipped: Some(reason.clone()),
        figures: Default::default(),
        warnings: Vec::new(),
    });
    let mut metrics = Metrics {
        pipeline: log.pipeline.clone(),
        wall_s,
        stages: ran.chain(skipped).collect(),
        panels: Default::default(),
        garment: None,
        shortfalls: Vec::new(),
    };
    let made = log.stages.iter().flat_map(|r| &r.outputs).flat_map(PortValue::entries);
    for (_, artifact) in made {
        if let Some(figures) = typed::<Figures>(artifact) {
            metrics.judge(figures);
        }
    }
    metrics
}

/// A stage's artifacts as ordinary files: `stages/STAGE/PANEL.png`.
fn exports(record: &StageRecord) -> Vec<OutputFile> {
    let mut files = Vec::new();
    for value in &record.outputs {
        for (entry, artifact) in value.entries() {
            let stem = if entry.is_empty() { value.kind().0.replace(' ', "_") } else { entry.to_owned() };
            for (extension, bytes) in artifact.export() {
                files.push(OutputFile { path: format!("stages/{}/{stem}.{extension}", record.id), bytes });
            }
        }
    }
    files
}
