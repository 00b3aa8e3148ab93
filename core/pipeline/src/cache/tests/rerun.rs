//! What runs again after an edit, and what does not.

use super::bench::{ALL, Bench, STAGES, file};
use crate::cache::Parts;
use crate::cost::{Expect, Meter, Predicted, Used};
use crate::load::Pipeline;
use crate::{RunOptions, RunResult, run};
use std::fs;
use std::sync::{Arc, Mutex};
use toile_core::artifact::Digester;
use toile_core::{Cancel, ErrorCode, Event, Listener, StageError};

#[test]
fn a_second_run_runs_nothing_and_gives_the_same() {
    let bench = Bench::new("second", STAGES);
    let (cold, ran, _) = bench.run(&[]);
    assert_eq!(ran, ALL);
    let (warm, ran, warnings) = bench.run(&[]);
    assert_eq!((ran.len(), warnings.len()), (0, 0));
    let (cold, warm) = (cold.unwrap(), warm.unwrap());
    assert_eq!(file(&warm, "levels.bin"), [9, 7]);
    let files = |r: &RunResult| r.files.iter().map(|f| (f.path.clone(), f.bytes.clone())).collect::<Vec<_>>();
    assert_eq!(files(&cold), files(&warm));
    assert_eq!(cold.results, warm.results);
    for (a, b) in cold.metrics.stages.iter().zip(&warm.metrics.stages) {
        assert!(!a.cached && b.cached, "{}", a.id);
        assert_eq!((&a.figures, &a.remarks), (&b.figures, &b.remarks));
    }
    assert_eq!(warm.metrics.stages[1].figures["back.level"], 3.0);
    assert_eq!(warm.metrics.stages[1].remarks.warnings, ["back: it is small", "front: it is small"]);
}

/// Notes of which stages it was asked.
#[derive(Debug, Default)]
struct Asked(Mutex<Vec<usize>>);

impl Expect for Asked {
    fn expected(&self, _pipeline: &Pipeline, node: usize) -> Option<Predicted> {
        self.0.lock().unwrap().push(node);
        Some(Predicted::default())
    }
}

#[test]
fn what_is_expected_is_asked_of_stages_that_ran_and_of_no_others() {
    let bench = Bench::new("expect", STAGES);
    let asked = |sets: &[&str]| {
        let asked = Arc::new(Asked::default());
        let meter: Arc<dyn Meter> = Arc::new(Still);
        let expect: Arc<dyn Expect> = asked.clone();
        let options = RunOptions {
            cache: Some(bench.cache()),
            meter: Some(meter),
            expect: Some(expect),
            ..RunOptions::default()
        };
        let listener: Arc<dyn Listener> = Arc::new(());
        let result = run(&bench.pipeline(sets), &options, &Cancel::new(), &listener).unwrap();
        let told = result.metrics.stages.iter().filter(|s| s.predicted.is_some()).count();
        let mut nodes = std::mem::take(&mut *asked.0.lock().unwrap());
        nodes.sort_unstable();
        nodes.dedup();
        (nodes, told)
    };
    assert_eq!(asked(&[]), (vec![0, 1, 2, 3], 4));
    assert_eq!(asked(&[]), (vec![], 0), "nothing ran, so nothing is fitted");
    assert_eq!(asked(&["stages.Modulo.levels=8"]), (vec![1, 2, 3], 3));
}

#[derive(Debug)]
struct Still;

impl Meter for Still {
    fn start(&self) {}
    fn stop(&self) -> Used {
        Used::default()
    }
}

#[test]
fn warnings_of_cached_results_are_told_again() {
    #[derive(Default)]
    struct Ears(Mutex<Vec<String>>);
    impl Listener for Ears {
        fn event(&self, stage: &str, entry: &str, event: &Event) {
            if let Event::Warning(text) = event {
                self.0.lock().unwrap().push(format!("{stage} {entry}: {text}"));
            }
        }
    }
    let bench = Bench::new("warnings", STAGES);
    bench.run(&[]).0.unwrap();
    let ears = Arc::new(Ears::default());
    let listener: Arc<dyn Listener> = ears.clone();
    let options = RunOptions { cache: Some(bench.cache()), ..RunOptions::default() };
    run(&bench.pipeline(&[]), &options, &Cancel::new(), &listener).unwrap();
    assert_eq!(*ears.0.lock().unwrap(), ["Modulo back: it is small", "Modulo front: it is small"]);
}

#[test]
fn an_edited_parameter_runs_its_stage_and_what_depends_on_it() {
    let bench = Bench::new("edit", STAGES);
    bench.run(&[]).0.unwrap();
    let (result, ran, _) = bench.run(&["stages.Modulo.levels=8"]);
    assert_eq!(file(&result.unwrap(), "levels.bin"), [1, 7]);
    assert_eq!(ran, ["Levels", "Log", "Modulo back", "Modulo front"]);
    assert!(bench.run(&[]).1.is_empty(), "going back finds the older result");
}

#[test]
fn equal_outputs_stop_the_run_right_there() {
    let bench = Bench::new("cutoff", "Bytes2(test: T), Modulo(test: T), Levels(test: T)");
    bench.run(&[]).0.unwrap();
    let (_, ran, _) = bench.run(&["stages.Modulo.levels=50"]);
    assert_eq!(ran, ["Modulo back", "Modulo front"]);
}

#[test]
fn an_edited_photo_runs_its_own_panel_alone() {
    let bench = Bench::new("panel", STAGES);
    bench.run(&[]).0.unwrap();
    bench.write("front", 8);
    let (result, ran, _) = bench.run(&[]);
    assert_eq!(file(&result.unwrap(), "levels.bin"), [9, 8]);
    assert_eq!(ran, ["Bytes2", "Levels", "Log", "Modulo front"]);
    bench.write("front", 7);
    assert!(bench.run(&[]).1.is_empty(), "the file's older content is known");
}

#[test]
fn a_stage_that_promises_nothing_is_always_run_and_those_after_it_are_not() {
    let bench = Bench::new("dice", "Bytes2(test: T), Dice(test: T), Modulo(test: T), Levels(test: T)");
    bench.run(&[]).0.unwrap();
    let (result, ran, _) = bench.run(&[]);
    assert_eq!(file(&result.unwrap(), "levels.bin"), [9, 7]);
    assert_eq!(bench.why(&[])[0], "Dice back: it is not deterministic and always runs");
    assert_eq!(ran[..2], ["Dice back", "Dice front"]);
}

#[test]
fn errors_are_not_kept() {
    let bench = Bench::new("errors", STAGES);
    fs::write(bench.dir.path().join("front.txt"), []).unwrap();
    for _ in 0..2 {
        let (result, ran, _) = bench.run(&[]);
        assert_eq!(
            (result.unwrap_err().error.message.as_str(), ran),
            ("it is empty", vec!["Bytes2".to_owned()])
        );
    }
    fs::remove_file(bench.dir.path().join("front.txt")).unwrap();
    assert_eq!(bench.run(&[]).0.unwrap_err().error.message, "cannot read \"front.txt\": no such file");
    bench.write("front", 7);
    assert_eq!(bench.run(&[]).1, ALL);
}

#[test]
fn a_part_is_kept_once_it_is_made_and_not_where_its_making_was_stopped() {
    let bench = Bench::new("parts", STAGES);
    let parts = Parts::of(&bench.cache(), &bench.pipeline(&[]).nodes[0].card);
    let key = Digester::new();
    let part = |made: Result<Vec<u8>, StageError>| parts.part("Levels", &key, Box::new(|| made));
    let stopped = part(Err(StageError::new(ErrorCode::Cancelled, "stopped on request")));
    assert_eq!(stopped.unwrap_err().message, "stopped on request");
    assert_eq!(part(Ok(vec![1])).unwrap(), [1]);
    assert_eq!(part(Ok(vec![2])).unwrap(), [1], "as it was kept");
}

#[test]
fn runs_at_once_share_the_cache() {
    let bench = Bench::new("shared", STAGES);
    std::thread::scope(|scope| {
        let runs: Vec<_> = (0..4).map(|_| scope.spawn(|| bench.run(&[]))).collect();
        for run in runs {
            let (result, _, warnings) = run.join().unwrap();
            assert_eq!((file(&result.unwrap(), "levels.bin"), warnings.len()), (&[9, 7][..], 0));
        }
    });
    bench.ran();
    assert!(bench.run(&[]).1.is_empty());
}
