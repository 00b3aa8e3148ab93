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
            let is_handed = k + 1 < plan.pieces.len() || plan.rest.from_here;
            level.begin(std::mem::take(&mut self.x), slides, is_handed);
            if plan.rest.from_here && !plan.scene.held.is_empty() {
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
                if !self.free(k, &mut level, progress)? && !plan.rest.sew_through {
                    return Ok(false);
                }
                self.bring(k, &mut level, &mut bending, progress).map(|()| true)
            })?;
            if !is_free {
                return Ok(Draped::TooCoarse { finer: plan.pieces[k].points });
            }
            // What was sewn through itself may come free on a finer mesh; nothing is gained by
            // sewing it there anew.
            if level.system.is_tangled() && (k == 0 || !plan.rest.sew_through) {
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
            slides = plan.finer(k, &level.system.held_back(&level.x));
            self.x = plan.finer(k, &level.x);
        }
        Err(ClothError::EmptyScene.into())
    }

    /// Lets level `k` come out over sharp edges and corners of the body that its coarser mesh came
    /// to lie on both sides of; whether it has. From its own start no mesh comes to cross one.
    fn free(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        if k + 1 == self.plan.pieces.len() || !level.system.is_pierced(&level.x) {
            return Ok(true);
        }
        self.settle(level, 1.0, NewtonOptions { steps: FREEING, ..self.pace() }, progress)?;
        Ok(!level.system.is_pierced(&level.x))
    }

    /// Brings level `k` near rest, the finest one to rest. `bending` is how many times stiffer it
    /// was left by the level before, and whether without friction.
    fn bring(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        bending: &mut (f64, bool),
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        let (stiff, loose) = *bending;
        if let Some(grade) = self.plan.grade(level.size()) {
            let end = if k == 0 { 1.0 } else { grade.resolved(level.edge()) };
            *bending = if k + 1 == self.plan.pieces.len() {
                self.forget(k, level, grade.first(), end, progress)?
            } else {
                (self.carry_on(k, level, [stiff, end.min(stiff)], loose, progress)?, loose)
            };
        } else if k > 0 {
            let pace = NewtonOptions { one_by_one: self.begins_with_pile(k), ..self.pace() };
            self.settle(level, 1.0, pace, progress)?;
        }
        if k == 0 { self.end(level, progress) } else { Ok(()) }
    }

    /// Brings a finer level from one stiffness to another, without friction if it stays; the
    /// stiffness reached.
    fn carry_on(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        way: [f64; 2],
        loose: bool,
        progress: &mut Progress<'_>,
    ) -> Result<f64, StaticsError> {
        let mut free = level.clone();
        if loose {
            free.disable_friction();
        }
        if self.continue_to(k, &mut free, way, progress)? {
            *level = free;
        } else if loose {
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
            if !self.stays(level, stage, self.forgetful(), progress)? {
                return Ok(false);
            }
        }
        if level.enable_friction() && k > 0 {
            self.settle(level, to, self.forgetful(), progress)?;
        }
        Ok(true)
    }

    /// Brings a level near rest; whether it stays on the body. With friction only a fall past the
    /// body says that it does not.
    pub(crate) fn stays(
        &mut self,
        level: &mut Level<'a>,
        stiff: f64,
        pace: NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<bool, StaticsError> {
        match self.settle(level, stiff, pace, progress) {
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
        pace: NewtonOptions,
        progress: &mut Progress<'_>,
    ) -> Result<(), StaticsError> {
        level.system.elastic.scale_bending(stiff);
        let offsets =
            level.system.support.as_mut().filter(|_| self.plan.rest.bending_continuation).map(|s| {
                s.grows = true;
                s.offsets.clone()
            });
        let Level { system, sheet, layout, x, .. } = &mut *level;
        let run = self.run_free(system, sheet, layout, x, &pace, progress);
        if let (Some(s), Some(offsets)) = (&mut level.system.support, offsets) {
            (s.grows, s.offsets) = (false, offsets);
        }
        level.system.elastic.scale_bending(1.0 / stiff);
        self.reports.push(run?);
        Ok(())
    }

    /// Brings the finest level to rest, and proves it.
    fn end(&mut self, level: &mut Level<'a>, progress: &mut Progress<'_>) -> Result<(), StaticsError> {
        let (steps, speed) = (self.plan.rest.finest_steps, self.plan.rest.speed);
        let one_by_one = self.begins_with_pile(0);
        let pace =
            NewtonOptions { first: FIRST_AT_END, steps, speed, prove: true, one_by_one, ..self.pace() };
        let Level { system, sheet, layout, x, .. } = level;
        let report = self.run_free(system, sheet, layout, x, &pace, progress)?;
        self.reports.push(report);
        self.clear(system, sheet, layout, x, &pace, progress)
    }

    /// Whether level `k` is where cloths are laid down one by one: finer ones start from a pile.
    fn begins_with_pile(&self, k: usize) -> bool {
        self.plan.is_pile && k + 1 == self.plan.pieces.len()
    }

    /// The pace of all but the end.
    pub(crate) fn pace(&self) -> NewtonOptions {
        let (first, longest, farthest) = SPAN;
        let (steps, speed) = (self.plan.rest.coarse_steps, 2.0 * self.plan.rest.speed);
        NewtonOptions {
            first,
            longest,
            steps,
            speed,
            non_static: self.plan.rest.non_static,
            farthest,
            prove: false,
            long_proof: self.plan.rest.long_proof,
            rough: false,
            yields: self.plan.rest.sew_through,
            one_by_one: false,
            asleep: self.plan.rest.asleep,
            precision: self.plan.rest.precision,
        }
    }

    /// The pace of a state on the way from stiff to limp.
    pub(crate) fn forgetful(&self) -> NewtonOptions {
        NewtonOptions {
            longest: LONGEST,
            steps: FORGET.0,
            speed: FORGET.1 * self.plan.rest.speed,
            ..self.pace()
        }
    }
}
