//! A garment that is kept in equilibrium while its fabric, its pins or its collider change.
//!
//! Method: the state of the finest level is kept: positions, friction anchors, neighbour pairs and
//! the order of elimination. After a small change one or two Newton steps suffice. When the changes
//! stop, [`Live::settle`] goes on until rest is proved.
//!
//! Cost of a step: one factorization, and O(n) for the rest. Limits: mesh and seams must stay.
//! Since friction and folds have a history, the equilibrium may differ from that of a fresh start.

use crate::mesh::Sheet;
use crate::scene::{Held, Scene};
use crate::statics::drive::held::hold_as;
use crate::statics::drive::solve::{Equilibrium, LevelReport, Progress, StaticEquilibrium, StaticsError};
use crate::statics::factor::multifrontal::Halt;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::clearance::clearance;
use crate::statics::forces::self_contact::SelfContact;
use crate::statics::forces::system::System;
use crate::statics::levels::assemble::{Collider, assemble, cloths, kept_seam_forces};
use crate::statics::levels::pieces::Pieces;
use crate::statics::newton::to_rest::{NewtonOptions, NewtonState, Outcome, Proof, greatest};
use crate::statics::report::unbalanced::unbalanced;
use std::time::Instant;
use toile_geometry::{Vec3, cloth_tree::ClothTree};

/// First step of pseudo-time, of a garment that was at rest, s.
const FIRST: f64 = 0.2;

/// Farthest that a node may move in a step, m.
const FARTHEST: f64 = 0.05;

/// A garment in equilibrium that can be changed.
pub struct Live<'a> {
    settings: StaticEquilibrium,
    scene: Scene,
    collider: Option<Collider<'a>>,
    pieces: Pieces,
    sheet: Sheet,
    system: System<'a>,
    newton: NewtonState,
    x: Vec<Vec3>,
}

impl<'a> Live<'a> {
    /// Starts from `state`, an equilibrium of `scene` on `collider`.
    ///
    /// # Errors
    /// [`StaticsError`], where the scene is at fault or the state has another number of vertices.
    pub fn new(
        settings: StaticEquilibrium,
        scene: Scene,
        collider: Option<Collider<'a>>,
        state: &Equilibrium,
    ) -> Result<Self, StaticsError> {
        Self::at(settings, scene, collider, &state.positions, &state.held())
    }

    /// Starts where `scene` stands, with the history of friction that it has.
    ///
    /// # Errors
    /// [`StaticsError`], where the scene is at fault.
    pub fn here(
        settings: StaticEquilibrium,
        scene: Scene,
        collider: Option<Collider<'a>>,
    ) -> Result<Self, StaticsError> {
        let (positions, held) = (scene.positions.clone(), scene.held.clone());
        Self::at(settings, scene, collider, &positions, &held)
    }

    fn at(
        settings: StaticEquilibrium,
        scene: Scene,
        collider: Option<Collider<'a>>,
        positions: &[Vec3],
        held: &Held,
    ) -> Result<Self, StaticsError> {
        scene.check()?;
        scene.check_still()?;
        if positions.len() != scene.rest.len() {
            return Err(StaticsError::Reshaped);
        }
        let pieces = Pieces::new(&scene);
        let sheet = pieces.sewn_sheet(&cloths(&scene))?;
        let mut system = assemble(&scene, collider, &pieces, &sheet, false, settings.models)?;
        system.set_seam_forces(kept_seam_forces(&scene, &pieces, settings.join_gap));
        let even = vec![1.0; scene.rest.len()];
        let x = pieces.sew(positions, &even);
        hold_as(held, &mut system, &pieces, &x);
        let layout = pieces.sew(&scene.positions, &even);
        let tree = scene.self_collision.then(|| ClothTree::new(sheet.triangles(), &layout));
        let newton = NewtonState::new(&mut system, &layout, tree, &x, FIRST);
        Ok(Self { settings, scene, collider, pieces, sheet, system, newton, x })
    }

    /// The present scene.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The positions of all vertices of the scene, m.
    #[must_use]
    pub fn positions(&self) -> Vec<Vec3> {
        self.pieces.spread(&self.x)
    }

    /// Changes the scene: fabrics, friction, pins, gravity. Mesh, seams and panels' ranges must
    /// stay.
    ///
    /// # Errors
    /// [`StaticsError`]: the changed scene is at fault, or of another shape; then nothing has
    /// changed.
    pub fn change(&mut self, edit: impl FnOnce(&mut Scene)) -> Result<(), StaticsError> {
        let mut scene = self.scene.clone();
        edit(&mut scene);
        scene.check()?;
        scene.check_still()?;
        let same_panels =
            scene.panels.iter().map(|p| &p.vertices).eq(self.scene.panels.iter().map(|p| &p.vertices));
        let same_mesh = scene.rest == self.scene.rest && scene.triangles == self.scene.triangles;
        if !same_mesh || !same_panels || scene.seams != self.scene.seams {
            return Err(StaticsError::Reshaped);
        }
        if let (Some(collider), Some(body)) = (&mut self.collider, &scene.body) {
            collider.friction = body.friction;
        }
        self.scene = scene;
        self.renew()
    }

    /// Replaces the collider by one near it.
    ///
    /// # Errors
    /// [`StaticsError`], where the scene is at fault.
    pub fn set_collider(&mut self, collider: Option<Collider<'a>>) -> Result<(), StaticsError> {
        self.collider = collider;
        self.system.get_mut::<BodyContact>().into_iter().for_each(|c| c.distance_cache.clear());
        self.renew()
    }

    /// Moves a pinned vertex to `to` within the next steps; returns whether it is pinned.
    pub fn pull(&mut self, vertex: u32, to: Vec3) -> bool {
        let node = self.pieces.node.get(vertex as usize).copied().filter(|n| self.system.pinned[*n as usize]);
        let Some(node) = node else { return false };
        self.system.targets.retain(|(n, _)| *n != node);
        self.system.targets.push((node, to));
        self.newton.wake();
        true
    }

    /// Takes over the changed scene, and keeps the state of the last steps.
    fn renew(&mut self) -> Result<(), StaticsError> {
        self.pieces.pinned.fill(false);
        self.scene.pinned.iter().for_each(|&p| self.pieces.pinned[p as usize] = true);
        self.sheet = self.pieces.sewn_sheet(&cloths(&self.scene))?;
        let mut new =
            assemble(&self.scene, self.collider, &self.pieces, &self.sheet, false, self.settings.models)?;
        new.set_seam_forces(kept_seam_forces(&self.scene, &self.pieces, self.settings.join_gap));
        new.continue_from(&self.system, &self.x);
        self.system = new;
        self.newton.renew(&mut self.system);
        Ok(())
    }

    /// Makes up to `steps` Newton steps towards rest; none if the garment is at rest. The last step
    /// is short: it removes the strain that long steps leave. The residual is that of the final
    /// state.
    ///
    /// # Errors
    /// [`StaticsError::NotPositive`], where no inertia makes the matrix positive definite.
    pub fn follow(&mut self, steps: usize) -> Result<Outcome, StaticsError> {
        let options = self.options();
        for left in (0..steps).rev() {
            if self.newton.outcome().at_rest {
                break;
            }
            if left == 0 {
                self.newton.shorten_next();
            }
            self.step(&options, &|| false)?;
        }
        self.system.update_contacts(&self.x);
        let residual = greatest(&self.system.gradient(&self.x));
        Ok(Outcome { residual, ..self.newton.outcome() })
    }

    fn options(&self) -> NewtonOptions {
        let (steps, speed) = (self.settings.finest_steps, self.settings.speed);
        NewtonOptions {
            first: FIRST,
            longest: 1.0,
            steps,
            speed,
            non_static: self.settings.non_static,
            farthest: FARTHEST,
            proof: Proof::of(self.settings.long_proof),
            skip_line_search: false,
            holds_stopped: false,
            one_by_one: false,
            asleep: self.settings.asleep,
            precision: self.settings.precision,
        }
    }

    fn step(
        &mut self,
        options: &NewtonOptions,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<Outcome, StaticsError> {
        self.newton.step(&mut self.system, &mut self.x, options, stop).map_err(|halt| match halt {
            Halt::NotPositive(error) => error.into(),
            Halt::Stopped => StaticsError::Stopped,
        })
    }

    /// Makes steps until the garment is at rest; `progress` is called after every step.
    ///
    /// # Errors
    /// Every [`StaticsError`]; the greatest number of steps is
    /// [`StaticEquilibrium::finest_steps`].
    pub fn settle(&mut self, progress: &mut Progress<'_>) -> Result<Equilibrium, StaticsError> {
        let (clock, budget, options) = (Instant::now(), self.settings.budget, self.options());
        let first = self.newton.outcome().steps;
        let mut outcome = self.newton.outcome();
        while !outcome.at_rest && outcome.steps < first + options.steps {
            outcome = self.step(&options, &|| clock.elapsed() > budget)?;
            if progress(&self.report(clock, first), &|| self.positions()).is_break() {
                return Err(StaticsError::Stopped);
            }
        }
        self.system.update_contacts(&self.x);
        let unbalanced = unbalanced(&self.system, &self.system.gradient(&self.x), &self.pieces);
        let state = Equilibrium {
            positions: self.positions(),
            outcome,
            residual: unbalanced.force,
            unbalanced,
            slides: self.pieces.spread(&self.system.displacements(&self.x)),
            folds: self.system.elastic.held().to_vec(),
            friction_contacts: self
                .system
                .get::<SelfContact>()
                .map_or_else(Vec::new, |c| c.friction_contacts.clone()),
            offsets: self.pieces.offsets(&self.system),
            energy: self.system.stored(&self.x),
            dip: self.collider.map_or(0.0, |c| clearance(&self.sheet, c.surface, &self.x).depth),
            joined_at: None,
            levels: vec![self.report(clock, first)],
            restarts: 0,
        };
        let pairs = self.newton.crossings(&self.x);
        if pairs > 0 {
            return Err(StaticsError::Crossing { pairs, state: Box::new(state) });
        }
        self.settings.judge(&self.scene, state)
    }

    fn report(&self, clock: Instant, first: usize) -> LevelReport {
        let outcome = self.newton.outcome();
        let outcome = Outcome { steps: outcome.steps - first, ..outcome };
        LevelReport {
            nodes: self.x.len(),
            sewing: false,
            gap: 0.0,
            seam: String::new(),
            pass: [1, 1],
            outcome,
            seconds: clock.elapsed().as_secs_f64(),
        }
    }
}

#[cfg(test)]
mod tests;
