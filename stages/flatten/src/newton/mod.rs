//! Newton's method for the flat places of a surface's vertices.
//!
//! Minimises `sum_t share_t e(J_t) + terms` under a few constraints `c(q) = 0`. Each iteration
//! solves `H d = -g - C^T m`, `C d = -c` with one sparse Cholesky factor of H (the symbolic part
//! made once) and, for k constraints, k more solutions; it shortens the step so that no triangle
//! flips (Smith and Schaefer 2015) and halves it until the energy, or with constraints the energy
//! plus a multiple of their violation, falls enough (Armijo). Far from a minimum the second
//! derivatives are projected (no negative eigenvalues), near it they are taken as they are. It
//! stops when the energy that one more step would save, half of `-g.d`, is below the tolerance.
//! Cost: for n vertices about n^1.5 products an iteration; four to ten iterations from a start
//! without flips near the minimum.

mod assembly;
mod constraint;
mod line_search;
mod term;
#[cfg(test)]
mod tests;

pub(crate) use constraint::Constraint;
pub(crate) use constraint::chain_length;
pub(crate) use term::QuadraticTerm;

use crate::energy::{EnergyDensity, Hessian};
use crate::error::FlattenError;
use crate::frames::TriangleFrames;
use crate::linear::CholeskyFactor;
use crate::system::PieceSystem;
use assembly::Assembly;
use line_search::StepTrial;
use nalgebra::{DMatrix, DVector, Point2, Vector2};

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoppingLimits {
    /// Most iterations, 0 or more.
    pub iterations: usize,
    /// The energy by area (0.0002 is about a strain of one per cent everywhere) that one more step
    /// may still save; above 0.
    pub tolerance: f64,
}

impl Default for StoppingLimits {
    fn default() -> Self {
        Self { iterations: 100, tolerance: 1e-9 }
    }
}

impl StoppingLimits {
    pub(crate) fn check(self) -> Result<Self, FlattenError> {
        if self.tolerance > 0.0 && self.tolerance.is_finite() {
            return Ok(self);
        }
        let range = "a finite number above 0";
        Err(FlattenError::InvalidParameter { name: "tolerance", value: self.tolerance, range })
    }
}

/// What the method did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonOutcome {
    /// Steps made.
    pub iterations: usize,
    /// The energy by area at the end.
    pub energy: f64,
    /// The energy that one more step would save.
    pub remaining: f64,
    /// Whether that is below the tolerance, with all constraints met.
    pub converged: bool,
}

/// Where a step would save less than this share of the energy, second derivatives are taken as they
/// are.
const NEAR: f64 = 0.1;

/// Where their sum was not positive, the next try waits until a step saves this much less.
const NEARER: f64 = 0.01;

/// Shift of the diagonal of a matrix that has no factor because of rounding (Levenberg 1944):
/// [`LEAST_SHIFT`] times its largest entry first, then each time larger by a factor, a limited
/// number of times.
const LEAST_SHIFT: f64 = 1e-14;
const SHIFT_GROWTH: f64 = 30.0;
const MOST_SHIFTS: usize = 6;

/// A violation of a constraint (a share of the length that it is about) below this counts as met.
const MET: f64 = 1e-7;

/// Weight of the identity by area that keeps rigid motions from making the matrix singular; it is
/// less than a ten-thousandth of the stiffness of the softest deformation, and does not move the
/// minimum.
const RIGID: f64 = 1e-4;

/// What is minimised.
pub(crate) struct NewtonProblem<'a> {
    /// The surface.
    pub system: &'a PieceSystem,
    /// Its triangles in their planes.
    pub frames: &'a TriangleFrames,
    /// The energy of the triangles.
    pub energy: &'a dyn EnergyDensity,
    /// Quadratic terms, their vertices coupled in the system's graph.
    pub terms: &'a [QuadraticTerm],
    /// Constraints, few of them.
    pub constraints: &'a [Constraint],
}

impl NewtonProblem<'_> {
    /// The energy at `q`; infinite if a triangle is flipped.
    #[must_use]
    pub(crate) fn energy_at(&self, q: &[Point2<f64>]) -> f64 {
        assembly::energy_at(self, q)
    }

    /// Moves `q` (units of [`TriangleFrames::unit`], no triangle flipped) to a minimum.
    ///
    /// # Errors
    /// [`FlattenError::InvalidParameter`] for options, [`FlattenError::Factorization`] if a system
    /// has no factor.
    pub(crate) fn minimise(
        &self,
        q: &mut [Point2<f64>],
        options: StoppingLimits,
    ) -> Result<NewtonOutcome, FlattenError> {
        let options = options.check()?;
        let mut assembly = Assembly::new(self);
        let mut factor = CholeskyFactor::analyse(self.system.graph(), 2, self.system.order())?;
        let mut penalty = 0.0;
        let mut iterations = 0;
        let (mut near_minimum, mut near_share) = (false, NEAR);
        loop {
            let (energy, exact) = self.factor(&mut assembly, &mut factor, q, near_minimum)?;
            if near_minimum && !exact {
                near_share *= NEARER;
            }
            let step = self.step(&factor, assembly.gradient(), q, &mut penalty)?;
            near_minimum = step.remaining <= near_share * energy;
            let near = step.remaining <= options.tolerance && step.violation <= MET;
            let done = near || iterations == options.iterations;
            if done && !near {
                return Ok(report(iterations, energy, &step, false));
            }
            let trial = StepTrial { problem: self, energy, slope: step.slope, penalty };
            let Some(length) = trial.search(q, &step.direction) else {
                return Ok(report(iterations, energy, &step, near));
            };
            q.iter_mut().zip(&step.direction).for_each(|(p, d)| *p += d * length);
            iterations += 1;
            if near {
                return Ok(report(iterations, energy - step.remaining, &step, true));
            }
        }
    }

    /// Sums up and factors at `q`, with exact second derivatives near a minimum if their sum is
    /// positive; returns the energy, and whether they were exact.
    fn factor(
        &self,
        assembly: &mut Assembly,
        factor: &mut CholeskyFactor<f64>,
        q: &[Point2<f64>],
        near_minimum: bool,
    ) -> Result<(f64, bool), FlattenError> {
        if near_minimum {
            let energy = assembly.evaluate(self, q, Hessian::Exact);
            if factor.factor(assembly.values()).is_ok() {
                return Ok((energy, true));
            }
        }
        let energy = assembly.evaluate(self, q, Hessian::Projected);
        let mut shift = assembly.largest() * LEAST_SHIFT;
        let mut done = factor.factor(assembly.values());
        for _ in 0..MOST_SHIFTS {
            if done.is_ok() {
                break;
            }
            assembly.stiffen(shift);
            done = factor.factor(assembly.values());
            shift *= SHIFT_GROWTH;
        }
        done.map(|()| (energy, false))
    }

    /// Newton's direction, and what it promises.
    fn step(
        &self,
        factor: &CholeskyFactor<f64>,
        gradient: &[f64],
        q: &[Point2<f64>],
        penalty: &mut f64,
    ) -> Result<NewtonStep, FlattenError> {
        let mut d: Vec<f64> = gradient.iter().map(|g| -g).collect();
        factor.solve(&mut d)?;
        let mut violation = 0.0;
        let mut weighted = 0.0;
        if !self.constraints.is_empty() {
            let (values, columns) = self.linearised(q);
            let multipliers = meet(factor, &values, &columns, &mut d)?;
            violation = values.amax();
            // The exact penalty must outweigh every multiplier.
            *penalty = penalty.max(2.0 * multipliers.amax());
            weighted = *penalty * values.iter().map(|c| c.abs()).sum::<f64>();
        }
        let drop = -dot(gradient, &d);
        let direction = d.chunks_exact(2).map(|p| Vector2::new(p[0], p[1])).collect();
        Ok(NewtonStep { direction, remaining: drop.abs() / 2.0, violation, slope: -drop - weighted })
    }

    /// Values of all constraints, and their gradients as columns.
    fn linearised(&self, q: &[Point2<f64>]) -> (DVector<f64>, Vec<Vec<f64>>) {
        let values = self.constraints.iter().map(|c| c.value(q));
        let columns = self.constraints.iter().map(|c| {
            let mut column = vec![0.0; 2 * q.len()];
            c.gradient(q, &mut |v, g| {
                column[2 * v as usize] += g.x;
                column[2 * v as usize + 1] += g.y;
            });
            column
        });
        (DVector::from_iterator(self.constraints.len(), values), columns.collect())
    }
}

struct NewtonStep {
    direction: Vec<Vector2<f64>>,
    /// Half of `-g.d`.
    remaining: f64,
    /// The largest violation of a constraint.
    violation: f64,
    /// The rate at which the energy plus penalty falls along the direction; negative.
    slope: f64,
}

fn report(iterations: usize, energy: f64, step: &NewtonStep, converged: bool) -> NewtonOutcome {
    NewtonOutcome { iterations, energy, remaining: step.remaining, converged }
}

/// Adds to the free step `d` what makes it meet the linearised constraints, by their Schur
/// complement; returns the multipliers.
fn meet(
    factor: &CholeskyFactor<f64>,
    values: &DVector<f64>,
    columns: &[Vec<f64>],
    d: &mut [f64],
) -> Result<DVector<f64>, FlattenError> {
    let k = columns.len();
    let mut solved: Vec<f64> = columns.concat();
    factor.solve(&mut solved)?;
    let solved: Vec<&[f64]> = solved.chunks_exact(d.len()).collect();
    let schur = DMatrix::from_fn(k, k, |i, j| dot(&columns[i], solved[j]));
    let wanted = DVector::from_iterator(k, columns.iter().zip(values).map(|(c, v)| dot(c, d) + v));
    // Constraints that say the same twice have a singular complement: its pseudo-inverse serves
    // both.
    let smallest = schur.diagonal().amax() * 1e-12;
    let multipliers = schur.svd(true, true).solve(&wanted, smallest).unwrap_or_else(|_| DVector::zeros(k));
    for (m, column) in multipliers.iter().zip(&solved) {
        d.iter_mut().zip(*column).for_each(|(d, s)| *d -= m * s);
    }
    Ok(multipliers)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
