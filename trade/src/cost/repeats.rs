//! Several runs of the same, made one.

use super::record::CostRecord;

/// Of runs of the same pipeline at the same setting, the shortest record of each stage: what else a
/// machine does makes a run longer, never shorter (Chen, Revels, Robust benchmarking in noisy
/// environments, 2016). Stages stand in the first run's order.
pub fn shortest(runs: Vec<Vec<CostRecord>>) -> Vec<CostRecord> {
    let mut runs = runs.into_iter();
    let mut best = runs.next().unwrap_or_default();
    for run in runs {
        for (own, next) in best.iter_mut().zip(run) {
            if next.stage == own.stage && next.used.wall_s < own.used.wall_s {
                *own = next;
            }
        }
    }
    best
}
