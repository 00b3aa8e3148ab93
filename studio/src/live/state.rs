//! Where the runs stand.

use super::ask::RunAsk;
use super::shown::ShownArtifacts;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;
use toile_core::artifact::{Garment, Point3};
use toile_core::{Cancel, Event};
use toile_pipeline::WatchedStage;

/// Where a stage stands.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct StageStatus {
    pub(crate) state: &'static str,
    pub(crate) seconds: Option<f64>,
    pub(crate) cached: bool,
    pub(crate) share: f64,
    pub(crate) notes: Vec<String>,
    pub(crate) warnings: Vec<String>,
    pub(crate) figures: Vec<StageFigure>,
}

/// A figure that a stage gave.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct StageFigure {
    name: String,
    value: f64,
    unit: String,
}

impl Default for StageStatus {
    fn default() -> Self {
        StageStatus {
            state: "waiting",
            seconds: None,
            cached: false,
            share: 0.0,
            notes: Vec::new(),
            warnings: Vec::new(),
            figures: Vec::new(),
        }
    }
}

/// Why a run failed, with its place in the project's text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct RunFault {
    pub(crate) stage: String,
    pub(crate) entry: String,
    pub(crate) message: String,
    pub(crate) hint: Option<String>,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// How far the stage at work has come.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ProgressNote {
    stage: String,
    entry: String,
    share: f64,
    words: String,
}

/// The latest run.
#[derive(Debug, Clone)]
pub(crate) struct RunStatus {
    pub(crate) number: u64,
    /// The number of the text that it runs.
    pub(crate) edit: u64,
    pub(crate) kind: &'static str,
    pub(crate) state: &'static str,
    pub(crate) begun: Option<Instant>,
    pub(crate) seconds: f64,
    pub(crate) error: Option<RunFault>,
    pub(crate) shortfalls: Vec<(String, String)>,
    /// How far the garment has moved, metres.
    pub(crate) moved: Option<f64>,
}

impl Default for RunStatus {
    fn default() -> Self {
        RunStatus {
            number: 0,
            edit: 0,
            kind: "none",
            state: "none",
            begun: None,
            seconds: 0.0,
            error: None,
            shortfalls: Vec::new(),
            moved: None,
        }
    }
}

impl RunStatus {
    pub(crate) fn json(&self) -> Value {
        let seconds = self.begun.map_or(self.seconds, |begun| begun.elapsed().as_secs_f64());
        let shortfall = |(code, message): &(String, String)| json!({ "code": code, "message": message });
        json!({
            "number": self.number,
            "edit": self.edit,
            "kind": self.kind,
            "state": self.state,
            "seconds": seconds,
            "error": self.error,
            "shortfalls": self.shortfalls.iter().map(shortfall).collect::<Vec<_>>(),
            "changed": { "mm": self.moved.map(|m| 1e3 * m), "seconds": seconds },
        })
    }
}

/// What is asked, what goes on, and what came of it.
#[derive(Debug, Default)]
pub(crate) struct LiveState {
    /// What to run next, and from when on.
    pub(super) asked: Option<(RunAsk, Instant)>,
    /// Stops the run under way.
    pub(super) cancel: Cancel,
    pub(super) ended: bool,
    pub(crate) run: RunStatus,
    /// By id.
    pub(crate) stages: BTreeMap<String, StageStatus>,
    /// Where the vertices of the garment have come to while it is draped, metres; else none.
    pub(crate) moving: Option<Arc<Vec<Point3>>>,
    /// Grows with it.
    pub(crate) moving_number: u64,
    /// What the present run has made.
    pub(super) fresh: ShownArtifacts,
    /// What the runs before it have left.
    pub(super) kept: ShownArtifacts,
    /// Grows with what is shown.
    pub(crate) view: u64,
    /// The last note of the present run. It stays when the run ends, so that none is lost on a
    /// short one.
    pub(crate) progress: Option<ProgressNote>,
    /// Grows with the notes of progress.
    pub(crate) progress_number: u64,
    /// The garment of the last run that came to its end.
    pub(super) done: Option<Arc<Garment>>,
    /// That of the last run before the last edit.
    pub(crate) before: Option<Arc<Garment>>,
}

impl LiveState {
    /// What is shown now.
    pub(crate) fn shown(&self) -> ShownArtifacts {
        self.fresh.over(&self.kept)
    }

    /// Takes note of where a garment has come to.
    pub(super) fn moves(&mut self, positions: Vec<Point3>) {
        self.moving = Some(Arc::new(positions));
        self.moving_number += 1;
    }

    /// Takes note of a stage that is done.
    pub(super) fn take(&mut self, stage: &WatchedStage<'_>) {
        self.moving = None;
        if self.fresh.take(&stage.outputs, self.run.edit) {
            self.view += 1;
        }
        let figure = |m: &toile_core::artifact::Measure| StageFigure {
            name: m.name.clone(),
            value: m.value,
            unit: m.unit.to_owned(),
        };
        let status = StageStatus {
            state: if stage.skipped.is_some() { "skipped" } else { "done" },
            seconds: stage.skipped.is_none().then_some(stage.wall_s),
            cached: stage.cached,
            share: 1.0,
            notes: stage.remarks.notes.clone(),
            warnings: stage.remarks.warnings.clone(),
            figures: stage.figures.iter().map(figure).collect(),
        };
        self.stages.insert(stage.id.to_owned(), status);
    }

    /// Takes note of an event of a stage at work.
    pub(super) fn hear(&mut self, stage: &str, entry: &str, event: &Event) {
        let status = self.stages.entry(stage.to_owned()).or_default();
        match event {
            Event::Progress { share, text } => {
                if status.state == "waiting" {
                    status.state = "running";
                }
                status.share = *share;
                let note = |text: &String| ProgressNote {
                    stage: stage.to_owned(),
                    entry: entry.to_owned(),
                    share: *share,
                    words: text.clone(),
                };
                self.progress = Some(note(text));
                self.progress_number += 1;
            }
            Event::Note(text) if !status.notes.contains(text) => status.notes.push(text.clone()),
            Event::Warning(text) if !status.warnings.contains(text) => status.warnings.push(text.clone()),
            Event::Note(_) | Event::Warning(_) => {}
        }
    }

    /// The present run has come to its end: what it did not make is no longer there.
    pub(super) fn settle(&mut self) {
        self.kept = std::mem::take(&mut self.fresh);
        self.done = self.kept.garment.clone();
        self.view += 1;
    }

    /// The present run was broken off: what it made stays beside what was there.
    pub(super) fn break_off(&mut self) {
        self.moving = None;
        self.kept = self.shown();
        self.fresh = ShownArtifacts::default();
    }
}
