//! Newton's method to rest on one level.
//!
//! Each step minimises the potential plus the inertia of a step of pseudo-time (a sheet at rest that is let go), which
//! grows as long as steps succeed: far from rest the cloth falls without overshooting, near rest the steps are Newton's
//! own. A step is first kept out of the body, then cut back where cloth would meet cloth, then shortened until the
//! potential falls.
//!
//! Cost of a step: one factorization, O(n^1.5), which is nine tenths of it.

use super::multifrontal::{Factor, NotPositive, Symbolic};
use super::pattern::Pattern;
use super::system::System;
use crate::contact::limit::limit;
use crate::contact::pair::Pair;
use crate::contact::tree::ClothTree;
use nalgebra::{Matrix3, Vector3};
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

/// Least and greatest share of friction's stiffness in the matrix where nodes slide.
pub(super) const EASE: (f64, f64) = (0.05, 1.0);

/// Friction of a node that slides, as a share of the limit at which it starts to: below 1 it comes to a stop.
const SLIDING: f64 = 0.7;

/// Friction asked for beyond its limit after a proof of rest, as a share of all friction: cloth that needs more slides on.
const EXCESS: f64 = 0.02;

/// Least step of pseudo-time in which the speed tells that sliding is over, s.
const HOLD_STEP: f64 = 0.1;

/// Multiple of the speed of rest below which the last slides are settled with friction that holds.
const HOLD: f64 = 5.0;

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

/// The matrix and its factor, kept from step to step.
struct Linear<'a> {
    layout: &'a [Vec3],
    pattern: Pattern,
    symbolic: Symbolic,
    values: Vec<Matrix3<f64>>,
}

impl<'a> Linear<'a> {
    fn new(system: &mut System<'_>, layout: &'a [Vec3]) -> Self {
        let pattern = system.pattern();
        system.elastic.bind(&pattern);
        let symbolic = Symbolic::new(&pattern, layout);
        Self { layout, pattern, symbolic, values: Vec::new() }
    }

    /// Follows the contacts: new pairs need new places in the matrix.
    fn follow(&mut self, system: &mut System<'_>) {
        let known = system.layers.iter().flat_map(|l| l.groups()).all(|nodes| self.pattern.couples(nodes));
        if !known {
            *self = Self { values: std::mem::take(&mut self.values), ..Self::new(system, self.layout) };
        }
    }

    /// The step of pseudo-time `dt` from `x`.
    fn step(
        &mut self,
        system: &System<'_>,
        x: &[Vec3],
        g: &[Vec3],
        dt: f64,
    ) -> Result<Vec<Vec3>, NotPositive> {
        let mut shift = 1.0 / (dt * dt);
        let factor: Factor = loop {
            system.matrix(x, &self.pattern, shift, &mut self.values);
            match self.symbolic.factor(&self.values) {
                Ok(factor) => break factor,
                // Rounding can cost a nearly singular matrix its sign; more inertia gives it back.
                Err(e) if shift > 1e12 => return Err(e),
                Err(_) => shift *= 100.0,
            }
        };
        let mut step: Vec<Vec3> = g.iter().map(|g| -g).collect();
        self.symbolic.solve(&factor, &mut step);
        Ok(step)
    }
}

/// Moves `x` to rest, or as far as the pace allows. `layout` orders the elimination, `tree` finds cloth near cloth.
///
/// # Errors
/// [`NotPositive`] where no inertia makes the matrix positive definite: the numbers are not finite.
pub fn relax(
    system: &mut System<'_>,
    layout: &[Vec3],
    tree: Option<&ClothTree>,
    x: &mut Vec<Vec3>,
    pace: &Pace,
    watch: &mut Watch<'_>,
) -> Result<Outcome, NotPositive> {
    if let (Some(tree), Some(layers)) = (tree, &mut system.layers) {
        layers.pairs = tree.pairs(x, &vec![Vec3::zeros(); x.len()], layers.thickness);
    }
    untangle(system, tree, x);
    system.touch(x);
    let mut linear = Linear::new(system, layout);
    let mut outcome = Outcome { dt: pace.first, ..Outcome::default() };
    let mut stage = Stage::Slide;
    let mut dt = pace.first;
    for step in 1..=pace.steps {
        if system.layers.as_ref().is_some_and(|l| !l.tangled.is_empty()) {
            untangle(system, tree, x);
        }
        system.touch(x);
        linear.follow(system);
        let g = system.gradient(x);
        let used = if stage == Stage::Prove { REST_STEP } else { dt };
        let mut moves = linear.step(system, x, &g, used)?;
        let longest = greatest(&moves);
        outcome = Outcome { steps: step, speed: longest / used, residual: greatest(&g), dt: used, ..outcome };
        let slow = outcome.speed < pace.speed;
        shorten(&mut moves, pace.farthest / longest);
        clear_of_body(system, x, &mut moves);
        if let (Some(tree), Some(layers)) = (tree, &mut system.layers) {
            layers.pairs = tree.pairs(x, &moves, layers.thickness);
            let strict: Vec<Pair> = layers.pairs.iter().filter(|p| !layers.is_tangled(p)).copied().collect();
            limit(x, &mut moves, &strict);
        }
        outcome.share = descend(system, x, &g, &moves);
        let stays = || stage == Stage::Prove && system.excess(x) < EXCESS;
        outcome.at_rest = slow && (!pace.prove || stays());
        if watch(system, x, &outcome).is_break() || outcome.at_rest {
            break;
        }
        dt = next_pace(system, dt, outcome.share, pace);
        stage = next_stage(system, x, stage, &outcome, pace);
    }
    if system.layers.as_ref().is_some_and(|l| !l.tangled.is_empty()) {
        untangle(system, tree, x);
    }
    Ok(outcome)
}

/// What a step may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// Nodes slide where friction is at its limit.
    Slide,
    /// Friction holds without limit, so that the rest comes to rest; a smooth problem, soon solved.
    Hold,
    /// A step of [`REST_STEP`] from standstill with friction cut back to its limit.
    Prove,
}

fn next_stage(system: &mut System<'_>, x: &[Vec3], stage: Stage, outcome: &Outcome, pace: &Pace) -> Stage {
    let slow = outcome.speed < pace.speed && outcome.share == 1.0;
    let (next, share) = match stage {
        _ if !pace.prove => (Stage::Slide, SLIDING),
        Stage::Slide if outcome.speed < HOLD * pace.speed && outcome.dt >= HOLD_STEP => {
            (Stage::Hold, SLIDING)
        }
        Stage::Slide => (Stage::Slide, SLIDING),
        Stage::Hold if slow => (Stage::Prove, 1.0),
        Stage::Hold => (Stage::Hold, f64::INFINITY),
        Stage::Prove => (Stage::Slide, SLIDING),
    };
    if share.is_finite() {
        system.drag(x, share);
    }
    system.holds = next == Stage::Hold;
    if next == Stage::Prove {
        // What was held beyond its limit must prove that it stays without the spring that held it.
        system.ease = 0.0;
    }
    next
}

/// The next step of time. Where a step overshot, sliding nodes are stiffened first, then the step shortened.
fn next_pace(system: &mut System<'_>, dt: f64, share: f64, pace: &Pace) -> f64 {
    let slides = system.slips.contains(&true);
    if system.ease == 0.0 {
        system.ease = EASE.0;
        return dt;
    }
    if share == 1.0 {
        system.ease = (0.5 * system.ease).max(EASE.0);
        (dt * 1.5).min(pace.longest)
    } else if slides && system.ease < EASE.1 {
        system.ease = (4.0 * system.ease).min(EASE.1);
        dt
    } else if share < 0.5 {
        (dt * 0.6).max(1e-3)
    } else {
        dt
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

/// Looks for crossings that the start has, or that are left of them.
fn untangle(system: &mut System<'_>, tree: Option<&ClothTree>, x: &[Vec3]) {
    if let (Some(tree), Some(layers)) = (tree, &mut system.layers) {
        layers.untangle(&tree.crossings(x), x);
    }
}

/// Ends moves that lead into the body just outside it.
fn clear_of_body(system: &System<'_>, x: &[Vec3], moves: &mut [Vec3]) {
    let Some(s) = &system.support else { return };
    let gaps: Vec<f64> = s.offsets.iter().map(|o| 0.5 * o).collect();
    s.body.guard(x, moves, &gaps);
}

/// Makes the step or, where the potential does not fall, a share of it; the share.
fn descend(system: &System<'_>, x: &mut Vec<Vec3>, g: &[Vec3], moves: &[Vec3]) -> f64 {
    if greatest(moves) < ROUNDING {
        x.iter_mut().zip(moves).for_each(|(p, m)| *p += m);
        return 1.0;
    }
    let slope: f64 = g.iter().zip(moves).map(|(g, d)| g.dot(d)).sum();
    let start = system.value(x);
    let mut share = 1.0;
    for tries in 0..=MOST_HALVINGS {
        let trial: Vec<Vec3> = x.iter().zip(moves).map(|(p, d)| p + d * share).collect();
        // Rounding of the sum hides changes smaller than this.
        let noise = 1e-13 * start.abs();
        if tries == MOST_HALVINGS
            || system.value(&trial) <= start + LEAST_FALL * share * slope.min(0.0) + noise
        {
            *x = trial;
            break;
        }
        share *= 0.5;
    }
    share
}
