//! How far the garment ends from itself when its start is moved a little.

use super::ReferenceSearch;
use crate::errors::compare;
use crate::knobs::source::Source;
use crate::measure::{Bench, Missed, Ran};
use crate::record::{OwnSpread, ReferenceLevel};
use std::sync::Arc;
use std::time::{Duration, Instant};
use toile_core::{Length, StageError};
use toile_pipeline::Override;
use toile_pipeline::cache::Cache;

impl ReferenceSearch<'_> {
    /// Starts the level before the last again from moved starts.
    pub(super) fn spread(
        &self,
        levels: &[ReferenceLevel],
        unmoved: &Ran,
        tell: &mut dyn FnMut(String),
    ) -> Result<Option<OwnSpread>, StageError> {
        let (started, level) = (Instant::now(), levels.len().saturating_sub(2));
        let jitter_mm = self.jitter.metres() * 1e3;
        let mut spread = OwnSpread { jitter_mm, level, starts_mm: Vec::new(), failed: Vec::new() };
        for seed in 1..=self.starts as u64 {
            let left = self.starts_budget.saturating_sub(started.elapsed());
            let overrides = self.board.overrides(&levels[level].setting);
            let (moved, cache) = ((self.jitter, seed), Some(self.cache.clone()));
            match moved_start(self.source, &overrides, self.bench, moved, Some(left), cache) {
                Ok(ran) => {
                    let d = compare(&ran, unmoved)?.distance_mm;
                    let within = format!("95 % within {:.2} mm of the unmoved", d.p95);
                    tell(format!("start {seed} moved by {jitter_mm} mm: {within}"));
                    spread.starts_mm.push(d);
                }
                Err(Missed::Cancelled) => return Err(Missed::Cancelled.into()),
                Err(Missed::OverLimit(_)) => break,
                Err(Missed::Failed(e)) => spread.failed.push(e.message),
            }
        }
        let tried = !spread.starts_mm.is_empty() || !spread.failed.is_empty();
        Ok(tried.then_some(spread))
    }
}

/// Runs a pipeline from a moved start.
pub(crate) fn moved_start(
    source: &Source<'_>,
    overrides: &[Override],
    bench: &Bench,
    moved: (Length, u64),
    limit: Option<Duration>,
    cache: Option<Arc<Cache>>,
) -> Result<Ran, Missed> {
    let pipeline = source.load(overrides).map_err(|f| Missed::Failed(StageError::invalid(f.to_string())))?;
    bench.run_moved(pipeline, moved, limit, cache)
}
