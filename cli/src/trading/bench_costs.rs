//! `toile bench costs`: what stages take over edge lengths and photo sizes, and how well that is
//! predicted.

use crate::args::{CostsArgs, Overrides};
use crate::failing::fail_run;
use crate::validate::open;
use crate::{
    Streams, exit, terminal::interrupt, terminal::stdin, terminal::threads, trading::apart, trading::costs,
};
use rayon::ThreadPool;
use std::path::Path;
use std::sync::Arc;
use toile_core::artifact::OutputFile;
use toile_core::{Listener, Registry};
use toile_pipeline::{Override, Pipeline, RunError, RunOptions, run, write_files};
use toile_trade::cost::{
    Collection, CostFigure, CostRecord, Costs, Variation, check, check_lines, note, parse_collection,
    shortest, variations,
};

/// Where a run's own process leaves its records, in the folder of photos of other sizes.
const ONE_RUN: &str = "run.jsonl";

/// Measures, writes the records, and checks predictions on pipelines that are left out.
pub(crate) fn costs(args: &CostsArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let mut collection = match args.from.as_deref().map(read).transpose() {
        Ok(from) => from.unwrap_or_else(|| Collection::here(Vec::new())),
        Err(e) => return refused(&e, streams),
    };
    for file in &args.pipelines {
        match measure(file, args, registry, streams) {
            Ok(records) => collection.records.extend(records),
            Err(code) => return code,
        }
    }
    if let Some(out) = &args.out
        && let Err(e) = write(&collection, args.slim, out)
    {
        return refused(&e, streams);
    }
    streams.say(format!("{} runs of stages on {}", collection.records.len(), collection.host));
    if args.check {
        for figure in CostFigure::ALL {
            check_lines(&check(&collection.records, &args.without, figure))
                .iter()
                .for_each(|l| streams.say(l));
        }
    }
    exit::DONE
}

/// Runs a pipeline in each of its settings; of the runs of a setting each stage's shortest counts.
fn measure(
    file: &Path,
    args: &CostsArgs,
    registry: &Registry,
    streams: &mut Streams<'_>,
) -> Result<Vec<CostRecord>, u8> {
    stdin::refused(file, "is not measured").map_err(|e| refused(&e, streams))?;
    let pipeline = load(file, args, &[], registry, streams)?;
    let settings = match args.one_run {
        true => vec![Variation { words: "one run".into(), overrides: Vec::new() }],
        false => variations(&pipeline, &args.work).map_err(|e| refused(&e.to_string(), streams))?,
    };
    // One pool for all runs: threads that end give memory back in the midst of the next run.
    let pool = threads::pool(args.threads, streams);
    let pool = pool.map_err(|e| refused(&format!("there are no threads: {e}"), streams))?;
    let mut records = Vec::new();
    for setting in &settings {
        let mut runs = Vec::new();
        for _ in 0..args.repeats {
            streams.notice(format!("{}: {}", pipeline.name, setting.words));
            runs.push(match args.one_run || streams.apart.is_none() {
                true => here(&load(file, args, &setting.overrides, registry, streams)?, &pool, streams)?,
                false => alone(file, args, &setting.overrides, streams)?,
            });
        }
        records.extend(shortest(runs));
    }
    Ok(records)
}

fn load(
    file: &Path,
    args: &CostsArgs,
    more: &[Override],
    registry: &Registry,
    streams: &mut Streams<'_>,
) -> Result<Pipeline, u8> {
    let set = args.overrides.set.iter().chain(more).cloned().collect();
    open(file, &Overrides { set, ..args.overrides.clone() }, registry).map_err(|faults| {
        streams.fault(&faults);
        exit::INVALID
    })
}

/// A run in this process.
fn here(pipeline: &Pipeline, pool: &ThreadPool, streams: &mut Streams<'_>) -> Result<Vec<CostRecord>, u8> {
    pool.install(|| once(pipeline)).map_err(|e| fail_run(pipeline, &e, false, streams))
}

/// A run in a process of its own: as `toile run` it finds no memory that an earlier run has
/// touched, nor threads that have worked before.
fn alone(
    file: &Path,
    args: &CostsArgs,
    more: &[Override],
    streams: &mut Streams<'_>,
) -> Result<Vec<CostRecord>, u8> {
    let out = args.work.join(ONE_RUN);
    let mut command = apart::again(streams.apart.as_ref());
    command.args(["bench", "costs", "--one-run", "--out"]).arg(&out).arg(file);
    command.args(args.threads.iter().flat_map(|n| ["--threads".to_owned(), n.to_string()]));
    command.args(args.overrides.quality.iter().flat_map(|q| ["--quality", q]));
    let set = args.overrides.set.iter().chain(more);
    command.args(set.flat_map(|o| ["--set".to_owned(), format!("{}={}", o.path, o.value)]));
    let ran = command.output().map_err(|e| refused(&format!("a run cannot be started: {e}"), streams))?;
    if !ran.status.success() {
        streams.tell(String::from_utf8_lossy(&ran.stderr).trim_end());
        return Err(ran.status.code().and_then(|c| u8::try_from(c).ok()).unwrap_or(exit::STOPPED));
    }
    read(&out).map(|c| c.records).map_err(|e| refused(&e, streams))
}

/// What the stages of a run without cache take.
fn once(pipeline: &Pipeline) -> Result<Vec<CostRecord>, RunError> {
    let options = RunOptions { meter: Some(Arc::new(costs::stopwatch())), ..RunOptions::default() };
    let listener: Arc<dyn Listener> = Arc::new(());
    let result = run(pipeline, &options, &interrupt::on_ctrl_c(), &listener)?;
    Ok(note(pipeline, &result.costs, &Costs::default(), rayon::current_num_threads()))
}

fn read(path: &Path) -> Result<Collection, String> {
    let name = path.display();
    let text = toile_core::read_text(path).map_err(|e| format!("cannot read \"{name}\": {e}"))?;
    parse_collection(&text).map_err(|why| format!("\"{name}\" {why}"))
}

fn write(collection: &Collection, slim: bool, path: &Path) -> Result<(), String> {
    let text = if slim { collection.clone().slim().to_text() } else { collection.to_text() };
    let (folder, name) = (path.parent().unwrap_or(Path::new("")), path.file_name().unwrap_or_default());
    let file = OutputFile { path: name.to_string_lossy().into_owned(), bytes: text.into_bytes() };
    write_files(folder, &[file]).map(|_| ()).map_err(|e| e.to_string())
}

fn refused(message: &str, streams: &mut Streams<'_>) -> u8 {
    streams.tell(format!("error: {message}"));
    exit::INVALID
}
