//! What an ablation comes to: the runs that are kept as the record that is shown.

use super::kept::{Came, KeptRecord};
use super::record::{Ablation, DecisionRow, EndedBudget, RuleVerdict, SCHEME, Unmeasured};
use super::turned::Turned;
use crate::digest::digest;
use toile_pipeline::Pipeline;

/// The ablation of a pipeline by the runs that are kept; `until` is the stage that they ended at.
pub(super) fn ablation(
    pipeline: &Pipeline,
    until: Option<String>,
    turned: &[Turned],
    kept: &KeptRecord,
    [done, all]: [usize; 2],
) -> Ablation {
    let rows: Vec<Option<DecisionRow>> = turned.iter().map(|t| row(t, kept)).collect();
    let missing = turned.iter().zip(&rows).filter(|(_, row)| row.is_none());
    let not_measured =
        missing.map(|(t, _)| Unmeasured { decided: t.decided.clone(), turned: t.by.clone() }).collect();
    Ablation {
        scheme: SCHEME,
        toile: env!("CARGO_PKG_VERSION").to_owned(),
        pipeline: pipeline.name.clone(),
        file: pipeline.file.clone(),
        base: digest(pipeline, &[]),
        date: kept.last().date.clone(),
        machine: kept.last().machine.clone(),
        until,
        reads: kept.reads().clone(),
        cpu_s: kept.own().into_values().collect(),
        rows: rows.into_iter().flatten().collect(),
        cut: (done < all).then_some(EndedBudget { done, all, not_measured }),
    }
}

/// The row of a decision; none where it was not turned round yet.
fn row(turned: &Turned, kept: &KeptRecord) -> Option<DecisionRow> {
    let came = kept.turned(&turned.by);
    if came.is_empty() {
        return None;
    }
    let (mut cpu_s, mut saved_s, mut change, mut failed) = (Vec::new(), Vec::new(), None, None);
    let is_cut = came.values().any(|c| c.is_cut());
    for came in came.into_values() {
        if let Came::Ran { cpu_s: cpu, saved_s: saved, change: found } = came {
            cpu_s.push(*cpu);
            saved_s.push(*saved);
            change = change.or(*found);
        }
        failed = failed.or(came.failed());
    }
    let change = change.filter(|_| failed.is_none());
    let verdict = match is_cut {
        true => RuleVerdict::Cut,
        false => RuleVerdict::of(change.as_ref(), turned.decided.decision.tolerance, &saved_s),
    };
    Some(DecisionRow {
        decided: turned.decided.clone(),
        turned: turned.by.clone(),
        cpu_s,
        saved_s,
        change,
        failed,
        verdict,
    })
}
