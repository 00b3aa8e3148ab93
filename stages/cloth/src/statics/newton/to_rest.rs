//! Newton's method to rest on one level.
//!
//! Each step minimises the potential plus the inertia of a step of pseudo-time (a sheet at rest
//! that is let go), which grows as long as steps succeed: far from rest the cloth falls without
//! overshooting, near rest the steps are Newton's own. A step is first kept out of the body, then
//! cut back where cloth would meet cloth (and tried again in less pseudo-time where most of it is
//! cut), then shortened until the potential lies below the highest of the last few (Grippo,
//! Lampariello, Lucidi 1986): cloth hardly stretches but bends freely, so a good step may first
//! raise the potential.
//!
//! Ending the moves of some nodes may leave the others a step uphill, of which no share lowers the
//! potential. Then the step is sought again with the stopped nodes held still (an active set),
//! where the pace says so: gathers and armholes jam without; cloth that is to slide off an edge is
//! kept from it by them.
//!
//! For the same reason the matrix takes the stress that the last step foretold, not that of the new
//! places, whose strain has an error of second order times a great stiffness (the mixed form of
//! Magisano, Leonetti, Garcea 2017): steps may then be many times longer. It leaves the answer
//! alone, for the forces are those of the places.
//!
//! Where a step moved few nodes, these and those around them are brought to rest by themselves
//! before the next one (see `awake`); a state of rest is proved with all.
//!
//! Cost of a step: one factorization, O(n^1.5), and O(n) for all else. Of the short steps that
//! prove rest only the first of a row has its own; the cloth moves so little in them that it serves
//! the others. What the search along a step has looked up at its end is not looked up again where
//! the next step starts.

use crate::statics::factor::multifrontal::{Halt, Stop};
use crate::statics::forces::system::System;
use crate::statics::newton::line_search::{descend, shorten};
use crate::statics::newton::linear::Linear;
use crate::statics::newton::nearby::Nearby;
use crate::statics::newton::stack::{StackStart, start_one_by_one};
use crate::statics::newton::state::StepEnd;
pub use crate::statics::newton::state::{NewtonOptions, NewtonState, Outcome, Watch, greatest};
use nalgebra::Vector3;
use toile_geometry::cloth_tree::ClothTree;

type Vec3 = Vector3<f64>;

/// The step of time in which cloth at rest must not gain speed, s.
pub const REST_STEP: f64 = 1.0 / 60.0;

/// Factor by which pseudo-time grows after a whole step.
const GROWTH: f64 = 1.5;

/// Steps of [`REST_STEP`] in a row before the cloth is let go on.
const MOST_PROOFS: usize = 3;

/// Slow steps in a row before the next proof, once one has failed: a proof costs a factorization
/// and hardly moves.
const SLOW_STEPS: usize = 3;

/// Least step of pseudo-time in which the speed tells that nothing slides or falls any more, s.
const SLOW_STEP: f64 = 0.1;

/// Speed in a step of pseudo-time above which rest is not tried, and a coarser mesh is not left,
/// m/s, however fast cloth at rest may be: in such a step, which may last a second, what slides
/// down a body slowly goes far.
const CREEP: f64 = 0.01;

/// Speed, as a multiple of that of rest, beyond which contacts are not held any more (see
/// [`crate::statics::forces::self_contact::SelfContact::hold`]): what the proof of a pile held it
/// forgets only far from rest, or it would look for it again at every proof.
const FAST: f64 = 10.0;

/// What holds a node still that is stopped, N/m, and the share of its move that a stopped node
/// loses at least.
const BRAKE: f64 = 1e7;
const STOPPED: f64 = 0.5;

/// Shortest step of pseudo-time, s.
const SHORTEST: f64 = 1e-3;

/// Share of a step (of its norm) that contacts of cloth with cloth must leave, or it is tried again
/// with pseudo-time [`RETRY`] times as long. Else layers that come down on each other are pressed
/// together at once, and jam.
const LEAST_KEPT: f64 = 0.7;

/// Shares below which pseudo-time falls, and above which it may grow, where cloth lies in layers:
/// on more than half of its nodes.
const FEW_KEPT: f64 = 0.8;
const MOST_KEPT: f64 = 0.9;

/// See [`LEAST_KEPT`].
const RETRY: f64 = 0.3;

impl NewtonState {
    /// Starts at `x`. `layout` orders the elimination, `tree` finds cloth near cloth.
    pub fn new(
        system: &mut System<'_>,
        layout: &[Vec3],
        tree: Option<ClothTree>,
        x: &[Vec3],
        first: f64,
    ) -> Self {
        Self::with(Nearby::new(tree), system, layout, x, first)
    }

    /// The same with what looks for neighbours.
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

    /// The same where the neighbours are known.
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
            proofs: 0,
            reuse_factor: false,
            slow_steps: 0,
            failed: false,
            dt: first,
            longest_move: f64::INFINITY,
            end: None,
            moves: Vec::new(),
            has_left: false,
        }
    }

    /// Takes up a system whose fabric, pins or body have changed.
    pub fn renew(&mut self, system: &mut System<'_>) {
        self.linear.bind(system);
        self.end = None;
        self.wake();
    }

    /// What was at rest may be so no more.
    pub fn wake(&mut self) {
        self.history.clear();
        (self.verifying, self.reuse_factor) = (false, false);
        self.outcome.at_rest = false;
    }

    /// Makes the next step one of [`REST_STEP`].
    pub fn shorten_next(&mut self) {
        self.verifying = true;
    }

    /// One step; says at rest where nothing gains speed any more. `stop` is asked every few
    /// milliseconds.
    ///
    /// # Errors
    /// [`Halt`]: `stop` said so, or no inertia makes the matrix positive definite, for the numbers
    /// are not finite.
    pub fn step(
        &mut self,
        system: &mut System<'_>,
        x: &mut [Vec3],
        options: &NewtonOptions,
        stop: &Stop,
    ) -> Result<Outcome, Halt> {
        // One way into the pool of threads a step, not one for every loop.
        rayon::scope(|_| self.step_here(system, x, options, stop))
    }

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
        let before = self.end.take().filter(|b| b.at == x);
        let (contact_free, queries) = match before {
            Some(StepEnd { contact_free, queries, .. }) => (Some(contact_free), Some(queries)),
            None => (None, None),
        };
        system.update_contacts_with(x, queries);
        let is_new = self.linear.follow(system);
        let g = system.gradient(x);
        let used = if self.verifying { REST_STEP } else { self.dt };
        let mut moves = match self.verifying && self.reuse_factor && !is_new {
            true => self.linear.again(&g),
            false => self.linear.step(system, x, &g, [used, self.longest_move], options.precision, stop)?,
        };
        self.reuse_factor = self.verifying;
        let longest = greatest(&moves);
        let residual = greatest(&g);
        let speed = greatest_but(&moves, options.non_static) / used;
        let fast = moves.iter().filter(|m| m.norm() > options.speed * used).count();
        self.outcome = Outcome {
            steps: self.outcome.steps + 1,
            speed,
            fastest: longest / used,
            non_static: fast as f64 / moves.len().max(1) as f64,
            residual,
            dt: used,
            gained: if self.verifying { Some(speed) } else { self.outcome.gained },
            ..self.outcome
        };
        self.longest_move = longest;
        shorten(&mut moves, options.farthest / longest);
        let wanted = moves.clone();
        let (mut pulled, mut kept) = self.bound(system, x, &mut moves, options.farthest);
        if options.holds_stopped && !pulled && !self.verifying && self.is_misled(system, &g, &moves) {
            // What is stopped by others holds still, and the rest finds a step without it.
            let is_stopped = |(w, m): (&Vec3, &Vec3)| (w - m).norm() > STOPPED * w.norm();
            system.brakes =
                wanted.iter().zip(&moves).map(|p| if is_stopped(p) { BRAKE } else { 0.0 }).collect();
            let step = self.linear.step(system, x, &g, [used, self.longest_move], options.precision, stop);
            system.brakes.clear();
            moves = step?;
            let longest = greatest(&moves);
            shorten(&mut moves, options.farthest / longest);
            (pulled, kept) = self.bound(system, x, &mut moves, options.farthest);
        }
        if kept < LEAST_KEPT && !pulled && !self.verifying && self.dt > SHORTEST {
            // The cloth stays: most of the step leads cloth through cloth, and what is left of it
            // would tear the sheet about.
            self.dt = (RETRY * self.dt).max(SHORTEST);
            self.moves.clear();
            return Ok(self.outcome);
        }
        let start = (!pulled && !options.skip_line_search).then(|| match contact_free {
            Some(contact_free) => system.value_at_start(x, contact_free),
            None => system.value(x),
        });
        let way = start.map(|start| descend(system, x, &g, &mut moves, start, &mut self.history));
        self.outcome.share = way.as_ref().map_or(1.0, |w| w.share);
        system.elastic.predict(x, &moves);
        x.iter_mut().zip(&moves).for_each(|(p, m)| *p += m);
        let end = way.and_then(|w| w.end);
        self.moves = moves;
        self.end = end.map(|v| StepEnd { at: x.to_vec(), contact_free: v.contact_free, queries: v.queries });
        self.plan(system, x, pulled, kept, options);
        Ok(self.outcome)
    }

    /// Ends moves where they lead beyond what is known, into the body or through cloth: whether
    /// pulled nodes still have a way to go, and the share of the moves that cloth leaves.
    fn bound(
        &mut self,
        system: &mut System<'_>,
        x: &[Vec3],
        moves: &mut [Vec3],
        farthest: f64,
    ) -> (bool, f64) {
        let pulled = system.follow_targets(x, moves, farthest);
        system.clear_of_body(x, moves, |_| true);
        system.clear_of_ridges(x, moves);
        let reach = self.nearby.within_reach(x, moves);
        self.has_left = reach < 1.0;
        shorten(moves, reach);
        self.nearby.seek(system, x, moves);
        let left = self.nearby.limit(system, x, moves);
        system.stop_at_ridges(x, moves);
        // Seams pull over long ways, whatever is between.
        (pulled, if system.seam_forces.is_empty() { left } else { 1.0 })
    }

    /// Whether a step that was ended for some nodes leads the others uphill: no share of it lowers
    /// the potential.
    fn is_misled(&self, system: &System<'_>, g: &[Vec3], moves: &[Vec3]) -> bool {
        let slope: f64 = g.iter().zip(moves).map(|(g, m)| g.dot(m)).sum();
        slope > 0.0 && system.seam_forces.is_empty() && !system.is_intersecting()
    }

    /// What comes after a step.
    fn plan(
        &mut self,
        system: &mut System<'_>,
        x: &[Vec3],
        pulled: bool,
        kept: f64,
        options: &NewtonOptions,
    ) {
        let limit = if self.verifying { options.speed } else { options.speed.min(CREEP) };
        let slow = self.outcome.speed < limit && !pulled;
        self.outcome.at_rest = slow && (self.verifying || !options.prove);
        if self.verifying {
            // A long step leaves strain of second order behind, which the first short ones take
            // away.
            self.proofs += 1;
            self.verifying = self.outcome.share == 1.0 && self.proofs < MOST_PROOFS;
            (self.slow_steps, self.failed) = (0, true);
            system.self_contact.iter_mut().for_each(|c| c.hold(true));
            return;
        }
        self.proofs = 0;
        let is_layered = system.self_contact.as_ref().is_some_and(|c| 2 * c.contacts.len() > x.len());
        self.dt = next_dt(self.dt, self.outcome.share, if is_layered { kept } else { 1.0 }, options);
        if !slow {
            system.drag_anchors(x);
        }
        if self.outcome.speed > FAST * options.speed {
            system.self_contact.iter_mut().for_each(|c| c.hold(false));
        }
        let calm = slow && self.outcome.share == 1.0 && self.outcome.dt >= SLOW_STEP;
        self.outcome.at_rest |= calm && options.long_proof;
        self.slow_steps = if calm { self.slow_steps + 1 } else { 0 };
        self.verifying = options.prove && self.slow_steps >= if self.failed { SLOW_STEPS } else { 1 };
    }

    /// The cloth has moved outside a step: nothing that was found where that ended holds.
    pub(crate) fn moved(&mut self) {
        (self.end, self.reuse_factor) = (None, false);
    }

    /// How it stands after the last step.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        self.outcome
    }

    /// How often triangles cross at `x`.
    #[must_use]
    pub fn crossings(&self, x: &[Vec3]) -> usize {
        self.nearby.crossings(x)
    }

    /// Looks for crossings that are left where some were being undone.
    fn finish(&mut self, system: &mut System<'_>, x: &[Vec3]) {
        if system.is_intersecting() {
            self.nearby.resolve_intersections(system, x);
        }
    }
}

/// Moves `x` to rest, or as far as the pace allows. `layout` orders the elimination, `tree` finds
/// cloth near cloth; `stop` is asked every few milliseconds.
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
            &StackStart { layout, tree, options: NewtonOptions { prove: false, ..*options }, stop },
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

/// The next step of pseudo-time after one of which the search took a `share` and contacts had left
/// so much.
fn next_dt(dt: f64, share: f64, kept: f64, options: &NewtonOptions) -> f64 {
    match share {
        s if s < 0.5 || kept < FEW_KEPT => (dt * 0.6).max(SHORTEST),
        1.0 if kept >= MOST_KEPT => (dt * GROWTH).min(options.longest),
        _ => dt,
    }
}

/// The greatest length of all but a share of the vectors, the longest.
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
        system.seam_forces = vec![SeamForce { nodes: [0, 1], force: 1.0, soft: 1e-3 }];
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
