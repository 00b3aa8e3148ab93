//! Newton's method to rest on one level.
//!
//! Each step minimises the potential plus the inertia of a step of pseudo-time (a sheet at rest that is let go), which
//! grows as long as steps succeed: far from rest the cloth falls without overshooting, near rest the steps are Newton's
//! own. A step is first kept out of the body, then cut back where cloth would meet cloth, then shortened until the
//! potential lies below the highest of the last few (Grippo, Lampariello, Lucidi 1986): cloth hardly stretches but bends
//! freely, so a good step may first raise the potential.
//!
//! For the same reason the matrix takes the stress that the last step foretold, not that of the new places, whose strain
//! has an error of second order times a great stiffness (the mixed form of Magisano, Leonetti, Garcea 2017): steps may then
//! be many times longer. It leaves the answer alone, for the forces are those of the places.
//!
//! Cost of a step: one factorization, O(n^1.5), and O(n) for all else.

use super::linear::Linear;
use super::multifrontal::{Halt, Stop};
use super::nearby::Nearby;
use super::system::System;
use crate::contact::tree::ClothTree;
use nalgebra::Vector3;
use std::ops::ControlFlow;

type Vec3 = Vector3<f64>;

/// The step of time in which cloth at rest must not gain speed, s.
pub const REST_STEP: f64 = 1.0 / 60.0;

/// Halvings of a step before it is taken as it is.
const MOST_HALVINGS: u32 = 6;

/// Moves shorter than this change the potential by less than its rounding, m.
const ROUNDING: f64 = 1e-10;

/// Share of the slope by which the potential must fall (Armijo's rule).
const LEAST_FALL: f64 = 1e-4;

/// Steps whose highest potential a new one is measured by. More lets the cloth pass through worse states to better ones.
const MEMORY: usize = 8;

/// Factor by which pseudo-time grows after a whole step.
const GROWTH: f64 = 1.5;

/// Least step of pseudo-time in which the speed tells that nothing slides or falls any more, s.
const SLOW_STEP: f64 = 0.1;

/// When to stop, and how fast to go.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// First step of pseudo-time, s.
    pub first: f64,
    /// Longest step of pseudo-time, s.
    pub longest: f64,
    /// Steps at most.
    pub steps: usize,
    /// Speed below which the cloth is at rest, m/s.
    pub speed: f64,
    /// Farthest that a node may move in a step, m.
    pub farthest: f64,
    /// Whether rest must be proved by a step of [`REST_STEP`].
    pub prove: bool,
}

/// How a level stands after a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Outcome {
    /// Steps made.
    pub steps: usize,
    /// Whether the cloth is at rest.
    pub at_rest: bool,
    /// Greatest speed gained in the last step of time, m/s.
    pub speed: f64,
    /// Greatest force left over on a node before that step, N.
    pub residual: f64,
    /// Share of the step that was taken.
    pub share: f64,
    /// The step of pseudo-time, s.
    pub dt: f64,
}

/// What a caller learns after each step; it may stop the level.
pub type Watch<'w> = dyn FnMut(&System<'_>, &[Vec3], &Outcome) -> ControlFlow<()> + 'w;

/// Moves `x` to rest, or as far as the pace allows. `layout` orders the elimination, `tree` finds cloth near cloth; `stop`
/// is asked every few milliseconds.
///
/// # Errors
/// [`Halt`]: `stop` said so, or no inertia makes the matrix positive definite, for the numbers are not finite.
pub fn relax(
    system: &mut System<'_>,
    layout: &[Vec3],
    tree: Option<&ClothTree>,
    x: &mut [Vec3],
    pace: &Pace,
    watch: &mut Watch<'_>,
    stop: &Stop,
) -> Result<Outcome, Halt> {
    let mut nearby = Nearby::new(tree);
    nearby.seek(system, x, &vec![Vec3::zeros(); x.len()]);
    nearby.untangle(system, x);
    system.touch(x);
    let mut linear = Linear::new(system, layout);
    let mut outcome = Outcome { dt: pace.first, ..Outcome::default() };
    let mut heights = Vec::new();
    let mut proves = false;
    let mut dt = pace.first;
    let mut last = f64::INFINITY;
    for step in 1..=pace.steps {
        if system.is_tangled() {
            nearby.untangle(system, x);
        }
        system.touch(x);
        linear.follow(system);
        let g = system.gradient(x);
        let used = if proves { REST_STEP } else { dt };
        let mut moves = linear.step(system, x, &g, used, last, stop)?;
        last = greatest(&moves);
        outcome = Outcome { steps: step, speed: last / used, residual: greatest(&g), dt: used, ..outcome };
        shorten(&mut moves, pace.farthest / last);
        system.clear_of_body(x, &mut moves);
        nearby.seek(system, x, &moves);
        nearby.limit(system, x, &mut moves);
        outcome.share = descend(system, x, &g, &mut moves, &mut heights);
        system.elastic.foretell(x, &moves);
        x.iter_mut().zip(&moves).for_each(|(p, m)| *p += m);
        let slow = outcome.speed < pace.speed;
        outcome.at_rest = slow && (proves || !pace.prove);
        if watch(system, x, &outcome).is_break() || outcome.at_rest {
            break;
        }
        if !proves {
            dt = next_dt(dt, outcome.share, pace);
        }
        if !proves && !slow {
            system.drag(x);
        }
        proves = pace.prove && !proves && slow && outcome.share == 1.0 && outcome.dt >= SLOW_STEP;
    }
    if system.is_tangled() {
        nearby.untangle(system, x);
    }
    Ok(outcome)
}

fn next_dt(dt: f64, share: f64, pace: &Pace) -> f64 {
    match share {
        1.0 => (dt * GROWTH).min(pace.longest),
        s if s < 0.5 => (dt * 0.6).max(1e-3),
        _ => dt,
    }
}

/// Greatest length.
#[must_use]
pub fn greatest(v: &[Vec3]) -> f64 {
    v.iter().map(Vec3::norm_squared).fold(0.0, f64::max).sqrt()
}

fn shorten(moves: &mut [Vec3], share: f64) {
    if share < 1.0 {
        moves.iter_mut().for_each(|m| *m *= share);
    }
}

/// Shortens the step until the potential falls below the highest of the last ones; the share that is left.
fn descend(system: &System<'_>, x: &[Vec3], g: &[Vec3], moves: &mut [Vec3], heights: &mut Vec<f64>) -> f64 {
    if greatest(moves) < ROUNDING {
        return 1.0;
    }
    let slope: f64 = g.iter().zip(moves.iter()).map(|(g, d)| g.dot(d)).sum();
    let start = system.value(x);
    heights.push(start);
    if heights.len() > MEMORY {
        heights.remove(0);
    }
    // Rounding of the sum hides changes smaller than this.
    let highest = heights.iter().copied().fold(start, f64::max) + 1e-13 * start.abs();
    let mut share = 1.0;
    for _ in 0..MOST_HALVINGS {
        let trial: Vec<Vec3> = x.iter().zip(moves.iter()).map(|(p, d)| p + d).collect();
        if system.value(&trial) <= highest + LEAST_FALL * share * slope.min(0.0) {
            break;
        }
        share *= 0.5;
        shorten(moves, 0.5);
    }
    share
}
