//! The program as it starts itself for each run that it measures: memory of each run, equal
//! results, lost runs.
#![cfg(unix)]
#![allow(clippy::unwrap_used)]

mod sheet;

use serde_json::{Value, json};
use sheet::sheet;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::Arc;
use std::time::Duration;
use toile_core::{Cancel, Length};
use toile_trade::ablate;
use toile_trade::knobs::source::Source;
use toile_trade::measure::Bench;
use toile_trade::measure::apart::Apart;
use toile_trade::record::{Clock, SettingOutcome, Trade};
use toile_trade::study::{StudyOptions, study};

const PIPELINE: &str = "(scene: Scene(file: \"sheet.json\"), stages: [StaticEquilibrium(speed: 0.01)])";

fn folder() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("sheet.ron"), PIPELINE).unwrap();
    fs::write(dir.path().join("sheet.json"), sheet().to_string()).unwrap();
    dir
}

fn program(dir: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_toile")).current_dir(dir).args(arguments).output().unwrap()
}

const TRADE: [&str; 10] = [
    "trade",
    "sheet.ron",
    "--knob",
    "StaticEquilibrium.speed=0.001..0.1",
    "--repeats",
    "2",
    "--starts",
    "1",
    "--budget",
    "2m",
];

fn record(dir: &Path, out: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(dir.join(out).join("trade.json")).unwrap()).unwrap()
}

#[test]
fn every_run_has_its_own_memory_and_a_study_in_one_process_gives_the_same_garments() {
    let dir = folder();
    let answer = program(dir.path(), &[&TRADE[..], &["--points", "3", "--out", "apart"]].concat());
    let said =
        String::from_utf8_lossy(&answer.stderr).into_owned() + &String::from_utf8_lossy(&answer.stdout);
    assert!(answer.status.success(), "{said}");
    assert!(
        said.contains("MB: the most that each run's own process held")
            && !said.contains("share this process"),
        "{said}"
    );
    let apart = record(dir.path(), "apart");
    assert_eq!(apart["apart"], true);

    // The same as a function, in the process of this test.
    let file = dir.path().join("sheet.ron").display().to_string();
    let out = dir.path().join("here").display().to_string();
    let (mut print, mut tell) = (Vec::new(), Vec::new());
    let arguments =
        [&["toile", "trade", file.as_str()], &TRADE[2..], &["--points", "3", "--out", &out]].concat();
    assert_eq!(toile::command(arguments, &mut print, &mut tell), 0);
    let told = String::from_utf8_lossy(&tell).into_owned();
    assert!(told.contains("runs share this process: memory is the process's own"), "{told}");
    let here = record(dir.path(), "here");
    assert_eq!(here["apart"], false);
    let figures = |trade: &Value| {
        let points = trade["points"].as_array().unwrap().clone();
        let one = |p: &Value| {
            let m = &p["outcome"]["measured"];
            assert_eq!(m["repeatable"], true);
            assert!(!cfg!(target_os = "linux") || m["peak_memory_bytes"].as_u64().unwrap() > 1_000_000);
            (p["setting"].clone(), m["errors"].clone(), m["triangles"].clone())
        };
        points.iter().map(one).collect::<Vec<_>>()
    };
    assert_eq!(figures(&apart), figures(&here));
    assert_eq!(apart["reference"]["levels"][1]["moved_mm"], here["reference"]["levels"][1]["moved_mm"]);
    assert_eq!(apart["reference"]["spread"], here["reference"]["spread"]);
}

#[test]
fn a_study_goes_on_from_what_runs_apart_left() {
    let dir = folder();
    let with =
        |points: &str| program(dir.path(), &[&TRADE[..], &["--out", "out", "--points", points]].concat());
    assert!(with("2").status.success());
    let before = record(dir.path(), "out");
    let answer = with("3");
    assert!(String::from_utf8_lossy(&answer.stderr).contains("goes on from 2 settings"));
    let after = record(dir.path(), "out");
    assert_eq!(after["points"].as_array().unwrap()[..2], before["points"].as_array().unwrap()[..]);
}

/// Runs through a shell, which counts them and does something else in the place of the one of that
/// number.
fn shell(counter: &Path, number: usize, instead: &str) -> Option<Apart> {
    let counter = counter.display();
    let script = format!(
        "n=$(($(cat {counter} 2>/dev/null || echo 0)+1)); echo $n > {counter}; [ $n -eq {number} ] && {instead}; exec {} run-apart",
        env!("CARGO_BIN_EXE_toile")
    );
    Some(Apart { program: "/bin/sh".into(), launch: Vec::new(), arguments: vec!["-c".into(), script.into()] })
}

fn counted(counter: &Path) -> usize {
    fs::read_to_string(counter).unwrap().trim().parse().unwrap()
}

/// A study of three settings, the run of that number killed.
fn through_a_shell(dir: &Path, out: &str, kills: usize) -> (Trade, usize) {
    let counter = dir.join(format!("{out}.count"));
    let apart = shell(&counter, kills, "kill -9 $$");
    let registry = toile::registry();
    let (text, file, base) = (PIPELINE.to_owned(), "sheet.ron".to_owned(), dir.to_owned());
    let source = Source { text, file, base, quality: None, set: Vec::new(), registry: &registry };
    let options = StudyOptions {
        out: dir.join(out),
        budget: Duration::from_secs(120),
        limit: None,
        points: Some(3),
        repeats: 1,
        starts: 1,
        jitter: Length::mm(1.0),
        reference: Vec::new(),
        clock: Clock::Cpu,
        bench: Bench { until: None, cancel: Cancel::new(), listener: Arc::new(()), apart },
    };
    let knobs = ["StaticEquilibrium.speed=0.001..0.1".parse().unwrap()];
    let trade = study(&source, &source.load(&[]).unwrap(), &knobs, &options, &mut |_| ()).unwrap();
    (trade, counted(&counter))
}

#[test]
fn a_run_that_the_system_ends_is_a_failed_setting_and_the_study_goes_on() {
    let dir = folder();
    let (whole, runs) = through_a_shell(dir.path(), "whole", 0);
    assert!(whole.points.iter().all(|p| p.measured().is_some()));
    let (trade, again) = through_a_shell(dir.path(), "killed", runs - 1);
    assert_eq!((again, trade.points.len()), (runs, 3), "each setting is run once");
    let message = "the run's own process was ended by signal 9".to_owned();
    assert_eq!(trade.points[1].outcome, SettingOutcome::Failed { code: "internal".into(), message });
    for i in [0, 2] {
        let errors = |t: &Trade| t.points[i].measured().unwrap().errors.clone();
        assert_eq!(errors(&trade), errors(&whole));
    }
}

#[test]
fn an_ablation_that_the_user_ends_goes_on_from_the_runs_that_were_done() {
    let dir = folder();
    let (dir, counter) = (dir.path(), dir.path().join("count"));
    let registry = toile::registry();
    let text = "(scene: Scene(file: \"sheet.json\"), fabric: Preset(\"cotton poplin\"), stages: [StaticEquilibrium(speed: 0.01, precision: Double, asleep: false)])";
    let (text, file, base) = (text.to_owned(), "sheet.ron".to_owned(), dir.to_owned());
    let source = Source { text, file, base, quality: None, set: Vec::new(), registry: &registry };
    // A run that hangs is ended by the user.
    let session = |hangs: usize| {
        let apart = shell(&counter, hangs, "exec sleep 600");
        let (cancel, mut begun) = (Cancel::new(), 0);
        let bench = Bench { until: None, cancel: cancel.clone(), listener: Arc::new(()), apart };
        let options =
            ablate::AblationOptions { out: dir.join("out"), repeats: 2, budget: None, limit: None, bench };
        ablate::ablate(&source, &source.load(&[]).unwrap(), &options, &mut |_| {
            begun += 1;
            if begun == hangs {
                cancel.cancel();
            }
        })
    };
    let stopped = session(3).unwrap_err();
    assert_eq!((stopped.message.as_str(), stopped.code.exit_code()), ("stopped on request", 5));
    let all = session(0).unwrap();
    assert_eq!(counted(&counter), 5, "two runs, one that was ended, and the two that were left");
    assert_eq!((all.cpu_s.len(), all.rows.len(), all.rows[0].saved_s.len()), (2, 1, 2));
    assert!(all.rows[0].change.unwrap().same_bits && all.cut.is_none());
}

#[test]
fn a_process_without_a_parent_ends_by_itself() {
    let dir = folder();
    let mut child = Command::new(env!("CARGO_BIN_EXE_toile"))
        .current_dir(dir.path())
        .arg("run-apart")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let vest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pipelines/vest.ron");
    let task = json!({ "text": fs::read_to_string(&vest).unwrap(), "file": "vest.ron", "base": vest.parent().unwrap(),
        "until": null, "also": [], "moved": null, "cache": null, "threads": 1 });
    let mut input = child.stdin.take().unwrap();
    writeln!(input, "{task}").unwrap();
    drop(input);
    assert_eq!(child.wait().unwrap().code(), Some(5));
}

#[test]
fn the_command_is_hidden_and_refuses_what_is_no_task() {
    let dir = folder();
    let help = program(dir.path(), &["--help"]);
    assert!(!String::from_utf8_lossy(&help.stdout).contains("run-apart"));
    let answer = program(dir.path(), &["run-apart"]);
    // The input is at its end: either is right.
    assert!(matches!(answer.status.code(), Some(3 | 5)), "{answer:?}");
}
