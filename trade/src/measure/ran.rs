//! What a run gave, or why it gave nothing.

use std::any::Any;
use std::collections::BTreeMap;
use std::sync::PoisonError;
use toile_core::RunLog;
use toile_core::artifact::{Body, Figures, Garment, Model};
use toile_core::{ArtifactType, ErrorCode, StageError};
use toile_pipeline::{Reads, RunResult};

/// What a run gave.
#[derive(Debug)]
pub struct Ran {
    /// The garment at the end.
    pub garment: Garment,
    /// The body that wears it.
    pub body: Option<Body>,
    /// The garment with its textures.
    pub model: Option<Model>,
    /// The judgement of the garment; none where the run ended before it.
    pub figures: Option<Figures>,
    /// Wall time by stage, seconds.
    pub stages_s: BTreeMap<String, f64>,
    /// Seconds of wall time.
    pub wall_s: f64,
    /// Seconds of processor time, all threads.
    pub cpu_s: f64,
    /// Greatest resident memory of its process, bytes, where the system reports it.
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

/// What a run gave, with its clocks: wall and processor time, seconds.
///
/// Errors: there is no garment.
pub(super) fn ran(
    result: &RunResult,
    reads: &Reads,
    [wall_s, cpu_s]: [f64; 2],
    peak_memory_bytes: Option<u64>,
) -> Result<Ran, Missed> {
    Ok(Ran {
        garment: last::<Garment>(&result.log).ok_or_else(no_garment)?,
        body: last(&result.log),
        model: last(&result.log),
        figures: last(&result.log),
        stages_s: stages(result),
        wall_s,
        cpu_s,
        peak_memory_bytes,
        reads: named(reads),
    })
}

/// Wall time by stage of those that ran, seconds.
fn stages(result: &RunResult) -> BTreeMap<String, f64> {
    let ran = result.metrics.stages.iter().filter(|s| s.skipped.is_none());
    ran.map(|s| (s.id.clone(), s.wall_s)).collect()
}

/// Files by name, with the digests of their contents.
fn named(reads: &Reads) -> BTreeMap<String, Option<String>> {
    let reads = reads.lock().unwrap_or_else(PoisonError::into_inner);
    let one = |(path, hash): (&std::path::PathBuf, &Option<toile_core::artifact::Digest>)| {
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

fn no_garment() -> Missed {
    let e = StageError::invalid("the pipeline makes no garment to be compared");
    Missed::Failed(e.hint("leave out --until, or name a stage behind the draper"))
}
