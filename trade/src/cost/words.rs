//! What people read of forecasts.

use super::check::{PredictionCheck, StageVerdict, Tally, is_right};
use super::predict::{Forecast, total};
use toile_core::cost::{Estimate, Predicted, Used};
use toile_pipeline::cache::Bytes;

/// A time as people read it.
pub(crate) fn time(s: f64) -> String {
    match s {
        s if s < 1e-3 => format!("{:.2} ms", s * 1e3),
        s if s < 1e-2 => format!("{:.1} ms", s * 1e3),
        s if s < 1.0 => format!("{:.0} ms", s * 1e3),
        s if s < 100.0 => format!("{s:.1} s"),
        s => format!("{s:.0} s"),
    }
}

fn bytes(b: f64) -> String {
    Bytes(b as u64).to_string()
}

fn range(e: Option<Estimate>, write: fn(f64) -> String) -> String {
    e.map_or_else(
        || "not known".to_owned(),
        |e| format!("{} ({} to {})", write(e.value), write(e.low), write(e.high)),
    )
}

fn row(name: &str, p: &Predicted) -> String {
    format!("  {name:<20} {:<30} {}", range(p.wall_s, time), range(p.peak_bytes, bytes)).trim_end().to_owned()
}

/// The forecast of a pipeline's stages, all of which run.
pub fn forecast_lines(forecasts: &[&Forecast], source: &str) -> Vec<String> {
    let mut lines = vec![
        "expected where nothing comes from the cache: wall time and memory at its peak beyond what is held before".to_owned(),
        format!("(80 of 100 runs lie in the range; {source})"),
    ];
    for f in forecasts {
        let mark = match (f.known, f.measured_here) {
            (false, _) => "  no record of it; others of its role stand in",
            (true, false) => "  not measured here",
            (true, true) => "",
        };
        lines.push(row(&f.stage, &f.predicted) + mark);
    }
    let all: Vec<&Predicted> = forecasts.iter().map(|f| &f.predicted).collect();
    lines.push(row("all, one by one", &total(&all)));
    lines
}

/// Prediction beside fact, a line a stage that ran whole, and how many were right.
pub fn beside(stages: &[(&str, Used, Predicted)]) -> Vec<String> {
    let mut lines = Vec::new();
    let mut tally = Tally::default();
    for (name, used, predicted) in stages {
        let took = match used.peak_bytes {
            Some(peak) => format!("{}, {}", time(used.wall_s), Bytes(peak)),
            None => time(used.wall_s),
        };
        let expected = [range(predicted.wall_s, time), range(predicted.peak_bytes, bytes)].join(", ");
        lines.push(format!("  {name:<20} took {took:<18} expected {expected}"));
        if let Some(e) = predicted.wall_s {
            tally.add(is_right(e.value, used.wall_s), e.holds(used.wall_s));
        }
    }
    if tally.count > 0 {
        lines.push(format!(
            "expected times: {} of {} within 30 %, {} in the range of 80 %",
            tally.right, tally.count, tally.in_range
        ));
    }
    lines
}

fn share(tally: &Tally) -> String {
    format!("{:.0} % ({} of {})", tally.share() * 100.0, tally.right, tally.count)
}

/// The table of a check.
pub fn check_lines(check: &PredictionCheck) -> Vec<String> {
    let (write, least): (fn(f64) -> String, _) =
        if check.figure.is_time() { (time, "1 ms") } else { (bytes, "1 MB") };
    let mut lines = vec![
        format!("{}: prediction / fact on pipelines left out of the fit", check.figure.as_str()),
        format!(
            "  {:<11} {:<21} {:>4} {:>10} {:>7} {:>7} {:>7}  within 30 %",
            "pipeline", "stage", "runs", "fact", "least", "middle", "most"
        ),
    ];
    lines.extend(check.stages.iter().map(|v| verdict(v, &write(v.fact))));
    lines.push(format!(
        "within 30 %: {} of all, {} of those above {least}, {} of these where other pipelines have the stage",
        share(&check.all),
        share(&check.telling),
        share(&check.met)
    ));
    let covered = check.telling.in_range as f64 / check.telling.count.max(1) as f64;
    lines.push(format!("in the range of 80 %: {:.0} % of those above {least}", covered * 100.0));
    lines
}

fn verdict(v: &StageVerdict, fact: &str) -> String {
    let at = |share: f64| {
        let i = ((v.ratios.len().saturating_sub(1)) as f64 * share).round() as usize;
        v.ratios.get(i).map_or_else(|| "-".to_owned(), |r| format!("{r:.2}"))
    };
    format!(
        "  {:<11} {:<21} {:>4} {fact:>10} {:>7} {:>7} {:>7}  {} of {}{}",
        v.pipeline,
        v.stage,
        v.tally.count,
        at(0.0),
        at(0.5),
        at(1.0),
        v.tally.right,
        v.tally.count,
        if v.stand_in { "  others of its role stand in" } else { "" }
    )
}
