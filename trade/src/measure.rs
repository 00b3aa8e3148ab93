//! One run of a pipeline with its clocks, cut short where it takes too long.
//!
//! Wall and processor time are those of the whole run, every stage of it, without the writing of files: what
//! `toile run --no-cache` takes. No cache takes part where times count, since finding, digesting and keeping results is
//! work of its own. Each run has a process of its own where the program can start itself (`apart`); memory is then the
//! greatest resident memory of that process, program and all. Elsewhere the process is the clock's: nothing else of it may work
//! meanwhile, and memory is its high-water mark, put back before the run where the kernel lets a process do so (Linux).

use crate::apart::{Apart, Task};
use crate::jitter;
use cpu_time::ProcessTime;
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};
use toile_core::artifact::{Body, Figures, Garment, Model, RunLog};
use toile_core::cache::Cache;
use toile_core::pipeline::Pipeline;
use toile_core::{
    ArtifactType, Cancel, ErrorCode, Length, Listener, Reads, RunError, RunOptions, RunResult, StageError,
    run,
};

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

/// What a run gave.
#[derive(Debug)]
pub struct Ran {
    /// The garment at the end.
    pub garment: Garment,
    /// Who wears it.
    pub body: Option<Body>,
    /// It with its textures.
    pub model: Option<Model>,
    /// The judgement of the garment; none where the run ended before it.
    pub figures: Option<Figures>,
    /// Wall time by stage, seconds.
    pub stages_s: BTreeMap<String, f64>,
    /// Seconds of wall time.
    pub wall_s: f64,
    /// Seconds of processor time, all threads.
    pub cpu_s: f64,
    /// Greatest resident memory of its process, bytes, where the system tells.
    pub peak_memory_bytes: Option<u64>,
    /// Files that it read, with the digests of their contents.
    pub reads: BTreeMap<String, Option<String>>,
}

/// Why a run gave nothing.
#[derive(Debug, Clone, PartialEq)]
pub enum Missed {
    /// It was stopped after so many seconds.
    OverLimit(f64),
    /// A stage failed.
    Failed(StageError),
    /// The user stopped everything.
    Cancelled,
}

impl From<Missed> for StageError {
    fn from(missed: Missed) -> Self {
        match missed {
            Missed::Failed(e) => e,
            Missed::Cancelled => StageError::new(ErrorCode::Cancelled, "stopped on request"),
            Missed::OverLimit(s) => {
                StageError::new(ErrorCode::Timeout, format!("it was not done after {s:.0} s"))
            }
        }
    }
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

    /// Runs a pipeline with stages that nothing asked for depends on.
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
        let garment = last::<Garment>(&result.log).ok_or_else(no_garment)?;
        Ok(Ran {
            garment,
            body: last(&result.log),
            model: last(&result.log),
            figures: last(&result.log),
            stages_s: stages(&result),
            wall_s,
            cpu_s,
            peak_memory_bytes,
            reads: named(&reads),
        })
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

fn no_garment() -> Missed {
    let e = StageError::invalid("the pipeline makes no garment to be compared");
    Missed::Failed(e.hint("leave out --until, or name a stage behind the draper"))
}

fn wait_is_on(wait: &Receiver<()>) -> bool {
    matches!(wait.recv_timeout(WATCH), Err(RecvTimeoutError::Timeout))
}

/// Wall time by stage of those that ran, seconds.
fn stages(result: &RunResult) -> BTreeMap<String, f64> {
    let ran = result.metrics.stages.iter().filter(|s| s.skipped.is_none());
    ran.map(|s| (s.id.clone(), s.wall_s)).collect()
}

/// Files by name, with the digests of their contents.
fn named(reads: &Reads) -> BTreeMap<String, Option<String>> {
    let reads = reads.lock().unwrap_or_else(PoisonError::into_inner);
    let one = |(path, hash): (&std::path::PathBuf, &Option<toile_core::cache::Hash>)| {
        (path.display().to_string(), hash.map(|h| h.hex()))
    };
    reads.iter().map(one).collect()
}

/// The last artifact of a type.
fn last<T: ArtifactType + Clone>(log: &RunLog) -> Option<T> {
    let values = log.stages.iter().rev().flat_map(|s| &s.outputs);
    let mut artifacts = values.flat_map(|v| v.entries()).map(|(_, a)| a);
    artifacts.find_map(|a| {
        let any: &dyn Any = a.as_ref();
        any.downcast_ref::<T>().cloned()
    })
}

/// Puts the high-water mark of memory back to what is held now; of no effect where the kernel does not do that.
fn forget_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// The high-water mark of resident memory, bytes, from the kernel's own record (Linux).
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kib * 1024)
}
