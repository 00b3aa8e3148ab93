//! Energies of one triangle as functions of its map `J` from 3D to the plane, and their
//! derivatives.
//!
//! The energy of a pattern is the sum over triangles of share of the area times density `e(J)`. Far
//! from a minimum the Hessian of each density is taken with its negative eigenvalues cut off, so
//! that sums of them are positive semi-definite and Newton's step goes downhill.

mod arap;
mod isotropic;
mod springs;
mod symmetric_dirichlet;
#[cfg(test)]
mod tests;
mod woven;

pub use arap::ArapEnergy;
pub use isotropic::{Isotropic, Stretches, singular_values};
pub use springs::SpringEnergy;
pub use symmetric_dirichlet::SymmetricDirichletEnergy;
pub use woven::{WovenEnergy, WovenStiffness};

use nalgebra::{Matrix2, Matrix4, Vector4};

/// A density of energy.
pub trait EnergyDensity: Sync {
    /// The density at the map `j` of a triangle; infinite where the triangle is flipped or without
    /// area.
    fn value(&self, triangle: usize, j: &Matrix2<f64>) -> f64;

    /// Value, gradient and Hessian by the entries of `j` in the order 11, 12, 21, 22; `j` has a
    /// positive determinant.
    fn derivatives(&self, triangle: usize, j: &Matrix2<f64>, hessian: Hessian) -> Derivatives;

    /// Whether a turn of the whole pattern leaves the energy as it is.
    fn turns_freely(&self) -> bool {
        true
    }
}

/// Which second derivatives are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hessian {
    /// As they are: near a minimum their sum is positive, and Newton's method converges
    /// quadratically.
    Exact,
    /// Without negative eigenvalues.
    Projected,
}

/// What Newton's method needs of one triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivatives {
    /// The density.
    pub value: f64,
    /// By the entries of the map, row by row.
    pub gradient: Vector4<f64>,
    /// Second derivatives.
    pub hessian: Matrix4<f64>,
}

/// The nearest matrix without negative eigenvalues.
pub(crate) fn project(hessian: Matrix4<f64>) -> Matrix4<f64> {
    if hessian.cholesky().is_some() {
        return hessian;
    }
    let mut eigen = hessian.symmetric_eigen();
    eigen.eigenvalues.apply(|v| *v = v.max(0.0));
    eigen.recompose()
}
