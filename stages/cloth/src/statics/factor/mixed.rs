//! Mixed precision: a factor in single precision where it solves well enough, otherwise in double.
//!
//! Method: iterative refinement of the solution in single precision (see `scalar`). Where the
//! residual stays above [`RIGHT`] of the right-hand side, the matrix is factored again in double
//! precision. Cost: half of a factorization in double precision, and a product with the matrix,
//! O(n). The choice depends on the numbers alone, so the bits do not depend on the number of
//! threads.

use crate::linear::Pattern;
use crate::statics::factor::multifrontal::{Factor, Halt, Stop, Symbolic};
use crate::statics::factor::scalar::Precision;
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// Greatest residual of a solution in single precision, as a share of the right-hand side. The step
/// is then accurate to about a thousandth, which is more than Newton's method needs.
const RIGHT: f64 = 1e-4;

/// Refinements at most before the matrix counts as too ill conditioned for single precision.
const REFINEMENTS: usize = 2;

/// The matrix of a linear system.
#[derive(Clone, Copy)]
pub(crate) struct Matrix<'m> {
    pub(crate) pattern: &'m Pattern,
    pub(crate) symbolic: &'m Symbolic,
    pub(crate) values: &'m [Matrix3<f64>],
}

/// The factors in both precisions, and which of them is the last one.
#[derive(Default)]
pub(crate) struct Mixed {
    single: Factor<f32>,
    double: Factor<f64>,
    is_single: bool,
}

impl Mixed {
    /// Factors the matrix and solves for `right`. Where the matrix `may_fail` to be positive
    /// definite, a failure in single precision counts.
    ///
    /// # Errors
    /// [`Halt`]: the matrix is not positive definite, or `stop` returned true.
    pub(crate) fn solve(
        &mut self,
        matrix: Matrix<'_>,
        right: &[Vec3],
        precision: Precision,
        may_fail: bool,
        stop: &Stop,
    ) -> Result<Vec<Vec3>, Halt> {
        if precision == Precision::Mixed {
            self.is_single = true;
            let mut x = right.to_vec();
            match matrix.symbolic.factor_and_solve(matrix.values, &mut self.single, &mut x, stop) {
                Ok(()) if self.refine(matrix, right, &mut x) => return Ok(x),
                Err(Halt::Stopped) => return Err(Halt::Stopped),
                Err(halt) if may_fail => return Err(halt),
                _ => {}
            }
        }
        self.is_single = false;
        let mut x = right.to_vec();
        matrix.symbolic.factor_and_solve(matrix.values, &mut self.double, &mut x, stop)?;
        Ok(x)
    }

    /// Solves with the last factor.
    pub(crate) fn again(&self, symbolic: &Symbolic, x: &mut [Vec3]) {
        match self.is_single {
            true => symbolic.solve(&self.single, x),
            false => symbolic.solve(&self.double, x),
        }
    }

    /// Refines a solution in single precision; returns whether it is accurate enough.
    fn refine(&self, matrix: Matrix<'_>, right: &[Vec3], x: &mut [Vec3]) -> bool {
        let most = RIGHT * norm(right);
        for round in 0..=REFINEMENTS {
            let mut over: Vec<Vec3> = right.iter().map(|r| -r).collect();
            matrix.pattern.multiply_add(matrix.values, x, &mut over);
            if norm(&over) <= most {
                return true;
            }
            if round < REFINEMENTS {
                matrix.symbolic.solve(&self.single, &mut over);
                x.iter_mut().zip(&over).for_each(|(x, o)| *x -= o);
            }
        }
        false
    }
}

fn norm(v: &[Vec3]) -> f64 {
    v.iter().map(Vec3::norm_squared).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A chain of springs of so many N/m, whose ends `hold` with another stiffness.
    fn chain(stiff: f64, hold: f64) -> (Pattern, Symbolic, Vec<Matrix3<f64>>) {
        let n = 40;
        let links: Vec<[u32; 2]> = (1..n).map(|i| [i - 1, i]).collect();
        let pattern = Pattern::new(n as usize, |visit| links.iter().for_each(|l| visit(l)));
        let layout: Vec<Vec3> = (0..n).map(|i| Vec3::x() * f64::from(i)).collect();
        let mut values = vec![Matrix3::zeros(); pattern.blocks()];
        for [i, j] in links {
            values[i as usize] += Matrix3::identity() * stiff;
            values[j as usize] += Matrix3::identity() * stiff;
            values[pattern.slot(i, j).unwrap().index as usize] -= Matrix3::identity() * stiff;
        }
        values[0] += Matrix3::identity() * hold;
        let symbolic = Symbolic::new(&pattern, &layout);
        (pattern, symbolic, values)
    }

    /// The solution under a pull of 1 N at the free end: how precise its factor was, and how far it
    /// is off, as a share.
    fn pulled(stiff: f64, hold: f64, precision: Precision) -> (bool, f64) {
        let (pattern, symbolic, values) = chain(stiff, hold);
        let matrix = Matrix { pattern: &pattern, symbolic: &symbolic, values: &values };
        let mut right = vec![Vec3::zeros(); 40];
        right[39] = Vec3::x();
        let mut mixed = Mixed::default();
        let x = mixed.solve(matrix, &right, precision, false, &|| false).unwrap();
        let end = 1.0 / hold + 39.0 / stiff;
        (mixed.is_single, (x[39].x - end).abs() / end)
    }

    #[test]
    fn single_precision_does_where_it_solves_well() {
        let (is_single, off) = pulled(1.0, 1.0, Precision::Mixed);
        assert!(is_single && off < 1e-4, "{off}");
        assert!(!pulled(1.0, 1.0, Precision::Double).0);
    }

    #[test]
    fn what_is_too_ill_conditioned_is_solved_in_double_precision() {
        // The hold is lost beside the springs in single precision: the pivot is zero, or any
        // number.
        let (is_single, off) = pulled(1.0, 1e-9, Precision::Mixed);
        assert!(!is_single && off < 1e-4, "{is_single} {off}");
    }

    #[test]
    fn a_matrix_that_may_fail_is_not_tried_twice() {
        let (pattern, symbolic, values) = chain(1.0, -1.0);
        let matrix = Matrix { pattern: &pattern, symbolic: &symbolic, values: &values };
        let mut mixed = Mixed::default();
        let right = vec![Vec3::x(); 40];
        let failed = mixed.solve(matrix, &right, Precision::Mixed, true, &|| false);
        assert!(matches!(failed, Err(Halt::NotPositive(_))) && mixed.is_single);
    }

    #[test]
    fn the_last_factor_serves_again() {
        let (pattern, symbolic, values) = chain(3.0, 2.0);
        let matrix = Matrix { pattern: &pattern, symbolic: &symbolic, values: &values };
        for precision in [Precision::Mixed, Precision::Double] {
            let mut mixed = Mixed::default();
            let right: Vec<Vec3> = (0..40).map(|i| Vec3::new(f64::from(i).sin(), 1.0, 0.0)).collect();
            let x = mixed.solve(matrix, &right, precision, false, &|| false).unwrap();
            let mut again = right.clone();
            mixed.again(&symbolic, &mut again);
            let off = x.iter().zip(&again).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            assert!(off < 1e-3 * norm(&x), "{off}");
        }
    }
}
