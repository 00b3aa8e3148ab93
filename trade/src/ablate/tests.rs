#![allow(clippy::unwrap_used)]
use super::kept::Came;
use super::*;
use crate::errors::Millimetres;
use crate::record::Machine;
use std::time::Duration;
use toile_core::decide::{Decision, Saves, State, Tolerance, Turn};
use toile_pipeline::decide::StageDecision;

fn change(p95: f64, same_bits: bool) -> GarmentChange {
    let mm = |x: f64| Millimetres { mean: x / 2.0, p95: x, max: 2.0 * x };
    GarmentChange {
        same_bits,
        distance_mm: mm(p95),
        outline_mm: mm(p95 / 10.0),
        texture_levels: Some(p95),
        crossings: [Some(0), Some(3)],
    }
}

fn row(tolerance: Tolerance, change: Option<GarmentChange>, saved_s: &[f64]) -> DecisionRow {
    let decision = Decision {
        rule: "few-pixels".into(),
        state: State::Simplified,
        what: "photos: fewer pixels".into(),
        fact: "large photos".into(),
        tolerance,
        saves: Saves::Modelled,
        source: "Nyquist 1928".into(),
        turn: Turn::Param { name: "pixel".into(), value: "\"0 mm\"".into() },
    };
    let decided = StageDecision { stage: "Mean".into(), decision };
    DecisionRow {
        turned: decided.words("stages.Mean"),
        decided,
        cpu_s: saved_s.iter().map(|s| 2.0 + s).collect(),
        saved_s: saved_s.to_vec(),
        change,
        failed: change.is_none().then(|| "Rest: it does not close".to_owned()),
        verdict: RuleVerdict::of(change.as_ref(), tolerance, saved_s),
    }
}

#[test]
fn a_run_that_was_stopped_at_its_limit_bears_nothing_out() {
    let cut = DecisionRow { verdict: RuleVerdict::Cut, ..row(Tolerance::SameBits, None, &[]) };
    assert_eq!(cut.verdict.as_str(), "not decided: turned round, the run was stopped at the limit");
}

#[test]
fn a_rule_is_borne_out_by_time_beyond_chance_and_by_its_tolerance() {
    let verdict =
        |tolerance, change: Option<GarmentChange>, saved: &[f64]| row(tolerance, change, saved).verdict;
    let (same, moved) = (Some(change(0.0, true)), Some(change(3.0, false)));
    assert_eq!(verdict(Tolerance::SameBits, same, &[0.1, 0.2]), RuleVerdict::Holds);
    assert_eq!(verdict(Tolerance::SameBits, same, &[0.1, -0.01]), RuleVerdict::SavesNothing);
    assert_eq!(verdict(Tolerance::SameBits, same, &[0.1]), RuleVerdict::SavesNothing, "one round is none");
    assert_eq!(verdict(Tolerance::SameBits, moved, &[0.1, 0.1]), RuleVerdict::ChangesMore);
    assert_eq!(verdict(Tolerance::Distance(3e-3), moved, &[0.1, 0.1]), RuleVerdict::Holds);
    assert_eq!(verdict(Tolerance::Distance(2.9e-3), moved, &[0.1, 0.1]), RuleVerdict::ChangesMore);
    assert_eq!(verdict(Tolerance::Outline(0.31e-3), moved, &[0.1, 0.1]), RuleVerdict::Holds);
    assert_eq!(verdict(Tolerance::Outline(0.29e-3), moved, &[0.1, 0.1]), RuleVerdict::ChangesMore);
    let painted = Some(GarmentChange { same_bits: true, ..change(3.0, true) });
    assert_eq!(verdict(Tolerance::Texture(3.0), painted, &[0.1, 0.1]), RuleVerdict::Holds);
    assert_eq!(verdict(Tolerance::Texture(2.9), painted, &[0.1, 0.1]), RuleVerdict::ChangesMore);
    assert_eq!(
        verdict(Tolerance::Texture(9.0), moved, &[0.1, 0.1]),
        RuleVerdict::ChangesMore,
        "the garment changed"
    );
    assert_eq!(
        verdict(Tolerance::SameBits, painted, &[0.1, 0.1]),
        RuleVerdict::ChangesMore,
        "the texture changed"
    );
    assert_eq!(verdict(Tolerance::SameBits, None, &[]), RuleVerdict::Needed);
}

fn ablation() -> Ablation {
    Ablation {
        scheme: SCHEME,
        toile: "0.1.0".into(),
        pipeline: "vest".into(),
        file: "vest.ron".into(),
        base: String::new(),
        date: "2026-11-22".into(),
        machine: Machine::here(),
        until: None,
        reads: std::collections::BTreeMap::new(),
        cpu_s: vec![2.0, 1.9, 2.2],
        rows: vec![
            row(Tolerance::Outline(1e-3), Some(change(3.0, false)), &[0.4, 0.5, 0.3]),
            row(Tolerance::SameBits, None, &[]),
        ],
        cut: None,
    }
}

/// The ablation as a budget cut it short.
fn cut() -> Ablation {
    let mut all = ablation();
    let last = all.rows.pop().unwrap();
    let not_measured = vec![Unmeasured { decided: last.decided, turned: last.turned }];
    Ablation { cut: Some(EndedBudget { done: 4, all: 9, not_measured }), ..all }
}

#[test]
fn the_table_word_for_word() {
    let words = "\
vest: as decided 2.00 s of processor time (from 1.90 to 2.20 s in 3 runs)
stage                rule               turned, s saved, s       +- |    95 %   worst  bits | outl 95   worst | texture | crossings  within
Mean                 few-pixels              2.40     0.40     0.12 |    3.00    6.00 other |   0.300   0.600 |    3.00 |      0, 3  outline 1 mm
    turned round by --set 'stages.Mean.pixel=\"0 mm\"'
    borne out
Mean                 few-pixels                 -        -        - |       -       -     - |       -       - |       - |         -  same bits
    turned round by --set 'stages.Mean.pixel=\"0 mm\"'
    borne out: turned round, the pipeline fails: Rest: it does not close
surface and outline in mm, texture in grey levels, crossings as decided and turned round; +- is twice the standard error of what was saved";
    assert_eq!(lines(&ablation()).join("\n"), words);
}

#[test]
fn a_table_that_was_cut_short_says_what_is_missing() {
    let told = lines(&cut());
    let words = "\
the budget ended after 4 of 9 runs; the same command goes on from there
    not measured: Mean few-pixels, turned round by --set 'stages.Mean.pixel=\"0 mm\"'";
    assert_eq!(told[told.len() - 2..].join("\n"), words);
    assert_eq!(csv(&cut()).lines().count(), 2, "rows of what was measured alone");
}

#[test]
fn the_file_word_for_word() {
    let words = "\
stage,rule,state,within,turned_round_by,cpu_s,cpu_turned_s,saved_s,saved_noise_s,same_bits,distance_mean_mm,distance_p95_mm,distance_max_mm,outline_p95_mm,outline_max_mm,texture_levels,crossings,crossings_turned,verdict
Mean,few-pixels,simplified,outline 1 mm,\"--set 'stages.Mean.pixel=\"\"0 mm\"\"'\",2,2.4,0.4,0.11547,false,1.5,3,6,0.3,0.6,3,0,3,borne out
Mean,few-pixels,simplified,same bits,\"--set 'stages.Mean.pixel=\"\"0 mm\"\"'\",2,,,,,,,,,,,,,borne out: turned round; the pipeline fails
";
    assert_eq!(csv(&ablation()), words);
}

#[test]
fn the_record_comes_back_as_it_was_written() {
    let all = ablation();
    let files = files(&all).unwrap();
    assert_eq!(files.iter().map(|f| f.path.as_str()).collect::<Vec<_>>(), ["ablation.csv", "ablation.json"]);
    assert_eq!(serde_json::from_slice::<Ablation>(&files[1].bytes).unwrap(), all);
    assert!(!String::from_utf8_lossy(&files[1].bytes).contains("cut"), "nothing is missing");
    let cut = cut();
    let json = serde_json::to_string(&cut).unwrap();
    assert!(json.contains(r#""cut":{"done":4,"all":9,"not_measured":[{"stage":"Mean","rule":"few-pixels""#));
    assert_eq!(serde_json::from_str::<Ablation>(&json).unwrap(), cut);
}

#[test]
fn a_run_that_was_stopped_stands_until_a_longer_limit_is_asked() {
    let stopped = Came::OverLimit { seconds: 5.0 };
    let stands = |limit: Option<u64>| stopped.stands(limit.map(Duration::from_secs));
    assert_eq!([stands(Some(5)), stands(Some(6)), stands(None)], [true, false, false]);
    assert!(Came::Failed { message: "it tears".into() }.stands(None));
    assert_eq!(stopped.failed().unwrap(), "stopped after 5 s");
}
