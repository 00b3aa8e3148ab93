//! A panic of a stage, of the runner and of the loader: exit code 70, who it was and what to do,
//! and nothing else.
#![allow(clippy::unwrap_used, clippy::panic)]

use serde_json::Value;
use std::fs;
use std::process::Command;
use toile_core::param::ParamType;
use toile_core::prelude::*;
use toile_core::serde::{Deserialize, Deserializer};

/// Panics when it runs.
#[stage(role = Writer)]
struct Breaks {}

#[stage]
impl Breaks {
    fn run(&self, _cx: &Context) -> Result<OutputFiles, StageError> {
        let none: Vec<u8> = Vec::new();
        panic!("index {} of a list of {}", 3, none.len());
    }
}

/// A value that panics when it is read.
#[derive(Debug, Clone, Default, PartialEq, toile_core::serde::Serialize)]
#[serde(crate = "toile_core::serde")]
struct Unreadable;

impl<'de> Deserialize<'de> for Unreadable {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        panic!("it cannot be read");
    }
}

impl ParamType for Unreadable {
    fn describe() -> String {
        "nothing".into()
    }
}

/// Its parameter panics in the loader.
#[stage(role = Writer)]
struct Misread {
    /// What cannot be read.
    what: Unreadable,
}

#[stage]
impl Misread {
    fn run(&self, _cx: &Context) -> Result<OutputFiles, StageError> {
        Ok(OutputFiles(Vec::new()))
    }
}

/// Its check before the run panics.
#[stage(role = Writer)]
struct Lies {}

#[stage]
impl Lies {
    fn run(&self, _cx: &Context) -> Result<OutputFiles, StageError> {
        Ok(OutputFiles(Vec::new()))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        panic!("a check that fails");
    }
}

fn registry() -> Registry {
    let mut r = Registry::new();
    r.add::<Breaks>().add::<Misread>().add::<Lies>();
    r
}

fn run(stages: &str, more: &[&str]) -> (u8, String, String) {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("p.ron");
    fs::write(&file, format!("(stages: [{stages}])")).unwrap();
    let (file, out) = (file.display().to_string(), dir.path().join("out").display().to_string());
    let all = [&["toile", "run", &file, "--no-cache", "--out", &out][..], more].concat();
    let (mut said, mut told) = (Vec::new(), Vec::new());
    let code = toile::command_with(&registry(), all, &mut said, &mut told);
    (code, String::from_utf8(said).unwrap(), String::from_utf8(told).unwrap())
}

const HELP: &str = "this is a bug, please report it with the pipeline and the command";

#[test]
fn a_stage_that_panics_is_named() {
    let (code, _, err) = run("Breaks()", &[]);
    let words = err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(code, 70);
    assert!(words.contains("× Breaks: the stage panicked: index 3 of a list of 0"), "{err}");
    assert!(words.contains(&format!("help: {HELP}")), "{err}");
    let (code, out, _) = run("Breaks()", &["--json"]);
    let said: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (code, &said["error"], &said["stage"], &said["hint"]),
        (70, &"internal".into(), &"Breaks".into(), &HELP.into())
    );
}

#[test]
fn a_panic_anywhere_else_is_told_as_a_bug() {
    let expected = "the program panicked: it cannot be read";
    let (code, out, err) = run("Misread(what: 3)", &[]);
    assert_eq!((code, out.as_str()), (70, ""));
    assert_eq!(err, format!("error: {expected}\n  help: {HELP}\n"));
    let (code, out, _) = run("Misread(what: 3)", &["--json"]);
    let said: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (code, said),
        (70, serde_json::json!({ "error": "internal", "message": expected, "hint": HELP }))
    );
}

#[test]
fn a_check_before_the_run_that_panics_is_left_out() {
    assert_eq!(run("Lies()", &[]).0, 0);
}

/// Called by the next test as a program of its own.
#[test]
#[ignore = "a program for the test beside it"]
fn program() {
    // By itself, as `--include-ignored` calls it, it has nothing to do.
    let Ok(file) = std::env::var("TOILE_TEST_FILE") else { return };
    let out = file.clone() + ".out";
    let arguments = ["toile", "run", &file, "--no-cache", "--out", &out];
    let code = toile::program(&registry(), arguments, &mut std::io::stdout(), &mut std::io::stderr());
    std::process::exit(i32::from(code));
}

#[test]
fn the_program_prints_no_trace_unless_it_is_asked_to_and_names_the_place() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("p.ron");
    fs::write(&file, "(stages: [Breaks()])").unwrap();
    let call = |trace: &str| {
        let mut program = Command::new(std::env::current_exe().unwrap());
        program.args(["--ignored", "--exact", "--nocapture", "program"]);
        let output = program.env("TOILE_TEST_FILE", &file).env("RUST_BACKTRACE", trace).output().unwrap();
        assert_eq!(output.status.code(), Some(70));
        String::from_utf8(output.stderr).unwrap()
    };
    let quiet = call("0");
    assert!(!quiet.contains("panicked at") && !quiet.contains("stack backtrace"), "{quiet}");
    assert!(quiet.contains("cli/tests/panics.rs:"), "{quiet}");
    assert!(call("1").contains("stack backtrace"));
}
