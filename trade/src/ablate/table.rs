//! An ablation as lines of text: a table for people, comma-separated values for programs.

use super::record::{Ablation, DecisionRow, EndedBudget, GarmentChange};
use crate::record::median;
use std::fmt::Write;

/// The table: a line a decision, and below it how it is turned round and what the rule comes to.
pub fn lines(ablation: &Ablation) -> Vec<String> {
    let mut lines = vec![as_decided(ablation), head()];
    for row in &ablation.rows {
        lines.push(line(row));
        lines.push(format!("    turned round by {}", row.turned));
        let why = row.failed.as_ref().map_or_else(String::new, |why| format!(": {why}"));
        lines.push(format!("    {}{why}", row.verdict.as_str()));
    }
    lines.push("surface and outline in mm, texture in grey levels, crossings as decided and turned round; +- is twice the standard error of what was saved".into());
    lines.extend(ablation.cut.iter().flat_map(missing));
    lines
}

fn as_decided(ablation: &Ablation) -> String {
    let runs = &ablation.cpu_s;
    format!(
        "{}: as decided {:.2} s of processor time (from {:.2} to {:.2} s in {} runs)",
        ablation.pipeline,
        median(runs),
        runs.iter().copied().fold(f64::INFINITY, f64::min),
        runs.iter().copied().fold(0.0, f64::max),
        runs.len()
    )
}

fn head() -> String {
    format!(
        "{:<20} {:<18} {:>9} {:>8} {:>8} | {:>7} {:>7} {:>5} | {:>7} {:>7} | {:>7} | {:>9}  within",
        "stage",
        "rule",
        "turned, s",
        "saved, s",
        "+-",
        "95 %",
        "worst",
        "bits",
        "outl 95",
        "worst",
        "texture",
        "crossings"
    )
}

/// What a budget that ended leaves open.
fn missing(cut: &EndedBudget) -> Vec<String> {
    let mut lines = vec![format!(
        "the budget ended after {} of {} runs; the same command goes on from there",
        cut.done, cut.all
    )];
    for u in &cut.not_measured {
        lines.push(format!(
            "    not measured: {} {}, turned round by {}",
            u.decided.stage, u.decided.decision.rule, u.turned
        ));
    }
    lines
}

fn line(row: &DecisionRow) -> String {
    let seconds = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |s| format!("{s:.2}"));
    let saved = row.saved();
    let time = (!row.cpu_s.is_empty()).then(|| median(&row.cpu_s));
    let mut text = format!(
        "{:<20} {:<18} {:>9} {:>8} {:>8} | ",
        row.decided.stage,
        row.decided.decision.rule,
        seconds(time),
        seconds(saved.map(|s| s.mean)),
        seconds(saved.map(|s| s.noise))
    );
    let _ = match &row.change {
        Some(c) => write!(
            text,
            "{:>7.2} {:>7.2} {:>5} | {:>7.3} {:>7.3} | {:>7} | {:>9}",
            c.distance_mm.p95,
            c.distance_mm.max,
            if c.same_bits { "same" } else { "other" },
            c.outline_mm.p95,
            c.outline_mm.max,
            c.texture_levels.map_or_else(|| "-".to_owned(), |t| format!("{t:.2}")),
            crossings(c),
        ),
        None => {
            write!(text, "{:>7} {:>7} {:>5} | {:>7} {:>7} | {:>7} | {:>9}", "-", "-", "-", "-", "-", "-", "-")
        }
    };
    format!("{text}  {}", row.decided.decision.tolerance)
}

fn crossings(c: &GarmentChange) -> String {
    let [a, b] = c.crossings.map(|n| n.map_or_else(|| "-".to_owned(), |n| n.to_string()));
    format!("{a}, {b}")
}

/// The columns of the file.
const HEAD: &str = "stage,rule,state,within,turned_round_by,cpu_s,cpu_turned_s,saved_s,saved_noise_s,same_bits,\
    distance_mean_mm,distance_p95_mm,distance_max_mm,outline_p95_mm,outline_max_mm,texture_levels,crossings,\
    crossings_turned,verdict\n";

/// All rows as comma-separated values, a head line first; empty where a figure is not known.
pub fn csv(ablation: &Ablation) -> String {
    let own = median(&ablation.cpu_s);
    let rows = ablation.rows.iter().map(|row| values(row, own) + "\n");
    std::iter::once(HEAD.to_owned()).chain(rows).collect()
}

/// The values of a row; `own` is the time as decided.
fn values(row: &DecisionRow, own: f64) -> String {
    let d = &row.decided.decision;
    let turned = (!row.cpu_s.is_empty()).then(|| median(&row.cpu_s));
    let noise = row.saved().map(|s| s.noise).filter(|n| n.is_finite());
    let same = row.change.map_or("", |c| if c.same_bits { "true" } else { "false" });
    format!(
        "{},{},{},{},\"{}\",{},{same},{},{}",
        row.decided.stage,
        d.rule,
        d.state.as_str(),
        d.tolerance,
        row.turned.replace('"', "\"\""),
        listed(&[Some(own), turned, row.saved().map(|s| s.mean), noise]),
        listed(&changes(row.change.as_ref())),
        row.verdict.as_str().replace(',', ";")
    )
}

fn changes(change: Option<&GarmentChange>) -> [Option<f64>; 8] {
    let Some(c) = change else { return [None; 8] };
    let [own, turned] = c.crossings.map(|n| n.map(|n| n as f64));
    let (d, outline) = (&c.distance_mm, &c.outline_mm);
    let known = [d.mean, d.p95, d.max, outline.p95, outline.max].map(Some);
    let [mean, p95, max, outline_p95, outline_max] = known;
    [mean, p95, max, outline_p95, outline_max, c.texture_levels, own, turned]
}

fn listed(numbers: &[Option<f64>]) -> String {
    let one = |x: &Option<f64>| x.map_or_else(String::new, |x| format!("{}", (x * 1e6).round() / 1e6));
    numbers.iter().map(one).collect::<Vec<_>>().join(",")
}
