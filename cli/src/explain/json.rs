//! `toile explain --json`: one object, described in docs/reference/costs.md.

use crate::explain::words::Explained;
use crate::validate::JudgedQuality;
use serde_json::{Value, json};
use toile_core::cost::Predicted;
use toile_core::{Feed, Node};
use toile_pipeline::{Basis, Pipeline};
use toile_trade::cost::{Forecast, total};
use toile_trade::decided::Told;

/// All that is said, for programs. SI units.
pub(crate) fn json(explained: &Explained<'_>) -> Value {
    let Explained { pipeline, qualities, plan, forecasts, source, told } = explained;
    let each = pipeline.nodes.iter().zip(plan).zip(forecasts);
    let stages: Vec<Value> =
        each.map(|((node, skipped), forecast)| stage(pipeline, node, skipped.as_deref(), forecast)).collect();
    let runs = forecasts.iter().zip(plan).filter(|(_, skipped)| skipped.is_none());
    let runs: Vec<&Predicted> = runs.map(|(f, _)| &f.predicted).collect();
    json!({
        "pipeline": pipeline.name,
        "file": pipeline.file,
        "quality": pipeline.quality,
        "qualities": qualities.iter().map(quality).collect::<Vec<_>>(),
        "stages": stages,
        "predicted": total(&runs),
        "predicted_from": source,
        "decisions": told.iter().map(decision).collect::<Vec<_>>(),
    })
}

fn stage(pipeline: &Pipeline, node: &Node, skipped: Option<&str>, forecast: &Forecast) -> Value {
    let fed = |feed: &Feed| match feed {
        Feed::Node { node, .. } => Some(pipeline.nodes[*node].id.as_str()),
        Feed::RunLog | Feed::Nothing => None,
    };
    let takes = node.card.inputs.iter().zip(&node.inputs).map(|(port, feed)| {
        json!({ "port": port.name, "kind": port.kind.0, "from": fed(feed), "is_run_log": *feed == Feed::RunLog })
    });
    json!({
        "id": node.id,
        "name": node.card.name,
        "role": node.card.role.as_str(),
        "runs": skipped.is_none(),
        "skipped": skipped,
        "improves": node.stage.improves(),
        "takes": takes.collect::<Vec<_>>(),
        "predicted": skipped.is_none().then_some(&forecast.predicted),
        "predicted_by_own_record": forecast.known,
        "measured_here": forecast.measured_here,
    })
}

fn quality(JudgedQuality { quality, standing, now }: &JudgedQuality) -> Value {
    let set: Vec<String> = quality.set.iter().map(|o| format!("{}={}", o.path, o.value)).collect();
    let digest = |basis: &Option<Basis>| basis.as_ref().map(Basis::to_string);
    json!({ "name": quality.name, "max_error_m": quality.max_error.metres(), "set": set, "measured": quality.measured,
        "measured_for": digest(&quality.basis), "this_pipeline": digest(now), "doubt": standing.words() })
}

fn decision(told: &Told) -> Value {
    let d = &told.decided.decision;
    json!({
        "stage": told.decided.stage,
        "rule": d.rule,
        "state": d.state,
        "what": d.what,
        "fact": d.fact,
        "tolerance": d.tolerance,
        "within": d.tolerance.to_string(),
        "saves": told.saving,
        "saves_in_words": told.saving.words(),
        "turned_round_by": told.turned,
        "source": d.source,
    })
}
