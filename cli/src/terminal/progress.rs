//! The progress line: which stage is at work, how far it is and what it says; how far a measurement
//! is.

use crate::Streams;
use crate::args::StudyArgs;
use crate::{terminal::interrupt, terminal::threads};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::Write;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};
use toile_core::{Event, Listener, Remarks, StageError};
use toile_pipeline::Pipeline;
use toile_trade::ablate::AblationProgress;

/// Steps of the bar a stage.
const STEPS: u64 = 100;

/// A bar over all stages, on standard error; silent where that is no terminal.
pub(crate) struct Bar {
    bar: ProgressBar,
    ids: Vec<String>,
    notes: Mutex<Vec<(String, String)>>,
    warnings: Mutex<Vec<(String, String)>>,
    moments: Option<Mutex<Moments>>,
}

/// When a run that is still at work says what it is doing.
struct Moments {
    start: Instant,
    /// How many of them are over.
    over: usize,
}

impl Moments {
    /// After so many seconds.
    const AFTER: [u64; 3] = [5, 15, 30];

    /// The moment that has come since the last look, s.
    fn come(&mut self, elapsed: Duration) -> Option<u64> {
        let over = Self::AFTER.iter().filter(|after| elapsed.as_secs() >= **after).count();
        let before = std::mem::replace(&mut self.over, over);
        (over > before).then(|| Self::AFTER[over - 1])
    }
}

impl Bar {
    pub(crate) fn new(pipeline: &Pipeline, streams: &Streams<'_>) -> Self {
        let ids: Vec<String> = pipeline.nodes.iter().map(|n| n.id.clone()).collect();
        let template = "{spinner} {elapsed:>4} [{bar:28}] {prefix}: {wide_msg}";
        let bar = drawn(ids.len() as u64 * STEPS, template, streams);
        tick(&bar, 120);
        let moments = (!streams.is_quiet()).then(|| Mutex::new(Moments { start: Instant::now(), over: 0 }));
        Bar { bar, ids, notes: Mutex::default(), warnings: Mutex::default(), moments }
    }

    /// Says after some seconds what a stage is doing, where it stays to be read.
    fn say_at_moments(&self, who: &str, text: &str) {
        let Some(moments) = &self.moments else { return };
        let mut moments = moments.lock().unwrap_or_else(PoisonError::into_inner);
        let elapsed = moments.start.elapsed();
        let Some(after) = moments.come(elapsed) else { return };
        let line = format!("after {after} s: {who}: {text}");
        match self.bar.is_hidden() {
            // A line that cannot be written is no reason to end a run.
            true => drop(writeln!(std::io::stderr().lock(), "{line}")),
            false => self.bar.println(line),
        }
    }

    /// Removes the bar and returns the notes and warnings of the stages, each with its stage.
    pub(crate) fn finish(&self) -> Remarks {
        self.bar.finish_and_clear();
        let take = |told: &Mutex<Vec<(String, String)>>| {
            let told = std::mem::take(&mut *told.lock().unwrap_or_else(PoisonError::into_inner));
            told.into_iter().map(|(who, text)| format!("{who}: {text}")).collect()
        };
        Remarks { notes: take(&self.notes), warnings: take(&self.warnings) }
    }
}

impl Listener for Bar {
    fn event(&self, stage: &str, entry: &str, event: &Event) {
        let who = if entry.is_empty() { stage.to_owned() } else { format!("{stage} ({entry})") };
        match event {
            Event::Progress { share, text } => {
                let before = self.ids.iter().position(|id| id == stage).unwrap_or(0) as u64;
                self.bar.set_position(before * STEPS + (share * STEPS as f64) as u64);
                interrupt::at_work(&who);
                self.say_at_moments(&who, text);
                self.bar.set_prefix(who);
                self.bar.set_message(text.clone());
            }
            Event::Note(text) => {
                told(&self.notes, who, text);
            }
            Event::Warning(text) => {
                told(&self.warnings, who, text);
            }
        }
    }
}

/// Keeps the text of `who`, unless another stage has given the same text.
fn told(list: &Mutex<Vec<(String, String)>>, who: String, text: &str) {
    let mut list = list.lock().unwrap_or_else(PoisonError::into_inner);
    let stage = |who: &str| who.split(" (").next().map(str::to_owned);
    // Entries of one stage may say the same, each of itself.
    let said =
        |(other, told): &(String, String)| told == text && (*other == who || stage(other) != stage(&who));
    if !list.iter().any(said) {
        list.push((who, text.to_owned()));
    }
}

/// Runs `work` on the requested threads; what it reports is shown line by line above a bar of the
/// budget.
pub(crate) fn with_budget<T: Send>(
    study: &StudyArgs,
    streams: &mut Streams<'_>,
    work: impl FnOnce(&mut dyn FnMut(String)) -> Result<T, StageError> + Send,
) -> Result<T, StageError> {
    let length = study.budget().as_secs().max(1);
    let bar = measuring(length, "{spinner} {elapsed:>4} of the budget [{bar:28}] {wide_msg}", streams);
    let told = |bar: &ProgressBar, line: String| {
        bar.set_position(bar.elapsed().as_secs());
        line
    };
    shown(&bar, study.threads, streams, told, work)
}

/// The same above a bar of the runs that are done, of those that are to do.
pub(crate) fn with_runs<T: Send>(
    threads: Option<u16>,
    streams: &mut Streams<'_>,
    work: impl FnOnce(&mut dyn FnMut(AblationProgress)) -> Result<T, StageError> + Send,
) -> Result<T, StageError> {
    let bar = measuring(1, "{spinner} {elapsed:>4} {pos} of {len} runs [{bar:28}] {wide_msg}", streams);
    shown(&bar, threads, streams, at, work)
}

/// Puts the bar where a measurement is; gives the line to show.
fn at(bar: &ProgressBar, progress: AblationProgress) -> String {
    match progress {
        AblationProgress::Note(line) => line,
        AblationProgress::Run(step) => {
            bar.set_length(step.all as u64);
            bar.set_position(step.done as u64);
            step.to_string()
        }
    }
}

fn measuring(length: u64, template: &str, streams: &Streams<'_>) -> ProgressBar {
    let bar = drawn(length, template, streams);
    tick(&bar, 200);
    bar
}

/// A bar on standard error, without colour. It is hidden where standard error is no terminal or a
/// dumb one, or with `--quiet`.
pub(crate) fn drawn(length: u64, template: &str, streams: &Streams<'_>) -> ProgressBar {
    let target = if streams.is_quiet() { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(length), target);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// Has a bar that is seen drawn by itself, which takes a thread: where there is none, it is drawn
/// as work goes on.
fn tick(bar: &ProgressBar, milliseconds: u64) {
    if !bar.is_hidden() && std::thread::Builder::new().spawn(|| {}).is_ok() {
        bar.enable_steady_tick(Duration::from_millis(milliseconds));
    }
}

/// Runs the work on a thread of its own, and shows what it reports.
fn shown<T: Send, M: Send>(
    bar: &ProgressBar,
    threads: Option<u16>,
    streams: &mut Streams<'_>,
    told: impl Fn(&ProgressBar, M) -> String,
    work: impl FnOnce(&mut dyn FnMut(M)) -> Result<T, StageError> + Send,
) -> Result<T, StageError> {
    let (send, receive) = channel::<M>();
    let (result, of_threads) = std::thread::scope(|scope| {
        let work = move || {
            let (pool, told) = threads::pool_of(threads, threads::cores());
            (threads::in_pool(pool, || work(&mut |m| drop(send.send(m)))), told)
        };
        let worker = std::thread::Builder::new().spawn_scoped(scope, work);
        let worker = match worker {
            Ok(worker) => worker,
            Err(e) => {
                let message = format!("cannot start a thread for a measurement: {e}");
                return (Err(StageError::internal(message)), Vec::new());
            }
        };
        for message in receive {
            let line = told(bar, message);
            bar.suspend(|| streams.notice(&line));
        }
        worker
            .join()
            .unwrap_or_else(|_| (Err(StageError::internal("the measurement ended unexpectedly")), Vec::new()))
    });
    bar.finish_and_clear();
    of_threads.into_iter().for_each(|words| streams.warn(words));
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_trade::ablate::RunStep;

    #[test]
    fn an_ablation_shows_runs_done_of_runs_to_do() {
        let bar = ProgressBar::hidden();
        let line = at(&bar, AblationProgress::Run(RunStep { done: 3, all: 12, what: "as decided".into() }));
        assert_eq!((bar.position(), bar.length()), (3, Some(12)));
        assert_eq!(line, "run 4 of 12: as decided");
        assert_eq!(at(&bar, AblationProgress::Note("goes on".into())), "goes on");
        assert_eq!(bar.position(), 3);
    }
}
