//! `toile explain`: what a run would do, what it would leave out, and why.

use crate::args::ExplainArgs;
use crate::explain::json::json;
use crate::explain::words::Explained;
use crate::failing::fail_run;
use crate::trading::costs::KnownCosts;
use crate::trading::measuring::{default_folder, failed, opened, quality};
use crate::validate::{JudgedQuality, quality_words, standings};
use crate::{Streams, exit};
use std::path::Path;
use toile_core::{Feed, Node, Registry, StageError};
use toile_pipeline::decide::{StageDecision, decisions};
use toile_pipeline::{Pipeline, RunError, RunOptions, plan};
use toile_trade::ablate::Ablation;
use toile_trade::cost::{Forecast, forecast_lines, predict};
use toile_trade::decided::{self, told};
use toile_trade::saving::Evidence;

/// Prints one line a stage: what feeds it, and whether it runs; then what is expected, and the
/// decisions.
pub(crate) fn explain(args: &ExplainArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let (source, pipeline) = match opened(&args.pipeline, &args.overrides, registry, args.json, streams) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    let (plan, decided) = match planned(args, &pipeline) {
        Ok(both) => both,
        Err(e) => return fail_run(&pipeline, &e, args.json, streams),
    };
    let ablation = match ablation(args, &pipeline, streams) {
        Ok(ablation) => ablation,
        Err(e) => return failed(&e, streams),
    };
    let known = KnownCosts::of(&args.cache, args.threads);
    known.warning().iter().for_each(|warning| streams.warn(warning));
    let (costs, ablation) = (known.costs(), ablation.as_ref());
    let told = told(&Evidence { source: &source, pipeline: &pipeline, costs, ablation }, decided);
    let (forecasts, source) = (predict(&pipeline, costs), known.source());
    let qualities = standings(&args.pipeline, &args.overrides, &pipeline, registry);
    let explained = Explained { pipeline: &pipeline, qualities, plan, forecasts, source, told };
    match args.json {
        true => streams.say(json(&explained)),
        false => lines(&explained).iter().for_each(|line| streams.say(line)),
    }
    exit::DONE
}

type Planned = (Vec<Option<String>>, Vec<StageDecision>);

fn planned(args: &ExplainArgs, pipeline: &Pipeline) -> Result<Planned, RunError> {
    let options = RunOptions { until: args.until.clone(), ..RunOptions::default() };
    Ok((plan(pipeline, &options)?, decisions(pipeline, &options)?))
}

/// The ablation that is named; else that of the usual place, where it is of the pipeline as it is.
fn ablation(
    args: &ExplainArgs,
    pipeline: &Pipeline,
    streams: &mut Streams<'_>,
) -> Result<Option<Ablation>, StageError> {
    let usual = default_folder(&args.pipeline, quality(&args.overrides), "ablation");
    match &args.ablation {
        Some(folder) => read(folder, pipeline).map(Some),
        None if !usual.join("ablation.json").is_file() => Ok(None),
        None => {
            let read = read(&usual, pipeline);
            Ok(read.map_err(|e| streams.tell(format!("note: {}", e.message))).ok())
        }
    }
}

fn read(folder: &Path, pipeline: &Pipeline) -> Result<Ablation, StageError> {
    let path = folder.join("ablation.json");
    let refuse = |why: String| {
        StageError::invalid(format!("\"{}\" is not taken: {why}", path.display()))
            .hint("`toile trade PIPELINE --ablate` measures again")
    };
    let text = toile_core::read_text(&path).map_err(|e| refuse(e.to_string()))?;
    let ablation: Ablation = serde_json::from_str(&text).map_err(|e| refuse(e.to_string()))?;
    match ablation.is_of(pipeline) {
        true => Ok(ablation),
        false => Err(refuse("it is of another state of the pipeline".into())),
    }
}

fn lines(explained: &Explained<'_>) -> Vec<String> {
    let Explained { pipeline, qualities, plan, forecasts, source, told } = explained;
    let stages = pipeline.nodes.iter().zip(plan).map(|(n, skipped)| line(pipeline, n, skipped.as_deref()));
    let runs: Vec<&Forecast> =
        forecasts.iter().zip(plan).filter(|(_, s)| s.is_none()).map(|(f, _)| f).collect();
    let expected = forecast_lines(&runs, source);
    std::iter::once(title(pipeline, qualities))
        .chain(stages)
        .chain(improving(pipeline, plan))
        .chain(expected)
        .chain(decided::lines(told))
        .collect()
}

/// `vest: 14 stages, quality Draft; qualities: Draft (10 mm), Fine (2 mm)`.
fn title(pipeline: &Pipeline, qualities: &[JudgedQuality]) -> String {
    let chosen = pipeline.quality.as_ref().map_or_else(String::new, |q| format!(", quality {q}"));
    let words = quality_words(qualities);
    let known = if words.is_empty() { words } else { format!("; qualities: {words}") };
    format!("{}: {} stages{chosen}{known}", pipeline.name, pipeline.nodes.len())
}

/// `PoseGarment and Settle only improve on the garment before them: where one fails, that goes on`.
fn improving(pipeline: &Pipeline, plan: &[Option<String>]) -> Option<String> {
    let runs = pipeline.nodes.iter().zip(plan).filter(|(_, skipped)| skipped.is_none());
    let ids: Vec<&str> = runs.filter(|(n, _)| n.stage.improves()).map(|(n, _)| n.id.as_str()).collect();
    let (last, rest) = ids.split_last()?;
    let (names, verb, them) = match rest {
        [] => ((*last).to_owned(), "improves", "it"),
        rest => (format!("{} and {last}", rest.join(", ")), "improve", "them"),
    };
    Some(format!(
        "{names} only {verb} on what was made before {them}: where one fails, the run goes on without"
    ))
}

fn line(pipeline: &Pipeline, node: &Node, skipped: Option<&str>) -> String {
    let feeds: Vec<String> = node
        .card
        .inputs
        .iter()
        .zip(&node.inputs)
        .map(|(port, feed)| match feed {
            Feed::Node { node, .. } => format!("{} from {}", port.kind, pipeline.nodes[*node].id),
            Feed::RunLog => "the run so far".to_owned(),
            Feed::Nothing => format!("no {}: left out, the pipeline makes none", port.kind),
        })
        .collect();
    let takes = if feeds.is_empty() { "nothing".to_owned() } else { feeds.join(", ") };
    match skipped {
        None => format!("  run   {:<20} takes {takes}", node.id),
        Some(reason) => format!("  skip  {:<20} {reason}", node.id),
    }
}
