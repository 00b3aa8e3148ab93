//! `Rest`: a whole scene straight to static equilibrium.
//!
//! Method: panels are coarsened; the coarsest level is sewn (seams pull with a force that hardly depends on their gap,
//! without weight, until they meet; then each pair becomes one node, so the gap is exactly zero) and draped; each finer
//! level starts from the coarser one's state, carried over by the triangles that its vertices lie in at rest. So the fall
//! and the sewing happen where steps cost milliseconds, and the finest level only settles.
//!
//! Where the coarsest level shows itself too coarse (a seam stays open, layers tangle, a limb comes through a triangle: see
//! `pierce`), the garment is sewn again on the next finer one.
//!
//! With [`Rest::graded`] bending starts stiff and is let go on the way (see `graded`), so that chance has less of a say.
//!
//! Cost: some 35 to 150 factorizations of the finest level (docs/performance.md). Limits: what the coarse level cannot see (a fold finer than its
//! mesh) must form on finer levels; one out of many equilibria is found, as friction and folds have many.

pub use super::assemble::Wearer;
use super::assemble::{KEPT_PULL, strongest};
use super::clear::{Clearance, clearance};
pub use super::error::RestError;
use super::graded::COARSEST;
use super::grip::Grip;
use super::multifrontal::Halt;
use super::newton::{Outcome, Pace, relax};
use super::pieces::Pieces;
use super::pierce::pierced;
use super::pile::pile_of;
use super::plan::Plan;
pub use super::real::Precision;
use super::sew::widest;
use super::system::System;
use crate::contact::body::Body;
use crate::error::ClothError;
use crate::mesh::Sheet;
use crate::scene::Scene;
use nalgebra::Vector3;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

type Vec3 = Vector3<f64>;

/// How often nodes are moved out where triangles dip into the body.
const CLEARINGS: usize = 4;

/// First step of pseudo-time after that: the cloth hardly moves, s.
const CLEAR_STEP: f64 = 0.2;

/// Settings of the rest solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Speed that cloth at rest must not gain in a sixtieth of a second, m/s.
    pub speed: f64,
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
    /// Whether bending starts far too stiff and is let go level by level, so that the state of rest hardly depends on where the
    /// cloth began.
    pub graded: bool,
    /// How precise the factor of each step is.
    pub precision: Precision,
}

impl Default for Rest {
    fn default() -> Self {
        Self {
            speed: 1e-3,
            coarsest: 200,
            coarse_steps: 30,
            finest_steps: 500,
            join_gap: 5e-4,
            budget: Duration::from_secs(600),
            graded: false,
            precision: Precision::default(),
        }
    }
}

/// What one level did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelReport {
    /// Its nodes.
    pub nodes: usize,
    /// Whether seams were open.
    pub sewing: bool,
    /// How it ended.
    pub outcome: Outcome,
    /// Wall time, s.
    pub seconds: f64,
}

/// A garment at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Rested {
    /// Position of every vertex of the scene, m.
    pub positions: Vec<Vec3>,
    /// How the finest level ended.
    pub outcome: Outcome,
    /// Greatest force left on a node, N.
    pub residual: f64,
    /// How far friction holds each vertex back, m: what [`Live`](super::live::Live) goes on from.
    pub slides: Vec<Vec3>,
    /// Friction of every contact of cloth with cloth, by sewn points: what `Live` goes on from.
    pub grips: Vec<Grip>,
    /// Distance at which the body begins to press on each vertex, m; none without a body.
    pub offsets: Vec<f64>,
    /// Elastic and gravitational energy, J.
    pub energy: f64,
    /// Deepest point inside the body between vertices, m; 0 unless the body has edges sharper than the mesh can follow.
    pub dip: f64,
    /// Widest seam when it was joined, m; nothing where there are none.
    pub joined_at: Option<f64>,
    /// Every level, coarse to fine.
    pub levels: Vec<LevelReport>,
}

/// What a caller learns while solving; it may stop the solver.
pub type Progress<'p> = dyn FnMut(&LevelReport) -> ControlFlow<()> + 'p;

impl Rest {
    /// Solves `scene`; `progress` hears of every step.
    ///
    /// # Errors
    /// Every [`RestError`].
    pub fn solve(&self, scene: &Scene, progress: &mut Progress<'_>) -> Result<Rested, RestError> {
        #[cfg(not(toile_without = "body"))]
        let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
        #[cfg(not(toile_without = "body"))]
        let wearer = body.as_ref().map(|(body, friction)| Wearer { skin: body, friction: *friction });
        #[cfg(toile_without = "body")]
        let wearer = None;
        self.solve_on(scene, wearer, progress)
    }

    /// Solves `scene` on a body that answers for itself; the scene's own body is not looked at.
    ///
    /// # Errors
    /// Every [`RestError`].
    pub fn solve_on(
        &self,
        scene: &Scene,
        wearer: Option<Wearer<'_>>,
        progress: &mut Progress<'_>,
    ) -> Result<Rested, RestError> {
        let clock = Instant::now();
        scene.check()?;
        scene.check_still()?;
        let pile = pile_of(scene);
        if self.graded && pile.is_some() {
            return Self { graded: false, ..*self }.solve_on(scene, wearer, progress);
        }
        let mut coarsest = if self.graded { COARSEST.max(self.coarsest) } else { self.coarsest };
        // The limit is for each cloth of a pile: nine nodes cannot follow a body.
        coarsest *= pile.unwrap_or(1);
        loop {
            let plan = Plan::new(self, coarsest, scene, wearer)?;
            let finer = plan.second();
            match (Work::new(&plan, clock).make(progress), finer) {
                (Ok(Draped::Rested(state)), _) => return self.judge(*state),
                // From its own start the level keeps free of crossings by itself, if slowly.
                (Ok(Draped::Tangled { pairs, .. }), None) => {
                    return Err(RestError::InitialCrossing { pairs });
                }
                (Ok(Draped::Tangled { nodes, .. }), Some(finer)) => coarsest = nodes.max(finer),
                (Ok(Draped::Pierced { finer }), _) => coarsest = finer,
                // What slides off while it is stiff may stay on as cloth.
                (Err(RestError::Falls), _) if self.graded => {
                    return Self { graded: false, ..*self }.solve_on(scene, wearer, progress);
                }
                // A sheet of a few vertices falls past a body that would catch it.
                (Err(RestError::Falls), Some(finer)) if wearer.is_some() => coarsest = finer,
                // A polygon of so few corners does not go round a limb, is folded onto itself by its seams, or hands on
                // folds that lie too close for a finer mesh to come apart.
                (Err(e), Some(finer)) if e.is_of_a_coarse_mesh() => coarsest = finer,
                (Err(e), _) => return Err(e),
            }
        }
    }

    pub(super) fn judge(&self, state: Rested) -> Result<Rested, RestError> {
        match state.outcome.at_rest {
            true => Ok(state),
            false => Err(RestError::NotAtRest { wanted: self.speed, state: Box::new(state) }),
        }
    }
}

/// How the levels ended.
pub(super) enum Draped {
    Rested(Box<Rested>),
    /// The state carried to the level of so many nodes crosses itself and could not be undone.
    Tangled {
        nodes: usize,
        /// Crossings left.
        pairs: usize,
    },
    /// The body comes through a coarse level between its vertices.
    Pierced {
        /// Points of the next finer level.
        finer: usize,
    },
}

/// A garment on its way to rest.
pub(super) struct Work<'a> {
    pub(super) plan: &'a Plan<'a>,
    clock: Instant,
    /// Where the nodes of the level in work are.
    pub(super) x: Vec<Vec3>,
    pub(super) joined_at: Option<f64>,
    /// How deep the cloth at rest dips into the body between its vertices, where that is known, m.
    dip: Option<f64>,
    pub(super) reports: Vec<LevelReport>,
}

impl<'a> Work<'a> {
    fn new(plan: &'a Plan<'a>, clock: Instant) -> Self {
        Self { plan, clock, x: vec![], joined_at: None, dip: None, reports: vec![] }
    }

    /// Sews and drapes.
    fn make(mut self, progress: &mut Progress<'_>) -> Result<Draped, RestError> {
        self.sew(progress)?;
        let coarsest = self.plan.pieces.len() - 1;
        let sheet = self.plan.pieces[coarsest].sewn_sheet(&self.plan.cloths)?;
        match self.pierced(coarsest, &sheet, &self.x) {
            Some(draped) => Ok(draped),
            None => self.drape(progress),
        }
    }

    /// Says if the body comes through level `k` with its nodes at `x`; the finest one is judged by its end.
    pub(super) fn pierced(&self, k: usize, sheet: &Sheet, x: &[Vec3]) -> Option<Draped> {
        let finer = self.plan.pieces.get(k.checked_sub(1)?)?.points;
        let wearer = self.plan.body?;
        (pierced(sheet, wearer.skin, x) > 0).then_some(Draped::Pierced { finer })
    }

    /// Moves nodes out where triangles between them dip into the body, and lets the cloth settle again.
    pub(super) fn clear(
        &mut self,
        system: &mut System<'_>,
        sheet: &Sheet,
        layout: &[Vec3],
        x: &mut [Vec3],
        pace: &Pace,
        progress: &mut Progress<'_>,
    ) -> Result<(), RestError> {
        let pace =
            Pace { first: CLEAR_STEP, steps: 2 * self.plan.rest.coarse_steps, one_by_one: false, ..*pace };
        for _ in 0..CLEARINGS {
            let Some(Clearance { lacks, depth, .. }) = self.plan.body.map(|w| clearance(sheet, w.skin, x))
            else {
                break;
            };
            if depth == 0.0 {
                self.dip = Some(depth);
                break;
            }
            if let Some(s) = &mut system.support {
                s.offsets.iter_mut().zip(&lacks).for_each(|(o, l)| *o += l);
            }
            let report = self.run(system, sheet, layout, x, &pace, &|_| false, progress)?;
            self.reports.push(report);
        }
        Ok(())
    }

    pub(super) fn finish(
        self,
        mut system: System<'_>,
        sheet: &Sheet,
        x: Vec<Vec3>,
    ) -> Result<Rested, RestError> {
        system.touch(&x);
        let residual = super::newton::greatest(&system.gradient(&x));
        let outcome = self.reports.last().map(|r| r.outcome).unwrap_or_default();
        let positions = self.plan.pieces[0].spread(&x);
        let energy = system.stored(&x);
        let depth = || self.plan.body.map_or(0.0, |w| clearance(sheet, w.skin, &x).depth);
        let (pairs, dip) = rayon::join(|| self.crossings(sheet, &x), || self.dip.unwrap_or_else(depth));
        let slides = self.plan.pieces[0].spread(&system.held_back(&x));
        let offsets = self.plan.pieces[0].offsets(&system);
        let (joined_at, levels) = (self.joined_at, self.reports);
        let grips = system.layers.take().map_or_else(Vec::new, |l| l.grips);
        let state =
            Rested { positions, outcome, residual, slides, grips, offsets, energy, dip, joined_at, levels };
        match pairs {
            0 => Ok(state),
            pairs => Err(RestError::Crossing { pairs, state: Box::new(state) }),
        }
    }

    /// How often the sewn garment crosses itself with its nodes at `x`.
    fn crossings(&self, sheet: &Sheet, x: &[Vec3]) -> usize {
        #[cfg(toile_without = "self_contact")]
        return 0;
        #[cfg(not(toile_without = "self_contact"))]
        match self.plan.scene.self_collision {
            true => self.plan.tree(sheet, x, false).crossings(x).len(),
            false => 0,
        }
    }

    /// Runs one level.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn run(
        &self,
        system: &mut System<'_>,
        sheet: &Sheet,
        layout: &[Vec3],
        x: &mut [Vec3],
        pace: &Pace,
        done: &dyn Fn(&[Vec3]) -> bool,
        progress: &mut Progress<'_>,
    ) -> Result<LevelReport, RestError> {
        let sewing = self.joined_at.is_none() && !system.threads.is_empty();
        let tree = self.plan.scene.self_collision.then(|| self.plan.tree(sheet, layout, sewing));
        let start = Instant::now();
        let mut report = LevelReport { nodes: x.len(), sewing, outcome: Outcome::default(), seconds: 0.0 };
        let (mut stop, mut is_late, mut falling) = (None, false, 0);
        let late = || self.clock.elapsed() > self.plan.rest.budget;
        let mut watch = |system: &System<'_>, x: &[Vec3], outcome: &Outcome| {
            let seconds = start.elapsed().as_secs_f64();
            report = LevelReport { nodes: x.len(), outcome: *outcome, seconds, ..report };
            let free = system.touches.is_empty() && !system.pinned.contains(&true);
            let falls = free
                && outcome.speed > 0.9 * system.gravity.norm() * outcome.dt
                && outcome.dt >= pace.longest;
            falling = if falls && outcome.speed > 0.0 { falling + 1 } else { 0 };
            if falling > 8 {
                stop = Some(RestError::Falls);
            } else if progress(&report).is_break() {
                stop = Some(RestError::Stopped);
            }
            is_late = late();
            if stop.is_some() || is_late || done(x) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        match relax(system, layout, tree, x, pace, &mut watch, &late) {
            Ok(outcome) => report.outcome = outcome,
            Err(Halt::NotPositive(error)) => return Err(error.into()),
            Err(Halt::Stopped) => is_late = true,
        }
        match stop {
            Some(error) => Err(error),
            None if is_late => Err(self.timeout(x)),
            None => Ok(report),
        }
    }

    /// Out of time with the nodes of a level at `x`.
    fn timeout(&self, x: &[Vec3]) -> RestError {
        let (seconds, levels) = (self.clock.elapsed().as_secs_f64(), self.plan.pieces.len());
        RestError::Timeout { seconds, level: levels - self.level_of(x), levels, positions: self.carried(x) }
    }

    /// The level, fine to coarse, that has these nodes, sewn or open.
    fn level_of(&self, x: &[Vec3]) -> usize {
        let has = |p: &Pieces| p.nodes == x.len() || p.rest.len() == x.len();
        self.plan.pieces.iter().position(has).unwrap_or(0)
    }

    /// The level's nodes, sewn or open, carried to the finest vertices.
    fn carried(&self, x: &[Vec3]) -> Vec<Vec3> {
        let k = self.level_of(x);
        let vertices =
            if self.plan.pieces[k].nodes == x.len() { self.plan.pieces[k].spread(x) } else { x.to_vec() };
        self.plan.coarser[..k].iter().rev().fold(vertices, |v, c| c.prolong(&v))
    }

    /// Refuses seams that are not joined and stay open at the end.
    pub(super) fn check_kept(&self, x: &[Vec3]) -> Result<(), RestError> {
        let gap = widest(x, &self.plan.pieces[0].kept_pairs());
        if gap <= self.plan.rest.join_gap {
            return Ok(());
        }
        let seam = self.widest_seam(0, &self.plan.pieces[0].spread(x));
        Err(RestError::SeamNotClosed { seam, gap, force: KEPT_PULL * strongest(&self.plan.cloths) })
    }

    /// Refuses cloth that the strain limit could not hold.
    pub(super) fn check_strain(&self, system: &System<'_>, x: &[Vec3]) -> Result<(), RestError> {
        match self.plan.scene.strain_limit.and_then(|l| system.elastic.over(x, &l)) {
            Some((index, strain, limit)) => {
                Err(ClothError::StrainLimitExceeded { index, strain, limit }.into())
            }
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod graded_tests;
#[cfg(test)]
mod layer_friction_tests;
#[cfg(test)]
mod sewn_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod truth_tests;
#[cfg(test)]
mod worn_tests;
