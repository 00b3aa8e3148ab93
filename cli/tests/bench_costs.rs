//! What stages take, measured by the program: each run in a process of its own.

use crate::sheet::sheet;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const PIPELINE: &str =
    "(name: \"sheet\", scene: Scene(file: \"sheet.json\"), stages: [StaticEquilibrium(speed: 0.01)])";

fn measured(dir: &Path, more: &[&str]) -> Output {
    fs::write(dir.join("sheet.ron"), PIPELINE).unwrap();
    let arguments = ["bench", "costs", "sheet.ron", "--work", "work", "--out", "all.jsonl"];
    let mut program = Command::new(env!("CARGO_BIN_EXE_toile"));
    program.current_dir(dir).args(arguments).args(more).output().unwrap()
}

fn lines(path: &Path) -> Vec<Value> {
    fs::read_to_string(path).unwrap().lines().map(|l| serde_json::from_str(l).unwrap()).collect()
}

#[test]
fn each_run_has_a_process_of_its_own_and_of_three_the_shortest_counts() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("sheet.json"), sheet().to_string()).unwrap();
    let answer = measured(
        dir.path(),
        &["--repeats", "3", "--threads", "1", "--set", "stages.StaticEquilibrium.speed=0.02"],
    );
    let (out, err) = (String::from_utf8_lossy(&answer.stdout), String::from_utf8_lossy(&answer.stderr));
    assert!(answer.status.success(), "{err}");
    assert!(out.starts_with("4 runs of stages on "), "{out}");
    assert_eq!(err, "sheet: edge x 1, photos x 1\n".repeat(3));
    let (all, last) = (lines(&dir.path().join("all.jsonl")), lines(&dir.path().join("work/run.jsonl")));
    assert_eq!((all.len(), last.len()), (5, 5), "a head and the stages");
    for (best, one) in all.iter().zip(&last).skip(1) {
        assert_eq!((&best["stage"], &best["key"], &best["threads"]), (&one["stage"], &one["key"], &json!(1)));
        assert!(best["used"]["wall_s"].as_f64().unwrap() <= one["used"]["wall_s"].as_f64().unwrap());
    }
}

#[test]
fn what_a_run_s_own_process_says_is_told_with_its_code() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("sheet.json"), "{}").unwrap();
    let answer = measured(dir.path(), &[]);
    let err = String::from_utf8_lossy(&answer.stderr);
    assert_eq!(answer.status.code(), Some(3), "{err}");
    assert!(err.contains("sheet.json") && !dir.path().join("all.jsonl").exists(), "{err}");
}
