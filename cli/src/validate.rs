//! `toile validate`, and the loading that all commands share.

use crate::args::{Overrides, ValidateArgs};
use crate::{Streams, exit, terminal::stdin};
use serde_json::json;
use std::path::Path;
use toile_core::Registry;
use toile_pipeline::{
    Basis, Changes, Fault, Faults, Pipeline, Quality, RunError, RunOptions, Standing, add_implicit, faults,
    load_with, plan,
};

/// Loads a pipeline with its overrides and the stages that every pipeline gets.
pub(crate) fn open(path: &Path, overrides: &Overrides, registry: &Registry) -> Result<Pipeline, Box<Faults>> {
    let file = stdin::name(path);
    let text = stdin::text(path).map_err(|why| unreadable(&file, &why))?;
    let base = stdin::folder(path);
    let set = crate::at_hand::found(&overrides.set);
    let changes =
        Changes { quality: overrides.quality.as_deref(), set: &set, asks: true, ..Changes::default() };
    let mut pipeline = load_with(&text, &file, base, registry, &changes).map_err(Box::new)?;
    add_implicit(&mut pipeline, registry);
    Ok(pipeline)
}

/// Asks the stages that a run would run what is wrong with their parameters and files.
/// The files that they look at are added to the options' `reads`.
pub(crate) fn inspect(pipeline: &Pipeline, options: &RunOptions) -> Result<(), RefusedPipeline> {
    let plan = plan(pipeline, options).map_err(RefusedPipeline::Run)?;
    let runs = |i: usize| plan.get(i).is_some_and(Option::is_none);
    faults(pipeline, runs, options.reads.as_ref()).map_err(|faults| RefusedPipeline::File(Box::new(faults)))
}

/// Why a pipeline is not run.
pub(crate) enum RefusedPipeline {
    /// The options ask for something that the pipeline does not have, such as a stage.
    Run(RunError),
    /// What its stages find wrong.
    File(Box<Faults>),
}

/// As [`open`], and asks every stage what is wrong with its parameters and files.
pub(crate) fn checked(
    path: &Path,
    overrides: &Overrides,
    registry: &Registry,
) -> Result<Pipeline, Box<Faults>> {
    let pipeline = open(path, overrides, registry)?;
    faults(&pipeline, |_| true, None)?;
    Ok(pipeline)
}

/// Shows warnings about a valid pipeline.
fn warn(warnings: &Faults, streams: &mut Streams<'_>) {
    warnings.lines().iter().for_each(|line| streams.warn(line));
}

/// Shows warnings before a run. It leaves out that a pipeline writes no garment, which may be
/// intended, and, in a run of a part, results that only the rest would use.
pub(crate) fn warn_before_run(
    pipeline: &Pipeline,
    registry: &Registry,
    is_whole: bool,
    streams: &mut Streams<'_>,
) {
    before_run(pipeline, registry, is_whole).iter().for_each(|w| warn(w, streams));
}

/// The warnings of [`warn_before_run`].
pub(crate) fn before_run(pipeline: &Pipeline, registry: &Registry, is_whole: bool) -> Option<Faults> {
    let mut warnings = pipeline.warnings(registry)?;
    warnings.faults.retain(|w| w.code != "no_garment" && (is_whole || w.code != "unused"));
    Some(warnings)
}

fn unreadable(file: &str, why: &str) -> Box<Faults> {
    let fault = Fault::new("pattern_loading", format!("cannot read the pipeline \"{file}\": {why}"));
    Box::new(Faults::new(file, "", vec![fault]))
}

/// Checks every pipeline and shows all faults of all of them.
pub(crate) fn validate(args: &ValidateArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let (mut faults, mut warnings) = (Vec::new(), Vec::new());
    for path in &args.pipelines {
        match checked(path, &args.overrides, registry) {
            Ok(p) if args.json => warnings.extend(p.warnings(registry)),
            Ok(p) => {
                p.warnings(registry).iter().for_each(|w| warn(w, streams));
                let line = format!("{}: valid, {} stages", stdin::name(path), p.nodes.len());
                let words = quality_words(&standings(path, &args.overrides, &p, registry));
                let words = if words.is_empty() { words } else { format!(", qualities {words}") };
                streams.report(format!("{line}{words}"));
            }
            Err(e) => faults.push(e),
        }
    }
    match args.json {
        true => {
            let list: Vec<_> = faults.iter().flat_map(|f| f.records()).collect();
            let warned: Vec<_> = warnings.iter().flat_map(Faults::records).collect();
            streams.say(json!({ "valid": faults.is_empty(), "faults": list, "warnings": warned }));
        }
        false => faults.iter().for_each(|f| streams.fault(f)),
    }
    if faults.is_empty() { exit::DONE } else { exit::INVALID }
}

/// A quality beside the pipeline as it is.
pub(crate) struct JudgedQuality {
    pub(crate) quality: Quality,
    /// What its claim is worth.
    pub(crate) standing: Standing,
    /// What it would be measured for now; none where the file does not load with it any more.
    pub(crate) now: Option<Basis>,
}

/// The named qualities of a pipeline, each with what its claim is worth for the file with the
/// overrides of the command line.
pub(crate) fn standings(
    path: &Path,
    overrides: &Overrides,
    pipeline: &Pipeline,
    registry: &Registry,
) -> Vec<JudgedQuality> {
    let stood = |quality: &Quality| {
        let with = Overrides { quality: Some(quality.name.clone()), set: overrides.set.clone() };
        // A file that loads without its qualities loads with each of them, unless it changed
        // meanwhile.
        let with = open(path, &with, registry).ok();
        let standing = with.as_ref().map_or(Standing::Unknown, |p| quality.standing(p));
        JudgedQuality { quality: quality.clone(), standing, now: with.as_ref().map(Basis::of) }
    };
    pipeline.qualities.iter().map(stood).collect()
}

/// Qualities in words: `Draft (10 mm), Fine (2 mm, measured for another pipeline)`.
pub(crate) fn quality_words(stood: &[JudgedQuality]) -> String {
    stood.iter().map(|s| s.quality.words(s.standing)).collect::<Vec<_>>().join(", ")
}
