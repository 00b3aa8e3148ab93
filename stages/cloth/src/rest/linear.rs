//! The linear problem of each Newton step: matrix, factor and solution, kept from step to step.

use super::mixed::{Matrix, Mixed};
use super::multifrontal::{Halt, Stop, Symbolic};
use super::pattern::Pattern;
use super::real::Precision;
use super::system::System;
use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// Share of compression that the matrix has near rest, if it is positive definite with it. All of it is the true second
/// derivative, which few limp states can factor; none of it makes folds that are about to form far too stiff.
const COMPRESSION: f64 = 0.7;

/// Steps below this are near rest; before, the matrix without compression converges sooner, m.
const NEAR_REST: f64 = 2e-3;

/// Inertia beyond which a matrix that is not positive definite has lost its numbers, 1/s².
const MOST_INERTIA: f64 = 1e12;

/// The matrix and its factor.
pub(super) struct Linear {
    layout: Vec<Vec3>,
    pattern: Pattern,
    symbolic: Symbolic,
    values: Vec<Matrix3<f64>>,
    factor: Mixed,
}

impl Linear {
    /// Prepares the matrix; `layout` orders the elimination.
    pub(super) fn new(system: &mut System<'_>, layout: Vec<Vec3>) -> Self {
        let pattern = system.pattern();
        system.elastic.bind(&pattern);
        let symbolic = Symbolic::new(&pattern, &layout);
        Self { layout, pattern, symbolic, values: Vec::new(), factor: Mixed::default() }
    }

    /// What orders the elimination.
    pub(super) fn layout(&self) -> &[Vec3] {
        &self.layout
    }

    /// Follows the contacts: new pairs need new places in the matrix. Whether any did.
    pub(super) fn follow(&mut self, system: &mut System<'_>) -> bool {
        let known = system.layers.iter().flat_map(|l| l.groups()).all(|nodes| self.pattern.couples(nodes));
        if !known {
            *self = Self::new(system, std::mem::take(&mut self.layout));
        }
        !known
    }

    /// Takes up elements whose stiffness has changed.
    pub(super) fn bind(&self, system: &mut System<'_>) {
        system.elastic.bind(&self.pattern);
    }

    /// The step of pseudo-time `dt` from `x`, the last step having moved nodes by up to `last`.
    pub(super) fn step(
        &mut self,
        system: &System<'_>,
        x: &[Vec3],
        g: &[Vec3],
        [dt, last]: [f64; 2],
        precision: Precision,
        stop: &Stop,
    ) -> Result<Vec<Vec3>, Halt> {
        let mut shift = 1.0 / (dt * dt);
        let mut compression = if last < NEAR_REST { COMPRESSION } else { 0.0 };
        let right: Vec<Vec3> = g.iter().map(|g| -g).collect();
        loop {
            system.matrix(x, &self.pattern, shift, compression, &mut self.values);
            let matrix = Matrix { pattern: &self.pattern, symbolic: &self.symbolic, values: &self.values };
            match self.factor.solve(matrix, &right, precision, compression > 0.0, stop) {
                Ok(moves) => return Ok(moves),
                Err(Halt::NotPositive(_)) if compression > 0.0 => compression = 0.0,
                // Rounding can cost a nearly singular matrix its sign; more inertia gives it back.
                Err(Halt::NotPositive(_)) if shift <= MOST_INERTIA => shift *= 100.0,
                Err(halt) => return Err(halt),
            }
        }
    }

    /// The step from a place so near that of the last one that its factor will do.
    pub(super) fn again(&self, g: &[Vec3]) -> Vec<Vec3> {
        let mut step: Vec<Vec3> = g.iter().map(|g| -g).collect();
        self.factor.again(&self.symbolic, &mut step);
        step
    }
}
