//! Friction between yarns, which holds folds: cloth bent and let go keeps part of its curvature.
//!
//! A measured moment is `B k` plus or minus a frictional couple (Grosberg 1966; half of Kawabata's hysteresis 2HB), so that a
//! strip's folds rest anywhere within that couple over B of where stiffness alone would put them. Here each hinge is held
//! near an angle by a potential like that of friction on the body (see `rub`): a spring where it has hardly turned, the
//! couple where it turns on; while the cloth moves fast the angle is dragged along. The angle is the fold's share along the
//! hinge's normal; that the normal turns with the sheet is left out of the derivatives, for a sheet that hardly stretches
//! curves along its normal alone.

use super::{Elastic, Hinge};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

type Vec3 = Vector3<f64>;

/// The curvature over which friction comes up, as a share of the couple over the rigidity: at this way it is 0.7 of the
/// couple, and a small fold is 1 / `SOFT` times stiffer on top of its rigidity.
const SOFT: f64 = 0.4;

/// How far behind an angle is dragged, in soft ways: friction is then half of its couple, as on the body.
const DRAG: f64 = 0.577;

/// Hinges of one task.
const TASK: usize = 4096;

/// Rounds of smoothing before the folds of a state are taken that a coarser mesh has handed on: they lie along its edges.
const ROUNDS: usize = 4;

/// What holds one hinge.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Hold {
    /// The greatest moment, N m.
    couple: f64,
    /// The angle over which it comes up, rad.
    soft: f64,
}

impl Hold {
    /// Of a hinge of that stiffness (N m), in which a curvature of 1/m makes an angle of `span` (m), by the frictional couple
    /// over the rigidity, 1/m.
    pub(super) fn new(stiffness: f64, span: f64, ratio: f64) -> Self {
        Self { couple: stiffness * span * ratio, soft: SOFT * span * ratio }
    }

    /// The way from the held angle in soft ways, and the root of one plus its square.
    fn way(&self, angle: f64, held: f64) -> (f64, f64) {
        let way = if self.soft > 0.0 { (angle - held) / self.soft } else { 0.0 };
        (way, (1.0 + way * way).sqrt())
    }
}

impl Hinge {
    /// The unit normal of its two triangles together; zero where they have none.
    fn normal(&self, x: &[Vec3]) -> Vec3 {
        let [a, b, c, d] = self.nodes.map(|i| x[i as usize]);
        let sum = (b - a).cross(&(c - a)) + (d - a).cross(&(b - a));
        sum.try_normalize(0.0).unwrap_or_else(Vec3::zeros)
    }

    fn fold(&self, x: &[Vec3]) -> f64 {
        self.curvature(x).dot(&self.normal(x))
    }
}

impl Elastic {
    /// Whether friction between yarns holds any fold.
    pub(in crate::rest) fn holds(&self) -> bool {
        !self.held.is_empty()
    }

    /// Holds all folds as they are at `x`. What a coarser mesh has `handed` on is smoothed first.
    pub(in crate::rest) fn hold(&mut self, x: &[Vec3], handed: bool) {
        if self.frictions.is_empty() {
            return;
        }
        let smooth = if handed { self.smoothed(x) } else { x.to_vec() };
        self.held = self.hinges.iter().map(|h| h.fold(&smooth)).collect();
    }

    /// The angles at which folds are held, hinge by hinge; empty where nothing is.
    pub(in crate::rest) fn held(&self) -> &[f64] {
        &self.held
    }

    /// Holds folds at these angles, if they are of as many hinges.
    pub(in crate::rest) fn hold_at(&mut self, held: &[f64]) {
        if held.len() == self.frictions.len() {
            self.held = held.to_vec();
        }
    }

    /// Drags the held angles along behind folds that turn.
    pub(in crate::rest) fn drag(&mut self, x: &[Vec3]) {
        let hinges = self.hinges.par_iter().zip(&self.frictions);
        self.held.par_iter_mut().zip(hinges).with_min_len(TASK).for_each(|(held, (h, hold))| {
            let most = DRAG * hold.soft;
            let way = h.fold(x) - *held;
            *held += way - way.clamp(-most, most);
        });
    }

    /// What friction holds, hinge by hinge.
    fn grasp(&self) -> impl IndexedParallelIterator<Item = (&Hinge, (&Hold, &f64))> {
        self.hinges.par_iter().zip(self.frictions.par_iter().zip(&self.held)).with_min_len(TASK)
    }

    /// The potential of the held folds, J.
    pub(in crate::rest) fn value_of_holds(&self, x: &[Vec3]) -> f64 {
        if !self.holds() {
            return 0.0;
        }
        let value = |(h, (hold, held)): (&Hinge, (&Hold, &f64))| {
            hold.couple * hold.soft * (hold.way(h.fold(x), *held).1 - 1.0)
        };
        let all: Vec<f64> = self.grasp().map(value).collect();
        // One after the other: the same bits for any number of threads.
        all.iter().sum()
    }

    /// Adds its derivative, N.
    pub(super) fn add_gradient_of_holds(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        if !self.holds() {
            return;
        }
        let moment = |(h, (hold, held)): (&Hinge, (&Hold, &f64))| {
            let normal = h.normal(x);
            let (way, root) = hold.way(h.curvature(x).dot(&normal), *held);
            normal * (hold.couple * way / root)
        };
        let moments: Vec<Vec3> = self.grasp().map(moment).collect();
        for (h, moment) in self.hinges.iter().zip(&moments) {
            h.nodes.iter().zip(&h.weights).for_each(|(&i, w)| gradient[i as usize] += moment * *w);
        }
    }

    /// The second derivative by the lifts of each hinge's nodes, N m; empty where nothing is held.
    pub(super) fn stiffness_of_holds(&self, x: &[Vec3]) -> Vec<Matrix3<f64>> {
        if !self.holds() {
            return Vec::new();
        }
        let stiffness = |(h, (hold, held)): (&Hinge, (&Hold, &f64))| {
            let normal = h.normal(x);
            let root = hold.way(h.curvature(x).dot(&normal), *held).1;
            let slope = if hold.soft > 0.0 { hold.couple / (hold.soft * root * root * root) } else { 0.0 };
            normal * normal.transpose() * slope
        };
        self.grasp().map(stiffness).collect()
    }

    /// Places drawn to the middle of their neighbours, but those on an open edge.
    fn smoothed(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut sides: Vec<[u32; 2]> = self.triangles.iter().flat_map(|t| sides(&t.nodes)).collect();
        sides.sort_unstable();
        let mut open = vec![false; x.len()];
        for run in sides.chunk_by(|a, b| a == b).filter(|run| run.len() == 1) {
            run[0].iter().for_each(|&i| open[i as usize] = true);
        }
        sides.dedup();
        let mut smooth = x.to_vec();
        for _ in 0..ROUNDS {
            let mut sums = vec![(Vec3::zeros(), 0.0); x.len()];
            for &[a, b] in &sides {
                for (i, j) in [(a as usize, b as usize), (b as usize, a as usize)] {
                    sums[i] = (sums[i].0 + smooth[j], sums[i].1 + 1.0);
                }
            }
            for (k, (sum, count)) in sums.into_iter().enumerate().filter(|(k, s)| !open[*k] && s.1 > 0.0) {
                smooth[k] = (smooth[k] + sum / count) * 0.5;
            }
        }
        smooth
    }
}

/// A triangle's sides, each with its lower node first.
fn sides(t: &[u32; 3]) -> [[u32; 2]; 3] {
    [0, 1, 2].map(|k| {
        let (a, b) = (t[k], t[(k + 1) % 3]);
        [a.min(b), a.max(b)]
    })
}

#[cfg(test)]
mod tests;
