//! Cloth, contacts and seams, advanced step by step.
//!
//! Order of a step: forces and new velocities (the solver), over-stretch, contact of cloth with
//! itself, contact with the body, and positions last. The body has the last word, so nothing ever
//! ends a step inside it; the bound on each node's way comes after that, so cloth never crosses.
//!
//! The time step adapts (after Desbrun 1999): it starts at the stability limit of the stiffest
//! spring, is halved and the motion taken back where a node moves absurdly fast, and grows
//! again after a calm stretch.

use super::contact::Contacts;
use super::model::{Cloth, Softening, State};
use super::overstretch::limit_stretch;
use super::pair::SelfPairs;
use super::seams::{SeamPull, Seams, join, mark_closed};
use super::skin::lift_off_skin;
use super::solver::Solver;
use nalgebra::Vector3;
use toile_core::prelude::*;

/// What acts, and how finely.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// Acceleration of gravity, m/s2; zero while sewing.
    pub gravity: Vector3<f64>,
    /// Damping on top of the fabric's, 1/s.
    pub damping: f64,
    /// No spring is stiffer.
    pub softening: Softening,
    /// Strain above which edges are shortened; `None` where springs alone hold the cloth.
    pub max_strain: Option<f64>,
    /// Share of the collider's friction that acts: less lets cloth slip into place.
    pub friction: f64,
    /// Cloth is held off itself by this share of the collider's thickness: less lets the two sides of
    /// a seam lie on each other while they are drawn together.
    pub self_thickness: f64,
    /// Seam forces; `None` where seams do not pull.
    pub pull: Option<SeamPull>,
}

/// Nodes faster than this are taken for a blow-up, m/s: cloth that falls a metre reaches 4.4, and
/// waves of stretch run at 70 in the stiffest cloth that is not cut.
const ABSURD_SPEED: f64 = 200.0;
/// Steps between two states that can be gone back to.
const KEEP_EVERY: usize = 64;
/// Steps after a halving before the time step grows again.
const CALM_STEPS: usize = 512;
/// Steps between two looks at how far nodes have drifted from their contact planes.
const LOOK_EVERY: usize = 4;
/// The time step is not halved below this share of its limit; then the motion has failed.
const LEAST_SHARE: f64 = 1.0 / 1024.0;

/// A garment in motion.
#[derive(Debug)]
pub struct Simulation<'a> {
    /// What acts; may be changed between steps (then call [`Simulation::retune`]).
    pub settings: Settings,
    /// The garment as it was given, with the joins made since.
    pub garment: Garment,
    /// Its springs.
    pub cloth: Cloth,
    /// Its motion.
    pub state: State,
    /// Open pairs.
    pub seams: Seams,
    collider: Option<&'a dyn Collide>,
    body: Contacts,
    pairs: SelfPairs,
    solver: Box<dyn Solver>,
    /// The springs' highest frequency; joins do not raise it.
    frequency: f64,
    dt: f64,
    limit: f64,
    kept: State,
    calm: usize,
    /// Steps made.
    pub steps: usize,
    /// Time passed, seconds.
    pub time: f64,
}

/// The garment's springs, its pins held.
fn held(garment: &Garment, softening: Softening) -> Cloth {
    let mut cloth = Cloth::new(garment, softening);
    for &v in &garment.pinned {
        cloth.hold(cloth.node_of[v as usize] as usize);
    }
    cloth
}

impl<'a> Simulation<'a> {
    /// A garment that passed [`check_garment`](super::check_garment), at its start.
    pub fn new(
        garment: &Garment,
        collider: Option<&'a dyn Collide>,
        solver: Box<dyn Solver>,
        settings: Settings,
    ) -> Self {
        let garment = garment.clone();
        let cloth = held(&garment, settings.softening);
        let state = cloth.gather(&garment);
        let seams = Seams::open(&garment, &cloth);
        let mut simulation = Simulation {
            settings,
            garment,
            seams,
            collider,
            body: Contacts::default(),
            pairs: SelfPairs::default(),
            solver,
            frequency: cloth.frequency(),
            dt: 0.0,
            limit: 0.0,
            kept: state.clone(),
            cloth,
            state,
            calm: 0,
            steps: 0,
            time: 0.0,
        };
        simulation.pairs.reset(simulation.cloth.len(), simulation.seams.partners());
        simulation.retune();
        simulation.dt = simulation.limit;
        simulation
    }

    /// Finds the stable time step for the present springs and settings.
    pub fn retune(&mut self) {
        let seams = self.settings.pull.map_or(0.0, |p| self.seams.frequency_square(p, &self.cloth));
        self.limit = self.solver.step_limit(self.frequency.hypot(seams.sqrt()));
        self.dt = self.dt.min(self.limit);
    }

    /// The present time step, seconds.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Sets the time step, for as long as it is stable.
    pub fn set_dt(&mut self, dt: f64) {
        self.limit = dt.min(self.limit);
        self.dt = self.limit;
    }

    /// Number of pairs of cloth near other cloth.
    pub fn pairs(&self) -> usize {
        self.pairs.len()
    }

    /// Searches for cloth near cloth made so far.
    pub fn searches(&self) -> usize {
        self.pairs.searches()
    }

    /// Advances by one step. Errs when the motion cannot be kept finite.
    pub fn step(&mut self) -> Result<(), StageError> {
        self.look();
        let strain = self.push();
        if let Some(limit) = self.settings.max_strain
            && strain > limit / 2.0
        {
            limit_stretch(&self.cloth, &mut self.state, limit, self.dt);
        }
        self.touch();
        self.steps += 1;
        self.time += self.dt;
        let fastest = self.travel();
        match fastest < ABSURD_SPEED * ABSURD_SPEED {
            true => self.keep(),
            false => self.go_back()?,
        }
        Ok(())
    }

    fn look(&mut self) {
        let Some(scheme) = self.collider else { return };
        if self.steps.is_multiple_of(LOOK_EVERY) {
            self.body.refresh(scheme, &self.cloth.edges, &self.state.x);
        }
        if scheme.card().self_collision {
            self.pairs.refresh(scheme, &self.state.x, &self.cloth.triangles);
        }
    }

    /// New velocities from all forces.
    fn push(&mut self) -> f64 {
        let Settings { gravity, damping, pull, .. } = self.settings;
        let (cloth, seams) = (&self.cloth, &self.seams);
        let forces = |state: &State, forces: &mut [Vector3<f64>]| {
            if let Some(pull) = pull {
                seams.add_forces(pull, state, forces);
            }
            forces.iter_mut().zip(&cloth.mass).for_each(|(f, m)| *f += gravity * *m);
            cloth.add_forces(&state.x, forces)
        };
        self.solver.advance(cloth, &mut self.state, damping, self.dt, &forces)
    }

    fn touch(&mut self) {
        let Some(scheme) = self.collider else { return };
        let mut card = scheme.card();
        card.friction *= self.settings.friction;
        if card.self_collision {
            let thickness = card.thickness * self.settings.self_thickness;
            self.pairs.respond(thickness, card.friction, &self.cloth, &mut self.state, self.dt);
        }
        self.body.respond(&card, &self.cloth, &mut self.state, self.dt);
        if card.self_collision {
            self.pairs.hold_back(&mut self.state, self.dt);
        }
    }

    /// Moves the nodes; returns the greatest speed squared, infinite for one that is no number.
    fn travel(&mut self) -> f64 {
        let mut fastest = 0.0f64;
        for (x, v) in self.state.x.iter_mut().zip(&self.state.v) {
            *x += v * self.dt;
            let square = v.norm_squared();
            fastest = if square.is_finite() { fastest.max(square) } else { f64::INFINITY };
        }
        fastest
    }

    fn keep(&mut self) {
        self.calm += 1;
        if self.steps.is_multiple_of(KEEP_EVERY) {
            self.kept.clone_from(&self.state);
        }
        if self.calm >= CALM_STEPS && self.dt < self.limit {
            self.dt = (self.dt * 1.25).min(self.limit);
            self.calm = 0;
        }
    }

    fn go_back(&mut self) -> Result<(), StageError> {
        self.state.clone_from(&self.kept);
        (self.dt, self.calm) = (self.dt / 2.0, 0);
        self.body.clear();
        self.pairs.reset(self.cloth.len(), self.seams.partners());
        match self.dt < self.limit * LEAST_SHARE {
            true => Err(StageError::new(ErrorCode::StaticEquilibrium, "the motion does not stay finite")
                .hint("see the fabric's stiffness and the panels' start; a coarser mesh is steadier")),
            false => Ok(()),
        }
    }

    /// Joins pairs nearer than `distance`; returns how many.
    pub fn join(&mut self, distance: f64) -> usize {
        let joined = join(&mut self.garment, &self.cloth, &mut self.state, distance);
        if joined > 0 {
            self.cloth.scatter(&self.state, &mut self.garment);
            self.rebuild();
        }
        joined
    }

    fn rebuild(&mut self) {
        self.cloth = held(&self.garment, self.settings.softening);
        self.state = self.cloth.gather(&self.garment);
        self.kept.clone_from(&self.state);
        self.seams = Seams::open(&self.garment, &self.cloth);
        self.body.clear();
        self.pairs.reset(self.cloth.len(), self.seams.partners());
        self.retune();
    }

    /// Elastic and gravitational energy, J; height counts from the ground.
    pub fn energy(&self) -> f64 {
        let weight = |(x, m): (&Point3, &f64)| -m * self.settings.gravity.dot(&x.coords);
        let lift: f64 = self.state.x.iter().zip(&self.cloth.mass).map(weight).sum();
        self.cloth.elastic_energy(&self.state.x) + lift
    }

    /// Energy of motion, J.
    pub fn kinetic_energy(&self) -> f64 {
        self.state.v.iter().zip(&self.cloth.inertia).map(|(v, m)| m * v.norm_squared() / 2.0).sum()
    }

    /// Greatest speed of a node, m/s.
    pub fn max_speed(&self) -> f64 {
        self.state.v.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt()
    }

    /// Lifts edges and triangles that dip into the skin between their nodes.
    pub fn lift_off_skin(&mut self) {
        if let Some(scheme) = self.collider {
            lift_off_skin(scheme, &self.cloth, &mut self.state);
        }
    }

    /// The garment as it is now.
    pub fn finish(mut self, converged: bool) -> Garment {
        let status = SolveStatus {
            steps: self.garment.status.steps + self.steps,
            converged,
            energy: self.energy(),
            max_speed: self.max_speed(),
            on_body: self.garment.status.on_body.clone(),
        };
        self.cloth.scatter(&self.state, &mut self.garment);
        mark_closed(&mut self.garment);
        self.garment.status = status;
        self.garment
    }
}
