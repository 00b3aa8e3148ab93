//! `toile trade --ablate` on a small sheet: kept run by run, gone on with, started anew, cut short
//! by its budget.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use toile_core::{Cancel, StageError};
use toile_tests::{Answer, napkin, toile};
use toile_trade::ablate::{Ablation, AblationOptions, AblationProgress, DecisionRow, RunStep, ablate, csv};
use toile_trade::knobs::source::Source;
use toile_trade::measure::Bench;

/// The napkin with a body and a cloth that nothing asks for: two decisions.
const PIPELINE: &str = r#"(
    name: "napkin",
    scene: Scene(file: "napkin.json"),
    body: Mannequin(edge: "22 mm"),
    fabric: Preset("cotton poplin"),
    stages: [ StaticEquilibrium(speed: 0.01, precision: Double, asleep: false), GarmentObj() ],
)
"#;

/// Runs in two rounds: as decided and with each decision turned round.
const RUNS: usize = 6;

fn folder() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    napkin::write(dir.path()).unwrap();
    fs::write(dir.path().join("napkin.ron"), PIPELINE).unwrap();
    dir
}

/// What a session is asked, beside the pipeline.
#[derive(Clone, Copy)]
struct Asked {
    rounds: usize,
    budget: Option<Duration>,
    /// The run at which the user stops everything, from 1.
    stop_at: usize,
}

const TWO_ROUNDS: Asked = Asked { rounds: 2, budget: None, stop_at: usize::MAX };
const ONE_ROUND: Asked = Asked { rounds: 1, ..TWO_ROUNDS };

fn record(dir: &Path) -> PathBuf {
    dir.join("out/ablation.jsonl")
}

/// Ablates in this process; gives the runs that were begun as well, and the notes.
fn session(dir: &Path, asked: Asked) -> (Result<Ablation, StageError>, Vec<RunStep>, Vec<String>) {
    let registry = toile::registry();
    let file = dir.join("napkin.ron");
    let source = Source {
        text: fs::read_to_string(&file).unwrap(),
        file: file.display().to_string(),
        base: dir.to_owned(),
        quality: None,
        set: Vec::new(),
        registry: &registry,
    };
    let cancel = Cancel::new();
    let bench = Bench { until: None, cancel: cancel.clone(), listener: Arc::new(()), apart: None };
    let (out, budget) = (dir.join("out"), asked.budget);
    let options = AblationOptions { out, repeats: asked.rounds, budget, limit: None, bench };
    let (mut steps, mut notes) = (Vec::new(), Vec::new());
    let result = ablate(&source, &source.load(&[]).unwrap(), &options, &mut |progress| match progress {
        AblationProgress::Note(note) => notes.push(note),
        AblationProgress::Run(step) => {
            steps.push(step);
            if steps.len() == asked.stop_at {
                cancel.cancel();
            }
        }
    });
    (result, steps, notes)
}

fn whole(dir: &Path) -> Ablation {
    session(dir, ONE_ROUND).0.unwrap()
}

/// An ablation without what depends on times and on the machine's load.
fn timeless(a: &Ablation) -> impl PartialEq + std::fmt::Debug + use<> {
    let row = |r: &DecisionRow| {
        let runs = (r.cpu_s.len(), r.saved_s.len());
        (r.decided.clone(), r.turned.clone(), runs, r.change, r.failed.clone())
    };
    (a.base.clone(), a.cpu_s.len(), a.rows.iter().map(row).collect::<Vec<_>>(), a.cut.clone())
}

#[test]
fn stopped_at_any_run_and_gone_on_with_it_is_as_in_one_go() {
    let one_go = folder();
    let (all, steps, notes) = session(one_go.path(), TWO_ROUNDS);
    let all = all.unwrap();
    let done: Vec<usize> = steps.iter().map(|s| s.done).collect();
    assert_eq!((done, notes), ((0..RUNS).collect(), Vec::new()));
    assert_eq!((all.rows.len(), all.cpu_s.len(), &all.cut), (2, 2, &None));
    assert!(all.rows.iter().all(|r| r.saved_s.len() == 2 && r.change.unwrap().same_bits));
    // In the first round, at the border of two, at the very end.
    for stop_at in [1, 3, 4, RUNS] {
        let dir = folder();
        let dir = dir.path();
        let (stopped, steps, _) = session(dir, Asked { stop_at, ..TWO_ROUNDS });
        assert_eq!((stopped.unwrap_err().message.as_str(), steps.len()), ("stopped on request", stop_at));
        assert_eq!(record(dir).exists(), stop_at > 1, "a run that is done is kept");
        let (again, steps, notes) = session(dir, TWO_ROUNDS);
        assert_eq!(timeless(&again.unwrap()), timeless(&all), "stopped at {stop_at}");
        // One more run as decided stands beside what is left of a round.
        let left = RUNS + 1 - stop_at;
        let beside = usize::from(stop_at % 3 != 1);
        assert_eq!(steps.len(), left + beside, "{steps:?}");
        if beside == 1 {
            let round = stop_at.div_ceil(3);
            assert_eq!(steps[0].what, format!("as decided, beside the rest of round {round}"));
        }
        let told = format!("goes on from {} runs in {}", stop_at - 1, dir.join("out").display());
        assert_eq!(notes, if stop_at > 1 { vec![told] } else { Vec::new() });
        assert!(files(dir).iter().all(|f| f == "ablation.jsonl"), "whole files alone: {:?}", files(dir));
    }
}

fn files(dir: &Path) -> Vec<String> {
    let names = fs::read_dir(dir.join("out")).unwrap();
    names.map(|f| f.unwrap().file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn what_is_done_is_not_run_again_and_further_rounds_are_added() {
    let dir = folder();
    let all = whole(dir.path());
    let (again, steps, _) = session(dir.path(), ONE_ROUND);
    assert_eq!((again.unwrap(), steps.len()), (all.clone(), 0), "to the last bit");
    let (more, steps, _) = session(dir.path(), TWO_ROUNDS);
    let more = more.unwrap();
    assert_eq!((more.cpu_s.len(), steps.len()), (2, 3));
    assert_eq!((more.cpu_s[0], more.rows[0].saved_s[0]), (all.cpu_s[0], all.rows[0].saved_s[0]));
}

#[test]
fn what_has_changed_starts_anew_and_says_so() {
    let dir = folder();
    let dir = dir.path();
    let before = whole(dir);
    let put_aside = |why: &str| vec![format!("what is in {} is put aside: {why}", dir.join("out").display())];
    fs::write(dir.join("napkin.ron"), PIPELINE.replace("0.01", "0.02")).unwrap();
    let (after, steps, notes) = session(dir, ONE_ROUND);
    let why = "the pipeline, --until, the machine or its number of threads has changed";
    assert_eq!((notes, steps.len()), (put_aside(why), RUNS / 2));
    assert_ne!(after.unwrap().base, before.base);
    assert!(dir.join("out/ablation.old.jsonl").exists());
    let scene = dir.join("napkin.json");
    fs::write(&scene, fs::read_to_string(&scene).unwrap().replace("500.0", "400.0")).unwrap();
    let (_, steps, notes) = session(dir, ONE_ROUND);
    assert_eq!((notes, steps.len()), (put_aside(&format!("\"{}\" has changed", scene.display())), RUNS / 2));
}

#[test]
fn a_torn_record_loses_a_run_which_is_told_with_its_place_and_made_again() {
    let dir = folder();
    let dir = dir.path();
    let all = whole(dir);
    let path = record(dir);
    let text = fs::read(&path).unwrap();
    // The last line without its end.
    fs::write(&path, &text[..text.len() - 20]).unwrap();
    let (again, steps, notes) = session(dir, ONE_ROUND);
    assert_eq!(timeless(&again.unwrap()), timeless(&all));
    assert_eq!(steps.len(), 2, "the run itself, and one as decided beside it");
    let place = format!("{}:{}:", path.display(), RUNS / 2 + 1);
    assert!(notes[0].starts_with(&place) && notes[0].contains(": the line is damaged and left out: EOF"));
    assert_eq!(notes[1], format!("goes on from {} runs in {}", RUNS / 2 - 1, dir.join("out").display()));
    // The first line is what all others rest on.
    fs::write(&path, &text[..40]).unwrap();
    let (_, steps, notes) = session(dir, ONE_ROUND);
    let why = "it is of another version or damaged";
    assert_eq!(notes, [format!("what is in {} is put aside: {why}", dir.join("out").display())]);
    assert_eq!(steps.len(), RUNS / 2);
}

#[test]
fn the_end_of_the_budget_leaves_what_was_measured_and_says_what_was_not() {
    let none = Asked { budget: Some(Duration::ZERO), ..TWO_ROUNDS };
    let dir = folder();
    let (nothing, steps, _) = session(dir.path(), none);
    let e = nothing.unwrap_err();
    assert_eq!(
        (e.message.as_str(), steps.len()),
        ("the budget ended before the pipeline as it is had run once", 0)
    );
    assert_eq!((e.hint.as_deref(), e.code.exit_code()), (Some("give a longer --budget"), 5));
    session(dir.path(), Asked { stop_at: 3, ..TWO_ROUNDS }).0.unwrap_err();
    let (some, steps, _) = session(dir.path(), none);
    let some = some.unwrap();
    let cut = some.cut.as_ref().unwrap();
    assert_eq!((cut.done, cut.all, steps.len()), (2, RUNS, 0));
    let missing: Vec<&str> = cut.not_measured.iter().map(|u| u.turned.as_str()).collect();
    assert_eq!((missing, some.rows.len()), (vec!["--also Preset"], 1));
    assert_eq!(csv(&some).lines().count(), 2);
    assert_eq!(whole(dir.path()).cut, None, "the next session ends it");
}

fn command(dir: &Path, more: &[&str]) -> Answer {
    let (file, out) = (dir.join("napkin.ron").display().to_string(), dir.join("out").display().to_string());
    toile(&[&["trade", &file, "--ablate", "--repeats", "2", "--out", &out], more].concat())
}

#[test]
fn the_command_keeps_its_budget() {
    let dir = folder();
    let dir = dir.path();
    let none = command(dir, &["--budget", "0.001ms"]);
    let words =
        "error: the budget ended before the pipeline as it is had run once\n  help: give a longer --budget\n";
    assert_eq!((none.code, none.err.as_str()), (5, words));
    assert!(!dir.join("out/ablation.json").exists());
    session(dir, Asked { stop_at: 3, ..TWO_ROUNDS }).0.unwrap_err();
    // The record of a session on as many threads.
    let some = command(dir, &["--budget", "0.001ms"]);
    assert_eq!(some.code, 0, "{}", some.err);
    let words = "
the budget ended after 2 of 6 runs; the same command goes on from there
    not measured: Preset unasked, turned round by --also Preset
";
    assert!(some.out.contains(words), "{}", some.out);
    let all = command(dir, &["--budget", "10m"]);
    assert_eq!(all.code, 0, "{}", all.err);
    assert!(
        !all.out.contains("the budget ended") && all.err.contains("goes on from 2 runs in "),
        "{}",
        all.err
    );
    assert!(all.err.contains("run 6 of 6: --also Preset"), "{}", all.err);
}
