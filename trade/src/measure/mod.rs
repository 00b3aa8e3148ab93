//! One run of a pipeline with its clocks, cut short where it takes too long.
//!
//! Wall and processor time are those of the whole run, every stage of it, without the writing of
//! files: what `toile run --no-cache` takes. No cache takes part where times count, since finding,
//! digesting and keeping results is work of its own. Each run has a process of its own where the
//! program can start itself (`apart`); memory is then the greatest resident memory of that process,
//! program and all. Elsewhere the process is the clock's: nothing else of it may work meanwhile,
//! and memory is its high-water mark, put back before the run where the kernel lets a process do so
//! (Linux).

pub mod apart;
pub mod jitter;
mod memory;
mod ran;

pub use ran::{Missed, Ran};

use crate::measure::apart::{Apart, Task};
use cpu_time::ProcessTime;
use memory::forget_peak;
pub use memory::peak;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};
use toile_core::{Cancel, ErrorCode, Length, Listener, StageError};
use toile_pipeline::cache::Cache;
use toile_pipeline::{Pipeline, Reads, RunError, RunOptions, RunResult, run};

/// Seconds of processor time that this process has taken, all threads.
#[must_use]
pub fn processor_seconds() -> f64 {
    ProcessTime::now().as_duration().as_secs_f64()
}

/// How often the watchdog looks at the clock.
const WATCH: Duration = Duration::from_millis(20);

/// How runs are made.
#[derive(Clone)]
pub struct Bench {
    /// Stop after this stage.
    pub until: Option<String>,
    /// Raised to stop everything.
    pub cancel: Cancel,
    /// Hears the stages of runs in this process.
    pub listener: Arc<dyn Listener>,
    /// Starts a process for each run; none runs them in this one.
    pub apart: Option<Apart>,
}

impl Bench {
    /// Runs a pipeline; `limit` ends it, `cache` is for runs whose times do not count.
    pub fn run(
        &self,
        pipeline: &Pipeline,
        limit: Option<Duration>,
        cache: Option<Arc<Cache>>,
    ) -> Result<Ran, Missed> {
        self.anywhere(pipeline, &[], limit, cache)
    }

    /// Runs a pipeline with stages that no requested result depends on.
    pub fn run_also(
        &self,
        pipeline: &Pipeline,
        also: &[String],
        limit: Option<Duration>,
    ) -> Result<Ran, Missed> {
        self.anywhere(pipeline, also, limit, None)
    }

    /// Runs a pipeline from a start moved by so much, with a seed.
    pub fn run_moved(
        &self,
        mut pipeline: Pipeline,
        (amount, seed): (Length, u64),
        limit: Option<Duration>,
        cache: Option<Arc<Cache>>,
    ) -> Result<Ran, Missed> {
        if let Some(apart) = &self.apart {
            let task = self.task(&pipeline, &[], limit, cache).moved((amount, seed));
            return apart.run(&task, &self.cancel);
        }
        jitter::insert(&mut pipeline, amount, seed).map_err(Missed::Failed)?;
        self.here(&pipeline, &[], limit, cache)
    }

    /// In a process of its own where there is one to start, else in this one.
    fn anywhere(
        &self,
        pipeline: &Pipeline,
        also: &[String],
        limit: Option<Duration>,
        cache: Option<Arc<Cache>>,
    ) -> Result<Ran, Missed> {
        match &self.apart {
            Some(apart) => apart.run(&self.task(pipeline, also, limit, cache), &self.cancel),
            None => self.here(pipeline, also, limit, cache),
        }
    }

    fn task(
        &self,
        pipeline: &Pipeline,
        also: &[String],
        limit: Option<Duration>,
        cache: Option<Arc<Cache>>,
    ) -> Task {
        let cache = cache.map(|c| c.folder().to_owned());
        Task { until: self.until.clone(), also: also.to_vec(), cache, limit, ..Task::of(pipeline) }
    }

    /// Runs in this process.
    pub(crate) fn here(
        &self,
        pipeline: &Pipeline,
        also: &[String],
        limit: Option<Duration>,
        cache: Option<Arc<Cache>>,
    ) -> Result<Ran, Missed> {
        // A run may be shorter than the watchdog's first look.
        if self.cancel.is_cancelled() {
            return Err(Missed::Cancelled);
        }
        let reads: Reads = Arc::default();
        let options = RunOptions {
            until: self.until.clone(),
            also: also.to_vec(),
            keep: cache.is_some(),
            cache,
            reads: Some(reads.clone()),
            ..RunOptions::default()
        };
        forget_peak();
        let (started, cpu) = (Instant::now(), ProcessTime::now());
        let result = self.watched(pipeline, &options, limit);
        let (wall_s, cpu_s) = (started.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
        let peak_memory_bytes = peak();
        let result = result.map_err(|e| self.missed(e, wall_s))?;
        ran::ran(&result, &reads, [wall_s, cpu_s], peak_memory_bytes)
    }

    fn missed(&self, e: RunError, wall_s: f64) -> Missed {
        match e.error.code {
            ErrorCode::Cancelled if self.cancel.is_cancelled() => Missed::Cancelled,
            ErrorCode::Cancelled => Missed::OverLimit(wall_s),
            _ => Missed::Failed(StageError { message: e.to_string(), ..e.error }),
        }
    }

    /// Runs with a watchdog beside it.
    fn watched(
        &self,
        pipeline: &Pipeline,
        options: &RunOptions,
        limit: Option<Duration>,
    ) -> Result<RunResult, RunError> {
        let own = Cancel::new();
        let end = limit.map(|l| Instant::now() + l);
        let (done, wait) = channel::<()>();
        let (user, run_own) = (self.cancel.clone(), own.clone());
        std::thread::scope(|scope| {
            scope.spawn(move || {
                while wait_is_on(&wait) {
                    if user.is_cancelled() || end.is_some_and(|end| Instant::now() >= end) {
                        run_own.cancel();
                    }
                }
            });
            let result = run(pipeline, options, &own, &self.listener);
            // The watchdog ends once its channel is closed.
            drop(done);
            result
        })
    }
}

fn wait_is_on(wait: &Receiver<()>) -> bool {
    matches!(wait.recv_timeout(WATCH), Err(RecvTimeoutError::Timeout))
}
