//! The linear problem of each Newton step: matrix, factor and solution, kept from step to step.

use super::multifrontal::{Factor, Halt, Stop, Symbolic};
use super::pattern::Pattern;
use super::system::System;
use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// Steps below this are asked of the true second derivative: near rest it converges fast, far from it the one without
/// compression does, m.
const EXACT_BELOW: f64 = 2e-3;

/// Inertia beyond which a matrix that is not positive definite has lost its numbers, 1/s².
const MOST_INERTIA: f64 = 1e12;

/// The matrix and its factor.
pub(super) struct Linear<'a> {
    layout: &'a [Vec3],
    pattern: Pattern,
    symbolic: Symbolic,
    values: Vec<Matrix3<f64>>,
    factor: Factor,
}

impl<'a> Linear<'a> {
    /// Prepares the matrix; `layout` orders the elimination.
    pub(super) fn new(system: &mut System<'_>, layout: &'a [Vec3]) -> Self {
        let pattern = system.pattern();
        system.elastic.bind(&pattern);
        let symbolic = Symbolic::new(&pattern, layout);
        Self { layout, pattern, symbolic, values: Vec::new(), factor: Factor::default() }
    }

    /// Follows the contacts: new pairs need new places in the matrix.
    pub(super) fn follow(&mut self, system: &mut System<'_>) {
        let known = system.layers.iter().flat_map(|l| l.groups()).all(|nodes| self.pattern.couples(nodes));
        if !known {
            *self = Self::new(system, self.layout);
        }
    }

    /// The step of pseudo-time `dt` from `x`, the last step having moved nodes by up to `last`.
    pub(super) fn step(
        &mut self,
        system: &System<'_>,
        x: &[Vec3],
        g: &[Vec3],
        dt: f64,
        last: f64,
        stop: &Stop,
    ) -> Result<Vec<Vec3>, Halt> {
        let mut shift = 1.0 / (dt * dt);
        let mut compression = last < EXACT_BELOW;
        loop {
            system.matrix(x, &self.pattern, shift, compression, &mut self.values);
            match self.symbolic.factor(&self.values, &mut self.factor, stop) {
                Ok(()) => break,
                Err(Halt::NotPositive(_)) if compression => compression = false,
                // Rounding can cost a nearly singular matrix its sign; more inertia gives it back.
                Err(Halt::NotPositive(_)) if shift <= MOST_INERTIA => shift *= 100.0,
                Err(halt) => return Err(halt),
            }
        }
        let mut step: Vec<Vec3> = g.iter().map(|g| -g).collect();
        self.symbolic.solve(&self.factor, &mut step);
        Ok(step)
    }
}
