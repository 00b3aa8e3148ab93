//! A run's process from inside.

use super::wire::{Task, write};
use crate::measure::jitter;
use crate::measure::{Bench, Missed, Ran};
use std::sync::Arc;
use toile_core::{Cancel, Registry, StageError};
use toile_pipeline::cache::Cache;
use toile_pipeline::{Changes, Pipeline, add_implicit, load_with};

/// Runs the task of a line and gives its answer as bytes.
///
/// Errors: a sentence; the line is no task, or threads cannot be had.
pub fn answer(line: &str, registry: &Registry) -> Result<Vec<u8>, String> {
    let task: Task = serde_json::from_str(line).map_err(|e| format!("this is no task: {e}"))?;
    let pool =
        rayon::ThreadPoolBuilder::new().num_threads(task.threads).build().map_err(|e| e.to_string())?;
    write(pool.install(|| run(&task, registry)))
}

fn run(task: &Task, registry: &Registry) -> Result<Ran, Missed> {
    let mut pipeline = loaded(task, registry).map_err(Missed::Failed)?;
    if let Some((amount, seed)) = task.moved_by() {
        jitter::insert(&mut pipeline, amount, seed).map_err(Missed::Failed)?;
    }
    let bench =
        Bench { until: task.until.clone(), cancel: Cancel::new(), listener: Arc::new(()), apart: None };
    let cache = task.cache.as_ref().map(|folder| Arc::new(Cache::new(folder)));
    bench.here(&pipeline, &task.also, None, cache)
}

/// The pipeline; its text was loaded before, with the overrides that are in it.
fn loaded(task: &Task, registry: &Registry) -> Result<Pipeline, StageError> {
    let changes = Changes { again: true, ..Changes::default() };
    let loaded = load_with(&task.text, &task.file, &task.base, registry, &changes);
    let mut pipeline = loaded.map_err(|faults| StageError::invalid(faults.to_string()))?;
    add_implicit(&mut pipeline, registry);
    Ok(pipeline)
}
