//! Newton's method with pseudo-transient continuation, on one level.
//!
//! Each step minimises the potential plus the inertia of a step of pseudo-time from rest. The step
//! of pseudo-time grows as long as steps succeed: far from rest the cloth falls without
//! overshooting, near rest the steps are those of Newton's method. A step is limited by the body,
//! then by continuous collision detection of cloth with cloth (and solved again with a shorter step
//! of pseudo-time if little of it is left), then by a non-monotone line search (see `line_search`):
//! cloth hardly stretches but bends freely, so a good step may first raise the potential.
//!
//! Limiting the moves of some nodes may turn the step of the others uphill, so that no share of it
//! lowers the potential. Where the options say so, the step is then solved again with the stopped
//! nodes held still (an active set). Gathers and armholes jam without this; but it keeps cloth from
//! sliding off an edge.
//!
//! For the same reason the matrix uses the stress that the last step predicted, not that at the new
//! positions, whose strain has an error of second order times a great stiffness (the mixed form of
//! Magisano, Leonetti, Garcea 2017). Steps may then be many times longer. The equilibrium does not
//! change, for the forces are those at the positions.
//!
//! Where a step moves few nodes, these and their neighbours are solved alone before the next step
//! (see `active_subset`). Rest is proved with all nodes, by a short step in which none of them
//! gains speed.
//!
//! Cost of a step: one factorization, O(n^1.5), and O(n) for the rest. Consecutive proof steps
//! share one factorization, for the cloth hardly moves in them. The next step reuses what the line
//! search evaluated at its end. Limits: one of many equilibria is found.

use crate::statics::factor::multifrontal::{Halt, Stop};
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use crate::statics::newton::line_search::{descend, shorten};
use crate::statics::newton::linear::Linear;
use crate::statics::newton::nearby::Nearby;
use crate::statics::newton::sequential_start::{StackStart, start_one_by_one};
use crate::statics::newton::state::StepEnd;
pub use crate::statics::newton::state::{NewtonOptions, NewtonState, Outcome, Proof, Watch, greatest};
use nalgebra::Vector3;
use toile_geometry::cloth_tree::ClothTree;

type Vec3 = Vector3<f64>;

/// A proof step: the time in which cloth at rest must not gain speed, s.
pub const REST_STEP: f64 = 1.0 / 60.0;

/// Factor by which pseudo-time grows after a full step.
const GROWTH: f64 = 1.5;

/// Factor by which pseudo-time falls after a step of which little is made.
const DECAY: f64 = 0.6;

/// Share of a step made by the line search, below which pseudo-time falls.
const LEAST_SHARE: f64 = 0.5;

/// Consecutive proof steps at most.
const MOST_PROOF_STEPS: usize = 3;

/// Consecutive slow steps before the next proof step, once one has failed: a proof step costs a
/// factorization and hardly moves the cloth.
const SLOW_STEPS: usize = 3;

/// Least step of pseudo-time in which a low speed tells that nothing slides or falls, s.
const SLOW_STEP: f64 = 0.1;

/// Speed above which rest is not tried and a coarser level is not left, m/s, however fast cloth at
/// rest may be. A step of pseudo-time may last a second, in which cloth that slides slowly down a
/// body moves far.
const CREEP: f64 = 0.01;

/// Speed, as a multiple of that of rest, above which contacts are not held any more (see
/// [`crate::statics::forces::self_contact::SelfContact::hold`]). Held contacts of a stack would
/// otherwise be sought again at every proof step.
const FAST: f64 = 10.0;

/// Stiffness that holds a stopped node still, N/m.
const BRAKE: f64 = 1e7;

/// Share of its move that a stopped node loses at least.
const STOPPED: f64 = 0.5;

/// Shortest step of pseudo-time, s.
const SHORTEST: f64 = 1e-3;

/// Share of a step (of its norm) that self-contact must leave; otherwise the step is solved again
/// with pseudo-time [`RETRY`] times as long. Longer steps would press falling layers together at
/// once, and they would jam.
const LEAST_KEPT: f64 = 0.7;

/// Share of a step that self-contact leaves, below which pseudo-time falls. For cloth in layers:
/// with contacts on more than half of its nodes.
const FEW_KEPT: f64 = 0.8;

/// The same share, from which on pseudo-time may grow.
const MOST_KEPT: f64 = 0.9;

/// See [`LEAST_KEPT`].
const RETRY: f64 = 0.3;

/// How contact and targets have limited the moves of a step.
#[derive(Clone, Copy)]
struct Limits {
    /// Whether nodes with a target have not reached it.
    is_led: bool,
    /// Share of the moves that self-contact has left.
    kept: f64,
}

impl NewtonState {
    /// Starts at `x`. `layout` orders the elimination, `tree` finds neighbour pairs.
    pub fn new(
        system: &mut System<'_>,
        layout: &[Vec3],
        tree: Option<ClothTree>,
        x: &[Vec3],
        first: f64,
    ) -> Self {
        Self::with(Nearby::new(tree), system, layout, x, first)
    }

    /// The same with a search for neighbour pairs.
    pub(crate) fn with(
        mut nearby: Nearby,
        system: &mut System<'_>,
        layout: &[Vec3],
        x: &[Vec3],
        first: f64,
    ) -> Self {
        nearby.seek(system, x, &vec![Vec3::zeros(); x.len()]);
        nearby.resolve_intersections(system, x);
        system.find_pierced(x);
        Self::among(nearby, system, layout, x, first)
    }

    /// The same where the neighbour pairs are known.
    pub(crate) fn among(
        nearby: Nearby,
        system: &mut System<'_>,
        layout: &[Vec3],
        x: &[Vec3],
        first: f64,
    ) -> Self {
        system.seek_ridges(x);
        system.update_contacts(x);
        let linear = Linear::new(system, layout);
        let outcome = Outcome { dt: first, ..Outcome::default() };
        Self {
            nearby,
            linear,
            outcome,
            history: vec![],
            verifying: false,
            proof_steps: 0,
            reuse_factor: false,
            slow_steps: 0,
            has_failed: false,
            dt: first,
            longest_move: f64::INFINITY,
            end: None,
            moves: Vec::new(),
            has_left: false,
        }
    }

    /// Takes over a system whose fabric, pins or body have changed.
    pub fn renew(&mut self, system: &mut System<'_>) {
        self.linear.bind(system);
        self.end = None;
        self.wake();
    }

    /// Tells that the cloth may not be at rest any more.
    pub fn wake(&mut self) {
        self.history.clear();
        (self.verifying, self.reuse_factor) = (false, false);
        self.outcome.at_rest = false;
    }

    /// Makes the next step a proof step.
    pub fn shorten_next(&mut self) {
        self.verifying = true;
    }

    /// Makes one step, and decides whether the cloth is at rest. `stop` is asked every few
    /// milliseconds.
    ///
    /// # Errors
    /// [`Halt`]: `stop` returned true, or no inertia makes the matrix positive definite because its
    /// numbers are not finite.
    pub fn step(
        &mut self,
        system: &mut System<'_>,
        x: &mut [Vec3],
        options: &NewtonOptions,
        stop: &Stop,
    ) -> Result<Outcome, Halt> {
        // The thread pool is entered once per step, not once per loop.
        rayon::scope(|_| self.step_here(system, x, options, stop))
    }

    /// [`Self::step`] within the thread pool.
    pub(crate) fn step_here(
        &mut self,
        system: &mut System<'_>,
        x: &mut [Vec3],
        options: &NewtonOptions,
        stop: &Stop,
    ) -> Result<Outcome, Halt> {
        if self.nearby.is_intersecting(system) {
            self.nearby.resolve_intersections(system, x);
        }
        let (contact_free, queries) = match self.end.take().filter(|end| end.at == x) {
            Some(StepEnd { contact_free, queries, .. }) => (Some(contact_free), Some(queries)),
            None => (None, None),
        };
        system.update_contacts_with(x, queries);
        let is_new = self.linear.follow(system);
        let g = system.gradient(x);
        let dt = if self.verifying { REST_STEP } else { self.dt };
        let mut moves = match self.verifying && self.reuse_factor && !is_new {
            true => self.linear.again(&g),
            false => self.linear.step(system, x, &g, [dt, self.longest_move], options.precision, stop)?,
        };
        self.reuse_factor = self.verifying;
        self.record(&moves, &g, dt, options);
        shorten(&mut moves, options.farthest / self.longest_move);
        let wanted = moves.clone();
        let mut limits = self.limit(system, x, &mut moves, options.farthest);
        if options.holds_stopped && !limits.is_led && !self.verifying && self.is_misled(system, &g, &moves) {
            system.brakes = brakes(&wanted, &moves);
            let step = self.linear.step(system, x, &g, [dt, self.longest_move], options.precision, stop);
            system.brakes.clear();
            moves = step?;
            let longest = greatest(&moves);
            shorten(&mut moves, options.farthest / longest);
            limits = self.limit(system, x, &mut moves, options.farthest);
        }
        if limits.kept < LEAST_KEPT && !limits.is_led && !self.verifying && self.dt > SHORTEST {
            // The cloth stays: the rest of a step that mostly leads cloth through cloth would
            // distort the sheet.
            self.dt = (RETRY * self.dt).max(SHORTEST);
            self.moves.clear();
            return Ok(self.outcome);
        }
        let start = (!limits.is_led && !options.skip_line_search).then(|| match contact_free {
            Some(contact_free) => system.value_at_start(x, contact_free),
            None => system.value(x),
        });
        self.advance(system, x, &g, moves, start);
        self.update(system, x, limits, options);
        Ok(self.outcome)
    }

    /// Records the speed and the residual of a Newton step that is not limited yet.
    fn record(&mut self, moves: &[Vec3], g: &[Vec3], dt: f64, options: &NewtonOptions) {
        let longest = greatest(moves);
        let residual = greatest(g);
        let speed = greatest_but(moves, options.non_static) / dt;
        let fast = moves.iter().filter(|m| m.norm() > options.speed * dt).count();
        self.outcome = Outcome {
            steps: self.outcome.steps + 1,
            speed,
            fastest: longest / dt,
            non_static: fast as f64 / moves.len().max(1) as f64,
            residual,
            dt,
            gained: if self.verifying { Some(speed) } else { self.outcome.gained },
            ..self.outcome
        };
        self.longest_move = longest;
    }

    /// Limits moves by targets, body, the region in which pairs are known, and self-contact.
    fn limit(&mut self, system: &mut System<'_>, x: &[Vec3], moves: &mut [Vec3], farthest: f64) -> Limits {
        let is_led = system.follow_targets(x, moves, farthest);
        system.clear_of_body(x, moves, |_| true);
        system.clear_of_ridges(x, moves);
        let reach = self.nearby.within_reach(x, moves);
        self.has_left = reach < 1.0;
        shorten(moves, reach);
        self.nearby.seek(system, x, moves);
        let left = self.nearby.limit(system, x, moves);
        system.stop_at_ridges(x, moves);
        // Seams move over long distances, whatever lies between.
        Limits { is_led, kept: if system.is_sewing() { 1.0 } else { left } }
    }

    /// Whether a step that was limited for some nodes leads the others uphill, so that no share of
    /// it lowers the potential.
    fn is_misled(&self, system: &System<'_>, g: &[Vec3], moves: &[Vec3]) -> bool {
        let slope: f64 = g.iter().zip(moves).map(|(g, m)| g.dot(m)).sum();
        slope > 0.0 && !system.is_sewing() && !system.is_intersecting()
    }

    /// Makes the step, shortened by a line search where the potential at the `start` is given.
    fn advance(
        &mut self,
        system: &mut System<'_>,
        x: &mut [Vec3],
        g: &[Vec3],
        mut moves: Vec<Vec3>,
        start: Option<f64>,
    ) {
        let accepted = start.map(|start| descend(system, x, g, &mut moves, start, &mut self.history));
        self.outcome.share = accepted.as_ref().map_or(1.0, |a| a.share);
        system.elastic.predict(x, &moves);
        x.iter_mut().zip(&moves).for_each(|(p, m)| *p += m);
        self.moves = moves;
        self.end = accepted.and_then(|a| a.end).map(|end| StepEnd {
            at: x.to_vec(),
            contact_free: end.contact_free,
            queries: end.queries,
        });
    }

    /// Updates dt and decides rest.
    fn update(&mut self, system: &mut System<'_>, x: &[Vec3], limits: Limits, options: &NewtonOptions) {
        let speed = if self.verifying { options.speed } else { options.speed.min(CREEP) };
        let is_slow = self.outcome.speed < speed && !limits.is_led;
        self.outcome.at_rest = is_slow && (self.verifying || options.proof == Proof::AnyStep);
        match self.verifying {
            true => self.update_after_proof_step(system),
            false => self.update_after_step(system, x, limits.kept, is_slow, options),
        }
    }

    /// Decides whether another proof step follows: the first ones remove the strain of second order
    /// that a long step leaves.
    fn update_after_proof_step(&mut self, system: &mut System<'_>) {
        self.proof_steps += 1;
        self.verifying = self.outcome.share == 1.0 && self.proof_steps < MOST_PROOF_STEPS;
        (self.slow_steps, self.has_failed) = (0, true);
        system.get_mut::<SelfContact>().into_iter().for_each(|c| c.hold(true));
    }

    /// Updates dt and the history of friction, and decides whether a proof step follows.
    fn update_after_step(
        &mut self,
        system: &mut System<'_>,
        x: &[Vec3],
        kept: f64,
        is_slow: bool,
        options: &NewtonOptions,
    ) {
        self.proof_steps = 0;
        let is_layered = system.get::<SelfContact>().is_some_and(|c| 2 * c.contacts.len() > x.len());
        self.dt = next_dt(self.dt, self.outcome.share, if is_layered { kept } else { 1.0 }, options);
        if !is_slow {
            system.drag_anchors(x);
        }
        if self.outcome.speed > FAST * options.speed {
            system.get_mut::<SelfContact>().into_iter().for_each(|c| c.hold(false));
        }
        let is_slow_step = is_slow && self.outcome.share == 1.0 && self.outcome.dt >= SLOW_STEP;
        self.outcome.at_rest |= is_slow_step && options.proof == Proof::ProofOrLongStep;
        self.slow_steps = if is_slow_step { self.slow_steps + 1 } else { 0 };
        let least = if self.has_failed { SLOW_STEPS } else { 1 };
        self.verifying = options.proof != Proof::AnyStep && self.slow_steps >= least;
    }

    /// Tells that the cloth has moved outside a step, so that nothing of its end can be reused.
    pub(crate) fn moved(&mut self) {
        (self.end, self.reuse_factor) = (None, false);
    }

    /// The outcome of the last step.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        self.outcome
    }

    /// How many crossings the cloth has at `x`.
    #[must_use]
    pub fn crossings(&self, x: &[Vec3]) -> usize {
        self.nearby.crossings(x)
    }

    /// Finds the crossings that are left of those that were being resolved.
    fn finish(&mut self, system: &mut System<'_>, x: &[Vec3]) {
        if system.is_intersecting() {
            self.nearby.resolve_intersections(system, x);
        }
    }
}

/// Moves `x` to rest, or as far as the options allow. `layout` orders the elimination, `tree` finds
/// neighbour pairs; `stop` is asked every few milliseconds.
///
/// # Errors
/// [`Halt`], as [`NewtonState::step`].
pub fn relax(
    system: &mut System<'_>,
    layout: &[Vec3],
    tree: Option<ClothTree>,
    x: &mut [Vec3],
    options: &NewtonOptions,
    watch: &mut Watch<'_>,
    stop: &Stop,
) -> Result<Outcome, Halt> {
    if let (true, Some(tree)) = (options.one_by_one, &tree)
        && start_one_by_one(
            system,
            &StackStart { layout, tree, options: NewtonOptions { proof: Proof::AnyStep, ..*options }, stop },
            x,
            watch,
        )?
        .is_break()
    {
        return Ok(Outcome::default());
    }
    let mut newton = NewtonState::new(system, layout, tree, x, options.first);
    while newton.outcome.steps < options.steps {
        let outcome = newton.step(system, x, options, stop)?;
        if watch(system, x, &outcome).is_break() || outcome.at_rest {
            break;
        }
        if options.asleep {
            newton.settle_active(system, x, options, stop)?;
        }
    }
    newton.finish(system, x);
    Ok(newton.outcome)
}

/// The next step of pseudo-time, after one of which self-contact has left the share `kept` and the
/// line search has made the share `share`.
fn next_dt(dt: f64, share: f64, kept: f64, options: &NewtonOptions) -> f64 {
    match share {
        s if s < LEAST_SHARE || kept < FEW_KEPT => (dt * DECAY).max(SHORTEST),
        1.0 if kept >= MOST_KEPT => (dt * GROWTH).min(options.longest),
        _ => dt,
    }
}

/// The stiffness that holds nodes still whose moves were limited from `wanted` to `moves`.
fn brakes(wanted: &[Vec3], moves: &[Vec3]) -> Vec<f64> {
    let is_stopped = |(w, m): (&Vec3, &Vec3)| (w - m).norm() > STOPPED * w.norm();
    wanted.iter().zip(moves).map(|p| if is_stopped(p) { BRAKE } else { 0.0 }).collect()
}

/// The greatest length of the vectors without a share of them, the longest.
fn greatest_but(v: &[Vec3], share: f64) -> f64 {
    let left_out = (share * v.len() as f64) as usize;
    if left_out == 0 {
        return greatest(v);
    }
    let mut squares: Vec<f64> = v.iter().map(Vec3::norm_squared).collect();
    let at = squares.len().saturating_sub(1 + left_out);
    squares.select_nth_unstable_by(at, f64::total_cmp).1.sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::energy::Models;
    use crate::scene::generate;
    use crate::statics::factor::scalar::Precision;
    use crate::statics::forces::seam_force::SeamForce;
    use crate::statics::levels::assemble::{assemble, cloths};
    use crate::statics::levels::pieces::Pieces;

    #[test]
    fn a_step_uphill_is_told_but_not_while_seams_pull() {
        let scene = generate::hang(3);
        let pieces = Pieces::new(&scene);
        let sheet = pieces.sewn_sheet(&cloths(&scene)).unwrap();
        let mut system = assemble(&scene, None, &pieces, &sheet, false, Models::STATIC).unwrap();
        let x = scene.positions.clone();
        let newton = NewtonState::new(&mut system, &x, None, &x, 0.05);
        let g = system.gradient(&x);
        let down: Vec<Vec3> = g.iter().map(|g| -g * 1e-3).collect();
        let up: Vec<Vec3> = g.iter().map(|g| g * 1e-3).collect();
        assert!(!newton.is_misled(&system, &g, &down));
        assert!(newton.is_misled(&system, &g, &up));
        system.set_seam_forces(vec![SeamForce { nodes: [0, 1], force: 1.0, softening: 1e-3 }]);
        assert!(!newton.is_misled(&system, &g, &up));
    }

    #[test]
    fn nodes_with_brakes_stay_while_the_others_go_on() {
        let scene = generate::hang(3);
        let pieces = Pieces::new(&scene);
        let sheet = pieces.sewn_sheet(&cloths(&scene)).unwrap();
        let mut system = assemble(&scene, None, &pieces, &sheet, false, Models::STATIC).unwrap();
        let x = scene.positions.clone();
        let mut newton = NewtonState::new(&mut system, &x, None, &x, 0.05);
        let g = system.gradient(&x);
        let step = |newton: &mut NewtonState, system: &System<'_>| {
            newton.linear.step(system, &x, &g, [0.05, 1.0], Precision::Double, &|| false).unwrap()
        };
        let free = step(&mut newton, &system);
        let lowest = (0..x.len()).max_by(|a, b| free[*a].norm().total_cmp(&free[*b].norm())).unwrap();
        system.brakes = vec![0.0; x.len()];
        system.brakes[lowest] = BRAKE;
        let braked = step(&mut newton, &system);
        assert!(free[lowest].norm() > 1e-3 && braked[lowest].norm() < 1e-6);
        assert!(greatest(&braked) > 1e-3);
    }
}
