//! Conjugate gradients, preconditioned by the 3 x 3 diagonal blocks. Memory: five vectors. The
//! number of iterations grows with the square root of the condition number, so it pays for soft
//! sheets and short steps; a factor pays for stiff ones.

use nalgebra::Matrix3;

use super::BlockMatrix;
use super::Vec3;
use crate::error::ClothError;
use crate::stopper::Stopper;

/// How an iteration ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PcgReport {
    /// Iterations made.
    pub iterations: usize,
    /// Residual norm over right-hand-side norm.
    pub relative_residual: f64,
}

/// Solves `a x = b` to a relative residual, starting from `x`.
///
/// Stops early at a direction of negative curvature with what it has: still a descent direction for
/// an optimiser.
///
/// # Errors
/// [`ClothError::Stopped`].
pub fn conjugate_gradients(
    a: &BlockMatrix,
    b: &[Vec3],
    x: &mut [Vec3],
    tolerance: f64,
    most_iterations: usize,
    stopper: &Stopper,
) -> Result<PcgReport, ClothError> {
    let inverse = inverse_diagonal(a);
    let mut y = a.times(x);
    let mut r: Vec<Vec3> = b.iter().zip(&y).map(|(b, y)| b - y).collect();
    let mut z: Vec<Vec3> = r.iter().zip(&inverse).map(|(r, m)| m * r).collect();
    let mut p = z.clone();
    let (mut rz, size) = (dot(&r, &z), dot(b, b).sqrt());
    let mut iterations = 0;
    while iterations < most_iterations && dot(&r, &r).sqrt() > tolerance * size {
        stopper.check()?;
        a.times_into(&p, &mut y);
        let curvature = dot(&p, &y);
        if curvature <= 0.0 {
            break;
        }
        let step = rz / curvature;
        for k in 0..x.len() {
            x[k] += p[k] * step;
            r[k] -= y[k] * step;
            z[k] = inverse[k] * r[k];
        }
        let next = dot(&r, &z);
        let turn = next / rz;
        rz = next;
        for (p, z) in p.iter_mut().zip(&z) {
            *p = z + *p * turn;
        }
        iterations += 1;
    }
    let relative_residual = if size > 0.0 { dot(&r, &r).sqrt() / size } else { 0.0 };
    Ok(PcgReport { iterations, relative_residual })
}

fn inverse_diagonal(a: &BlockMatrix) -> Vec<Matrix3<f64>> {
    (0..a.rows()).map(|i| a.diagonal(i).try_inverse().unwrap_or_else(Matrix3::identity)).collect()
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
