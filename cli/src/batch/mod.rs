//! `toile batch`: a pipeline for every garment of a manifest.
//!
//! ```text
//! manifest, pipeline --plan--> garments to run --pool--> garments/ID
//!     --summary--> results.jsonl, index.html
//! ```
//!
//! - `manifest`: the garments and what is wrong with their lines; `make`, `csv`, `names`: manifests
//!   from files and tables.
//! - `plan`: which garments are run, by the records of those that are done.
//! - `quality`: the quality at which they are run, where an error or a deadline is asked for.
//! - `pool`: a process a garment, within memory and time; `memory`: what Linux tells of that;
//!   `task`: what goes in and comes out; `child`: that process from inside; `thumb`: its picture.
//! - `keep`: what came of a garment, put into its place with its `record`; `folder`: the output
//!   folder and its locks.
//! - `summary`, `tally`, `page`: what all shares write together.
//! - `mirror`: manifests and results in object stores.
//!
//! docs/reference/batch.md has the files and their fields.

pub(crate) mod child;
mod csv;
mod folder;
mod keep;
pub(crate) mod make;
pub(crate) mod manifest;
mod memory;
mod mirror;
mod names;
mod page;
mod plan;
mod pool;
mod quality;
mod record;
mod summary;
mod tally;
mod task;
mod thumb;

use crate::args::{BatchArgs, Overrides};
use crate::failing::fail_load;
use crate::terminal::{interrupt, stdin, threads};
use crate::trading::apart;
use crate::validate::open;
use crate::{Streams, at_hand, exit};
use folder::BatchFolder;
use keep::GarmentKeeper;
use manifest::{GarmentLine, LineFault};
use mirror::Mirror;
use plan::BatchPlan;
use pool::PoolLimits;
use quality::{Means, Timed};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use tally::{BatchTally, Tallies, counted};
use toile_core::{Cancel, Registry, StageError};
use toile_pipeline::Faults;

/// The most faults of a manifest that are shown.
const MOST_FAULTS: usize = 100;

/// Runs the garments of a share that are not done yet.
pub(crate) fn batch(args: &BatchArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    if let Err(e) = stdin::refused(&args.pipeline, "is read again by every garment") {
        return streams.refuse(args.json, e);
    }
    let (local, mirror) = match Mirror::open(args) {
        Ok(opened) => opened,
        Err(e) => return refused(&e, args.json, streams),
    };
    let bytes = match toile_core::read_file(&local.manifest) {
        Ok(bytes) => bytes,
        Err(e) => {
            let name = args.manifest.display();
            return streams.refuse(args.json, format!("cannot read the manifest \"{name}\": {e}"));
        }
    };
    let (garments, mut faults) = manifest::parse(&bytes);
    let folders = [folder_of(&local.manifest), folder_of(&args.pipeline)];
    if let Err(e) = mirror.look_at_inputs(&garments) {
        return refused(&e, args.json, streams);
    }
    let has_input = |file: &str| mirror.has_input(file);
    let gone = manifest::missing(&garments, folders.each_ref().map(PathBuf::as_path), &has_input);
    let is_whole = |g: &GarmentLine| gone.iter().all(|fault| fault.line != g.line);
    let garments: Vec<GarmentLine> = garments.iter().filter(|g| is_whole(g)).cloned().collect();
    faults.extend(gone);
    faults.sort_by_key(|fault| fault.line);
    if !faults.is_empty() {
        tell_faults(args, &faults, streams);
        if !args.skip_faulty || garments.is_empty() {
            return exit::INVALID;
        }
    }
    if let Some(id) = args.only.iter().find(|id| garments.iter().all(|g| g.id != **id)) {
        return streams.refuse(args.json, format!("the manifest has no garment \"{id}\""));
    }
    // The first one's files are looked at by every share.
    let own = garments.iter().enumerate().filter(|(i, _)| *i == 0 || !args.merge && args.shard.has(*i));
    if let Err(e) = mirror.bring_inputs(own.map(|(_, g)| g)) {
        return refused(&e, args.json, streams);
    }
    if let Err(faults) = loads(&local, &folders[0], &garments, registry) {
        return fail_load(&faults, args.json, streams);
    }
    let code = match planned(&local, &folders[0], garments, &mirror, registry, streams) {
        Ok(code) => code,
        Err(e) => return refused(&e, args.json, streams),
    };
    if faults.is_empty() { code } else { code.max(exit::INVALID) }
}

/// The full path of the folder in which a file lies.
fn folder_of(file: &Path) -> PathBuf {
    let full = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    full.parent().map_or_else(|| PathBuf::from("."), Path::to_owned)
}

fn tell_faults(args: &BatchArgs, faults: &[LineFault], streams: &mut Streams<'_>) {
    let name = args.manifest.display();
    if args.json && !args.skip_faulty {
        let records: Vec<_> =
            faults.iter().map(|f| json!({ "line": f.line, "message": f.message })).collect();
        return streams.say(json!({ "valid": false, "faults": records }));
    }
    let head = if args.skip_faulty { "warning" } else { "error" };
    for fault in faults.iter().take(MOST_FAULTS) {
        streams.tell(format!("{head}: \"{name}\", {fault}"));
    }
    if faults.len() > MOST_FAULTS {
        streams.tell(format!("and {} more", faults.len() - MOST_FAULTS));
    }
    if !args.skip_faulty {
        streams.tell("  help: nothing was run; mend these lines, or leave them out with --skip-faulty");
    }
}

/// Whether the pipeline loads, by itself or for the first garment: what is wrong with every garment
/// is said before any is run.
fn loads(
    args: &BatchArgs,
    folder: &Path,
    garments: &[GarmentLine],
    registry: &Registry,
) -> Result<(), Box<Faults>> {
    match (open(&args.pipeline, &args.overrides, registry), garments.first()) {
        (Err(_), Some(first)) => open(&args.pipeline, &overrides(args, folder, first), registry).map(drop),
        (opened, _) => opened.map(drop),
    }
}

/// The values of a garment, with the files that are seen from the manifest's folder.
fn overrides(args: &BatchArgs, folder: &Path, garment: &GarmentLine) -> Overrides {
    let own = at_hand::found_from(folder, &garment.set);
    let set = at_hand::found(&args.overrides.set).into_iter().chain(own).collect();
    Overrides { quality: args.overrides.quality.clone(), set }
}

fn refused(e: &StageError, json: bool, streams: &mut Streams<'_>) -> u8 {
    match (json, &e.hint) {
        (true, hint) => {
            streams.say(json!({ "error": e.code.as_str(), "message": e.message, "hint": hint }));
        }
        (false, hint) => {
            streams.tell(format!("error: {}", e.message));
            hint.iter().for_each(|hint| streams.tell(format!("  help: {hint}")));
        }
    }
    exit::INVALID
}

/// A batch that disk or store keep from going on. That may pass, so it is no fault of its input:
/// whoever starts it again should.
fn broken_off(e: &StageError, json: bool, streams: &mut Streams<'_>) -> u8 {
    refused(e, json, streams);
    exit::STOPPED
}

/// Runs what is to be run, and writes what all shares write together.
fn planned(
    args: &BatchArgs,
    manifest_folder: &Path,
    garments: Vec<GarmentLine>,
    mirror: &Mirror,
    registry: &Registry,
    streams: &mut Streams<'_>,
) -> Result<u8, StageError> {
    let out = args.out.clone().unwrap_or_else(|| PathBuf::from("out").join(stdin::stem(&args.manifest)));
    let started = Instant::now();
    let by_error = match args.deadline {
        None => quality::by_error(args, manifest_folder, &garments, registry, streams)?,
        Some(_) => args.clone(),
    };
    let of_share = garments.iter().enumerate().filter(|(place, _)| args.shard.has(*place));
    let ids: Vec<&str> = of_share.map(|(_, g)| &*g.id).collect();
    mirror.fetch_records(&ids)?;
    if args.merge {
        let plan = BatchPlan::new(&by_error, manifest_folder, &out, garments, registry, mirror)?;
        return merged(&by_error, &plan, &out, mirror, streams);
    }
    mirror.fetch_reads(&ids)?;
    if args.check {
        let plan = BatchPlan::new(&by_error, manifest_folder, &out, garments, registry, mirror)?;
        return Ok(told_plan(args, &plan, streams));
    }
    let Some(program) = streams.apart.as_ref().map(|p| apart::for_command(p, "run-garment")) else {
        return Err(StageError::invalid(
            "a batch starts a process for each garment, which only the program can",
        )
        .hint("call the command `toile`"));
    };
    let limits = limits(args);
    let cancel = interrupt::on_ctrl_c();
    let chosen = match args.deadline {
        None => Some(Timed { args: by_error, forecast: None }),
        Some(deadline) => {
            let means =
                Means { program: &program, limits: &limits, cancel: &cancel, registry, mirror, started };
            let folders = (manifest_folder, out.as_path());
            quality::by_deadline(args, deadline, folders, &garments, &means, streams)?
        }
    };
    let Some(Timed { args, forecast }) = &chosen else { return Ok(exit::STOPPED) };
    let plan = BatchPlan::new(args, manifest_folder, &out, garments, registry, mirror)?;
    let folder = BatchFolder::open(&out, args.shard)?;
    streams.notice(plan.words());
    if mirror.has_results() {
        send_unsent(args, &plan, &folder, mirror, streams)?;
    }
    args.deadline.iter().for_each(|deadline| stop_after(quality::left(*deadline, started), &cancel));
    let mut keeper = GarmentKeeper::new(args, &plan, &folder, registry, streams, limits.jobs > 1, mirror);
    let ran = pool::run(&program, plan.run.iter().copied(), &limits, &cancel, &mut keeper);
    interrupt::begin_writing();
    let sent = mirror.end_sending(&cancel);
    let tallies = match summary::write(folder.root(), &plan, args.shard, mirror, sent == Ok(0)) {
        Ok(tallies) => tallies,
        Err(e) => return Ok(broken_off(&e, args.json, streams)),
    };
    let unsent = match sent {
        Ok(unsent) => unsent,
        Err(e) => return Ok(broken_off(&e, args.json, streams)),
    };
    if unsent > 0 {
        streams.warn(format!("{} not sent yet; the next start sends them", counted(unsent)));
    }
    if let Err(why) = ran {
        let e = StageError::invalid(why)
            .hint("what was done before is kept: start the batch again, and it goes on from there");
        return Ok(broken_off(&e, args.json, streams));
    }
    let is_stopped = cancel.is_cancelled() || unsent > 0;
    tell_end(args, &mirror.results_in_words(folder.root()), &tallies, is_stopped, streams);
    if let (Some(forecast), false) = (forecast, is_stopped) {
        let took = quality::in_words(started.elapsed().as_secs_f64());
        streams
            .notice(format!("it took {took} with the pilot; {} were expected", quality::in_words(*forecast)));
    }
    // What other shares have come to says nothing of this one.
    Ok(match (is_stopped, tallies.share.faults.is_empty()) {
        (true, _) => exit::STOPPED,
        (false, false) => exit::QUALITY,
        (false, true) => exit::DONE,
    })
}

/// Sends the garments of the share that were done before and that the store has not.
fn send_unsent(
    args: &BatchArgs,
    plan: &BatchPlan,
    folder: &BatchFolder,
    mirror: &Mirror,
    streams: &mut Streams<'_>,
) -> Result<(), StageError> {
    let mut sent = 0;
    for record in plan.done(folder.root(), args.shard) {
        sent += usize::from(mirror.send_unsent(&record.line.id, &record)?);
    }
    if sent > 0 {
        streams.notice(format!("{} done before, and sent now", counted(sent)));
    }
    Ok(())
}

/// Writes the results of all shares, by what is done.
fn merged(
    args: &BatchArgs,
    plan: &BatchPlan,
    out: &Path,
    mirror: &Mirror,
    streams: &mut Streams<'_>,
) -> Result<u8, StageError> {
    let root = std::path::absolute(out).unwrap_or_else(|_| out.to_owned());
    let name = mirror.results_in_words(&root);
    if summary::done(&root, plan, mirror).is_empty() {
        return Err(StageError::invalid(format!("\"{name}\" holds no garment of this batch"))
            .hint("run it first; pipeline, values and options have to be those that it was run with"));
    }
    let tallies = summary::write(&root, plan, args.shard, mirror, true)?;
    tell_end(args, &name, &tallies, false, streams);
    Ok(if tallies.all.faults.is_empty() { exit::DONE } else { exit::QUALITY })
}

/// Stops the batch after so many seconds, as Ctrl-C does.
fn stop_after(seconds: f64, cancel: &Cancel) {
    let cancel = cancel.clone();
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_secs_f64(seconds));
        cancel.cancel();
    });
}

fn told_plan(args: &BatchArgs, plan: &BatchPlan, streams: &mut Streams<'_>) -> u8 {
    match args.json {
        true => streams.say(json!({
            "valid": true, "garments": plan.garments.len(), "share": plan.share, "not_run": plan.not_run,
            "to_run": plan.run.len(),
        })),
        false => streams.say(plan.words()),
    }
    exit::DONE
}

/// What garments may take.
fn limits(args: &BatchArgs) -> PoolLimits {
    let cores = threads::cores();
    let free = memory::free().map_or(u64::MAX, |free| free / 10 * 9);
    let memory = args.memory.map_or(free, |m| m.0);
    PoolLimits {
        cores,
        jobs: args.jobs.map_or(cores, usize::from),
        memory,
        max_memory: args.max_memory.map_or(memory, |m| m.0),
        max_time: args.max_time,
    }
}

fn tell_end(
    args: &BatchArgs,
    results: &str,
    Tallies { all, share }: &Tallies,
    is_stopped: bool,
    streams: &mut Streams<'_>,
) {
    let counts = |t: &BatchTally| json!({ "garments": t.garments, "good": t.good, "faults": t.faults, "left": t.left() });
    match args.json {
        true => {
            let mut record = counts(all);
            record["share"] = counts(share);
            record["stopped"] = is_stopped.into();
            record["folder"] = results.into();
            streams.say(record);
        }
        false => {
            if args.shard.count > 1 {
                streams.report(format!("share {}, {}", args.shard, share.words()));
            }
            streams.report(all.words());
            streams.report(format!("{results}/index.html"));
        }
    }
    if is_stopped {
        streams.notice("stopped; started again, the batch goes on from here");
    }
}
