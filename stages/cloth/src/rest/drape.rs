//! The sewn garment comes to rest, level by level and from stiff to limp.

use super::assemble::{assemble, gravity, kept_threads};
use super::graded::{Grade, stages};
use super::level::Level;
use super::newton::Pace;
use super::solve::{Draped, Progress, RestError, Work};
use crate::error::ClothError;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Steps of a state on the way from stiff to limp, and the speed at which it rests, as a share of that of the end: so near
/// rest, the state forgets where it began.
const FORGET: (usize, f64) = (60, 0.05);

/// How far the middle of a garment without friction may move from where it was placed, as a share of its size; else it slides
/// off.
const MOST_FALL: f64 = 0.1;

/// First and longest step of pseudo-time, s, and the farthest way in a step, m.
const SPAN: (f64, f64, f64) = (0.05, 1.0, 0.1);

/// First step of pseudo-time on the finest mesh, s: what a coarser one leaves has little speed.
const FIRST_AT_END: f64 = 0.15;

/// The longest step on the way from stiff to limp, s: what slides without friction takes its time.
const LONGEST: f64 = 10.0;

impl<'a> Work<'a> {
    /// Lets the sewn garment come to rest.
    pub(super) fn drape(mut self, progress: &mut Progress<'_>) -> Result<Draped, RestError> {
        let (mut stiff, mut loose) = (1.0, false);
        let mut slides = Vec::new();
        for k in (0..self.pieces.len()).rev() {
            let mut level = self.level(k, std::mem::take(&mut slides))?;
            if let Some(grade) = self.grade(level.size()) {
                let end = if k == 0 { 1.0 } else { grade.resolved(level.edge()) };
                if k + 1 == self.pieces.len() {
                    (stiff, loose) = self.forget(k, &mut level, grade.first(), end, progress)?;
                } else {
                    stiff = self.carry_on(k, &mut level, [stiff, end.min(stiff)], loose, progress)?;
                }
            } else if k > 0 {
                let pace = Pace { one_by_one: self.begins_with_pile(k), ..self.pace() };
                self.settle(&mut level, 1.0, pace, progress)?;
            }
            if k == 0 {
                self.end(&mut level, progress)?;
            }
            if level.system.is_tangled() {
                let pairs = level.system.layers.as_ref().map_or(0, |l| l.tangles.len());
                return Ok(Draped::Tangled { nodes: level.x.len(), pairs });
            }
            if let Some(pierced) = self.pierced(k, &level.sheet, &level.x) {
                return Ok(pierced);
            }
            if k == 0 {
                self.check_kept(&level.x)?;
                self.check_strain(&level.system, &level.x)?;
                return Ok(Draped::Rested(Box::new(self.finish(level.system, &level.sheet, level.x)?)));
            }
            slides = self.finer(k, &level.system.held_back(&level.x));
            self.x = self.finer(k, &level.x);
        }
        Err(ClothError::EmptyScene.into())
    }

    /// How bending is let go in a garment of that size, if it is.
    pub(super) fn grade(&self, size: f64) -> Option<Grade> {
        let gravity = gravity(self.scene).norm();
        self.rest.graded.then(|| Grade::of(&self.cloths, gravity, size)).flatten()
    }

    /// Level `k`, where the level before left the cloth.
    fn level(&mut self, k: usize, slides: Vec<Vec3>) -> Result<Level<'a>, RestError> {
        let pieces = &self.pieces[k];
        let sheet = pieces.sewn_sheet(&self.cloths)?;
        let layout = pieces.sew(&self.starts[k], &vec![1.0; self.starts[k].len()]);
        let mut system = assemble(self.scene, self.body, pieces, &sheet, false)?;
        system.threads = kept_threads(self.scene, pieces, self.rest.join_gap);
        system.layers.iter_mut().for_each(|l| l.crowded = self.is_pile);
        if let (true, true, Some(s)) = (self.rest.graded, k > 0, &mut system.support) {
            // Offsets that grow with the edges of a passing state would shake the cloth, and with it the choice of folds.
            s.edges.clear();
        }
        let x = std::mem::take(&mut self.x);
        if slides.len() == x.len() {
            system.slides = slides;
        }
        Ok(Level { system, sheet, layout, x, friction: None })
    }

    /// Brings a finer level from one stiffness to another, without friction if it stays; the stiffness reached.
    fn carry_on(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        way: [f64; 2],
        loose: bool,
        progress: &mut Progress<'_>,
    ) -> Result<f64, RestError> {
        let mut free = level.clone();
        if loose {
            free.loosen();
        }
        if self.let_go(k, &mut free, way, progress)? {
            *level = free;
        } else if loose {
            self.let_go(k, level, way, progress)?;
        }
        Ok(way[1])
    }

    /// Lets the bending of level `k` go from one factor to another, and gives friction back; whether the garment stays.
    pub(super) fn let_go(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        [from, to]: [f64; 2],
        progress: &mut Progress<'_>,
    ) -> Result<bool, RestError> {
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
        if level.tighten() && k > 0 {
            self.settle(level, to, self.forgetful(), progress)?;
        }
        Ok(true)
    }

    /// Brings a level near rest; whether it stays on the body. With friction only a free fall says that it does not.
    pub(super) fn stays(
        &mut self,
        level: &mut Level<'a>,
        stiff: f64,
        pace: Pace,
        progress: &mut Progress<'_>,
    ) -> Result<bool, RestError> {
        match self.settle(level, stiff, pace, progress) {
            Ok(()) if level.friction.is_some() => Ok(level.moved() < MOST_FALL * level.size()),
            Ok(()) => Ok(true),
            Err(RestError::Falls) => Ok(false),
            Err(e) => Err(e),
        }
    }

    /// Brings a level near rest with bending so many times stiffer.
    fn settle(
        &mut self,
        level: &mut Level<'a>,
        stiff: f64,
        pace: Pace,
        progress: &mut Progress<'_>,
    ) -> Result<(), RestError> {
        level.system.elastic.stiffen(stiff);
        let offsets = level.system.support.as_mut().filter(|_| self.rest.graded).map(|s| {
            s.grows = true;
            s.offsets.clone()
        });
        let run = self.run(
            &mut level.system,
            &level.sheet,
            &level.layout,
            &mut level.x,
            &pace,
            &|_| false,
            progress,
        );
        if let (Some(s), Some(offsets)) = (&mut level.system.support, offsets) {
            (s.grows, s.offsets) = (false, offsets);
        }
        level.system.elastic.stiffen(1.0 / stiff);
        self.reports.push(run?);
        Ok(())
    }

    /// Brings the finest level to rest, and proves it.
    fn end(&mut self, level: &mut Level<'a>, progress: &mut Progress<'_>) -> Result<(), RestError> {
        let (steps, speed) = (self.rest.finest_steps, self.rest.speed);
        let one_by_one = self.begins_with_pile(0);
        let pace = Pace { first: FIRST_AT_END, steps, speed, prove: true, one_by_one, ..self.pace() };
        let Level { system, sheet, layout, x, .. } = level;
        let report = self.run(system, sheet, layout, x, &pace, &|_| false, progress)?;
        self.reports.push(report);
        self.clear(system, sheet, layout, x, &pace, progress)
    }

    /// Whether level `k` is where cloths are laid down one by one: finer ones start from a pile.
    fn begins_with_pile(&self, k: usize) -> bool {
        self.is_pile && k + 1 == self.pieces.len()
    }

    /// The pace of all but the end.
    pub(super) fn pace(&self) -> Pace {
        let (first, longest, farthest) = SPAN;
        let (steps, speed) = (self.rest.coarse_steps, 2.0 * self.rest.speed);
        Pace {
            first,
            longest,
            steps,
            speed,
            farthest,
            prove: false,
            one_by_one: false,
            precision: self.rest.precision,
        }
    }

    /// The pace of a state on the way from stiff to limp.
    pub(super) fn forgetful(&self) -> Pace {
        Pace { longest: LONGEST, steps: FORGET.0, speed: FORGET.1 * self.rest.speed, ..self.pace() }
    }

    /// Values at the nodes of level `k` carried to those of the next finer one.
    fn finer(&self, k: usize, values: &[Vec3]) -> Vec<Vec3> {
        let fine = self.coarser[k - 1].prolong(&self.pieces[k].spread(values));
        self.pieces[k - 1].sew(&fine, &vec![1.0; fine.len()])
    }
}
