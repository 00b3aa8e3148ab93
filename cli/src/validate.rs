//! `toile validate`, and the loading that all commands share.

use crate::args::{Overrides, ValidateArgs};
use crate::{Streams, exit};
use serde_json::json;
use std::path::Path;
use toile_core::pipeline::{Basis, Changes, Fault, Faults, Pipeline, Quality, Standing, load_with};
use toile_core::{Registry, add_implicit};

/// Loads a pipeline with its overrides and the stages that every pipeline gets.
pub(crate) fn open(path: &Path, overrides: &Overrides, registry: &Registry) -> Result<Pipeline, Box<Faults>> {
    let file = path.display().to_string();
    let text = std::fs::read(path).map_err(|e| unreadable(&file, &e.to_string()))?;
    let text = String::from_utf8(text).map_err(|_| unreadable(&file, "it is not UTF-8 text"))?;
    let base = path.parent().unwrap_or(Path::new("."));
    let set = crate::at_hand::found(&overrides.set);
    let changes = Changes { quality: overrides.quality.as_deref(), set: &set, ..Changes::default() };
    let mut pipeline = load_with(&text, &file, base, registry, &changes).map_err(Box::new)?;
    add_implicit(&mut pipeline, registry);
    Ok(pipeline)
}

fn unreadable(file: &str, why: &str) -> Box<Faults> {
    let fault = Fault::new("pattern_loading", format!("cannot read the pipeline \"{file}\": {why}"));
    Box::new(Faults::new(file, "", vec![fault]))
}

/// Checks every pipeline and shows all faults of all of them.
pub(crate) fn validate(args: &ValidateArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let mut faults = Vec::new();
    for path in &args.pipelines {
        match open(path, &args.overrides, registry) {
            Ok(_) if args.json => {}
            Ok(p) => {
                let line = format!("{}: valid, {} stages", path.display(), p.nodes.len());
                let words = quality_words(&standings(path, &args.overrides, &p, registry));
                let words = if words.is_empty() { words } else { format!(", qualities {words}") };
                streams.say(format!("{line}{words}"));
            }
            Err(e) => faults.push(e),
        }
    }
    match args.json {
        true => {
            let list: Vec<_> = faults.iter().flat_map(|f| f.records()).collect();
            streams.say(json!({ "valid": faults.is_empty(), "faults": list }));
        }
        false => faults.iter().for_each(|f| streams.fault(f)),
    }
    if faults.is_empty() { exit::DONE } else { exit::INVALID }
}

/// A quality beside the pipeline as it is.
pub(crate) struct Stood {
    pub(crate) quality: Quality,
    /// What its claim is worth.
    pub(crate) standing: Standing,
    /// What it would be measured for now; none where the file does not load with it any more.
    pub(crate) now: Option<Basis>,
}

/// The named qualities of a pipeline, each with what its claim is worth for the file with the overrides of the command line.
pub(crate) fn standings(
    path: &Path,
    overrides: &Overrides,
    pipeline: &Pipeline,
    registry: &Registry,
) -> Vec<Stood> {
    let stood = |quality: &Quality| {
        let with = Overrides { quality: Some(quality.name.clone()), set: overrides.set.clone() };
        // A file that loads without its qualities loads with each of them, unless it changed meanwhile.
        let with = open(path, &with, registry).ok();
        let standing = with.as_ref().map_or(Standing::Unknown, |p| quality.standing(p));
        Stood { quality: quality.clone(), standing, now: with.as_ref().map(Basis::of) }
    };
    pipeline.qualities.iter().map(stood).collect()
}

/// Qualities in words: `Draft (10 mm), Fine (2 mm, measured for another pipeline)`.
pub(crate) fn quality_words(stood: &[Stood]) -> String {
    stood.iter().map(|s| s.quality.words(s.standing)).collect::<Vec<_>>().join(", ")
}
