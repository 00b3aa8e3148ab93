//! Bending hysteresis, by friction between yarns: cloth that was bent keeps a part of its
//! curvature.
//!
//! A measured moment is `B k` plus or minus a frictional couple (Grosberg 1966; half of Kawabata's
//! hysteresis 2HB). So the curvature of a strip at rest may differ from that of stiffness alone by
//! up to the couple over B. Method: each hinge is held near an angle by a potential like that of
//! friction on the body: a spring at small turns, whose moment approaches the couple at large ones.
//! The angle moves along while the cloth moves fast. The angle is the component of the fold along
//! the normal of the hinge. The rotation of the normal is left out of the derivatives, for a sheet
//! that hardly stretches curves only along its normal. Cost: a few operations a hinge.

use super::quadratic::{Fold, folds};
use crate::contact::coulomb::SLIP_RETURN;
use crate::energy::{Assembled, Cloth, Element, Projection, Subset, Vec3};
use crate::fabric::Rigidity;
use crate::mesh::{Edge, Side};
use nalgebra::{Matrix3, Vector2};
use rayon::prelude::*;

/// The turn at which friction is 0.7 of the couple, as a share of the couple over the rigidity.
/// Friction adds 1 / `SLIP_TOLERANCE` of its rigidity to the stiffness of a small fold.
const SLIP_TOLERANCE: f64 = 0.4;

/// Hinges per parallel task.
const TASK: usize = 4096;

/// The friction of one hinge.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Hold {
    fold: Fold,
    /// The greatest moment, N m.
    couple: f64,
    /// The turn at which the moment is 0.7 of the greatest one, rad.
    tolerance: f64,
}

/// Friction at every hinge of a sheet.
#[derive(Debug, Clone)]
pub struct Hysteresis {
    holds: Vec<Hold>,
    /// The angle of each hinge; empty before they are set.
    held: Vec<f64>,
}

impl Hysteresis {
    /// Of a cloth, without angles; `None` where no fabric has friction between its yarns.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>) -> Option<Assembled<4, Self>> {
        let sheet = cloth.sheet;
        if (0..sheet.triangles().len()).all(|t| !cloth.fabric_of(t).has_bending_friction()) {
            return None;
        }
        // The couple over the rigidity of the fabric of this side, across the edge, 1/m.
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
            Hold { fold, couple, tolerance: SLIP_TOLERANCE * fold.span * ratio }
        };
        let holds: Vec<Hold> =
            folds(cloth).into_iter().zip(sheet.edges().iter().filter_map(both)).map(hold).collect();
        (!holds.is_empty()).then(|| Assembled(Self { holds, held: Vec::new() }))
    }
}

impl Hold {
    /// The turn from the held angle in slip tolerances, and the root of one plus its square.
    fn turn(&self, angle: f64, held: f64) -> (f64, f64) {
        let turn = if self.tolerance > 0.0 { (angle - held) / self.tolerance } else { 0.0 };
        (turn, (1.0 + turn * turn).sqrt())
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
        hold.couple * hold.tolerance * (hold.turn(hold.angle(x), self.held[e]).1 - 1.0)
    }

    fn gradient(&self, e: usize, x: &[Vec3; 4]) -> [Vec3; 4] {
        let (hold, normal) = (&self.holds[e], normal(x));
        let (turn, root) = hold.turn(hold.fold.curvature(x).dot(&normal), self.held[e]);
        let moment = normal * (hold.couple * turn / root);
        hold.fold.weights.map(|w| moment * w)
    }

    fn state(&self, e: usize, x: &[Vec3; 4], _: Projection) -> Matrix3<f64> {
        let (hold, normal) = (&self.holds[e], normal(x));
        let root = hold.turn(hold.fold.curvature(x).dot(&normal), self.held[e]).1;
        let slope =
            if hold.tolerance > 0.0 { hold.couple / (hold.tolerance * root * root * root) } else { 0.0 };
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
            let most = SLIP_RETURN * h.tolerance;
            let turn = h.angle(&h.fold.nodes.map(|i| x[i as usize])) - *held;
            *held += turn - turn.clamp(-most, most);
        });
    }
}

#[cfg(test)]
mod tests;
