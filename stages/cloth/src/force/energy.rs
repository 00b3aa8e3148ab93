//! The interface between models and implicit solvers.

use nalgebra::Vector3;

use crate::linear::BlockMatrix;

/// A position, force or direction in space.
pub type Vec3 = Vector3<f64>;

/// Whether Hessian blocks must be positive semi-definite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Projection {
    /// The exact second derivative: Newton's method converges quadratically near a minimum.
    Exact,
    /// A positive semi-definite matrix near it: every Newton direction goes downhill.
    PositiveSemiDefinite,
}

/// A potential energy of the vertex positions, in joules.
///
/// All three results are the same bits for any number of threads.
pub trait Energy: Send + Sync {
    /// What it is called in reports.
    fn name(&self) -> &'static str;

    /// Energy at `x`, joules.
    fn value(&self, x: &[Vec3]) -> f64;

    /// Adds dE/dx (that is, minus the force, newtons) to `gradient`.
    fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]);

    /// Hands each group of vertices that the Hessian couples to `visit`, so that the sparsity pattern can be built.
    fn couplings(&self, visit: &mut dyn FnMut(&[u32]));

    /// Adds the 3 x 3 blocks of the second derivative (N/m). The pattern of `hessian` holds all couplings.
    fn add_hessian(&self, x: &[Vec3], projection: Projection, hessian: &mut BlockMatrix);
}

/// Sum of the energies at `x`.
#[must_use]
pub fn total_value(energies: &[&dyn Energy], x: &[Vec3]) -> f64 {
    energies.iter().map(|e| e.value(x)).sum()
}

/// Sum of the gradients at `x`.
#[must_use]
pub fn total_gradient(energies: &[&dyn Energy], x: &[Vec3]) -> Vec<Vec3> {
    let mut gradient = vec![Vec3::zeros(); x.len()];
    for e in energies {
        e.add_gradient(x, &mut gradient);
    }
    gradient
}

/// An all-zero matrix with the pattern of these energies' Hessians, for `n` nodes.
#[must_use]
pub fn matrix_of(n: usize, energies: &[&dyn Energy]) -> BlockMatrix {
    BlockMatrix::with_couplings(n, |visit| energies.iter().for_each(|e| e.couplings(visit)))
}
