//! Panels are sewn, on the coarsest level.

use super::assemble::{assemble, spacing, strongest};
use super::graded::stages;
use super::newton::Pace;
use super::solve::{Progress, RestError};
use super::system::System;
use super::thread::Thread;
use super::work::Work;
use crate::mesh::Sheet;
use crate::scene::Seam;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Force of a seam per metre, as a share of stretch stiffness: the strain that sewing causes.
const SEAM_PULL: f64 = 0.01;

/// Factor by which a seam that stays open pulls harder, and how often.
const HARDER: (f64, usize) = (3.0, 4);

/// Steps of sewing, its first step of pseudo-time, s, and the least way that is the farthest of a step, m.
const SEWING: (usize, f64, f64) = (40, 0.02, 0.05);

/// Steps in which cloth without seams is pressed flat.
const PRESSING: usize = 10;

impl Work<'_> {
    /// Closes the seams on the coarsest level and joins them.
    pub(super) fn sew(&mut self, progress: &mut Progress<'_>) -> Result<(), RestError> {
        let coarsest = self.plan.pieces.len() - 1;
        let sheet = self.plan.pieces[coarsest].open_sheet(&self.plan.cloths)?;
        let mut x = self.plan.starts[coarsest].clone();
        let pairs = self.plan.pieces[coarsest].seam_pairs();
        let here = self.plan.rest.from_here;
        if here && widest(&x, &pairs) <= self.plan.rest.join_gap {
            self.joined_at = (!pairs.is_empty()).then(|| widest(&x, &pairs));
        } else if pairs.is_empty() {
            self.press(&sheet, &mut x, progress)?;
        } else {
            self.close(&sheet, &pairs, &mut x, progress)?;
        }
        self.x = self.plan.pieces[coarsest].sew(&x, sheet.masses());
        Ok(())
    }

    /// Closes the seams of cloth as stiff as its first state is to be, or else, each time from the start, as stiff as they close.
    fn close(
        &mut self,
        sheet: &Sheet,
        pairs: &[[u32; 2]],
        x: &mut [Vec3],
        progress: &mut Progress<'_>,
    ) -> Result<(), RestError> {
        let first = self.plan.grade(size(sheet)).map_or(1.0, |g| g.first());
        let mut force = 0.0;
        let start = x.to_vec();
        for stiff in std::iter::once(first).chain(stages(first, 1.0)) {
            // Cloth too stiff to go round the body has been squeezed out of its place: above the arms, off the shoulders.
            x.copy_from_slice(&start);
            force = self.pull(sheet, pairs, x, stiff, progress)?;
            if widest(x, pairs) <= self.plan.rest.join_gap {
                break;
            }
        }
        let gap = widest(x, pairs);
        self.joined_at = Some(gap);
        if gap > self.plan.rest.join_gap {
            let seam = self.widest_seam(self.plan.pieces.len() - 1, x);
            return Err(RestError::SeamNotClosed { seam, gap, force });
        }
        Ok(())
    }

    /// Pulls harder and harder until the seams are closed; the force a metre that it took.
    fn pull(
        &mut self,
        sheet: &Sheet,
        pairs: &[[u32; 2]],
        x: &mut [Vec3],
        stiff: f64,
        progress: &mut Progress<'_>,
    ) -> Result<f64, RestError> {
        let coarsest = self.plan.pieces.len() - 1;
        let spacing = spacing(&self.plan.pieces[coarsest], pairs);
        let mut pull = SEAM_PULL * strongest(&self.plan.cloths);
        for _ in 0..HARDER.1 {
            let gap = widest(x, pairs);
            if gap < self.plan.rest.join_gap {
                break;
            }
            let thread = |nodes: &[u32; 2]| Thread {
                nodes: *nodes,
                force: pull * spacing,
                soft: 2.0 * self.plan.rest.join_gap,
            };
            let mut system = self.open(sheet, stiff)?;
            system.threads = pairs.iter().map(thread).collect();
            let (steps, first, least) = SEWING;
            let farthest = (0.2 * gap).max(least);
            let pace =
                Pace { first, longest: 1.0, steps, speed: self.plan.rest.speed, farthest, ..self.pace() };
            let closed = |x: &[Vec3]| self.plan.rest.join_gap > widest(x, pairs);
            let report =
                self.run(&mut system, sheet, &self.plan.starts[coarsest], x, &pace, &closed, progress)?;
            self.reports.push(report);
            pull *= HARDER.0;
        }
        Ok(pull / HARDER.0)
    }

    /// Lets stiff cloth without seams forget its unevenness before it has weight.
    fn press(&mut self, sheet: &Sheet, x: &mut [Vec3], progress: &mut Progress<'_>) -> Result<(), RestError> {
        let Some(grade) = self.plan.grade(size(sheet)) else { return Ok(()) };
        let (_, first, farthest) = SEWING;
        let pace = Pace { first, longest: 1.0, steps: PRESSING, speed: 0.0, farthest, ..self.pace() };
        let layout = x.to_vec();
        let report =
            self.run(&mut self.open(sheet, grade.first())?, sheet, &layout, x, &pace, &|_| false, progress)?;
        self.reports.push(report);
        Ok(())
    }

    /// Weightless cloth before it is sewn, so many times stiffer.
    fn open<'b>(&'b self, sheet: &Sheet, stiff: f64) -> Result<System<'b>, RestError> {
        let mut system = assemble(
            self.plan.scene,
            self.plan.body,
            &self.plan.pieces[self.plan.pieces.len() - 1],
            sheet,
            true,
        )?;
        if self.plan.rest.graded {
            system.elastic.stiffen(stiff);
            system.support.iter_mut().for_each(|s| s.grows = true);
        }
        Ok(system)
    }

    /// The vertex of the scene that vertex `v` of level `k` is.
    pub(super) fn finest(&self, k: usize, v: u32) -> u32 {
        self.plan.coarser[..k].iter().rev().fold(v, |v, c| c.kept[v as usize])
    }

    /// The name of the seam that is open widest, with the vertices of level `k` at `x`.
    pub(super) fn widest_seam(&self, k: usize, x: &[Vec3]) -> String {
        let gap = |p: &[u32; 2]| (x[p[0] as usize] - x[p[1] as usize]).norm();
        let worst = self.plan.pieces[k].seam_pairs().into_iter().max_by(|a, b| gap(a).total_cmp(&gap(b)));
        let point = |v: u32| self.plan.pieces[0].point[v as usize];
        let at = worst.map(|p| point(self.finest(k, p[0])));
        let has = |s: &&Seam| s.pairs.iter().any(|p| Some(point(p[0])) == at);
        self.plan.scene.seams.iter().find(has).map_or("?", |s| &s.name).to_string()
    }
}

/// The root of a sheet's area, m.
pub(super) fn size(sheet: &Sheet) -> f64 {
    sheet.areas().iter().sum::<f64>().sqrt()
}

/// The widest gap of pairs of vertices, m.
pub(super) fn widest(x: &[Vec3], pairs: &[[u32; 2]]) -> f64 {
    pairs.iter().map(|p| (x[p[0] as usize] - x[p[1] as usize]).norm()).fold(0.0, f64::max)
}
