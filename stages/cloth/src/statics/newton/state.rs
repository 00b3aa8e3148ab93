//! The options and the state of Newton's method, and what it reports.

use crate::statics::factor::scalar::Precision;
use crate::statics::forces::distance_query::ContactQuery;
use crate::statics::forces::system::System;
use crate::statics::newton::linear::Linear;
use crate::statics::newton::nearby::Nearby;
use nalgebra::Vector3;
use std::ops::ControlFlow;

type Vec3 = Vector3<f64>;

/// What proves that the cloth is at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Proof {
    /// Any step in which nothing is fast.
    AnyStep,
    /// A proof step, of [`REST_STEP`](super::to_rest::REST_STEP), in which nothing is fast.
    ProofStep,
    /// A proof step, or a full step of at least `SLOW_STEP`, in which nothing is fast.
    ProofOrLongStep,
}

impl Proof {
    /// The proof of a final state; `long` if a long step proves rest, too.
    pub(crate) fn of(long: bool) -> Self {
        if long { Self::ProofOrLongStep } else { Self::ProofStep }
    }
}

/// Options of Newton's method with pseudo-transient continuation.
#[derive(Debug, Clone, Copy)]
pub struct NewtonOptions {
    /// First step of pseudo-time, s.
    pub first: f64,
    /// Longest step of pseudo-time, s.
    pub longest: f64,
    /// Steps at most.
    pub steps: usize,
    /// Speed below which the cloth is at rest, m/s.
    pub speed: f64,
    /// Share of the nodes that may be faster.
    pub non_static: f64,
    /// Farthest that a node may move in a step, m.
    pub farthest: f64,
    /// What proves that the cloth is at rest.
    pub proof: Proof,
    /// Whether steps are made without a line search: cloth then slides over a rough surface, where
    /// some nodes never come to rest.
    pub skip_line_search: bool,
    /// Whether a step that raises the potential because some of its nodes are stopped is solved
    /// again with these nodes held still.
    pub holds_stopped: bool,
    /// Precision of the factor of each step.
    pub precision: Precision,
    /// Whether the cloths of a stack start one by one before all move together.
    pub one_by_one: bool,
    /// Whether nodes at rest are held still while few others move, which are then solved alone.
    pub asleep: bool,
}

/// The state of a level after a step, for reports.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Outcome {
    /// Steps made.
    pub steps: usize,
    /// Whether the cloth is at rest.
    pub at_rest: bool,
    /// Greatest speed gained in the last step, m/s, without the share of nodes that may be faster.
    pub speed: f64,
    /// Greatest speed gained in the last step, m/s.
    pub fastest: f64,
    /// Share of the nodes that were faster than cloth at rest.
    pub non_static: f64,
    /// Greatest residual force on a node before that step, N.
    pub residual: f64,
    /// Share of the step that was taken.
    pub share: f64,
    /// The step of pseudo-time, s.
    pub dt: f64,
    /// Greatest speed gained in the last proof step, m/s: it tells how far from rest the cloth is.
    /// `None` before the first one.
    pub gained: Option<f64>,
}

/// Called after each step; it may stop the level.
pub type Watch<'w> = dyn FnMut(&System<'_>, &[Vec3], &Outcome) -> ControlFlow<()> + 'w;

/// The state of Newton's method from step to step.
pub struct NewtonState {
    pub(crate) nearby: Nearby,
    pub(crate) linear: Linear,
    pub(crate) outcome: Outcome,
    /// The potentials of the last steps, for the non-monotone line search.
    pub(crate) history: Vec<f64>,
    /// Whether the next step is a proof step, of [`REST_STEP`](super::to_rest::REST_STEP).
    pub(crate) verifying: bool,
    /// Consecutive proof steps.
    pub(crate) proof_steps: usize,
    /// Whether the factor is that of the last proof step.
    pub(crate) reuse_factor: bool,
    /// Consecutive slow steps since the last proof step.
    pub(crate) slow_steps: usize,
    /// Whether a proof step has failed.
    pub(crate) has_failed: bool,
    /// The next step of pseudo-time, s.
    pub(crate) dt: f64,
    /// Longest move of the last Newton step before it was limited, m.
    pub(crate) longest_move: f64,
    /// The energy at the end of the last step.
    pub(crate) end: Option<StepEnd>,
    /// The moves of the last step, m.
    pub(crate) moves: Vec<Vec3>,
    /// Whether the last step was shortened to the region in which the pairs of a subdomain are
    /// known.
    pub(crate) has_left: bool,
}

/// The energy at the end of a step, with what the next step can reuse.
pub(crate) struct StepEnd {
    pub(crate) at: Vec<Vec3>,
    pub(crate) contact_free: f64,
    pub(crate) queries: Vec<ContactQuery>,
}

/// Greatest length of the vectors.
#[must_use]
pub fn greatest(v: &[Vec3]) -> f64 {
    v.iter().map(Vec3::norm_squared).fold(0.0, f64::max).sqrt()
}
