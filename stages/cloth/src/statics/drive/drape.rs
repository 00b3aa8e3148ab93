//! Draping: the sewn garment is brought to equilibrium, level by level.
//!
//! Method: each level starts from the state of the coarser one, prolonged to its vertices. With
//! bending continuation (see `levels/bending_continuation`), each level also lowers the stiffness
//! of bending. While a level is solved, another thread prepares the next finer one. Only the finest
//! level must prove that it is at rest. Cost and limits: see `solve`.

use crate::statics::drive::coarse_to_fine::{Draped, LevelMesh, Solve};
use crate::statics::drive::dips::Rounds;
use crate::statics::drive::held::hold_as;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::levels::bending_continuation::stages;
use crate::statics::levels::mesh_level::Level;
use crate::statics::newton::to_rest::{NewtonOptions, Proof};
use crate::statics::report::equilibrium::Progress;
use crate::statics::report::error::StaticsError;
use crate::statics::report::intersecting::intersections_of;

/// Newton steps of a state of bending continuation.
const CONTINUATION_STEPS: usize = 60;

/// Speed at which such a state is at rest, as a share of that of the final state. A state so near
/// to rest no longer depends on the start.
const CONTINUATION_SPEED: f64 = 0.05;

/// How far the centre of mass of a garment without friction may move from its initial place, as a
/// share of its size. A garment that moves farther slides off.
const MOST_FALL: f64 = 0.1;

/// First step of pseudo-time, s.
const FIRST: f64 = 0.05;

/// Longest step of pseudo-time, s.
const LONGEST: f64 = 1.0;

/// Farthest that a node may move in a step, m.
const FARTHEST: f64 = 0.1;

/// First step of pseudo-time on the finest level, s: the state of a coarser level has little speed.
const FIRST_ON_FINEST: f64 = 0.15;

/// Newton steps in which cloth that a coarser level left on both sides of a sharp edge must come
/// out over it.
const FREEING: usize = 20;

/// Longest step of pseudo-time of bending continuation, s: cloth without friction slides slowly.
const LONGEST_CONTINUATION: f64 = 10.0;

/// How far a level has come in bending continuation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Continued {
    /// How many times stiffer bending is than that of the fabric.
    pub(crate) stiff: f64,
    /// Whether the level was solved without friction.
    pub(crate) frictionless: bool,
}

impl<'a> Solve<'a> {
    /// Brings the sewn garment to equilibrium.
    pub(crate) fn drape(mut self, progress: &mut Progress<'_>) -> Result<Draped, StaticsError> {
        let plan = self.plan;
        let (mut continued, mut slides) = (Continued { stiff: 1.0, frictionless: false }, Vec::new());
        let mut k = plan.coarsest_level();
        let mut level = plan.level(k)?;
        loop {
            let is_prolonged = k < plan.coarsest_level() || plan.settings.from_here;
            level.begin(std::mem::take(&mut self.x), std::mem::take(&mut slides), is_prolonged);
            if plan.settings.from_here && !plan.scene.held.is_empty() {
                hold_as(&plan.scene.held, &mut level.system, &plan.pieces[k], &level.x);
            }
            let mut finer = None;
            // Another thread prepares the next finer level meanwhile.
            let is_free = rayon::in_place_scope(|scope| {
                if k > 0 {
                    scope.spawn(|_| finer = Some(plan.level(k - 1)));
                }
                // Cloth that was sewn through itself cannot start anew without crossings: a finer
                // level may come out over the edge.
                if !self.free_of_ridges(k, &mut level, progress)? && !plan.settings.sew_through {
                    return Ok(false);
                }
                self.solve_level(k, &mut level, &mut continued, progress).map(|()| true)
            })?;
            if !is_free {
                return Ok(Draped::TooCoarse { finer: plan.pieces[k].points });
            }
            // Crossings of cloth that was sewn through itself may be resolved on a finer level;
            // sewing it there anew gains nothing.
            if level.system.is_intersecting() && (k == 0 || !plan.settings.sew_through) {
                return Ok(Draped::Intersecting(intersections_of(&plan.pieces[k], &level)));
            }
            if let Some(pierced) = self.pierced(k, &level.sheet, &level.x) {
                return Ok(pierced);
            }
            let Some(finer) = finer else {
                self.check_kept(&level.x)?;
                self.check_strain(&level.sheet, &level.x)?;
                let state = self.finish(level.system, &level.sheet, level.x)?;
                return Ok(Draped::Equilibrium(Box::new(state)));
            };
            slides = plan.finer(k, &level.system.displacements(&level.x));
            self.x = plan.finer(k, &level.x);
            level = finer?;
            k -= 1;
        }
    }

    /// Lets level `k` come out over the sharp edges and corners of the body that pass through it;
    /// returns whether it has. Only the state of a coarser level can be so.
    fn free_of_ridges(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        if k == self.plan.coarsest_level() || !level.system.is_pierced(&level.x) {
            return Ok(true);
        }
        self.settle(k, level, 1.0, NewtonOptions { steps: FREEING, ..self.options() }, progress)?;
        Ok(!level.system.is_pierced(&level.x))
    }

    /// Brings level `k` near rest, and the finest level to rest. `continued` is how far the coarser
    /// level came, and then how far this level has come.
    fn solve_level(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        continued: &mut Continued,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        if let Some(continuation) = self.plan.continuation(level.size()) {
            let end = if k == 0 { 1.0 } else { continuation.resolved(level.edge()) };
            let Continued { stiff, frictionless } = *continued;
            *continued = if k == self.plan.coarsest_level() {
                self.initial_equilibrium(k, level, continuation.first(), end, progress)?
            } else {
                let stiff = self.continue_level(k, level, [stiff, end.min(stiff)], frictionless, progress)?;
                Continued { stiff, frictionless }
            };
        } else if k > 0 {
            let options = NewtonOptions { one_by_one: self.starts_one_by_one(k), ..self.options() };
            self.settle(k, level, 1.0, options, progress)?;
        }
        if k == 0 { self.solve_finest(level, progress) } else { Ok(()) }
    }

    /// Brings a finer level from one stiffness to another, if it stays on the body without friction
    /// then so; returns the stiffness reached.
    fn continue_level(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        range: [f64; 2],
        frictionless: bool,
        progress: &mut Progress<'_>,
    ) -> Result<f64, StaticsError> {
        let mut free = level.clone();
        if frictionless {
            free.disable_friction();
        }
        if self.continue_to(k, &mut free, range, progress)? {
            *level = free;
        } else if frictionless {
            self.continue_to(k, level, range, progress)?;
        }
        Ok(range[1])
    }

    /// Lowers the bending of level `k` from one factor to another, then enables friction; returns
    /// whether the garment stays on the body.
    pub(crate) fn continue_to(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        [from, to]: [f64; 2],
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        let mut stages = stages(from, to);
        // The last stage of the finest level is solved by `solve_finest`.
        if k == 0 {
            stages.pop();
        } else if stages.is_empty() {
            stages.push(to);
        }
        for stage in stages {
            if !self.stays(k, level, stage, self.continuation_options(), progress)? {
                return Ok(false);
            }
        }
        if level.enable_friction() && k > 0 {
            self.settle(k, level, to, self.continuation_options(), progress)?;
        }
        Ok(true)
    }

    /// Brings level `k` near rest; returns whether it stays on the body. With friction only a fall
    /// past the body shows that it does not.
    pub(crate) fn stays(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        stiff: f64,
        options: NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        match self.settle(k, level, stiff, options, progress) {
            Ok(()) if level.is_frictionless => Ok(level.moved() < MOST_FALL * level.size()),
            Ok(()) => Ok(true),
            Err(StaticsError::FallsPast(fallen)) if !fallen.is_certain => {
                self.last_fall = Some(StaticsError::FallsPast(fallen));
                Ok(false)
            }
            Err(e) => Err(e),
        }
    }

    /// Brings level `k` near rest with bending `stiff` times stiffer.
    fn settle(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        stiff: f64,
        options: NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        level.system.elastic.scale_bending(stiff);
        let contact = level.system.get_mut::<BodyContact>();
        let offsets = contact.filter(|_| self.plan.settings.bending_continuation).map(|c| {
            c.grows_offsets = true;
            c.offsets.clone()
        });
        let Level { system, sheet, layout, x, .. } = &mut *level;
        let mesh = LevelMesh { k, is_open: false, sheet, layout };
        let run = self.relax_uncrossed(mesh, system, x, &options, progress);
        if let (Some(contact), Some(offsets)) = (level.system.get_mut::<BodyContact>(), offsets) {
            (contact.grows_offsets, contact.offsets) = (false, offsets);
        }
        level.system.elastic.scale_bending(1.0 / stiff);
        self.reports.push(run?);
        Ok(())
    }

    /// Brings the finest level to rest, and proves that it is.
    fn solve_finest(
        &mut self,
        level: &mut Level<'a>,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let (steps, speed) = (self.plan.settings.finest_steps, self.plan.settings.speed);
        let proof = Proof::of(self.plan.settings.long_proof);
        let one_by_one = self.starts_one_by_one(0);
        let options =
            NewtonOptions { first: FIRST_ON_FINEST, steps, speed, proof, one_by_one, ..self.options() };
        let Level { system, sheet, layout, x, .. } = level;
        let mesh = LevelMesh { k: 0, is_open: false, sheet, layout };
        let report = self.relax_uncrossed(mesh, system, x, &options, progress)?;
        self.reports.push(report);
        self.restore_clearance(Rounds { mesh, system, x, options }, progress)
    }

    /// Whether the cloths of a stack start one by one on level `k`. Finer levels start from the
    /// stack.
    fn starts_one_by_one(&self, k: usize) -> bool {
        self.plan.is_stack && k == self.plan.coarsest_level()
    }

    /// The options of all runs but the last.
    pub(crate) fn options(&self) -> NewtonOptions {
        let (steps, speed) = (self.plan.settings.coarse_steps, 2.0 * self.plan.settings.speed);
        NewtonOptions {
            first: FIRST,
            longest: LONGEST,
            steps,
            speed,
            non_static: self.plan.settings.non_static,
            farthest: FARTHEST,
            proof: Proof::AnyStep,
            skip_line_search: false,
            holds_stopped: self.plan.settings.sew_through,
            one_by_one: false,
            asleep: self.plan.settings.asleep,
            precision: self.plan.settings.precision,
        }
    }

    /// The options of a state of bending continuation.
    pub(crate) fn continuation_options(&self) -> NewtonOptions {
        NewtonOptions {
            longest: LONGEST_CONTINUATION,
            steps: CONTINUATION_STEPS,
            speed: CONTINUATION_SPEED * self.plan.settings.speed,
            ..self.options()
        }
    }
}
