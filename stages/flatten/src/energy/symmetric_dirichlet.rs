//! Symmetric Dirichlet energy (Smith and Schaefer 2015): `|J|^2 + |J^-1|^2 - 4`, in stretches
//! `s^2 + 1/s^2 - 2` each.
//!
//! Zero for isometries; a stretch by a factor costs as much as a shrinkage by it; infinite where a
//! triangle loses its area.

use super::isotropic::{Isotropic, Stretches};
use nalgebra::Vector2;

/// `(s1 - 1/s1)^2 + (s2 - 1/s2)^2`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SymmetricDirichletEnergy;

impl Isotropic for SymmetricDirichletEnergy {
    fn value(&self, s: Vector2<f64>) -> f64 {
        // (s - 1/s)^2, without the loss of digits of s^2 + 1/s^2 - 2 near 1.
        s.map(|s| (s - 1.0 / s).powi(2)).sum()
    }

    fn stretches(&self, s: Vector2<f64>) -> Stretches {
        let (a, b) = (s.x, s.y);
        let product = (a * b).powi(3);
        Stretches {
            first: s.map(|s| 2.0 * (s - 1.0 / s.powi(3))),
            second: s.map(|s| 2.0 + 6.0 / s.powi(4)),
            flip: 2.0 + 2.0 * (a * a + a * b + b * b) / product,
        }
    }
}
