//! `toile run` as a function, for programs that use this library as the Python package does.
//!
//! It prints nothing and listens to no signal: what the command tells at a terminal comes out as
//! values, and the caller stops a run by its own flag. What stages took is neither measured nor
//! kept for forecasts, since other runs may be under way in the same process.

use crate::args::{CacheChoice, Overrides};
use crate::failing::as_faults;
use crate::run::{doubt, left, of_writing, written};
use crate::terminal::threads::{cores, in_pool, pool_of};
use crate::validate::{RefusedPipeline, before_run, inspect, open};
use crate::{batch, cache};
use serde_json::Value;
use std::path::PathBuf;
use std::sync::Arc;
use toile_core::artifact::Kind;
use toile_core::{Cancel, Listener, Registry, StageError};
use toile_pipeline::plugin::load_plugin;
use toile_pipeline::{
    Faults, Override, Pipeline, RunError, RunOptions, RunResult, SoFar, check_folder, run as run_stages,
};

/// Which cache a called run uses.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum CalledCache {
    /// That of the command: TOILE_CACHE, else XDG_CACHE_HOME/toile, else ~/.cache/toile.
    #[default]
    Usual,
    /// None: every stage is run.
    Off,
    /// The one in this folder.
    At(PathBuf),
}

/// What is to be run; the defaults are those of the command.
#[derive(Debug, Clone, Default)]
pub struct RunCall {
    /// The pipeline file.
    pub pipeline: PathBuf,
    /// A named quality of the pipeline.
    pub quality: Option<String>,
    /// Values that are set after it. Files are found from the current folder, as with `--set`.
    pub set: Vec<Override>,
    /// Stop after this stage.
    pub until: Option<String>,
    /// Stages that are run though no requested result depends on them.
    pub also: Vec<String>,
    /// Give every stage's artifacts as files as well.
    pub keep: bool,
    /// Threads; one for each core where none are given.
    pub threads: Option<u16>,
    /// Where results of stages are kept and found.
    pub cache: CalledCache,
    /// Where files are written; none where no folder is given.
    pub out: Option<PathBuf>,
    /// Kinds of which the last artifact is in the record in any case.
    pub load: Vec<Kind>,
    /// Libraries of plugins whose stages are added.
    pub plugins: Vec<PathBuf>,
}

/// What a called run gives.
#[derive(Debug)]
pub struct CalledRun {
    /// Files, metrics and the record of the stages. Where they are written, `metrics.json` is one
    /// of the files.
    pub result: RunResult,
    /// Warnings about the pipeline, the threads and the cache; those of stages are in the metrics.
    pub warnings: Vec<String>,
}

/// Why a called run gives nothing.
#[derive(Debug)]
pub enum FailedCall {
    /// The file, its values or what they name are at fault.
    File(Box<Faults>),
    /// A stage failed, or the options ask for a stage that there is not: the error with its place.
    Run(Box<RunError>, Box<Faults>),
    /// What the caller gave is at fault.
    Given(StageError),
}

/// Runs a pipeline with the stages of a registry. `change` may change it before it is checked, such
/// as put artifacts of the caller into the place of readers.
pub fn run(
    call: &RunCall,
    registry: &Registry,
    change: impl FnOnce(&mut Pipeline) -> Result<(), StageError>,
    cancel: &Cancel,
    listener: &Arc<dyn Listener>,
) -> Result<CalledRun, FailedCall> {
    let mut registry = registry.clone();
    for plugin in &call.plugins {
        load_plugin(&mut registry, plugin, None).map_err(|refused| {
            let error = StageError::invalid(refused.to_string());
            FailedCall::Given(refused.hint.into_iter().fold(error, StageError::hint))
        })?;
    }
    let overrides = Overrides { quality: call.quality.clone(), set: call.set.clone() };
    let mut pipeline = open(&call.pipeline, &overrides, &registry).map_err(FailedCall::File)?;
    change(&mut pipeline).map_err(FailedCall::Given)?;
    let doubt = doubt(&overrides, &mut pipeline);
    let mut warnings: Vec<String> =
        doubt.into_iter().map(|[warning, help]| format!("{warning}; {help}")).collect();
    let failed = |e: RunError| {
        let faults = as_faults(&pipeline, &e);
        FailedCall::Run(Box::new(e), Box::new(faults))
    };
    let (until, also) = (call.until.clone(), call.also.clone());
    let asked = RunOptions { until, also, ..RunOptions::default() };
    match inspect(&pipeline, &asked) {
        Ok(()) => {}
        Err(RefusedPipeline::Run(e)) => return Err(failed(e)),
        Err(RefusedPipeline::File(faults)) => return Err(FailedCall::File(faults)),
    }
    let of_file = before_run(&pipeline, &registry, call.until.is_none());
    warnings.extend(of_file.iter().flat_map(Faults::lines));
    if let Some(out) = &call.out {
        check_folder(out).map_err(|e| failed(of_writing(e)))?;
    }
    let (cache, of_cache) = cache::found(&choice(&call.cache));
    warnings.extend(of_cache);
    let (load, so_far) = (call.load.clone(), SoFar::default());
    let options = RunOptions { keep: call.keep, load, cache, so_far: Some(so_far.clone()), ..asked };
    let (pool, of_threads) = pool_of(call.threads, cores());
    warnings.extend(of_threads);
    let outcome = in_pool(pool, || run_stages(&pipeline, &options, cancel, listener));
    warnings.extend(options.cache.iter().flat_map(|c| c.take_warnings()));
    let mut result = outcome.map_err(|e| {
        // What cannot be written of a run that failed is no news beside its failure.
        let _ = call.out.as_ref().map(|out| left(out, &so_far));
        failed(e)
    })?;
    if let Some(out) = &call.out {
        written(out, &mut result.files, &result.metrics).map_err(|e| failed(of_writing(e)))?;
    }
    Ok(CalledRun { result, warnings })
}

fn choice(cache: &CalledCache) -> CacheChoice {
    match cache {
        CalledCache::Usual => CacheChoice::default(),
        CalledCache::Off => CacheChoice { no_cache: true, cache_dir: None },
        CalledCache::At(folder) => CacheChoice { no_cache: false, cache_dir: Some(folder.clone()) },
    }
}

/// A value as `--set` takes it, by the rules of a manifest's: numbers, `true` and `false`, lists of
/// texts and numbers, and texts; one that is no value of RON (`6 mm`, `EU 42`) gets its quotes.
///
/// # Errors
/// A sentence: the path is none, or the value is another.
pub fn setting(path: &str, value: &Value) -> Result<Override, String> {
    batch::manifest::setting(path, value)
}
