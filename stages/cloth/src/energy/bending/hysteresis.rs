//! Friction between yarns, which holds folds (bending hysteresis): cloth bent and let go keeps part
//! of its curvature.
//!
//! A measured moment is `B k` plus or minus a frictional couple (Grosberg 1966; half of Kawabata's
//! hysteresis 2HB), so that a strip's folds rest anywhere within that couple over B of where
//! stiffness alone would put them. Here each hinge is held near an angle by a potential like that
//! of friction on the body: a spring where it has hardly turned, the couple where it turns on;
//! while the cloth moves fast the angle is dragged along. The angle is the fold's share along the
//! hinge's normal; that the normal turns with the sheet is left out of the derivatives, for a sheet
//! that hardly stretches curves along its normal alone.

use super::quadratic::{Fold, folds};
use crate::energy::{Assembled, Cloth, Element, Projection, Subset, Vec3};
use crate::fabric::Rigidity;
use crate::mesh::{Edge, Side};
use nalgebra::{Matrix3, Vector2};
use rayon::prelude::*;

/// The curvature over which friction comes up, as a share of the couple over the rigidity: at this
/// way it is 0.7 of the couple, and a small fold is 1 / `SOFT` times stiffer on top of its
/// rigidity.
const SLIP_TOLERANCE: f64 = 0.4;

/// How far behind an angle is dragged, in soft ways: friction is then half of its couple, as on the
/// body.
const SLIP_RETURN: f64 = 0.577;

/// Hinges of one task.
const TASK: usize = 4096;

/// What holds one hinge.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Hold {
    fold: Fold,
    /// The greatest moment, N m.
    couple: f64,
    /// The angle over which it comes up, rad.
    soft: f64,
}

/// Friction at every hinge of a sheet.
#[derive(Debug, Clone)]
pub struct Hysteresis {
    holds: Vec<Hold>,
    /// The angles at which it holds, as many; empty until it does.
    held: Vec<f64>,
}

impl Hysteresis {
    /// Of a cloth; nothing where no fabric has friction between its yarns. It holds nothing yet.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>) -> Option<Assembled<4, Self>> {
        let sheet = cloth.sheet;
        if (0..sheet.triangles().len()).all(|t| !cloth.fabric_of(t).has_bending_friction()) {
            return None;
        }
        // The couple over the rigidity of the side's cloth, across the edge, 1/m.
        let ratio = |side: &Side| {
            let (r, k) = (&sheet.rest()[side.triangle as usize], side.corner as usize);
            let e = (r[(k + 2) % 3] - r[(k + 1) % 3]).normalize();
            let fabric = cloth.fabric_of(side.triangle as usize);
            let along = |r: Rigidity| r.along(&Vector2::new(e.y, -e.x));
            let rigidity = along(Rigidity::of(fabric));
            if rigidity > 0.0 { along(fabric.bending_friction()) / rigidity } else { 0.0 }
        };
        let both = |e: &Edge| Some(0.5 * (ratio(&e.sides.0) + ratio(&e.sides.1?)));
        let hold = |(fold, ratio): (Fold, f64)| {
            let couple = fold.stiffness * fold.span * ratio;
            Hold { fold, couple, soft: SLIP_TOLERANCE * fold.span * ratio }
        };
        let holds: Vec<Hold> =
            folds(cloth).into_iter().zip(sheet.edges().iter().filter_map(both)).map(hold).collect();
        (!holds.is_empty()).then(|| Assembled(Self { holds, held: Vec::new() }))
    }
}

impl Hold {
    /// The way from the held angle in soft ways, and the root of one plus its square.
    fn way(&self, angle: f64, held: f64) -> (f64, f64) {
        let way = if self.soft > 0.0 { (angle - held) / self.soft } else { 0.0 };
        (way, (1.0 + way * way).sqrt())
    }

    fn angle(&self, x: &[Vec3; 4]) -> f64 {
        self.fold.curvature(x).dot(&normal(x))
    }
}

/// The unit normal of the two triangles together; zero where they have none.
fn normal([a, b, c, d]: &[Vec3; 4]) -> Vec3 {
    let sum = (b - a).cross(&(c - a)) + (d - a).cross(&(b - a));
    sum.try_normalize(0.0).unwrap_or_else(Vec3::zeros)
}

impl Element<4> for Hysteresis {
    /// The second derivative by the lifts of the hinge's nodes, N m.
    type State = Matrix3<f64>;

    fn name(&self) -> &'static str {
        "friction between yarns"
    }

    fn count(&self) -> usize {
        self.holds.len()
    }

    fn nodes(&self, e: usize) -> [u32; 4] {
        self.holds[e].fold.nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 4]) -> f64 {
        let hold = &self.holds[e];
        hold.couple * hold.soft * (hold.way(hold.angle(x), self.held[e]).1 - 1.0)
    }

    fn gradient(&self, e: usize, x: &[Vec3; 4]) -> [Vec3; 4] {
        let (hold, normal) = (&self.holds[e], normal(x));
        let (way, root) = hold.way(hold.fold.curvature(x).dot(&normal), self.held[e]);
        let moment = normal * (hold.couple * way / root);
        hold.fold.weights.map(|w| moment * w)
    }

    fn state(&self, e: usize, x: &[Vec3; 4], _: Projection) -> Matrix3<f64> {
        let (hold, normal) = (&self.holds[e], normal(x));
        let root = hold.way(hold.fold.curvature(x).dot(&normal), self.held[e]).1;
        let slope = if hold.soft > 0.0 { hold.couple / (hold.soft * root * root * root) } else { 0.0 };
        normal * normal.transpose() * slope
    }

    #[inline]
    fn add_block(&self, e: usize, state: &Matrix3<f64>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
        let weights = &self.holds[e].fold.weights;
        *sum += state * (weights[row] * weights[column]);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let hold = |&e: &usize| {
            let fold = &self.holds[e].fold;
            Hold { fold: Fold { nodes: subset.renumbered(fold.nodes), ..*fold }, ..self.holds[e] }
        };
        Self {
            holds: elements.iter().map(hold).collect(),
            held: elements.iter().filter_map(|&e| self.held.get(e)).copied().collect(),
        }
    }

    fn acts(&self) -> bool {
        !self.held.is_empty()
    }

    fn merge(&mut self, elements: &[usize], part: &Self) {
        if self.acts() {
            elements.iter().zip(&part.held).for_each(|(&e, new)| self.held[e] = *new);
        }
    }

    fn is_hysteretic(&self) -> bool {
        true
    }

    fn hold(&mut self, x: &[Vec3]) {
        self.held = self.holds.iter().map(|h| h.angle(&h.fold.nodes.map(|i| x[i as usize]))).collect();
    }

    fn held(&self) -> &[f64] {
        &self.held
    }

    fn hold_at(&mut self, held: &[f64]) {
        if held.len() == self.holds.len() {
            self.held = held.to_vec();
        }
    }

    fn drag(&mut self, x: &[Vec3]) {
        let holds = self.holds.par_iter();
        self.held.par_iter_mut().zip(holds).with_min_len(TASK).for_each(|(held, h)| {
            let most = SLIP_RETURN * h.soft;
            let way = h.angle(&h.fold.nodes.map(|i| x[i as usize])) - *held;
            *held += way - way.clamp(-most, most);
        });
    }
}

#[cfg(test)]
mod tests;
