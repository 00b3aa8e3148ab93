//! How far to go along a direction.
//!
//! First the length at which some triangle would lose its area (the least positive root of a
//! quadratic each, Smith and Schaefer 2015); from nine tenths of it, at most 1, the length is
//! halved until the energy has fallen by a share of what the slope promises.

use super::NewtonProblem;
use super::assembly::energy_at;
use nalgebra::{Point2, Vector2};
use rayon::prelude::*;

/// The share of the way to the first flip that is gone at most.
const SHORT_OF_FLIP: f64 = 0.9;

/// The share of the promised fall that is asked for (Armijo).
const ENOUGH: f64 = 1e-4;

/// Halvings before the search gives up: the direction no longer helps in the digits at hand.
const MOST_HALVINGS: usize = 40;

/// What a step is measured against.
pub(super) struct StepTrial<'a, 'b> {
    pub(super) problem: &'a NewtonProblem<'b>,
    /// Energy at the start.
    pub(super) energy: f64,
    /// Rate of change of energy and penalty, negative.
    pub(super) slope: f64,
    /// Weight of the constraints' violation.
    pub(super) penalty: f64,
}

impl StepTrial<'_, '_> {
    /// The length to go, or none if no length helps.
    pub(super) fn search(&self, q: &[Point2<f64>], direction: &[Vector2<f64>]) -> Option<f64> {
        let falls = self.slope < 0.0;
        if !falls {
            return None;
        }
        let start = self.energy + self.violation(q);
        let mut length = (SHORT_OF_FLIP * self.first_flip(q, direction)).min(1.0);
        for _ in 0..MOST_HALVINGS {
            let moved: Vec<_> = q.iter().zip(direction).map(|(p, d)| p + d * length).collect();
            let merit = energy_at(self.problem, &moved) + self.violation(&moved);
            // Equal energies are a success where the promise is below their rounding.
            let rounding = 1e-15 * start.abs();
            if merit <= start + ENOUGH * length * self.slope + rounding {
                return Some(length);
            }
            length /= 2.0;
        }
        None
    }

    fn violation(&self, q: &[Point2<f64>]) -> f64 {
        self.penalty * self.problem.constraints.iter().map(|c| c.value(q).abs()).sum::<f64>()
    }

    /// The least length at which a triangle has no area; infinite if there is none.
    fn first_flip(&self, q: &[Point2<f64>], d: &[Vector2<f64>]) -> f64 {
        let flip = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a as usize, b as usize, c as usize];
            let (u, v, du, dv) = (q[b] - q[a], q[c] - q[a], d[b] - d[a], d[c] - d[a]);
            least_root(du.perp(&dv), u.perp(&dv) + du.perp(&v), u.perp(&v))
        };
        self.problem.system.triangles().par_iter().map(flip).reduce(|| f64::INFINITY, f64::min)
    }
}

/// The least positive root of `a x^2 + b x + c` for c > 0, or infinity.
fn least_root(a: f64, b: f64, c: f64) -> f64 {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 || discriminant.is_nan() {
        return f64::INFINITY;
    }
    // The form that does not cancel: with c > 0 the roots are 2c / (-b +- root).
    let root = discriminant.sqrt();
    let largest = (-b + root).max(-b - root);
    if largest > 0.0 { 2.0 * c / largest } else { f64::INFINITY }
}
