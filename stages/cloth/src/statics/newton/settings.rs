//! Settings of the static solver.

use crate::energy::Models;
use crate::statics::factor::scalar::Precision;
use std::time::Duration;

/// Settings of the static solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticEquilibrium {
    /// Membrane and bending models.
    pub models: Models,
    /// Cloth at rest gains less than this speed in a sixtieth of a second, m/s.
    pub speed: f64,
    /// Share of the vertices that may gain more: some never come to rest where the surface of a
    /// body folds.
    pub non_static: f64,
    /// Nodes of the coarsest level, at most about this many.
    pub coarsest: usize,
    /// Steps at most on each level but the finest.
    pub coarse_steps: usize,
    /// Steps at most on the finest level.
    pub finest_steps: usize,
    /// Gap below which seams are joined, m.
    pub join_gap: f64,
    /// Wall time at most.
    pub budget: Duration,
    /// Whether bending starts far too stiff and is lowered level by level, so that the equilibrium
    /// hardly depends on the initial positions.
    pub bending_continuation: bool,
    /// Whether the cloth is solved from its present state on its own mesh alone, without coarser
    /// levels, so that it keeps its folds.
    pub from_here: bool,
    /// Whether cloth passes through cloth while its seams close. Other cloth then does not keep
    /// them open, and the crossings of the sewn garment are resolved.
    pub sew_through: bool,
    /// Whether a seam that stays open on a finer mesh than the first ends the solution, because the
    /// caller has another way of sewing: each finer mesh takes several times as long.
    pub gives_way: bool,
    /// Whether a step of at least a tenth of a second in which nothing is faster than `speed`
    /// proves rest, too.
    pub long_proof: bool,
    /// Precision of the factor of each step.
    pub precision: Precision,
    /// Whether nodes at rest are held still while few others move, which are then solved alone.
    pub asleep: bool,
}

impl Default for StaticEquilibrium {
    fn default() -> Self {
        Self {
            models: Models::STATIC,
            speed: 1e-3,
            non_static: 0.0,
            coarsest: 200,
            coarse_steps: 30,
            finest_steps: 500,
            join_gap: 5e-4,
            budget: Duration::from_secs(600),
            bending_continuation: false,
            from_here: false,
            sew_through: false,
            gives_way: false,
            long_proof: false,
            precision: Precision::default(),
            asleep: true,
        }
    }
}
