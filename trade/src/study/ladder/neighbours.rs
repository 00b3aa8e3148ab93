//! How far levels that are a little finer or coarser end from each other.
//!
//! What a fiftieth of a resolution adds to the error of a mesh is a twenty-fifth of that error at
//! second order, so what lies farther apart are states of rest that the mesh picks by chance. Moved
//! starts of one mesh do not tell of those.

use super::{RATIO, ReferenceSearch};
use crate::errors::compare;
use crate::measure::{Missed, Ran};
use crate::record::{NeighbourLevels, ReferenceLevel};
use std::time::{Duration, Instant};
use toile_core::StageError;

/// By how much resolutions are refined and coarsened, as factors.
const NEAR: [f64; 2] = [1.02, 1.0 / 1.02];

impl ReferenceSearch<'_> {
    /// Runs the level before the last with resolutions near its own, where it has any; `unmoved` is
    /// its garment.
    pub(super) fn neighbours(
        &self,
        levels: &[ReferenceLevel],
        unmoved: &Ran,
        budget: Duration,
        tell: &mut dyn FnMut(String),
    ) -> Result<Option<NeighbourLevels>, StageError> {
        let (started, level) = (Instant::now(), levels.len().saturating_sub(2));
        let mut near = NeighbourLevels { level, ..NeighbourLevels::default() };
        for factor in NEAR {
            let setting = self.board.refined(RATIO.powi(level as i32) * factor);
            // Two parts of an edge are two, a fiftieth more or less.
            if setting == levels[level].setting
                || !self.board.differ_in_space(&setting, &levels[level].setting)
            {
                break;
            }
            let left = budget.saturating_sub(started.elapsed());
            match self.level(&setting, Some(left)) {
                Ok(ran) => {
                    let d = compare(&ran, unmoved)?.distance_mm;
                    let way = if factor > 1.0 { "finer" } else { "coarser" };
                    tell(format!("a fiftieth {way} than level {level}: 95 % within {:.2} mm of it", d.p95));
                    near.apart_mm.push(d);
                }
                Err(Missed::Cancelled) => return Err(Missed::Cancelled.into()),
                Err(Missed::OverLimit(_)) => break,
                Err(Missed::Failed(e)) => near.failed.push(e.message),
            }
        }
        let tried = !near.apart_mm.is_empty() || !near.failed.is_empty();
        Ok(tried.then_some(near))
    }
}
