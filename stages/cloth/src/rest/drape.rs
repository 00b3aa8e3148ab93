//! The sewn garment comes to rest, level by level and from stiff to limp.

use super::assemble::{assemble, gravity, kept_threads};
use super::graded::{Grade, Stillness, stages};
use super::newton::Pace;
use super::solve::{Draped, Progress, RestError, Work};
use super::system::System;
use crate::error::ClothError;
use crate::mesh::Sheet;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Steps for the first, stiffest state, and the speed at which it rests, m/s: it is what the start is forgotten in.
const FIRST: (usize, f64) = (200, 1e-4);

/// How far apart, in the mean, the first state may lie with friction and without, m: where it is farther, friction holds the
/// garment up.
const MOST_SLIP: f64 = 0.1;

/// First and longest step of pseudo-time, s, and the farthest way in a step, m.
const SPAN: (f64, f64, f64) = (0.05, 1.0, 0.1);

/// One level at work.
#[derive(Clone)]
struct Level<'s> {
    system: System<'s>,
    sheet: Sheet,
    /// Orders the elimination.
    layout: Vec<Vec3>,
    x: Vec<Vec3>,
    /// The friction taken away, if it was.
    friction: Option<Vec<f64>>,
}

impl Level<'_> {
    fn loosen(&mut self) {
        if self.friction.is_none() {
            let mut none = vec![0.0; self.x.len()];
            self.system.swap_friction(&mut none);
            self.friction = Some(none);
        }
    }

    fn tighten(&mut self) {
        if let Some(mut friction) = self.friction.take() {
            self.system.swap_friction(&mut friction);
        }
    }

    fn edge(&self) -> f64 {
        let lengths = self.sheet.edges().iter().map(|e| e.rest_length);
        lengths.sum::<f64>() / self.sheet.edges().len().max(1) as f64
    }
}

impl<'a> Work<'a> {
    /// Lets the sewn garment come to rest.
    pub(super) fn drape(mut self, progress: &mut Progress<'_>) -> Result<Draped, RestError> {
        let (mut stiff, mut loose) = (1.0, false);
        let mut slides = Vec::new();
        for k in (0..self.pieces.len()).rev() {
            let mut level = self.level(k, std::mem::take(&mut slides))?;
            let area = level.sheet.areas().iter().sum();
            if let Some(grade) = self.grade(area) {
                if k + 1 == self.pieces.len() {
                    (stiff, loose) = self.stiffest(&mut level, grade.first(), progress)?;
                }
                let end = if k == 0 { 1.0 } else { grade.resolved(level.edge()).min(stiff) };
                self.let_go(k, &mut level, stiff, end, loose, progress)?;
                stiff = end;
            } else if k > 0 {
                self.settle(&mut level, 1.0, self.pace(), progress)?;
            }
            if k == 0 {
                self.end(&mut level, progress)?;
            }
            if level.system.is_tangled() {
                let pairs = level.system.layers.as_ref().map_or(0, |l| l.tangles.len());
                return Ok(Draped::Tangled { nodes: level.x.len(), pairs, levels: self.pieces.len() });
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

    /// How bending is let go, if it is.
    fn grade(&self, area: f64) -> Option<Grade> {
        let gravity = gravity(self.scene).norm();
        self.rest.graded.then(|| Grade::of(&self.cloths, gravity, area)).flatten()
    }

    /// Level `k`, where the level before left the cloth.
    fn level(&mut self, k: usize, slides: Vec<Vec3>) -> Result<Level<'a>, RestError> {
        let pieces = &self.pieces[k];
        let sheet = pieces.sewn_sheet(&self.cloths)?;
        let layout = pieces.sew(&self.starts[k], &vec![1.0; self.starts[k].len()]);
        let mut system = assemble(self.scene, self.body, pieces, &sheet, false)?;
        system.threads = kept_threads(self.scene, pieces, self.rest.join_gap);
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

    /// Brings the coarsest level to a first, stiff state: how stiff, and whether without friction. A plate falls off a ball
    /// that a cloth stays on.
    fn stiffest(
        &mut self,
        level: &mut Level<'a>,
        first: f64,
        progress: &mut Progress<'_>,
    ) -> Result<(f64, bool), RestError> {
        for stiff in std::iter::once(first).chain(stages(first, 1.0)) {
            let mut free = level.clone();
            free.loosen();
            let pace = Pace { steps: FIRST.0, speed: FIRST.1, ..self.pace() };
            let is_free = self.rests(&mut free, stiff, pace, progress)?;
            free.tighten();
            let mut held = level.clone();
            let is_held =
                free.system.rubs_nowhere() || self.rests(&mut held, stiff, self.pace(), progress)?;
            let loose = is_free && (free.system.rubs_nowhere() || apart(&held.x, &free.x) < MOST_SLIP);
            if loose || is_held {
                *level = if loose { free } else { held };
                return Ok((stiff, loose));
            }
        }
        Ok((1.0, false))
    }

    /// Whether the level comes to rest, so stiff, and does not fall.
    fn rests(
        &mut self,
        level: &mut Level<'a>,
        stiff: f64,
        pace: Pace,
        progress: &mut Progress<'_>,
    ) -> Result<bool, RestError> {
        match self.settle(level, stiff, pace, progress) {
            // What still moves after so many steps slides.
            Ok(()) => Ok(self.reports.last().is_some_and(|r| r.outcome.steps < pace.steps)),
            Err(RestError::Falls) => Ok(false),
            Err(e) => Err(e),
        }
    }

    /// Lets the bending of level `k` go from one factor to another.
    fn let_go(
        &mut self,
        k: usize,
        level: &mut Level<'a>,
        from: f64,
        to: f64,
        loose: bool,
        progress: &mut Progress<'_>,
    ) -> Result<(), RestError> {
        if loose && k > 0 {
            level.loosen();
        }
        let mut stages = stages(from, to);
        if k == 0 {
            // The last stage of the finest level is its end.
            stages.pop();
        } else if stages.is_empty() {
            stages.push(to);
        }
        for stage in stages {
            self.settle(level, stage, self.pace(), progress)?;
        }
        level.tighten();
        Ok(())
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
        let still = Stillness::default();
        let done = |x: &[Vec3]| self.rest.graded && still.sees(x);
        let run =
            self.run(&mut level.system, &level.sheet, &level.layout, &mut level.x, &pace, &done, progress);
        level.system.elastic.stiffen(1.0 / stiff);
        self.reports.push(run?);
        Ok(())
    }

    /// Brings the finest level to rest, and proves it.
    fn end(&mut self, level: &mut Level<'a>, progress: &mut Progress<'_>) -> Result<(), RestError> {
        let pace = Pace { steps: self.rest.finest_steps, speed: self.rest.speed, prove: true, ..self.pace() };
        let Level { system, sheet, layout, x, .. } = level;
        let report = self.run(system, sheet, layout, x, &pace, &|_| false, progress)?;
        self.reports.push(report);
        self.clear(system, sheet, layout, x, &pace, progress)
    }

    /// The pace of all but the end.
    fn pace(&self) -> Pace {
        let (first, longest, farthest) = SPAN;
        let (steps, speed) = (self.rest.coarse_steps, 2.0 * self.rest.speed);
        Pace { first, longest, steps, speed, farthest, prove: false }
    }

    /// Values at the nodes of level `k` carried to those of the next finer one.
    fn finer(&self, k: usize, values: &[Vec3]) -> Vec<Vec3> {
        let fine = self.coarser[k - 1].prolong(&self.pieces[k].spread(values));
        self.pieces[k - 1].sew(&fine, &vec![1.0; fine.len()])
    }
}

/// Mean distance of two states of the same nodes, m.
fn apart(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).sum::<f64>() / a.len().max(1) as f64
}
