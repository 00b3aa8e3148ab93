//! Tasks and answers; whole processes are in the tests of the command.
#![allow(clippy::unwrap_used)]

use super::wire::{Task, read, write};
use super::{Apart, answer};
use crate::measure::{Missed, Ran};
use crate::surface::testing::sheet;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};
use toile_core::artifact::Figures;
use toile_core::{Cancel, ErrorCode, Length, Registry, StageError};

fn ran() -> Ran {
    let mut figures = Figures::default();
    figures.garment.edge_strain.p99 = 0.1 + 0.2;
    Ran {
        garment: sheet(3, 1.0),
        body: None,
        model: None,
        figures: Some(figures),
        stages_s: BTreeMap::from([("StaticEquilibrium".to_owned(), 0.25)]),
        wall_s: 1.5,
        cpu_s: 2.5,
        peak_memory_bytes: Some(123_456_789),
        reads: BTreeMap::from([("a.jpg".to_owned(), None)]),
    }
}

#[test]
fn an_answer_comes_back_bit_by_bit() {
    let back = read(&write(Ok(ran())).unwrap()).unwrap();
    let own = ran();
    assert_eq!(
        (back.garment.positions, back.garment.triangles),
        (own.garment.positions, own.garment.triangles)
    );
    assert_eq!((back.figures, back.stages_s, back.reads), (own.figures, own.stages_s, own.reads));
    assert_eq!((back.wall_s, back.cpu_s, back.peak_memory_bytes), (1.5, 2.5, Some(123_456_789)));
    assert!(back.body.is_none() && back.model.is_none());
}

#[test]
fn a_failure_comes_back_with_code_words_and_hint() {
    let e = StageError::new(ErrorCode::StitchingError, "a seam stays open").hint("sew it");
    let back = read(&write(Err(Missed::Failed(e.clone()))).unwrap());
    assert_eq!(back.unwrap_err(), Missed::Failed(e));
}

#[test]
fn what_is_no_answer_is_a_fault_and_no_panic() {
    let words = |bytes: &[u8]| match read(bytes) {
        Err(Missed::Failed(e)) => e.message,
        other => format!("{other:?}"),
    };
    assert_eq!(words(b""), "a run's own process answers with no whole line");
    let whole = write(Ok(ran())).unwrap();
    let line = whole.iter().position(|b| *b == b'\n').unwrap() + 1;
    assert_eq!(words(&whole[..line + 10]), "a run's own process answers with an artifact cut short");
    for cut in (0..whole.len()).step_by(37) {
        assert!(words(&whole[..cut]).starts_with("a run's own process answers with "), "{cut}");
    }
}

#[test]
fn a_task_goes_in_bit_by_bit() {
    let task = Task { text: "(\n)".into(), threads: 3, ..Task::default() }.moved((Length::mm(0.1), 7));
    let back: Task = serde_json::from_str(&serde_json::to_string(&task).unwrap()).unwrap();
    assert_eq!(back, task);
    assert_eq!(back.moved_by(), Some((Length::mm(0.1), 7)));
    assert_eq!(
        answer("x", &Registry::new()).unwrap_err(),
        "this is no task: expected value at line 1 column 1"
    );
}

#[test]
fn a_pipeline_that_does_not_load_is_the_runs_own_failure() {
    let task = Task { text: "(stages: [])".into(), file: "a.ron".into(), threads: 1, ..Task::default() };
    let bytes = answer(&serde_json::to_string(&task).unwrap(), &Registry::new()).unwrap();
    let Err(Missed::Failed(e)) = read(&bytes) else { unreachable!("it has no stages") };
    assert_eq!(e.message, "a.ron:1:10: `stages` holds no stage");
}

/// A program of the system in the place of this one.
#[cfg(unix)]
fn shell(script: &str) -> Apart {
    Apart { program: "/bin/sh".into(), launch: Vec::new(), arguments: vec!["-c".into(), script.into()] }
}

#[cfg(unix)]
fn failure(script: &str) -> StageError {
    match shell(script).run(&Task::default(), &Cancel::new()) {
        Err(Missed::Failed(e)) => e,
        other => unreachable!("{other:?}"),
    }
}

#[cfg(unix)]
#[test]
fn a_process_that_breaks_off_is_a_failed_run() {
    let killed = failure("kill -9 $$");
    assert_eq!(killed.message, "the run's own process was ended by signal 9");
    assert_eq!(killed.hint.unwrap(), "a system that is out of memory ends processes like this");
    let aborted = failure("echo first >&2; echo 'stack overflow' >&2; kill -6 $$");
    assert_eq!(aborted.message, "the run's own process was ended by signal 6: stack overflow");
    assert_eq!(aborted.hint, None);
    assert_eq!(failure("exit 70").message, "the run's own process ended with code 70");
    assert_eq!(failure("true").message, "a run's own process answers with no whole line");
    let gone = Apart { program: "no/such/program".into(), launch: Vec::new(), arguments: Vec::new() };
    let Err(Missed::Failed(e)) = gone.run(&Task::default(), &Cancel::new()) else {
        unreachable!("it is not there")
    };
    assert!(e.message.starts_with("a run's own process cannot be started: "), "{}", e.message);
}

/// By its status, since a shell that was started in the background ignores the signal itself.
#[cfg(unix)]
#[test]
fn a_process_that_ctrl_c_ended_was_cancelled() {
    use std::os::unix::process::ExitStatusExt;
    let status = std::process::ExitStatus::from_raw(2);
    assert_eq!(super::parent::broken_off(status, b"", &Cancel::new()), Missed::Cancelled);
}

#[cfg(unix)]
#[test]
fn ctrl_c_and_the_limit_end_a_process() {
    let endless = shell("exec sleep 600");
    let task = Task { limit: Some(Duration::from_millis(100)), ..Task::default() };
    let started = Instant::now();
    assert!(matches!(endless.run(&task, &Cancel::new()), Err(Missed::OverLimit(s)) if s >= 0.1));
    let cancel = Cancel::new();
    cancel.cancel();
    assert_eq!(endless.run(&Task::default(), &cancel).unwrap_err(), Missed::Cancelled);
    assert!(started.elapsed() < Duration::from_secs(300), "they were waited for");
}
