//! `toile run`.

use crate::args::{Overrides, RunArgs};
use crate::failing::{fail_load, fail_run};
use crate::live::reads;
use crate::terminal::progress::Bar;
use crate::trading::costs::{self, KnownCosts};
use crate::validate::{RefusedPipeline, inspect, open, warn_before_run};
use crate::{Streams, cache, exit, lock, terminal::interrupt, terminal::stdin, terminal::threads};
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError};
use toile_core::artifact::OutputFile;
use toile_core::{Cancel, Listener, Registry, Remarks, StageError};
use toile_pipeline::cache::Cache;
use toile_pipeline::{
    Metrics, Pipeline, Reads, RunError, RunOptions, RunResult, SoFar, check_folder, run as run_stages,
    write_files,
};

/// How a run has ended.
pub(crate) struct RunEnd {
    pub(crate) code: u8,
    /// Why what it made, or had made when it failed, could not be written.
    pub(crate) unwritten: Option<StageError>,
}

impl From<u8> for RunEnd {
    fn from(code: u8) -> Self {
        RunEnd { code, unwritten: None }
    }
}

/// Runs a pipeline, writes its files and says what came of it; the paths that it reads are added to
/// `reads`.
pub(crate) fn once(
    args: &RunArgs,
    registry: &Registry,
    reads: Option<&Reads>,
    streams: &mut Streams<'_>,
) -> u8 {
    ended(args, registry, reads, false, streams).code
}

/// As [`once`]; with `so_far_of_stopped`, a run that is stopped leaves what it had made, too.
pub(crate) fn ended(
    args: &RunArgs,
    registry: &Registry,
    reads: Option<&Reads>,
    so_far_of_stopped: bool,
    streams: &mut Streams<'_>,
) -> RunEnd {
    if args.locked
        && let Err(e) = stdin::refused(&args.pipeline, "has no lock beside it")
    {
        return streams.refuse(args.json, e).into();
    }
    let mut pipeline = match open(&args.pipeline, &args.overrides, registry) {
        Ok(pipeline) => pipeline,
        Err(faults) => return fail_load(&faults, args.json, streams).into(),
    };
    if let Some([warning, help]) = doubt(&args.overrides, &mut pipeline) {
        streams.tell(format!("warning: {warning}"));
        streams.tell(format!("  help: {help}"));
    }
    let lock = match args.locked.then(|| lock::read(&args.pipeline)).transpose() {
        Ok(lock) => lock,
        Err(e) => return streams.refuse(args.json, e).into(),
    };
    let (until, also, reads_too) = (args.until.clone(), args.also.clone(), reads.cloned());
    let asked = RunOptions { until, also, reads: reads_too, ..RunOptions::default() };
    match inspect(&pipeline, &asked) {
        Ok(()) => {}
        Err(RefusedPipeline::Run(e)) => return fail_run(&pipeline, &e, args.json, streams).into(),
        Err(RefusedPipeline::File(faults)) => return fail_load(&faults, args.json, streams).into(),
    }
    warn_before_run(&pipeline, registry, args.until.is_none(), streams);
    if let Err(e) = check_folder(&folder(args)) {
        return unwritable(&pipeline, e, args.json, streams);
    }
    let cache = cache::chosen(&args.cache, streams);
    // A lock is compared by digests, which a cache takes.
    let cache = cache.or_else(|| lock.as_ref().map(|_| Arc::new(Cache::nowhere())));
    if let Some(reads) = reads {
        reads::note_plugins(&pipeline, reads);
    }
    let known = Arc::new(KnownCosts::of(&args.cache, args.threads));
    let so_far = SoFar::default();
    let options = RunOptions {
        so_far: Some(so_far.clone()),
        so_far_of_stopped,
        meter: Some(Arc::new(costs::stopwatch())),
        expect: Some(known.clone()),
        until: args.until.clone(),
        also: args.also.clone(),
        keep: args.keep,
        load: Vec::new(),
        cache,
        reads: reads.cloned(),
        watch: None,
    };
    let outcome = under_a_bar(&pipeline, &options, args.threads, args.verbose, streams);
    match outcome {
        Err(e) => {
            let code = fail_run(&pipeline, &e, args.json, streams);
            if let (true, false, Some(detail)) = (args.verbose, args.json, &e.error.detail) {
                streams.notice(format!("detail: {detail}"));
            }
            RunEnd { code, unwritten: leave(&folder(args), &so_far, args.json, streams).err() }
        }
        Ok(result) => {
            known.keep(&pipeline, &result.costs);
            let locked =
                lock.map_or(exit::DONE, |l| lock::compare(&l, &pipeline, registry, &result, streams));
            let RunEnd { code, unwritten } = finish(args, &pipeline, result, &known, streams);
            RunEnd { code: code.max(locked), unwritten }
        }
    }
}

/// Writes what a failed run has made until then into a folder of its own, so that it is not taken
/// for a result.
fn leave(dir: &Path, so_far: &SoFar, json: bool, streams: &mut Streams<'_>) -> Result<(), StageError> {
    interrupt::begin_writing();
    let page = left(dir, so_far).inspect_err(|e| streams.warn(e.to_string()))?;
    if let (false, Some(page)) = (json, page) {
        streams.tell(format!("what the run made until then: {}", page.display()));
    }
    Ok(())
}

/// Writes what a failed run has made until then; gives its page, or the folder where there is none.
pub(crate) fn left(dir: &Path, so_far: &SoFar) -> Result<Option<PathBuf>, StageError> {
    let files = std::mem::take(&mut *so_far.lock().unwrap_or_else(PoisonError::into_inner));
    if files.is_empty() {
        return Ok(None);
    }
    let dir = dir.join(FAILED);
    clear(&dir);
    write_files(&dir, &files)?;
    let page = files.iter().find(|f| f.path.ends_with(".html")).map_or("", |f| f.path.as_str());
    Ok(Some(dir.join(page)))
}

/// The folder of a run that failed, within its output folder.
pub(crate) const FAILED: &str = "failed";

/// Removes what an earlier failed run has left in its folder; any other folder stays.
fn clear(dir: &Path) {
    if dir.join("reason.txt").is_file() {
        // What cannot be removed stays beside the new files.
        let _ = std::fs::remove_dir_all(dir);
    }
}

/// What is to be said if the requested quality's error was not measured for the pipeline as it is,
/// and how to measure it. The metrics and the report say the same, unless they already say that
/// `--set` changed the quality.
pub(crate) fn doubt(overrides: &Overrides, pipeline: &mut Pipeline) -> Option<[String; 2]> {
    let asked = overrides.quality.as_deref();
    let quality = pipeline.qualities.iter().find(|q| Some(q.name.as_str()) == asked)?;
    let words = quality.standing(pipeline).words()?;
    let (name, error) = (quality.name.clone(), quality.max_error);
    let warning = format!("quality {name}: {words}; whether it keeps {error} here is not known");
    let help = format!("`toile tune PIPELINE --quality \"{name}={error}\"` measures it");
    if overrides.set.is_empty() {
        pipeline.quality = Some(format!("{name}, {words}"));
    }
    Some([warning, help])
}

/// Runs with a progress line; prints the notes and warnings of the stages, then the warnings of the
/// cache.
fn under_a_bar(
    pipeline: &Pipeline,
    options: &RunOptions,
    threads: Option<u16>,
    verbose: bool,
    streams: &mut Streams<'_>,
) -> Result<RunResult, RunError> {
    let pool = threads::pool(threads, streams);
    let bar = Arc::new(Bar::new(pipeline, streams));
    let listener: Arc<dyn Listener> = bar.clone();
    let outcome =
        threads::in_pool(pool, || run_stages(pipeline, options, &interrupt::on_ctrl_c(), &listener));
    let of_cache = options.cache.iter().flat_map(|c| c.take_warnings());
    let Remarks { notes, warnings } = bar.finish();
    match (notes.len(), verbose) {
        (0, _) => {}
        (_, true) => notes.iter().for_each(|note| streams.notice(format!("note: {note}"))),
        (1, false) => streams.notice("1 decision was noted: --verbose and the report show it"),
        (n, false) => streams.notice(format!("{n} decisions were noted: --verbose and the report show them")),
    }
    for warning in warnings.into_iter().chain(of_cache) {
        streams.warn(warning);
    }
    outcome
}

/// Runs a pipeline without a progress line, for commands that look at the record of the run.
pub(crate) fn run_quietly(
    pipeline: &Pipeline,
    cancel: &Cancel,
    streams: &mut Streams<'_>,
) -> Result<RunResult, RunError> {
    let listener: Arc<dyn Listener> = Arc::new(());
    let pool = threads::pool(None, streams);
    threads::in_pool(pool, || run_stages(pipeline, &RunOptions::default(), cancel, &listener))
}

fn finish(
    args: &RunArgs,
    pipeline: &Pipeline,
    result: RunResult,
    known: &KnownCosts,
    streams: &mut Streams<'_>,
) -> RunEnd {
    let dir = folder(args);
    let mut files = result.files;
    interrupt::begin_writing();
    if let Err(error) = written(&dir, &mut files, &result.metrics) {
        return unwritable(pipeline, error, args.json, streams);
    }
    match args.json {
        true => streams.say(result.metrics.to_json()),
        false if streams.is_quiet() => {}
        false => {
            summary(&result.metrics, &dir, &files, streams);
            if args.verbose {
                costs::beside(&result.metrics, known).iter().for_each(|line| streams.say(line));
            }
        }
    }
    for (code, message) in &result.metrics.shortfalls {
        streams.tell(format!("quality: {code}: {message}"));
    }
    RunEnd::from(if result.metrics.shortfalls.is_empty() { exit::DONE } else { exit::QUALITY })
}

/// Writes a run's files, with its metrics as one more of them, and removes what an earlier run that
/// failed has left there.
pub(crate) fn written(dir: &Path, files: &mut Vec<OutputFile>, metrics: &Metrics) -> Result<(), StageError> {
    files.push(OutputFile { path: "metrics.json".into(), bytes: metrics.to_json().into_bytes() });
    write_files(dir, files)?;
    clear(&dir.join(FAILED));
    Ok(())
}

/// Where the files go.
fn folder(args: &RunArgs) -> PathBuf {
    args.out.clone().unwrap_or_else(|| PathBuf::from("out").join(stdin::stem(&args.pipeline)))
}

fn unwritable(pipeline: &Pipeline, error: StageError, json: bool, streams: &mut Streams<'_>) -> RunEnd {
    let unwritten = Some(error.clone());
    RunEnd { code: fail_run(pipeline, &of_writing(error), json, streams), unwritten }
}

/// An error of writing as one of the run.
pub(crate) fn of_writing(error: StageError) -> RunError {
    RunError { stage: "writing".into(), entry: String::new(), span: 0..0, error }
}

fn summary(metrics: &Metrics, dir: &std::path::Path, files: &[OutputFile], streams: &mut Streams<'_>) {
    for stage in metrics.stages.iter().filter(|s| s.skipped.is_none()) {
        let cached = if stage.cached { "  cached" } else { "" };
        streams.say(format!("  {:<20} {:>8.3} s{cached}", stage.id, stage.wall_s));
    }
    if let Some(g) = &metrics.garment {
        let f = &g.figures;
        streams.say(format!(
            "{} triangles, seam gap {:.2} mm, strain p99 {:.1} %, {} steps",
            f.triangles,
            f.seam_gap_max_m * 1e3,
            f.edge_strain.p99 * 1e2,
            f.steps
        ));
        let cm = |m: f64| m * 100.0;
        for (level, g) in &f.girths {
            let (cloth, body) = (cm(g.cloth_m), cm(g.body_m));
            streams.say(format!(
                "{level}: {cloth:.1} cm of cloth around {body:.1} cm, ease {:.1} cm",
                cloth - body
            ));
        }
    }
    if let Some(quality) = &metrics.quality {
        streams.say(format!("quality {quality}"));
    }
    let stages = counts(metrics);
    streams.say(format!("{:.2} s ({stages}), {} files in {}", metrics.wall_s, files.len(), dir.display()));
}

/// How many stages ran and how many came from the cache.
fn counts(metrics: &Metrics) -> String {
    let ran = metrics.stages.iter().filter(|s| s.skipped.is_none());
    let (cached, run): (Vec<_>, Vec<_>) = ran.partition(|s| s.cached);
    format!("{} stages run, {} from the cache", run.len(), cached.len())
}
