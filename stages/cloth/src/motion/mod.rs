//! `Motion`: dynamics of a whole scene, with any of the time-stepping solvers.
//!
//! Method: a step of the solver for the sheet alone, then three corrections of its moves: seams
//! close at a set speed, layers of cloth stay apart, and cloth stays outside the body with Coulomb
//! friction. Last, moves are shortened until nothing collides. Pairs that have met become one
//! vertex with the common momentum. Cost: one solver step a step, and contacts linear in the
//! triangles. Limits: the corrections are of first order in time for any solver, and a stack of
//! many layers comes to rest slowly.

mod contact;
mod error;
mod fall;
mod method;
mod moving;
mod near;
mod recorder;
mod seams;
mod through;

#[cfg(test)]
mod tests;

pub use contact::{PenaltyForce, Response};
pub use error::MotionError;
pub use method::Method;
pub use recorder::Recorder;
pub use seams::SeamClosing;
pub use through::Through;

use crate::contact::collision_surface::CollisionSurface;
use crate::energy::{Air, Models};
use crate::error::ClothError;
use crate::scene::Scene;
use crate::statics::drive::solve::Collider;
use crate::statics::levels::coarsen::Coarser;
use crate::statics::levels::pieces::Pieces;
use crate::statics::report::start::{check, probably_reversed};
use crate::stopper::Stopper;
use fall::Falls;
use moving::Moving;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};
use through::JOINED_GAP;
use toile_geometry::Vec3;

/// When a motion ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Until {
    /// When the seams are joined: without weight and without wind.
    Sewn {
        /// Longest time, s.
        longest: f64,
    },
    /// After the phases of the scene, each for its seconds. Seams are sewn first, without weight
    /// and wind, for as long as they take: the phases that have no weight and come first last so
    /// much less.
    Phases {
        /// Longest time for sewing, s.
        longest: f64,
    },
    /// Sewn without weight and without wind, then at rest under the last phase's gravity, in its
    /// air, or after so many seconds of either.
    Rest {
        /// Way of every vertex in a sixtieth of a second, as a speed, m/s.
        speed: f64,
        /// Change of the energy in that time as a share of itself.
        energy: f64,
        /// Longest time for sewing, and again for draping, s.
        longest: f64,
    },
}

/// Settings of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// The solver.
    pub method: Method,
    /// Membrane and bending, for solvers that take them as energies.
    pub models: Models,
    /// Time between two searches for contacts, s. Above 1/120 s a tight garment slips off, for
    /// contacts act after the step, not in it.
    pub dt: f64,
    /// Mass-proportional drag, 1/s.
    pub drag: f64,
    /// Stiffness-proportional damping time, s; of implicit Euler and central differences.
    pub viscosity: f64,
    /// What brings the two sides of a seam together.
    pub seam_force: SeamClosing,
    /// The set speed at which they are brought together, m/s.
    pub closing: f64,
    /// Share of friction that acts while seams close.
    pub sewing_friction: f64,
    /// Seams are joined when their gaps are below this, m.
    pub join_gap: f64,
    /// How draping is damped.
    pub calming: Calming,
    /// No edge stays longer than its rest length by more than this share (Provot, 1995).
    pub strain_limit: Option<f64>,
    /// How the body answers cloth that touches it.
    pub response: Response,
    /// How cloth passes through cloth while its seams close; `None` where it does not.
    pub through: Option<Through>,
    /// When to end.
    pub until: Until,
    /// Wall time at most.
    pub budget: Duration,
}

/// How draping is damped: folds form freely first, then oscillations are damped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calming {
    /// Time in which the drag doubles, s, up to 120 1/s; infinite where it stays.
    pub doubling: f64,
    /// Time in which friction grows to its full value, s: cloth slips into place as a collider
    /// shakes it.
    pub slip: f64,
}

impl Calming {
    /// No added damping.
    pub const NONE: Self = Self { doubling: f64::INFINITY, slip: 0.0 };

    /// The drag after `time` s of draping, 1/s.
    fn drag(&self, first: f64, time: f64) -> f64 {
        (first * (time / self.doubling).exp2()).min(GREATEST_DRAG.max(first))
    }

    /// The share of friction that acts after `time` s of draping.
    fn friction(&self, time: f64) -> f64 {
        if time >= self.slip { 1.0 } else { time / self.slip }
    }
}

/// Greatest drag, 1/s: above it cloth creeps.
const GREATEST_DRAG: f64 = 120.0;

impl Default for Motion {
    fn default() -> Self {
        Self {
            method: Method::ImplicitEuler { tolerance: 1e-4, relative: None },
            models: Models::DEFAULT,
            dt: 1.0 / 240.0,
            drag: 0.0,
            viscosity: 0.0,
            seam_force: SeamClosing::Speed,
            closing: 0.5,
            sewing_friction: 1.0,
            join_gap: 5e-4,
            calming: Calming::NONE,
            strain_limit: None,
            response: Response::default(),
            through: None,
            until: Until::Phases { longest: LONGEST },
            budget: Duration::from_secs(600),
        }
    }
}

/// How far a motion has come.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Progress {
    /// Simulated time, s.
    pub time: f64,
    /// Steps made.
    pub steps: usize,
    /// Greatest move of a vertex since the last check, as a speed, m/s.
    pub speed: f64,
    /// Widest open seam, m; 0 once all are joined.
    pub gap: f64,
    /// Greatest residual force of the solver, N.
    pub residual: f64,
}

/// Called after every step, with a function that gives the position of every vertex of the scene,
/// m; it may stop the motion.
pub type OnStep<'p> = dyn FnMut(&Progress, &dyn Fn() -> Vec<Vec3>) -> ControlFlow<()> + 'p;

/// Where a motion ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Position of every vertex of the scene, m.
    pub positions: Vec<Vec3>,
    /// Its velocity, m/s.
    pub velocities: Vec<Vec3>,
    /// How it ended.
    pub progress: Progress,
    /// Whether it is at rest; always true after [`Until::Phases`].
    pub converged: bool,
    /// Whether self-contact held the whole cloth back in the last step, so that it is in the air.
    pub is_jammed: bool,
    /// Elastic and gravitational energy, J.
    pub energy: f64,
    /// Widest gap of the seams when they were joined, m; `None` without seams.
    pub joined_at: Option<f64>,
}

/// Longest time for sewing, s.
const LONGEST: f64 = 6.0;

/// Share of its widest gap by which a seam must close within [`PATIENCE`]; otherwise it is stuck.
const LEAST_CLOSED: f64 = 0.02;

/// Simulated time in which the gap of an open seam must shrink, s.
const PATIENCE: f64 = 0.5;

/// Time between two checks of speed and energy, s.
const LOOK: f64 = 1.0 / 60.0;

/// Difference below which two times count as equal, s.
const SAME_TIME: f64 = 1e-9;

impl Motion {
    /// Simulates `scene`; `progress` is called after every step and may stop it.
    ///
    /// # Errors
    /// Every [`MotionError`].
    pub fn run(
        &self,
        scene: &Scene,
        collider: Option<Collider<'_>>,
        progress: &mut OnStep<'_>,
    ) -> Result<Moved, MotionError> {
        self.run_until_stopped(scene, collider, &Stopper::default(), progress)
    }

    /// The same; `stopper` is also asked within steps, for a step of stiff cloth may take long.
    ///
    /// # Errors
    /// Every [`MotionError`].
    pub fn run_until_stopped(
        &self,
        scene: &Scene,
        collider: Option<Collider<'_>>,
        stopper: &Stopper,
        progress: &mut OnStep<'_>,
    ) -> Result<Moved, MotionError> {
        self.run_around(scene, collider, &[], stopper, progress, None)
    }

    /// The same, where `recorder` takes the frames; [`MotionError::Stopped`] where it is full.
    /// Where cloth is sewn through cloth, it is sewn on the first of the solids `around`, which are
    /// thinner than the collider, and pushed out by each next one.
    ///
    /// # Errors
    /// Every [`MotionError`].
    pub fn run_around(
        &self,
        scene: &Scene,
        collider: Option<Collider<'_>>,
        around: &[&dyn CollisionSurface],
        stopper: &Stopper,
        progress: &mut OnStep<'_>,
        recorder: Option<&mut Recorder>,
    ) -> Result<Moved, MotionError> {
        scene.check()?;
        if self.method.takes_one_fabric() {
            one_fabric(scene)?;
        }
        let pieces = Pieces::new(scene);
        let falls = Falls::of(scene, collider, &pieces);
        let (clock, budget, asked) = (Instant::now(), self.budget, stopper.clone());
        let stopper = Stopper::when(move || asked.is_up() || clock.elapsed() > budget);
        let mut run = MotionRun {
            settings: self,
            scene,
            collider,
            around,
            coarser: Vec::new(),
            points: pieces.point.clone(),
            pieces,
            falls,
            clock,
            stopper,
            progress,
            recorder,
        };
        match self.until {
            Until::Sewn { longest } => {
                let sewn = run.sewn(longest)?;
                Ok(run.finish(sewn, true))
            }
            Until::Phases { longest } => run.phases(longest),
            Until::Rest { speed, energy, longest } => run.rest(speed, energy, longest),
        }
    }
}

/// Refuses a scene whose panels are of several fabrics.
fn one_fabric(scene: &Scene) -> Result<(), MotionError> {
    let first = scene.fabric_of(0);
    match (0..scene.panels.len()).find(|&k| scene.fabric_of(k) != first) {
        Some(k) => Err(MotionError::Fabrics { panel: scene.panels[k].name.clone() }),
        None => Ok(()),
    }
}

/// A running motion.
struct MotionRun<'a> {
    settings: &'a Motion,
    scene: &'a Scene,
    collider: Option<Collider<'a>>,
    /// Thinner solids, on the first of which the cloth is sewn; empty for the body alone.
    around: &'a [&'a dyn CollisionSurface],
    /// The mesh that moves.
    pieces: Pieces,
    /// From the scene's mesh to the one that moves, how each was made coarser.
    coarser: Vec<Coarser>,
    /// The sewn point of each vertex of the scene.
    points: Vec<u32>,
    falls: Option<Falls>,
    clock: Instant,
    /// Stops where the caller does, and when the time limit is reached.
    stopper: Stopper,
    progress: &'a mut OnStep<'a>,
    recorder: Option<&'a mut Recorder>,
}

impl<'a> MotionRun<'a> {
    /// The solid on which the seams close.
    fn sewn_on(&self) -> Option<Collider<'a>> {
        self.collider.map(|c| Collider { surface: self.around.first().copied().unwrap_or(c.surface), ..c })
    }

    /// The garment with its seams joined.
    fn sewn(&mut self, longest: f64) -> Result<Moving, MotionError> {
        if let Some(through) = self.settings.through {
            return self.sewn_through(through, longest);
        }
        let surface = self.collider.map(|c| c.surface);
        let start = check::<MotionError>(self.scene, surface, self.settings.join_gap)?;
        let open = Moving::open(self, start)?;
        self.sew(open, longest)
    }

    fn phases(&mut self, longest: f64) -> Result<Moved, MotionError> {
        let mut moving = self.sewn(longest)?;
        moving.set_damping(self.settings.drag, 1.0);
        let mut sewn_for = moving.progress.time;
        for phase in &self.scene.phases {
            moving.set_gravity(phase.gravity);
            moving.set_air(phase.air);
            sewn_for = if phase.gravity == Vec3::zeros() { sewn_for } else { 0.0 };
            let seconds = (phase.seconds - sewn_for).max(0.0);
            sewn_for = (sewn_for - phase.seconds).max(0.0);
            let end = moving.progress.time + seconds;
            while end - moving.progress.time > SAME_TIME {
                self.step(&mut moving, end)?;
            }
        }
        let converged = !moving.is_jammed;
        Ok(self.finish(moving, converged))
    }

    /// Closes and joins the seams, if there are any, without weight and wind.
    fn sew(&mut self, mut moving: Moving, longest: f64) -> Result<Moving, MotionError> {
        moving.set_gravity(Vec3::zeros());
        moving.set_damping(self.settings.drag, self.settings.sewing_friction);
        moving.set_air(self.scene.phases.last().and_then(|p| p.air).map(Air::calmed));
        if moving.seams.widest(&moving.state.x).is_some_and(|(_, gap)| gap < self.settings.join_gap) {
            return moving.join(self);
        }
        let (mut widest, mut since) = (f64::INFINITY, moving.progress.time);
        while !moving.seams.is_empty() && moving.progress.time < longest {
            self.step(&mut moving, f64::INFINITY)?;
            if moving.seams_met(self.settings.join_gap) {
                return moving.join(self);
            }
            if moving.progress.gap < (1.0 - LEAST_CLOSED) * widest {
                (widest, since) = (moving.progress.gap, moving.progress.time);
            } else if moving.progress.time - since > PATIENCE {
                break;
            }
        }
        if self.settings.through.is_some() && moving.seams_met(JOINED_GAP * moving.edge()) {
            return moving.join(self);
        }
        self.closed(&moving)?;
        Ok(moving)
    }

    fn rest(&mut self, speed: f64, energy: f64, longest: f64) -> Result<Moved, MotionError> {
        let last = self.scene.phases.last();
        let (gravity, air) = (last.map(|p| p.gravity).unwrap_or_default(), last.and_then(|p| p.air));
        let mut moving = self.sewn(longest)?;
        moving.set_gravity(gravity);
        moving.set_air(air);
        let (began, calming, drag) = (moving.progress.time, self.settings.calming, self.settings.drag);
        let end = began + longest;
        let mut stored = f64::INFINITY;
        while moving.progress.time < end {
            let draped = moving.progress.time - began;
            moving.set_damping(calming.drag(drag, draped), calming.friction(draped));
            let look = moving.progress.time + LOOK;
            let before = moving.state.x.clone();
            while look - moving.progress.time > SAME_TIME {
                self.step(&mut moving, look)?;
            }
            let way = before.iter().zip(&moving.state.x).map(|(a, b)| (b - a).norm()).fold(0.0, f64::max);
            let now = moving.energy();
            let settled = (now - stored).abs() <= energy * now.abs().max(f64::MIN_POSITIVE);
            stored = now;
            moving.progress.speed = way / LOOK;
            if moving.progress.speed < speed && settled && !moving.is_jammed && draped >= calming.slip {
                return Ok(self.finish(moving, true));
            }
        }
        Ok(self.finish(moving, false))
    }

    fn step(&mut self, moving: &mut Moving, end: f64) -> Result<(), MotionError> {
        self.step_on(self.collider, moving, end)
    }

    /// One step on a solid.
    fn step_on(
        &mut self,
        solid: Option<Collider<'_>>,
        moving: &mut Moving,
        end: f64,
    ) -> Result<(), MotionError> {
        let before = self.recorder.is_some().then(|| (moving.progress.time, moving.state.x.clone()));
        let stepped = moving.step(self.settings, solid, end);
        if let Err(MotionError::Cloth(ClothError::Stopped)) = stepped {
            return Err(self.stopped(moving));
        }
        stepped?;
        if let Some(fallen) = self.falls.as_ref().and_then(|f| f.look(self.scene, moving)) {
            return Err(MotionError::FallsPast(Box::new(fallen)));
        }
        self.record(before, moving)?;
        let (pieces, coarser) = (&self.pieces, &self.coarser);
        let positions = || vertices(pieces, coarser, moving, &moving.state.x);
        if (self.progress)(&moving.progress, &positions).is_break() {
            return Err(MotionError::Stopped);
        }
        if self.clock.elapsed() > self.settings.budget {
            return Err(self.stopped(moving));
        }
        Ok(())
    }

    /// Hands the recorder the step that was made, where a frame is due.
    fn record(&mut self, before: Option<(f64, Vec<Vec3>)>, moving: &Moving) -> Result<(), MotionError> {
        let (now, Some((time, x))) = (moving.progress.time, before) else { return Ok(()) };
        if !self.recorder.as_ref().is_some_and(|r| r.is_due(now)) {
            return Ok(());
        }
        let (from, to) = (self.vertices(moving, &x), self.vertices(moving, &moving.state.x));
        match self.recorder.as_mut().is_none_or(|r| r.pass((time, &from), (now, &to))) {
            true => Ok(()),
            false => Err(MotionError::Stopped),
        }
    }

    /// Why the caller or the time limit ends a motion.
    fn stopped(&self, moving: &Moving) -> MotionError {
        let (seconds, Progress { time, gap, .. }) = (self.clock.elapsed(), moving.progress);
        match seconds > self.settings.budget {
            true => {
                let positions = self.vertices(moving, &moving.state.x);
                MotionError::Timeout { seconds: seconds.as_secs_f64(), time, gap, positions }
            }
            false => MotionError::Stopped,
        }
    }

    fn closed(&self, moving: &Moving) -> Result<(), MotionError> {
        match moving.seams.widest(&moving.state.x) {
            Some((pair, gap)) => {
                let vertex = self.coarser.iter().rev().fold(pair[0], |v, c| c.kept[v as usize]);
                let seam = seams::name_of(self.scene, &self.points, vertex);
                let reversed = probably_reversed(self.scene, &self.scene.positions);
                let (time, positions) = (moving.progress.time, self.vertices(moving, &moving.state.x));
                Err(MotionError::SeamNotClosed { seam, gap, time, reversed, positions })
            }
            None => Ok(()),
        }
    }

    fn finish(&self, mut moving: Moving, converged: bool) -> Moved {
        if let Some(collider) = self.collider {
            moving.restore_clearance(collider);
        }
        Moved {
            positions: self.vertices(&moving, &moving.state.x),
            velocities: self.vertices(&moving, &moving.state.v),
            progress: moving.progress,
            converged,
            is_jammed: moving.is_jammed,
            energy: moving.energy(),
            joined_at: moving.joined_at,
        }
    }

    /// Values of the scene's vertices from those of the cloth that moves.
    fn vertices(&self, moving: &Moving, values: &[Vec3]) -> Vec<Vec3> {
        vertices(&self.pieces, &self.coarser, moving, values)
    }
}

/// Values of the scene's vertices from those of the cloth that moves.
fn vertices(pieces: &Pieces, coarser: &[Coarser], moving: &Moving, values: &[Vec3]) -> Vec<Vec3> {
    let values = if moving.is_joined { pieces.spread(values) } else { values.to_vec() };
    coarser.iter().rev().fold(values, |values, c| c.prolong(&values))
}
