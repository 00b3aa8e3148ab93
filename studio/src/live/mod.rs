//! Runs that follow the edits: a draft soon after each, then the file as it says.
//!
//! One thread takes what was asked last, waits a moment for more, runs it and tells what comes of
//! it. A new edit stops the run under way; what runs made before stays in view until new results
//! take its place.
//!
//! - `ask`: which pipelines; `state`: where they stand; `shown`: what they made; `read`: a pattern
//!   as it was read; `moved`: how far a garment is from another; `print`: one writer run by itself.

pub(crate) mod ask;
mod moved;
pub(crate) mod print;
pub(crate) mod read;
pub(crate) mod shown;
pub(crate) mod state;

use crate::project::outputs::OUT;
use crate::pulse::Pulse;
use ask::{RunAsk, RunKind, ends};
use moved::largest_move;
use state::{LiveState, RunFault, RunStatus};
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use toile_core::artifact::{Kind, OutputFile, Point3};
use toile_core::{Cancel, ErrorCode, Event, Listener, Registry, StageError, panics};
use toile_pipeline::cache::Cache;
use toile_pipeline::{Pipeline, RunError, RunOptions, RunResult, RunWatch, WatchedStage, run, write_files};

/// How long after an edit its run begins: an edit that follows at once spares it.
const SOON: Duration = Duration::from_millis(150);

/// What runs need beside their pipeline.
#[derive(Debug, Clone)]
pub(crate) struct RunTools {
    pub(crate) registry: Arc<Registry>,
    pub(crate) cache: Option<Arc<Cache>>,
    /// Threads; as many as the machine has cores where none are named.
    pub(crate) threads: Option<usize>,
}

/// The runs of a project.
#[derive(Debug)]
pub(crate) struct LiveRuns {
    desk: Arc<RunDesk>,
}

/// Where those who ask and the thread that runs meet.
#[derive(Debug)]
struct RunDesk {
    state: Mutex<LiveState>,
    asked: Condvar,
    pulse: Pulse,
}

impl RunDesk {
    fn state(&self) -> MutexGuard<'_, LiveState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LiveRuns {
    /// Starts the thread.
    pub(crate) fn new(tools: RunTools, pulse: Pulse) -> Self {
        let desk = Arc::new(RunDesk { state: Mutex::default(), asked: Condvar::new(), pulse });
        let own = desk.clone();
        // Without a thread nothing is run, and the project can be edited all the same.
        let _ = std::thread::Builder::new().name("runs".into()).spawn(move || work(&own, &tools));
        LiveRuns { desk }
    }

    /// An edit was made: its run follows soon, and the one under way stops. None for a text that
    /// cannot be run.
    pub(crate) fn edited(&self, ask: Option<RunAsk>) {
        let mut state = self.desk.state();
        state.before = state.done.clone();
        self.ask(&mut state, ask.map(|ask| (ask, Instant::now() + SOON)));
    }

    /// Runs at once.
    pub(crate) fn run(&self, ask: RunAsk) {
        self.ask(&mut self.desk.state(), Some((ask, Instant::now())));
    }

    /// Stops what goes on.
    pub(crate) fn stop(&self) {
        self.ask(&mut self.desk.state(), None);
    }

    fn ask(&self, state: &mut LiveState, ask: Option<(RunAsk, Instant)>) {
        state.cancel.cancel();
        state.asked = ask;
        self.desk.asked.notify_all();
        self.desk.pulse.beat();
    }

    /// Where the runs stand.
    pub(crate) fn state(&self) -> MutexGuard<'_, LiveState> {
        self.desk.state()
    }
}

impl Drop for LiveRuns {
    fn drop(&mut self) {
        self.desk.state().ended = true;
        self.stop();
    }
}

/// Takes one thing after the other, until the end.
fn work(desk: &Arc<RunDesk>, tools: &RunTools) {
    while let Some((ask, cancel)) = next(desk) {
        for kind in &ask.kinds {
            if !attempt(desk, tools, &ask, kind, &cancel) {
                break;
            }
        }
    }
}

/// What is to be run now; waits for it.
fn next(desk: &RunDesk) -> Option<(RunAsk, Cancel)> {
    let mut state = desk.state();
    loop {
        if state.ended {
            return None;
        }
        let due = state.asked.as_ref().map(|(_, due)| due.saturating_duration_since(Instant::now()));
        match due {
            None => state = desk.asked.wait(state).unwrap_or_else(PoisonError::into_inner),
            Some(wait) if wait.is_zero() => {
                let (ask, _) = state.asked.take()?;
                state.cancel = Cancel::new();
                return Some((ask, state.cancel.clone()));
            }
            Some(wait) => {
                let woken = desk.asked.wait_timeout(state, wait);
                state = woken.unwrap_or_else(PoisonError::into_inner).0;
            }
        }
    }
}

/// The least time between two looks at a garment that moves: a page draws it in less.
const LOOK: Duration = Duration::from_millis(120);

/// Hears what goes on and passes it to the desk.
#[derive(Debug)]
struct DeskWatch {
    desk: Arc<RunDesk>,
    /// When the garment was looked at last.
    looked: Mutex<Instant>,
}

impl RunWatch for DeskWatch {
    fn kinds(&self) -> &[Kind] {
        &shown::KINDS
    }

    fn done(&self, stage: &WatchedStage<'_>) {
        self.desk.state().take(stage);
        self.desk.pulse.beat();
    }
}

impl Listener for DeskWatch {
    fn event(&self, stage: &str, entry: &str, event: &Event) {
        self.desk.state().hear(stage, entry, event);
        self.desk.pulse.beat();
    }

    fn looks_on(&self) -> bool {
        let mut looked = self.looked.lock().unwrap_or_else(PoisonError::into_inner);
        let is_due = looked.elapsed() >= LOOK && self.desk.pulse.is_listened_to();
        if is_due {
            *looked = Instant::now();
        }
        is_due
    }

    fn moves(&self, _: &str, positions: Vec<Point3>) {
        self.desk.state().moves(positions);
        self.desk.pulse.beat();
    }
}

/// One run; whether the next may follow.
fn attempt(desk: &Arc<RunDesk>, tools: &RunTools, ask: &RunAsk, kind: &RunKind, cancel: &Cancel) -> bool {
    {
        let mut state = desk.state();
        let number = state.run.number + 1;
        let (kind, begun) = (kind.word(), Some(Instant::now()));
        let edit = ask.edit;
        state.run = RunStatus { number, edit, kind, state: "running", begun, ..RunStatus::default() };
        state.stages.clear();
        state.progress = None;
        state.break_off();
    }
    desk.pulse.beat();
    let outcome = ask.pipeline(kind, &tools.registry).map_err(|faults| {
        let message = faults.faults.first().map_or_else(String::new, |f| f.message.clone());
        let hint = faults.faults.first().and_then(|f| f.hint.clone());
        RunFault { stage: String::new(), entry: String::new(), message, hint, start: 0, end: 0 }
    });
    let outcome = outcome.map_err(Some).and_then(|pipeline| {
        let result = staged(desk, tools, &pipeline, kind, cancel);
        let result = result.map_err(|e| fault(&pipeline, &e))?;
        if matches!(kind, RunKind::Full(_)) {
            leave(&ask.base, &result).map_err(|e| Some(of_writing(e)))?;
        }
        Ok(result)
    });
    let mut state = desk.state();
    state.run.seconds = state.run.begun.take().map_or(0.0, |begun| begun.elapsed().as_secs_f64());
    let goes_on = outcome.is_ok();
    match outcome {
        Ok(result) => {
            state.settle();
            state.run.moved =
                state.before.as_ref().zip(state.done.as_ref()).and_then(|(a, b)| largest_move(a, b));
            state.run.shortfalls = result.metrics.shortfalls;
            state.run.state = "done";
        }
        Err(error) => {
            let ended = if error.is_some() { "failed" } else { "stopped" };
            if let Some(error) = &error
                && let Some(status) = state.stages.get_mut(&error.stage)
            {
                status.state = "failed";
            }
            for status in state.stages.values_mut().filter(|s| s.state == "running") {
                status.state = "waiting";
            }
            state.run.error = error;
            state.run.state = ended;
            state.break_off();
        }
    }
    drop(state);
    desk.pulse.beat();
    goes_on
}

/// Runs a pipeline in threads of its own.
fn staged(
    desk: &Arc<RunDesk>,
    tools: &RunTools,
    pipeline: &Pipeline,
    kind: &RunKind,
    cancel: &Cancel,
) -> Result<RunResult, RunError> {
    let watch = Arc::new(DeskWatch { desk: desk.clone(), looked: Mutex::new(Instant::now()) });
    let options = RunOptions {
        cache: tools.cache.clone(),
        also: if matches!(kind, RunKind::Draft(_)) { ends(pipeline) } else { Vec::new() },
        watch: Some(watch.clone()),
        ..RunOptions::default()
    };
    let listener: Arc<dyn Listener> = watch;
    in_threads(tools, || run(pipeline, &options, cancel, &listener))
}

/// Does the work of a run in threads of its own; a panic in it is an error.
pub(super) fn in_threads(
    tools: &RunTools,
    work: impl FnOnce() -> Result<RunResult, RunError> + Send,
) -> Result<RunResult, RunError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(tools.threads.unwrap_or(0)).build();
    let outcome = panics::caught(|| match pool {
        Ok(pool) => pool.install(work),
        // The system gives no threads: those of the program do it.
        Err(_) => work(),
    });
    outcome.unwrap_or_else(|words| {
        let error = StageError::internal(format!("the run panicked: {words}")).hint(panics::REPORT);
        Err(RunError { stage: String::new(), entry: String::new(), span: 0..0, error })
    })
}

/// Writes what a full run gave, with its metrics, into the project's folder of results.
fn leave(base: &Path, result: &RunResult) -> Result<(), StageError> {
    let mut files = result.files.clone();
    files.push(OutputFile::new("metrics.json", result.metrics.to_json().into_bytes()));
    write_files(&base.join(OUT), &files).map(drop)
}

/// An error of a run for the page; none where somebody stopped it.
fn fault(pipeline: &Pipeline, e: &RunError) -> Option<RunFault> {
    if e.error.code == ErrorCode::Cancelled {
        return None;
    }
    let located = pipeline.find(&e.stage).map(|i| pipeline.locate(&pipeline.nodes[i], &e.error));
    let place = located.as_ref().and_then(|l| l.faults.first()).filter(|f| f.option.is_none());
    let span = place.and_then(|f| f.labels.first()).map_or(0..0, |l| l.span.clone());
    Some(RunFault {
        stage: e.stage.clone(),
        entry: e.entry.clone(),
        message: e.error.message.clone(),
        hint: e.error.hint.clone(),
        start: span.start,
        end: span.end,
    })
}

fn of_writing(e: StageError) -> RunFault {
    let (stage, entry) = ("writing".to_owned(), String::new());
    RunFault { stage, entry, message: e.message, hint: e.hint, start: 0, end: 0 }
}
