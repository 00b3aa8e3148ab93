//! If an improving stage fails, the garment at rest that it was given is kept.
#![allow(clippy::unwrap_used)]

use super::{RunError, RunOptions, RunResult, RunWatch, WatchedStage, run, typed};
use crate::load::load;
use std::path::Path;
use std::sync::{Arc, Mutex};
use toile_core::artifact::{OutputFile, Shortfall};
use toile_core::prelude::*;
use toile_core::testkit::dress;
use toile_core::{Cancel, Listener};

/// Sews a garment whose first vertex lies at x = 0.
#[stage(role = Draper, contracts(Deterministic))]
struct Sew {
    /// Whether it comes to rest.
    #[param(default = true)]
    rests: bool,
}

#[stage]
impl Sew {
    fn run(&self, cx: &Context) -> Result<Garment, StageError> {
        cx.work(10.0);
        let mut garment = dress::garment();
        garment.positions[0].x = 0.0;
        garment.status.converged = self.rests;
        Ok(garment)
    }
}

/// Moves the first vertex by 1 m.
#[stage(role = Placement, contracts(Deterministic, Improves))]
struct Pose {
    /// What it says where it fails; empty where it does not.
    #[param(default = String::new())]
    fails: String,
    /// Whether the user asks to stop meanwhile.
    #[param(default = false)]
    stopped: bool,
    /// Steps over all vertices.
    #[param(default = 1.0, min = 0.0, max = 100.0)]
    steps: f64,
    /// Whether the garment is at rest then.
    #[param(default = true)]
    rests: bool,
}

#[stage]
impl Pose {
    fn run(&self, garment: &Garment, cx: &Context) -> Result<Garment, StageError> {
        if self.stopped {
            return Err(StageError::new(ErrorCode::Cancelled, "stopped on request"));
        }
        for _ in 0..self.steps as usize {
            cx.work(1.0);
            cx.check()?;
        }
        if !self.fails.is_empty() {
            return Err(StageError::invalid(self.fails.clone()));
        }
        let mut garment = garment.clone();
        garment.positions[0].x += 1.0;
        garment.status.converged = self.rests;
        Ok(garment)
    }
}

/// Misses a limit where the first vertex lies beyond it.
#[stage(role = Writer, contracts(Deterministic))]
struct Limit {
    /// The limit.
    #[param(default = 10.0, min = 0.0, max = 10.0)]
    most: f64,
}

#[stage]
impl Limit {
    fn run(&self, garment: &Garment, _cx: &Context) -> Result<Figures, StageError> {
        let beyond = garment.positions[0].x > self.most;
        let missed = Shortfall { code: ErrorCode::SelfIntersection, message: "it crosses itself".into() };
        let shortfalls = beyond.then_some(missed).into_iter().collect();
        Ok(Figures { shortfalls, ..Figures::default() })
    }
}

/// Writes where the first vertex lies.
#[stage(role = Writer, contracts(Deterministic))]
struct Write {}

#[stage]
impl Write {
    fn run(&self, garment: &Garment, _cx: &Context) -> Result<OutputFiles, StageError> {
        let bytes = format!("{}", garment.positions[0].x).into_bytes();
        Ok(OutputFiles(vec![OutputFile::new("x.txt", bytes)]))
    }
}

/// Runs these stages behind each other.
fn ran(stages: &str) -> Result<RunResult, RunError> {
    under(stages, RunOptions::default())
}

fn under(stages: &str, options: RunOptions) -> Result<RunResult, RunError> {
    let mut registry = Registry::new();
    registry.add::<Sew>();
    registry.add::<Pose>();
    registry.add::<Limit>();
    registry.add::<Write>();
    let text = format!("(name: \"improved\", stages: [{stages}])");
    let pipeline = load(&text, "improved.ron", Path::new("."), &registry, &[]).unwrap();
    let listener: Arc<dyn Listener> = Arc::new(());
    run(&pipeline, &options, &Cancel::new(), &listener)
}

/// Where the first vertex lies in the end, and the warnings, each with its stage.
fn told(stages: &str) -> (String, Vec<String>) {
    let result = ran(stages).unwrap();
    let x = result.files.iter().find(|f| f.path == "x.txt").unwrap();
    let of = |s: &crate::StageMetrics| -> Vec<String> {
        s.remarks.warnings.iter().map(|w| format!("{}: {w}", s.id)).collect()
    };
    let warnings = result.metrics.stages.iter().flat_map(of).collect();
    (String::from_utf8(x.bytes.clone()).unwrap(), warnings)
}

#[test]
fn an_improvement_that_comes_off_is_shown() {
    assert_eq!(told("Sew(), Pose(), Pose(id: \"Settle\"), Write()"), ("2".into(), vec![]));
}

#[test]
fn where_an_improvement_fails_all_of_them_are_undone_and_the_garment_goes_on() {
    let (x, warnings) =
        told("Sew(), Pose(rests: false), Pose(id: \"Settle\", fails: \"the sleeve is caught\"), Write()");
    assert_eq!(x, "0");
    assert_eq!(warnings, ["Settle: the sleeve is caught; the garment is shown as `Sew` left it"]);
}

#[test]
fn an_improvement_that_does_not_come_to_rest_is_undone() {
    let (x, warnings) = told("Sew(), Pose(), Pose(id: \"Settle\", rests: false), Write()");
    assert_eq!(x, "0");
    assert_eq!(warnings, ["Settle: the garment did not come to rest again; it is shown as `Sew` left it"]);
}

#[test]
fn an_improvement_gets_the_work_that_the_garment_took() {
    assert_eq!(told("Sew(), Pose(steps: 10.0), Write()"), ("1".into(), vec![]));
    let (x, warnings) = told("Sew(), Pose(steps: 11.0), Write()");
    assert_eq!(x, "0");
    let why = "it was not done after 10 steps, as many as the garment before it took";
    assert_eq!(warnings, [format!("Pose: {why}; the garment is shown as `Sew` left it")]);
}

#[test]
fn an_improvement_that_misses_a_limit_is_undone_where_the_garment_keeps_it() {
    let (x, warnings) = told("Sew(), Pose(), Limit(most: 0.5), Write()");
    assert_eq!(x, "0");
    let why = "it crosses itself; without this the garment keeps all limits, and is shown as `Sew` left it";
    assert_eq!(warnings, [format!("Pose: {why}")]);
    let (x, warnings) = told("Sew(), Limit(most: 0.0), Pose(), Limit(id: \"Late\", most: 0.0), Write()");
    assert_eq!((x.as_str(), warnings.len()), ("0", 1), "{warnings:?}");
}

#[test]
fn what_stands_on_nothing_good_fails_as_any_stage() {
    let message = |stages: &str| ran(stages).unwrap_err().to_string();
    assert_eq!(message("Sew(rests: false), Pose(fails: \"caught\"), Write()"), "Pose: caught");
    assert_eq!(message("Sew(), Pose(stopped: true), Write()"), "Pose: stopped on request");
}

/// Where the first vertex lies after each stage.
#[derive(Debug, Default)]
struct Places(Mutex<Vec<String>>);

impl RunWatch for Places {
    fn done(&self, stage: &WatchedStage<'_>) {
        let artifacts = stage.outputs.iter().flat_map(|value| value.entries());
        let at = artifacts.filter_map(|(_, a)| typed::<Garment>(a)).map(|g| g.positions[0].x);
        self.0.lock().unwrap().extend(at.map(|x| format!("{} {x}", stage.id)));
    }
}

#[test]
fn a_watcher_is_told_of_what_is_undone_once_more() {
    let watched = |stages: &str| {
        let places = Arc::new(Places::default());
        let watch: Arc<dyn RunWatch> = places.clone();
        under(stages, RunOptions { watch: Some(watch), ..RunOptions::default() }).unwrap();
        std::mem::take(&mut *places.0.lock().unwrap())
    };
    let fails = "Sew(), Pose(), Pose(id: \"Settle\", fails: \"caught\"), Write()";
    assert_eq!(watched(fails), ["Sew 0", "Pose 1", "Pose 0", "Settle 0"]);
    assert_eq!(watched("Sew(), Pose(), Limit(most: 0.5), Write()"), ["Sew 0", "Pose 1", "Pose 0"]);
}
