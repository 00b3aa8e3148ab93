//! `toile why`: what a run would do again and why, and where a triangle of a result comes from.

use crate::args::WhyArgs;
use crate::failing::{fail_load, fail_run};
use crate::validate::open;
use crate::{Streams, cache, exit};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use toile_core::{Feed, Node, Registry};
use toile_pipeline::cache::{Cache, Cause};
use toile_pipeline::{Outlook, Pipeline, RunError, RunOptions, forecast};
use toile_stages::write::origin::{FILE, Trace, trace};

/// Explains a run that has yet to be, or a triangle of one that was.
pub(crate) fn why(args: &WhyArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    match args.face {
        Some(face) => why_face(args, face, streams),
        None => why_run(args, registry, streams),
    }
}

/// Follows a triangle back.
fn why_face(args: &WhyArgs, face: usize, streams: &mut Streams<'_>) -> u8 {
    let traced = traced(&args.target, face);
    match traced {
        Err(e) => return streams.refuse(args.json, format!("{}: {e}", args.target.display())),
        Ok(t) if args.json => streams.say(json!({
            "face": face, "panel": t.panel, "triangle": t.triangle, "place_m": t.place,
            "edge": t.edge.as_ref().map(|(name, _)| name), "edge_distance_m": t.edge.as_ref().map(|(_, d)| d),
            "photo": t.photo.as_ref().map(|(file, _)| file), "pixel": t.photo.as_ref().map(|(_, px)| px),
            "mirrored": t.mirrored,
        })),
        Ok(t) => face_lines(face, &t).into_iter().for_each(|line| streams.say(line)),
    }
    exit::DONE
}

fn traced(result: &Path, face: usize) -> Result<Trace, String> {
    let bytes = toile_core::read_file(result).map_err(|e| format!("cannot read it: {e}"))?;
    let extension = result.extension().map_or_else(String::new, |e| e.to_string_lossy().to_lowercase());
    let folder = result.parent().unwrap_or(Path::new("."));
    let origin = toile_core::read_file(&folder.join(FILE)).map_err(|e| {
        format!("there is no \"{FILE}\" beside it ({e}); `toile run` writes one with every garment")
    })?;
    trace(&origin, &bytes, &extension, face)
}

fn face_lines(face: usize, t: &Trace) -> Vec<String> {
    let [x, y] = t.place;
    let mut lines = vec![
        format!("face {face}: triangle {} of panel \"{}\"", t.triangle, t.panel),
        format!("in the panel: x {x:.4} m, y {y:.4} m"),
    ];
    lines.push(match &t.edge {
        Some((name, far)) => format!("nearest edge: {name}, {:.1} mm away", far * 1e3),
        None => "nearest edge: the panel names none".to_owned(),
    });
    let mirrored = if t.mirrored { ", as its mirror image" } else { "" };
    lines.push(match &t.photo {
        Some((file, [px, py])) => format!("photo: {file}, pixel {px:.1}, {py:.1}{mirrored}"),
        None => "photo: none".to_owned(),
    });
    lines
}

fn why_run(args: &WhyArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let pipeline = match open(&args.target, &args.overrides, registry) {
        Ok(pipeline) => pipeline,
        Err(faults) => return fail_load(&faults, args.json, streams),
    };
    let Some(cache) = cache::at(args.cache_dir.clone()).map(Arc::new) else {
        return streams.refuse(args.json, "there is no place for a cache; set TOILE_CACHE to a folder");
    };
    match explained(args, &pipeline, &cache) {
        Err(e) => fail_run(&pipeline, &e, args.json, streams),
        Ok((outlooks, roots)) if args.json => {
            let records = |all: &[Outlook]| all.iter().map(record).collect::<Vec<_>>();
            streams.say(json!({ "stages": records(&outlooks), "since": records(&roots) }));
            exit::DONE
        }
        Ok((outlooks, roots)) => {
            outlooks.iter().flat_map(lines).for_each(|line| streams.say(line));
            roots.iter().flat_map(lines).for_each(|line| streams.say(format!("  since {line}")));
            if args.stage.is_none() {
                let needed = outlooks.iter().filter(|o| o.skipped.is_none());
                let (run, kept): (Vec<_>, Vec<_>) = needed.partition(|o| o.runs());
                streams.say(format!("{} stages would run, {} come from the cache", run.len(), kept.len()));
            }
            exit::DONE
        }
    }
}

/// The outlook of the stage that was named with those of the stages that are the cause where it is
/// not itself, or of all stages.
fn explained(
    args: &WhyArgs,
    pipeline: &Pipeline,
    cache: &Arc<Cache>,
) -> Result<(Vec<Outlook>, Vec<Outlook>), RunError> {
    let whole = || forecast(pipeline, &RunOptions::default(), cache);
    let Some(stage) = &args.stage else { return Ok((whole()?, Vec::new())) };
    // A run that stops after the stage: an unknown one is refused with those that there are.
    let until = RunOptions { until: Some(stage.clone()), ..RunOptions::default() };
    let mut before = forecast(pipeline, &until, cache)?;
    let reports = |n: &Node| n.inputs.contains(&Feed::RunLog);
    if pipeline.find(stage).is_some_and(|i| reports(&pipeline.nodes[i])) {
        // It sees the whole run before it.
        before = whole()?;
    }
    let at = before.iter().position(|o| o.stage == *stage).unwrap_or(before.len());
    let named: Vec<Outlook> = before.drain(at..).take(1).collect();
    let follows = named.iter().any(|o| causes(o).any(|c| matches!(c, Cause::Upstream(_))));
    let roots = before.into_iter().filter(|o| follows && causes(o).any(is_own)).collect();
    Ok((named, roots))
}

fn causes(outlook: &Outlook) -> impl Iterator<Item = &Cause> {
    outlook.entries.iter().filter_map(|(_, causes)| causes.as_ref()).flatten()
}

/// True of what does not come from a stage before.
fn is_own(cause: &Cause) -> bool {
    !matches!(cause, Cause::Upstream(_) | Cause::Input { .. })
}

/// A stage in lines: one for each set of causes, with the entries that share it.
fn lines(outlook: &Outlook) -> Vec<String> {
    let id = &outlook.stage;
    if let Some(reason) = &outlook.skipped {
        return vec![format!("{id}: skipped, {reason}")];
    }
    let mut groups: Vec<(Vec<&str>, &Option<Vec<Cause>>)> = Vec::new();
    for (entry, causes) in &outlook.entries {
        match groups.iter_mut().find(|(_, c)| *c == causes) {
            Some((entries, _)) => entries.push(entry),
            None => groups.push((vec![entry], causes)),
        }
    }
    let several = groups.len() > 1;
    let line = |(entries, causes): (Vec<&str>, &Option<Vec<Cause>>)| {
        let who = if several { format!("{id} ({})", entries.join(", ")) } else { id.clone() };
        match causes {
            None => format!("{who}: from the cache"),
            Some(causes) => format!("{who}: would run: {}", words(causes)),
        }
    };
    groups.into_iter().map(line).collect()
}

fn words(causes: &[Cause]) -> String {
    causes.iter().map(Cause::to_string).collect::<Vec<_>>().join("; ")
}

fn record(outlook: &Outlook) -> Value {
    let entry = |(name, causes): &(String, Option<Vec<Cause>>)| {
        let causes = causes.as_ref().map(|c| c.iter().map(Cause::to_string).collect::<Vec<_>>());
        json!({ "entry": name, "runs": causes.is_some(), "causes": causes.unwrap_or_default() })
    };
    json!({
        "stage": outlook.stage, "skipped": outlook.skipped,
        "entries": outlook.entries.iter().map(entry).collect::<Vec<_>>(),
    })
}
