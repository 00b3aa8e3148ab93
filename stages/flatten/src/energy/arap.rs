//! As-rigid-as-possible energy (Liu and others 2008): `|J - R|^2` with the nearest rotation R; in
//! stretches, `(s - 1)^2` each.
//!
//! That alone lets triangles lose their area: a thousandth of the symmetric Dirichlet energy keeps
//! it above zero.

use super::SymmetricDirichletEnergy;
use super::isotropic::{Isotropic, Stretches};
use nalgebra::Vector2;

/// The share of symmetric Dirichlet energy: it changes stretches by some thousandths of their
/// distance from 1.
const AREA_KEEPER: f64 = 1e-3;

/// `(s1 - 1)^2 + (s2 - 1)^2`, with a thousandth of [`SymmetricDirichletEnergy`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ArapEnergy;

impl Isotropic for ArapEnergy {
    fn value(&self, s: Vector2<f64>) -> f64 {
        s.map(|s| (s - 1.0).powi(2)).sum() + AREA_KEEPER * Isotropic::value(&SymmetricDirichletEnergy, s)
    }

    fn stretches(&self, s: Vector2<f64>) -> Stretches {
        let keeper = SymmetricDirichletEnergy.stretches(s);
        Stretches {
            first: s.map(|s| 2.0 * (s - 1.0)) + keeper.first * AREA_KEEPER,
            second: Vector2::new(2.0, 2.0) + keeper.second * AREA_KEEPER,
            flip: 2.0 + AREA_KEEPER * keeper.flip,
        }
    }
}
