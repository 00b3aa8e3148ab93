//! The quality at which a batch is run: by the error that its garments may have, by the time until
//! which it is to be done, or both.
//!
//! Method: named qualities of the pipeline whose error is small enough, from the coarsest on. By
//! time, a pilot of some garments, spread over the sizes of their files, is run at each, as the
//! batch would run them; the mean of their times says how long all take. The finest quality that is
//! done in time is taken, and what its pilot made is part of the batch. The choice is written
//! beside the results, so that a batch which goes on, and other shares, take the same.

use super::folder::{BatchFolder, garment};
use super::keep::GarmentKeeper;
use super::manifest::GarmentLine;
use super::mirror::Mirror;
use super::plan::BatchPlan;
use super::pool::{self, PoolLimits};
use super::record::GarmentRecord;
use super::tally::counted;
use crate::args::{BatchArgs, Overrides, Shard};
use crate::validate::open;
use crate::verify::write_text;
use crate::{Streams, at_hand};
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use toile_core::artifact::Digest;
use toile_core::{Cancel, Length, Registry, StageError};
use toile_trade::measure::apart::Apart;

/// Where the choice is written.
const FILE: &str = "quality.json";

/// Garments of a pilot: a share of all, and the least and the most.
const SHARE: f64 = 0.1;
const LEAST: usize = 8;
const MOST: usize = 64;

/// What a batch needs to run garments.
pub(crate) struct Means<'a> {
    pub(crate) program: &'a Apart,
    pub(crate) limits: &'a PoolLimits,
    pub(crate) cancel: &'a Cancel,
    pub(crate) registry: &'a Registry,
    pub(crate) mirror: &'a Mirror,
    /// When the batch was started.
    pub(crate) started: Instant,
}

/// What is written of a choice.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct QualityChoice {
    quality: String,
    /// Seconds that the garments of the share were expected to take.
    forecast: f64,
    /// Of the pipeline and of what was asked.
    asked: Digest,
}

/// A choice by time.
pub(crate) struct Timed {
    pub(crate) args: BatchArgs,
    /// Seconds that all garments of the share are expected to take; none where that was told
    /// before.
    pub(crate) forecast: Option<f64>,
}

/// The arguments with the coarsest quality that keeps the error, where one is asked for.
///
/// Errors: no quality keeps it; the pipeline has none.
pub(crate) fn by_error(
    args: &BatchArgs,
    manifest_folder: &Path,
    garments: &[GarmentLine],
    registry: &Registry,
    streams: &mut Streams<'_>,
) -> Result<BatchArgs, StageError> {
    if args.max_error.is_none() {
        return Ok(args.clone());
    }
    let known = qualities(args, manifest_folder, garments, registry)?;
    let (name, error) = &known[0];
    streams.notice(format!("quality {name}, which keeps {error}"));
    Ok(with(args, name))
}

/// The arguments with the finest quality at which the share is done by the deadline; none where the
/// batch was stopped before that was known.
///
/// Errors: the pipeline has no quality that keeps the error that is asked for, or none that is done
/// in time; a file cannot be written.
pub(crate) fn by_deadline(
    args: &BatchArgs,
    deadline: Duration,
    (manifest_folder, out): (&Path, &Path),
    garments: &[GarmentLine],
    means: &Means<'_>,
    streams: &mut Streams<'_>,
) -> Result<Option<Timed>, StageError> {
    let known = qualities(args, manifest_folder, garments, means.registry)?;
    fs::create_dir_all(out.join("locks")).map_err(|e| unwritten(out, &e))?;
    // Of shares that start together one chooses.
    let held = File::options().create(true).append(true).open(out.join("locks/quality"));
    let _held = held.ok().filter(|file| file.lock().is_ok());
    let asked = asked(args, deadline)?;
    let written = toile_core::read_file(&out.join(FILE)).ok();
    let before = written.and_then(|bytes| serde_json::from_slice::<QualityChoice>(&bytes).ok());
    let before = before.filter(|c| c.asked == asked && known.iter().any(|(name, _)| *name == c.quality));
    if let Some(QualityChoice { quality, .. }) = before {
        streams.notice(format!("quality {quality}, as it was chosen before"));
        return Ok(Some(Timed { args: with(args, &quality), forecast: None }));
    }
    let share: Vec<usize> = (0..garments.len()).filter(|place| args.shard.has(*place)).collect();
    let places = spread(&share, garments, manifest_folder);
    let pilot: Vec<GarmentLine> = places.into_iter().map(|place| garments[place].clone()).collect();
    let (mut best, mut coarsest): (Option<QualityChoice>, Option<(&str, f64)>) = (None, None);
    for (name, error) in &known {
        let own = BatchArgs { shard: Shard { number: 1, count: 1 }, ..with(args, name) };
        let folder = pilot_of(out, name);
        let Some(seconds) = piloted(&own, (manifest_folder, &folder), &pilot, means, streams)? else {
            return Ok(None);
        };
        let at_a_time = means.limits.jobs.min(share.len()).max(1);
        let forecast = seconds * share.len() as f64 / at_a_time as f64;
        let (count, time) = (counted(share.len()), in_words(forecast));
        streams.notice(format!("quality {name}, which keeps {error}: {count} in {time}"));
        coarsest.get_or_insert((name.as_str(), forecast));
        if forecast > left(deadline, means.started) {
            break;
        }
        best = Some(QualityChoice { quality: name.clone(), forecast, asked });
    }
    let Some(choice) = best else {
        return Err(too_slow(coarsest, deadline));
    };
    adopt(&pilot_of(out, &choice.quality), out, &pilot).map_err(|e| unwritten(out, &e))?;
    let _ = fs::remove_dir_all(out.join("pilot"));
    let text = serde_json::to_string(&choice).map_err(|e| StageError::internal(e.to_string()))? + "\n";
    write_text(&out.join(FILE), &text).map_err(|e| StageError::invalid(e.to_string()))?;
    streams.notice(format!("quality {} is taken", choice.quality));
    Ok(Some(Timed { args: with(args, &choice.quality), forecast: Some(choice.forecast) }))
}

fn with(args: &BatchArgs, quality: &str) -> BatchArgs {
    let overrides = Overrides { quality: Some(quality.to_owned()), set: args.overrides.set.clone() };
    BatchArgs { overrides, ..args.clone() }
}

/// What is left until the deadline, s.
pub(crate) fn left(deadline: Duration, started: Instant) -> f64 {
    deadline.saturating_sub(started.elapsed()).as_secs_f64()
}

/// The qualities that keep the error, the coarsest first.
fn qualities(
    args: &BatchArgs,
    manifest_folder: &Path,
    garments: &[GarmentLine],
    registry: &Registry,
) -> Result<Vec<(String, Length)>, StageError> {
    let own = garments.first().map(|first| super::overrides(args, manifest_folder, first));
    let plain = Overrides { quality: None, set: at_hand::found(&args.overrides.set) };
    let pipeline = open(&args.pipeline, &plain, registry)
        .or_else(|faults| own.map_or(Err(faults), |own| open(&args.pipeline, &own, registry)))
        .map_err(|_| StageError::invalid("the pipeline does not load"))?;
    let mut all: Vec<(String, Length)> =
        pipeline.qualities.iter().map(|q| (q.name.clone(), q.max_error)).collect();
    all.sort_by(|a, b| b.1.metres().total_cmp(&a.1.metres()));
    let name = args.pipeline.display();
    if all.is_empty() {
        return Err(StageError::invalid(format!("the pipeline \"{name}\" has no qualities to choose from"))
            .hint(format!(
                "measure some: toile tune {name} --quality \"Draft=3 mm\" --quality \"Fine=1 mm\""
            )));
    }
    let words: Vec<String> = all.iter().map(|(name, error)| format!("{name} {error}")).collect();
    all.retain(|(_, error)| args.max_error.is_none_or(|most| error.metres() <= most.metres()));
    match (all.is_empty(), args.max_error) {
        (true, Some(most)) => Err(StageError::invalid(format!("no quality of the pipeline keeps {most}"))
            .hint(format!("they keep: {}", words.join(", ")))),
        _ => Ok(all),
    }
}

/// A digest of what decides the choice.
fn asked(args: &BatchArgs, deadline: Duration) -> Result<Digest, StageError> {
    let text = toile_core::read_text(&args.pipeline).map_err(|e| {
        StageError::invalid(format!("cannot read the pipeline \"{}\": {e}", args.pipeline.display()))
    })?;
    let error = args.max_error.map_or(0.0, Length::metres);
    let set: Vec<String> = args.overrides.set.iter().map(|o| format!("{}={}", o.path, o.value)).collect();
    let all = format!("{text}\n{error}\n{}\n{}", deadline.as_secs_f64(), set.join("\n"));
    Ok(Digest::of(all.as_bytes()))
}

/// Garments for a pilot: in the order of the sizes of their files, evenly.
fn spread(share: &[usize], garments: &[GarmentLine], folder: &Path) -> Vec<usize> {
    let size = |place: &usize| -> u64 {
        let found = at_hand::found_from(folder, &garments[*place].set);
        let files = found.iter().filter_map(at_hand::named);
        files.filter_map(|file| fs::metadata(folder.join(file)).ok()).map(|m| m.len()).sum()
    };
    let mut sorted: Vec<(u64, usize)> = share.iter().map(|place| (size(place), *place)).collect();
    sorted.sort_unstable();
    let count = ((SHARE * share.len() as f64).ceil() as usize).clamp(LEAST, MOST).min(share.len());
    // The middle of each of `count` parts.
    let at = |k: usize| sorted[(2 * k + 1) * sorted.len() / (2 * count)].1;
    let mut places: Vec<usize> = (0..count).map(at).collect();
    places.sort_unstable();
    places
}

fn pilot_of(out: &Path, quality: &str) -> PathBuf {
    out.join("pilot").join(quality)
}

/// Runs the garments of a pilot that are not done, and gives their mean time, s; none where the
/// batch was stopped.
fn piloted(
    args: &BatchArgs,
    (manifest_folder, out): (&Path, &Path),
    garments: &[GarmentLine],
    means: &Means<'_>,
    streams: &mut Streams<'_>,
) -> Result<Option<f64>, StageError> {
    let plan = BatchPlan::new(args, manifest_folder, out, garments.to_vec(), means.registry, means.mirror)?;
    let folder = BatchFolder::open(out, args.shard)?;
    let forecasts = means.limits.jobs > 1;
    let mut keeper =
        GarmentKeeper::new(args, &plan, &folder, means.registry, streams, forecasts, means.mirror);
    pool::run(means.program, plan.run.iter().copied(), means.limits, means.cancel, &mut keeper)
        .map_err(StageError::invalid)?;
    if means.cancel.is_cancelled() {
        return Ok(None);
    }
    let seconds = |g: &GarmentLine| GarmentRecord::read(&garment(out, &g.id)).map(|r| r.costs.seconds);
    let all: Vec<f64> = garments.iter().filter_map(seconds).collect();
    Ok(Some(all.iter().sum::<f64>() / all.len().max(1) as f64))
}

/// Moves what a pilot made to the batch, where that has not made it itself.
fn adopt(pilot: &Path, out: &Path, garments: &[GarmentLine]) -> std::io::Result<()> {
    fs::create_dir_all(out.join("garments"))?;
    for g in garments {
        let (from, to) = (garment(pilot, &g.id), garment(out, &g.id));
        if from.is_dir() && !to.exists() {
            fs::rename(from, to)?;
        }
    }
    Ok(())
}

fn too_slow(coarsest: Option<(&str, f64)>, deadline: Duration) -> StageError {
    let (name, forecast) = coarsest.unwrap_or_default();
    StageError::invalid(format!(
        "even at the quality {name} the garments are not done in {}: they take {}",
        in_words(deadline.as_secs_f64()),
        in_words(forecast)
    ))
    .hint("give it longer with --deadline, or divide the manifest among machines with --shard")
}

fn unwritten(path: &Path, e: &std::io::Error) -> StageError {
    StageError::invalid(format!("cannot write \"{}\": {e}", path.display()))
        .hint("choose another folder with --out")
}

/// A time in the unit that fits.
pub(crate) fn in_words(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_pilot_is_spread_over_the_sizes_of_files() {
        let dir = tempfile::tempdir().unwrap();
        let line = |k: usize| {
            fs::write(dir.path().join(format!("{k}.json")), vec![b' '; 1000 - k]).unwrap();
            format!("{{\"id\": \"g{k}\", \"set\": {{\"pattern.file\": \"{k}.json\"}}}}\n")
        };
        let text: String = (0..40).map(line).collect();
        let (garments, faults) = super::super::manifest::parse(text.as_bytes());
        assert!(faults.is_empty());
        let all: Vec<usize> = (0..40).collect();
        assert_eq!(spread(&all, &garments, dir.path()), [2, 7, 12, 17, 22, 27, 32, 37]);
        assert_eq!(spread(&all[..5], &garments, dir.path()), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn times_are_told_in_the_unit_that_fits() {
        assert_eq!([59.6, 600.0, 30_000.0].map(in_words), ["60 s", "10 min", "8.3 h"]);
    }
}
