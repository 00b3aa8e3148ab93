//! Settings of the static solver.

use crate::energy::Models;
use crate::statics::factor::scalar::Precision;
use std::time::Duration;

/// Settings of the rest solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticEquilibrium {
    /// Membrane and bending.
    pub models: Models,
    /// Speed that cloth at rest must not gain in a sixtieth of a second, m/s.
    pub speed: f64,
    /// The share of the vertices that may gain more: some never come to rest where the skin of a
    /// body folds.
    pub non_static: f64,
    /// The coarsest level has at most about this many nodes.
    pub coarsest: usize,
    /// Steps on each level but the finest.
    pub coarse_steps: usize,
    /// Steps on the finest level before giving up.
    pub finest_steps: usize,
    /// Seams are joined when their gaps are below this, m.
    pub join_gap: f64,
    /// Wall time before giving up.
    pub budget: Duration,
    /// Whether bending starts far too stiff and is let go level by level, so that the state of rest
    /// hardly depends on where the cloth began.
    pub bending_continuation: bool,
    /// Whether the cloth goes on from where it is, on its own mesh alone: what came to rest on a
    /// coarser mesh keeps its folds.
    pub from_here: bool,
    /// Whether cloth passes through cloth while its seams close: what lies in its way does not keep
    /// them open, and the sewn garment is taken out of itself.
    pub sew_through: bool,
    /// Whether a step of a tenth of a second and more in which nothing is faster than `speed`
    /// proves rest, too.
    pub long_proof: bool,
    /// How precise the factor of each step is.
    pub precision: Precision,
    /// Whether what rests sleeps while few nodes move, which settle by themselves.
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
            long_proof: false,
            precision: Precision::default(),
            asleep: true,
        }
    }
}
