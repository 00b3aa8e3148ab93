//! Newton's method with line search on a sum of energies.
//!
//! Each iteration solves `(H + mu M) d = -g` and shortens d until the energy falls enough (Armijo).
//! H is the exact Hessian near the minimum, where steps are taken whole, and its positive part
//! elsewhere. `mu` is a pseudo-time step 1/dt² (pseudo-transient continuation; Kelley and Keyes,
//! 1998): large far from equilibrium, where the full Newton step of a soft strip would be far too
//! long, and zero near it. Cost: one factorization and a few energy evaluations an iteration.

use crate::energy::{Energy, Projection, Vec3, matrix_of, total_gradient, total_value, write_matrix};
use crate::error::ClothError;
use crate::linear::{BlockMatrix, Cholesky, conjugate_gradients};
use crate::stopper::Stopper;

/// Share of the predicted fall of energy that a step must reach.
const ARMIJO: f64 = 1e-4;
/// Halvings at most of a direction.
const MOST_HALVINGS: usize = 24;
/// A step that energies cannot judge must lower the residual to this share.
const LEAST_FALL: f64 = 0.5;
/// Rounding of the energy of a hardly strained sheet: a strain of 1e-7 is known to nine digits.
const ROUNDED_STRAIN: f64 = 1e-9;
/// Energies are compared no finer than this share of their size.
const ENERGY_NOISE: f64 = 1e-13;
/// Factorizations that may fail, each with ten times the shift, before giving up.
const MOST_SHIFTS: usize = 12;

/// The shift that a cut step brings in, as a share of the first: small, since most cuts are mild.
const SHIFT_AFTER_A_CUT: f64 = 1e-3;

/// How the linear systems are solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LinearMethod {
    /// A sparse factor: exact, the right choice for stiff sheets.
    Cholesky,
    /// Conjugate gradients to this relative residual: less memory, for short time steps.
    ConjugateGradients {
        /// Residual norm over right-hand-side norm.
        tolerance: f64,
    },
}

/// Options and the factor kept between calls.
pub struct Newton {
    /// Largest force that may be left on a free vertex, N.
    pub tolerance: f64,
    /// Iterations before [`NewtonReport::converged`] is false.
    pub most_iterations: usize,
    /// How to solve the linear systems.
    pub linear: LinearMethod,
    /// First pseudo-time step, s; infinite for plain Newton.
    pub pseudo_step: f64,
    /// Whether to begin with the pseudo-time step, or to bring it in only when the line search cuts
    /// a step.
    pub cautious: bool,
    /// Asked in every iteration.
    pub stopper: Stopper,
    factor: Option<(BlockMatrix, Cholesky)>,
}

/// How a minimisation ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonReport {
    /// Iterations made.
    pub iterations: usize,
    /// Largest gradient of a free vertex, N.
    pub residual: f64,
    /// Whether the residual is within the tolerance.
    pub converged: bool,
}

impl Newton {
    /// With this tolerance in newtons.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            most_iterations: 200,
            linear: LinearMethod::Cholesky,
            pseudo_step: f64::INFINITY,
            cautious: true,
            stopper: Stopper::default(),
            factor: None,
        }
    }

    /// Moves the free vertices of `x` to a minimum of the energies nearby.
    ///
    /// # Errors
    /// [`ClothError::Factorization`] if no shift makes the matrix positive;
    /// [`ClothError::Diverged`] for NaN; [`ClothError::Stopped`]. `x` is then the best so far.
    pub fn minimise(
        &mut self,
        energies: &[&dyn Energy],
        masses: &[f64],
        fixed: &[bool],
        x: &mut Vec<Vec3>,
    ) -> Result<NewtonReport, ClothError> {
        let (mut hessian, places) = matrix_of(x.len(), energies);
        let mut value = total_value(energies, x);
        let first_shift = self.pseudo_step.powi(-2);
        let (mut shift, mut exact) = (if self.cautious { first_shift } else { 0.0 }, false);
        let mut residual = f64::INFINITY;
        for iterations in 0..=self.most_iterations {
            self.stopper.check()?;
            let gradient = free_gradient(energies, x, fixed);
            residual = largest(&gradient);
            if !residual.is_finite() {
                return Err(ClothError::Diverged { what: "force", step: iterations });
            }
            if residual <= self.tolerance {
                return Ok(NewtonReport { iterations, residual, converged: true });
            }
            if iterations == self.most_iterations {
                break;
            }
            let projection = if exact { Projection::Exact } else { Projection::PositiveSemiDefinite };
            write_matrix(energies, &places, x, projection, &mut hessian);
            let direction = match self.direction(&mut hessian, shift, masses, fixed, &gradient, exact)? {
                Some(d) => d,
                None => {
                    exact = false;
                    continue;
                }
            };
            let mut step = line_search(energies, x, &gradient, &direction, value);
            if step.as_ref().is_none_or(|s| s.0 < 1.0) {
                step = whole_step(energies, x, &direction, fixed, (value, residual)).or(step);
            }
            match step {
                Some((share, next, next_value)) => {
                    (*x, value) = (next, next_value);
                    exact = share == 1.0;
                    shift = next_shift(shift, share, first_shift);
                }
                None if exact => exact = false,
                None if shift > first_shift * 1e12 + 1e12 => break,
                None => shift = (shift * 16.0).max(1e-4 * largest_ratio(&hessian, masses)),
            }
        }
        Ok(NewtonReport { iterations: self.most_iterations, residual, converged: false })
    }

    /// A downhill direction, or none if the exact Hessian does not give one.
    fn direction(
        &mut self,
        hessian: &mut BlockMatrix,
        shift: f64,
        masses: &[f64],
        fixed: &[bool],
        gradient: &[Vec3],
        exact: bool,
    ) -> Result<Option<Vec<Vec3>>, ClothError> {
        hessian.add_diagonal(masses.iter().map(|m| shift * m));
        hessian.fix(fixed);
        let b: Vec<Vec3> = gradient.iter().map(|g| -g).collect();
        let d = match self.linear {
            LinearMethod::ConjugateGradients { tolerance } => {
                let mut d = vec![Vec3::zeros(); b.len()];
                conjugate_gradients(hessian, &b, &mut d, tolerance, 20 * b.len(), &self.stopper)?;
                d
            }
            LinearMethod::Cholesky => match self.factored(hessian, exact)? {
                Some(factor) => factor.solve(&b),
                None => return Ok(None),
            },
        };
        let downhill: f64 = d.iter().zip(gradient).map(|(d, g)| d.dot(g)).sum();
        Ok((downhill < 0.0).then_some(d).or_else(|| (!exact).then(|| b.clone())))
    }

    fn factored(&mut self, hessian: &mut BlockMatrix, exact: bool) -> Result<Option<&Cholesky>, ClothError> {
        let reusable = self.factor.as_ref().is_some_and(|(kept, _)| kept.same_pattern(hessian));
        if !reusable {
            self.factor = Some((hessian.zeroed(), Cholesky::analyse(hessian)?));
        }
        let Some((_, factor)) = &mut self.factor else { return Ok(None) };
        let mut bump = 1e-10 * largest_diagonal(hessian);
        for _ in 0..MOST_SHIFTS {
            self.stopper.check()?;
            match factor.factor(hessian) {
                Ok(()) => return Ok(Some(factor)),
                Err(_) if exact => return Ok(None),
                Err(_) => hessian.add_diagonal(std::iter::repeat_n(bump, hessian.rows())),
            }
            bump *= 10.0;
        }
        Err(ClothError::Factorization { why: "not positive definite even with a large shift".into() })
    }
}

/// Pseudo-time steps grow while steps are taken whole and shrink when the line search cuts them.
fn next_shift(shift: f64, share: f64, first: f64) -> f64 {
    let next = if share == 1.0 { shift * 0.125 } else { (shift * 2.0).max(first * SHIFT_AFTER_A_CUT) };
    if next < first * 1e-9 { 0.0 } else { next }
}

fn free_gradient(energies: &[&dyn Energy], x: &[Vec3], fixed: &[bool]) -> Vec<Vec3> {
    let mut gradient = total_gradient(energies, x);
    gradient.iter_mut().zip(fixed).filter(|(_, f)| **f).for_each(|(g, _)| *g = Vec3::zeros());
    gradient
}

/// Largest norm; NaN counts as infinite.
fn largest(v: &[Vec3]) -> f64 {
    v.iter().map(|v| v.norm()).fold(0.0, |a, b| if b.is_nan() { f64::INFINITY } else { a.max(b) })
}

fn largest_diagonal(h: &BlockMatrix) -> f64 {
    (0..h.rows()).map(|i| h.diagonal(i).trace()).fold(0.0, f64::max)
}

fn largest_ratio(h: &BlockMatrix, masses: &[f64]) -> f64 {
    masses
        .iter()
        .enumerate()
        .filter(|(_, m)| **m > 0.0)
        .map(|(i, m)| h.diagonal(i).trace() / m)
        .fold(0.0, f64::max)
}

/// The whole step if it halves the residual and the energy rises by no more than its rounding can:
/// the residual then still decides.
fn whole_step(
    energies: &[&dyn Energy],
    x: &[Vec3],
    d: &[Vec3],
    fixed: &[bool],
    (value, residual): (f64, f64),
) -> Option<(f64, Vec<Vec3>, f64)> {
    let next: Vec<Vec3> = x.iter().zip(d).map(|(x, d)| x + d).collect();
    let next_value = total_value(energies, &next);
    let rounding = ROUNDED_STRAIN * energies.iter().map(|e| e.value(x).abs()).sum::<f64>();
    (next_value <= value + rounding
        && largest(&free_gradient(energies, &next, fixed)) < LEAST_FALL * residual)
        .then_some((1.0, next, next_value))
}

/// Shortens `d` until the energy falls enough; returns the share of d, the positions and the energy
/// there.
fn line_search(
    energies: &[&dyn Energy],
    x: &[Vec3],
    gradient: &[Vec3],
    d: &[Vec3],
    value: f64,
) -> Option<(f64, Vec<Vec3>, f64)> {
    let slope: f64 = gradient.iter().zip(d).map(|(g, d)| g.dot(d)).sum();
    let noise = ENERGY_NOISE * energies.iter().map(|e| e.value(x).abs()).sum::<f64>();
    let mut share = 1.0;
    for _ in 0..MOST_HALVINGS {
        let next: Vec<Vec3> = x.iter().zip(d).map(|(x, d)| x + d * share).collect();
        let next_value = total_value(energies, &next);
        if next_value <= value + ARMIJO * share * slope + noise {
            return Some((share, next, next_value));
        }
        share *= 0.5;
    }
    None
}
