//! The sewn garment comes to rest, level by level and from stiff to limp.

use crate::error::ClothError;
use crate::statics::drive::coarse_to_fine::{Draped, Solve};
use crate::statics::drive::held::hold_as;
use crate::statics::levels::bending_continuation::stages;
use crate::statics::levels::mesh_level::Level;
use crate::statics::newton::to_rest::NewtonOptions;
use crate::statics::report::equilibrium::Progress;
use crate::statics::report::error::StaticsError;
use crate::statics::report::intersecting::entangled;

/// Steps of a state on the way from stiff to limp, and the speed at which it rests, as a share of
/// that of the end: so near rest, the state forgets where it began.
const FORGET: (usize, f64) = (60, 0.05);

/// How far the middle of a garment without friction may move from where it was placed, as a share
/// of its size; else it slides off.
const MOST_FALL: f64 = 0.1;

/// First and longest step of pseudo-time, s, and the farthest way in a step, m.
const SPAN: (f64, f64, f64) = (0.05, 1.0, 0.1);

/// First step of pseudo-time on the finest mesh, s: what a coarser one leaves has little speed.
const FIRST_AT_END: f64 = 0.15;

/// Steps in which cloth that a coarser mesh left on both sides of a sharp edge must come out over
/// it.
const FREEING: usize = 20;

/// The longest step on the way from stiff to limp, s: what slides without friction takes its time.
const LONGEST: f64 = 10.0;

impl<'a> Solve<'a> {
    /// Lets the sewn garment come to rest.
    pub(crate) fn drape(mut self, progress: &mut Progress<'_>) -> Result<Draped, StaticsError> {
        let plan = self.plan;
        let (mut bending, mut slides) = ((1.0, false), Vec::new());
        let mut ready = plan.level(plan.pieces.len() - 1);
        for k in (0..plan.pieces.len()).rev() {
            let mut level = ready?;
            let is_handed = k + 1 < plan.pieces.len() || plan.settings.from_here;
            level.begin(std::mem::take(&mut self.x), slides, is_handed);
            if plan.settings.from_here && !plan.scene.held.is_empty() {
                hold_as(&plan.scene.held, &mut level.system, &plan.pieces[k], &level.x);
            }
            // Another thread makes the next finer level ready meanwhile; below the finest there is
            // none, and nobody asks.
            ready = Err(ClothError::EmptyScene.into());
            let is_free = rayon::in_place_scope(|scope| {
                if k > 0 {
                    scope.spawn(|_| ready = plan.level(k - 1));
                }
                // What was sewn through itself has no start that is free of crossings: a finer mesh
                // may come over the edge.
                if !self.free_of_ridges(k, &mut level, progress)? && !plan.settings.sew_through {
                    return Ok(false);
                }
                self.solve_level(k, &mut level, &mut bending, progress).map(|()| true)
            })?;
            if !is_free {
                return Ok(Draped::TooCoarse { finer: plan.pieces[k].points });
            }
            // What was sewn through itself may come free on a finer mesh; nothing is gained by
            // sewing it there anew.
            if level.system.is_intersecting() && (k == 0 || !plan.settings.sew_through) {
                return Ok(Draped::Tangled(entangled(&plan.pieces[k], &level)));
            }
            if let Some(pierced) = self.pierced(k, &level.sheet, &level.x) {
                return Ok(pierced);
            }
            if k == 0 {
                self.check_kept(&level.x)?;
                self.check_strain(&level.sheet, &level.x)?;
                return Ok(Draped::Equilibrium(Box::new(self.finish(
                    level.system,
                    &level.sheet,
                    level.x,
                )?)));
            }
            slides = plan.finer(k, &level.system.displacements(&level.x));
            self.x = plan.finer(k, &level.x);
        }
        Err(ClothError::EmptyScene.into())
    }

    /// Lets level `k` come out over sharp edges and corners of the body that its coarser mesh came
    /// to lie on both sides of; whether it has. From its own start no mesh comes to cross one.
    fn free_of_ridges(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        if k + 1 == self.plan.pieces.len() || !level.system.is_pierced(&level.x) {
            return Ok(true);
        }
        self.settle(level, 1.0, NewtonOptions { steps: FREEING, ..self.options() }, progress)?;
        Ok(!level.system.is_pierced(&level.x))
    }

    /// Brings level `k` near rest, the finest one to rest. `bending` is how many times stiffer it
    /// was left by the level before, and whether without friction.
    fn solve_level(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        bending: &mut (f64, bool),
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let (stiff, frictionless) = *bending;
        if let Some(continuation) = self.plan.continuation(level.size()) {
            let end = if k == 0 { 1.0 } else { continuation.resolved(level.edge()) };
            *bending = if k + 1 == self.plan.pieces.len() {
                self.initial_equilibrium(k, level, continuation.first(), end, progress)?
            } else {
                (
                    self.continue_level(k, level, [stiff, end.min(stiff)], frictionless, progress)?,
                    frictionless,
                )
            };
        } else if k > 0 {
            let options = NewtonOptions { one_by_one: self.starts_one_by_one(k), ..self.options() };
            self.settle(level, 1.0, options, progress)?;
        }
        if k == 0 { self.solve_finest(level, progress) } else { Ok(()) }
    }

    /// Brings a finer level from one stiffness to another, without friction if it stays; the
    /// stiffness reached.
    fn continue_level(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        way: [f64; 2],
        frictionless: bool,
        progress: &mut Progress<'_>,
    ) -> Result<f64, StaticsError> {
        let mut free = level.clone();
        if frictionless {
            free.disable_friction();
        }
        if self.continue_to(k, &mut free, way, progress)? {
            *level = free;
        } else if frictionless {
            self.continue_to(k, level, way, progress)?;
        }
        Ok(way[1])
    }

    /// Lets the bending of level `k` go from one factor to another, and gives friction back;
    /// whether the garment stays.
    pub(crate) fn continue_to(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        [from, to]: [f64; 2],
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        let mut stages = stages(from, to);
        // The last stage of the finest level is its end.
        if k == 0 {
            stages.pop();
        } else if stages.is_empty() {
            stages.push(to);
        }
        for stage in stages {
            if !self.stays(level, stage, self.continuation_options(), progress)? {
                return Ok(false);
            }
        }
        if level.enable_friction() && k > 0 {
            self.settle(level, to, self.continuation_options(), progress)?;
        }
        Ok(true)
    }

    /// Brings a level near rest; whether it stays on the body. With friction only a fall past the
    /// body says that it does not.
    pub(crate) fn stays(
        &mut self,
        level: &mut Level<'a>,
        stiff: f64,
        options: NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        match self.settle(level, stiff, options, progress) {
            Ok(()) if level.friction.is_some() => Ok(level.moved() < MOST_FALL * level.size()),
            Ok(()) => Ok(true),
            Err(StaticsError::FallsPast(fallen)) if !fallen.is_certain => {
                self.last_fall = Some(StaticsError::FallsPast(fallen));
                Ok(false)
            }
            Err(e) => Err(e),
        }
    }

    /// Brings a level near rest with bending so many times stiffer.
    fn settle(
        &mut self,
        level: &mut Level<'a>,
        stiff: f64,
        options: NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        level.system.elastic.scale_bending(stiff);
        let offsets =
            level.system.body_contact.as_mut().filter(|_| self.plan.settings.bending_continuation).map(|s| {
                s.grows = true;
                s.offsets.clone()
            });
        let Level { system, sheet, layout, x, .. } = &mut *level;
        let run = self.relax_uncrossed(system, sheet, layout, x, &options, progress);
        if let (Some(s), Some(offsets)) = (&mut level.system.body_contact, offsets) {
            (s.grows, s.offsets) = (false, offsets);
        }
        level.system.elastic.scale_bending(1.0 / stiff);
        self.reports.push(run?);
        Ok(())
    }

    /// Brings the finest level to rest, and proves it.
    fn solve_finest(
        &mut self,
        level: &mut Level<'a>,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let (steps, speed) = (self.plan.settings.finest_steps, self.plan.settings.speed);
        let one_by_one = self.starts_one_by_one(0);
        let options =
            NewtonOptions { first: FIRST_AT_END, steps, speed, prove: true, one_by_one, ..self.options() };
        let Level { system, sheet, layout, x, .. } = level;
        let report = self.relax_uncrossed(system, sheet, layout, x, &options, progress)?;
        self.reports.push(report);
        self.restore_clearance(system, sheet, layout, x, &options, progress)
    }

    /// Whether level `k` is where cloths are laid down one by one: finer ones start from a pile.
    fn starts_one_by_one(&self, k: usize) -> bool {
        self.plan.is_stack && k + 1 == self.plan.pieces.len()
    }

    /// The pace of all but the end.
    pub(crate) fn options(&self) -> NewtonOptions {
        let (first, longest, farthest) = SPAN;
        let (steps, speed) = (self.plan.settings.coarse_steps, 2.0 * self.plan.settings.speed);
        NewtonOptions {
            first,
            longest,
            steps,
            speed,
            non_static: self.plan.settings.non_static,
            farthest,
            prove: false,
            long_proof: self.plan.settings.long_proof,
            rough: false,
            yields: self.plan.settings.sew_through,
            one_by_one: false,
            asleep: self.plan.settings.asleep,
            precision: self.plan.settings.precision,
        }
    }

    /// The pace of a state on the way from stiff to limp.
    pub(crate) fn continuation_options(&self) -> NewtonOptions {
        NewtonOptions {
            longest: LONGEST,
            steps: FORGET.0,
            speed: FORGET.1 * self.plan.settings.speed,
            ..self.options()
        }
    }
}
