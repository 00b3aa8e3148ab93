//! `toile explain`: what a run would do, what it would leave out, and why.

use crate::args::ExplainArgs;
use crate::costs::Known;
use crate::trade::opened;
use crate::{Streams, exit};
use toile_core::decide::decisions;
use toile_core::pipeline::{Feed, Node, Pipeline, Quality};
use toile_core::{Registry, RunOptions, plan};
use toile_trade::cost::{Forecast, forecast_lines, predict};
use toile_trade::decided::{self, told};

/// Prints one line a stage: what feeds it, and whether it runs.
pub(crate) fn explain(args: &ExplainArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let (source, pipeline) = match opened(&args.pipeline, &args.overrides, registry, streams) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    let options = RunOptions { until: args.until.clone(), ..RunOptions::default() };
    let (plan, decided) =
        match plan(&pipeline, &options).and_then(|p| Ok((p, decisions(&pipeline, &options)?))) {
            Ok(both) => both,
            Err(e) => {
                streams.tell(format!("error: {e}"));
                return exit::INVALID;
            }
        };
    streams.say(title(&pipeline));
    for (node, skipped) in pipeline.nodes.iter().zip(&plan) {
        streams.say(line(&pipeline, node, skipped.as_deref()));
    }
    let known = expected(args, &pipeline, &plan, streams);
    let told = told(&source, &pipeline, decided, &known.costs);
    decided::lines(&told).iter().for_each(|line| streams.say(line));
    exit::DONE
}

/// `vest: 14 stages, quality Draft; qualities: Draft (10 mm), Fine (2 mm)`.
fn title(pipeline: &Pipeline) -> String {
    let chosen = pipeline.quality.as_ref().map_or_else(String::new, |q| format!(", quality {q}"));
    let words: Vec<String> = pipeline.qualities.iter().map(Quality::words).collect();
    let known = if words.is_empty() { String::new() } else { format!("; qualities: {}", words.join(", ")) };
    format!("{}: {} stages{chosen}{known}", pipeline.name, pipeline.nodes.len())
}

/// What the stages that run are expected to take.
fn expected(
    args: &ExplainArgs,
    pipeline: &Pipeline,
    plan: &[Option<String>],
    streams: &mut Streams<'_>,
) -> Known {
    let known = Known::open(&args.cache, args.threads);
    if let Some(warning) = &known.warning {
        streams.tell(format!("warning: {warning}"));
    }
    let forecasts = predict(pipeline, &known.costs);
    let runs: Vec<&Forecast> =
        forecasts.iter().zip(plan).filter(|(_, s)| s.is_none()).map(|(f, _)| f).collect();
    forecast_lines(&runs, &known.source()).iter().for_each(|line| streams.say(line));
    known
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
