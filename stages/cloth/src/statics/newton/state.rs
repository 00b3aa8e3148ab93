//! Newton's method under way: options, state, and what is reported.

use crate::statics::factor::scalar::Precision;
use crate::statics::forces::body_contact::ContactQuery;
use crate::statics::forces::system::System;
use crate::statics::newton::linear::Linear;
use crate::statics::newton::nearby::Nearby;
use nalgebra::Vector3;
use std::ops::ControlFlow;

type Vec3 = Vector3<f64>;

/// When to stop, and how fast to go.
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
    /// The share of its nodes that may be faster.
    pub non_static: f64,
    /// Farthest that a node may move in a step, m.
    pub farthest: f64,
    /// Whether rest must be proved by a step of [`REST_STEP`].
    pub prove: bool,
    /// Whether a whole step of [`SLOW_STEP`] and more in which nothing is fast proves rest, too.
    pub long_proof: bool,
    /// Whether steps are taken without a search along them: the cloth gets about in rough ground,
    /// where some nodes never come to rest.
    pub rough: bool,
    /// Whether a step that raises the potential, because some of its nodes are stopped, is sought
    /// again with these held still.
    pub yields: bool,
    /// How precise the factor of each step is.
    pub precision: Precision,
    /// Whether cloths are laid down one by one before all move together.
    pub one_by_one: bool,
    /// Whether what rests sleeps while few nodes move, which settle by themselves.
    pub asleep: bool,
}

/// How a level stands after a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Outcome {
    /// Steps made.
    pub steps: usize,
    /// Whether the cloth is at rest.
    pub at_rest: bool,
    /// Greatest speed gained in the last step of time, m/s, but for the share of nodes that may be
    /// faster.
    pub speed: f64,
    /// Greatest speed gained in it, m/s.
    pub fastest: f64,
    /// The share of nodes that were faster than the cloth at rest is.
    pub non_static: f64,
    /// Greatest force left over on a node before that step, N.
    pub residual: f64,
    /// Share of the step that was taken.
    pub share: f64,
    /// The step of pseudo-time, s.
    pub dt: f64,
    /// Greatest speed gained in the last step of [`REST_STEP`], m/s: what says how far from rest
    /// the cloth is. Nothing before the first.
    pub gained: Option<f64>,
}

/// What a caller learns after each step; it may stop the level.
pub type Watch<'w> = dyn FnMut(&System<'_>, &[Vec3], &Outcome) -> ControlFlow<()> + 'w;

/// Newton's method under way: what is kept from step to step.
pub struct NewtonState {
    pub(crate) nearby: Nearby,
    pub(crate) linear: Linear,
    pub(crate) outcome: Outcome,
    /// The potentials of the last steps.
    pub(crate) history: Vec<f64>,
    /// Whether the next step is to prove rest.
    pub(crate) verifying: bool,
    /// Steps of it made in a row.
    pub(crate) proofs: usize,
    /// Whether the factor is that of such a step.
    pub(crate) reuse_factor: bool,
    /// Slow steps since the last of it.
    pub(crate) slow_steps: usize,
    /// Whether a proof has failed.
    pub(crate) failed: bool,
    pub(crate) dt: f64,
    /// How far the last step wanted to go, m.
    pub(crate) last: f64,
    /// What the last step found where it ended.
    pub(crate) before: Option<Before>,
    /// The last step.
    pub(crate) moves: Vec<Vec3>,
    /// Whether a step was cut short where the pairs of a part end.
    pub(crate) left: bool,
}

/// What a step found where it ended.
pub(crate) struct Before {
    pub(crate) at: Vec<Vec3>,
    pub(crate) contact_free: f64,
    pub(crate) queries: Vec<ContactQuery>,
}

/// Greatest length.
#[must_use]
pub fn greatest(v: &[Vec3]) -> f64 {
    v.iter().map(Vec3::norm_squared).fold(0.0, f64::max).sqrt()
}
