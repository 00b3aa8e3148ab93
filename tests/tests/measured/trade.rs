//! `toile trade` and `toile tune` on a small sheet: measured, gone on with, picked, proved,
//! written.

use serde_json::Value;
use std::fs;
use std::path::Path;
use toile_tests::napkin::{self, PIPELINE};
use toile_tests::{Answer, toile};

fn trade(dir: &Path, more: &[&str]) -> Answer {
    let (file, out) = (dir.join("napkin.ron").display().to_string(), dir.join("out").display().to_string());
    let fixed = [
        "trade",
        &file,
        "--out",
        &out,
        "--knob",
        "StaticEquilibrium.speed=0.001..0.1",
        "--repeats",
        "1",
        "--starts",
        "1",
    ];
    toile(&[&fixed, more].concat())
}

fn record(dir: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(dir.join("out/trade.json")).unwrap()).unwrap()
}

#[test]
fn a_front_is_measured_gone_on_with_and_tuned_from() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    napkin::write(dir).unwrap();

    let first = trade(dir, &["--points", "3", "--budget", "2m"]);
    assert_eq!(first.code, 0, "{}{}", first.out, first.err);
    for file in ["trade.csv", "trade.json", "trade.svg", "trade.png", "trade.html", "trade.jsonl"] {
        assert!(dir.join("out").join(file).metadata().unwrap().len() > 100, "{file}");
    }
    let before = record(dir);
    assert_eq!(before["points"].as_array().unwrap().len(), 3);

    let second = trade(dir, &["--points", "4", "--budget", "2m"]);
    assert!(second.err.contains("goes on from 3 settings"), "{}", second.err);
    let after = record(dir);
    assert_eq!(after["points"].as_array().unwrap()[..3], before["points"].as_array().unwrap()[..]);
    assert_eq!(after["points"].as_array().unwrap().len(), 4);

    tuned(dir);
    refused(dir);
}

fn tune(dir: &Path, more: &[&str]) -> Answer {
    let (file, from) = (dir.join("napkin.ron").display().to_string(), dir.join("out").display().to_string());
    toile(&[&["tune", &file, "--from", &from, "--starts", "2"], more].concat())
}

/// A wide wish is kept, and the file keeps its comments.
fn tuned(dir: &Path) {
    let out = dir.join("quick.ron").display().to_string();
    let answer = tune(dir, &["--max-error", "20 cm", "--out", &out]);
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    assert!(answer.out.contains("2 of 2 moved starts within 200 mm"), "{}", answer.out);
    let text = fs::read_to_string(&out).unwrap();
    assert!(
        text.starts_with("// toile tune: 20") && text.contains("// A napkin held at two corners.\n(\n"),
        "{text}"
    );
    assert!(text.contains("),  // mine\n"), "{text}");
    assert_eq!(toile(&["validate", &out]).code, 0);
}

fn refused(dir: &Path) {
    let answer = tune(dir, &["--max-time", "0.001ms"]);
    assert_eq!(answer.code, 4, "{}{}", answer.out, answer.err);
    let words = "error: no setting of the measured front keeps a time of at most 0.000001 s\n  help: the most accurate keeps";
    assert!(answer.err.contains(words), "{}", answer.err);
    let elsewhere = tune(dir, &["--max-time", "1s", "--out", "elsewhere/quick.ron"]);
    assert_eq!(elsewhere.code, 3);
    assert!(
        elsewhere.err.starts_with("error: \"elsewhere/quick.ron\" is not in the folder of the pipeline\n"),
        "{}",
        elsewhere.err
    );
    fs::write(dir.join("napkin.ron"), PIPELINE.replace("0.01", "0.02")).unwrap();
    let stale = tune(dir, &["--max-time", "1s"]);
    assert!(stale.err.starts_with("error: the measurement is of another state of "), "{}", stale.err);
}

#[test]
fn a_budget_that_can_say_nothing_is_refused_with_the_least_that_can() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    napkin::write(dir).unwrap();
    let refused = |more: &[&str]| {
        let answer = trade(dir, more);
        assert_eq!(answer.code, 5, "{}{}", answer.out, answer.err);
        assert!(!dir.join("out/trade.json").exists());
        answer.err
    };
    let whole = refused(&["--budget", "0.1ms"]);
    let words = "error: a run of the pipeline as it is takes longer than the whole budget of ";
    assert!(whole.contains(words) && whole.contains("\n  help: give `--budget 1s` or more\n"), "{whole}");
    let limit = refused(&["--budget", "2m", "--limit", "0.1ms"]);
    let words = "error: a run may take 0.10 ms, and the pipeline as it is takes ";
    let every = ": every setting would be stopped\n  help: give `--limit 1s` or more\n";
    assert!(limit.contains(words) && limit.contains(every), "{limit}");
}

#[test]
fn faults_of_knobs_end_before_anything_runs() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    napkin::write(dir).unwrap();
    let answer = trade(dir, &["--knob", "StaticEquilibrium.sped=1..2"]);
    assert_eq!(
        (answer.code, answer.err.as_str()),
        (
            3,
            "error: `StaticEquilibrium` has no parameter `sped`\n  help: did you mean `StaticEquilibrium.speed`?\n"
        )
    );
    assert!(!dir.join("out").exists());
}
