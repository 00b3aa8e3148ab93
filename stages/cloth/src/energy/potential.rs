//! The interface between models and solvers: every solver of this engine, static or in time, takes
//! any sum of energies.

use super::places::Places;
use super::subset::Subset;
use crate::linear::{BlockMatrix, Pattern, Vec3};
use nalgebra::Matrix3;
use std::any::Any;

/// Which matrix stands for the second derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// The exact second derivative: Newton's method converges quadratically near a minimum.
    Exact,
    /// A positive semi-definite matrix near it: every Newton direction goes downhill.
    PositiveSemiDefinite,
    /// The same, but this share (0 to 1) of compressive stress counts: nearer to the exact matrix,
    /// and mostly positive near rest.
    Compressed(f64),
    /// A bound of it for springs: no smaller than it at any positions. Other energies give the
    /// positive semi-definite matrix.
    Bound,
}

impl Projection {
    /// The share of compressive stress that counts.
    #[must_use]
    pub fn compression(self) -> f64 {
        match self {
            Self::Exact => 1.0,
            Self::PositiveSemiDefinite | Self::Bound => 0.0,
            Self::Compressed(share) => share,
        }
    }
}

/// A potential energy of the positions of the nodes, in joules.
///
/// All results have the same bits for any number of threads. An energy without a second derivative
/// needs only a value and a gradient.
pub trait Energy: Send + Sync {
    /// Its name in reports.
    fn name(&self) -> &'static str;

    /// Energy at `x`, joules.
    fn value(&self, x: &[Vec3]) -> f64;

    /// Adds dE/dx (that is, minus the force, newtons) to `gradient`.
    fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]);

    /// Visits each group of nodes that the second derivative couples, for the sparsity pattern.
    fn couplings(&self, _visit: &mut dyn FnMut(&[u32])) {}

    /// The places of its blocks in a pattern that has its couplings, found once per pattern.
    fn places(&self, _pattern: &Pattern) -> Places {
        Places::default()
    }

    /// Adds the 3 x 3 blocks of the second derivative (N/m) to the values of a matrix, at `places`.
    fn add_matrix(&self, _x: &[Vec3], _form: Projection, _places: &Places, _values: &mut [Matrix3<f64>]) {}
}

/// The elastic energy of a sheet for the static solver: it can be restricted to a subset of nodes,
/// its bending can be scaled, and it may have a history.
pub trait Resistance: Energy {
    /// A copy.
    fn boxed(&self) -> Box<dyn Resistance>;

    /// The same, restricted to the elements with an active node.
    fn part(&self, subset: &Subset) -> Box<dyn Resistance>;

    /// Takes over the history of a restricted copy.
    fn merge(&mut self, subset: &Subset, part: &dyn Resistance);

    /// Its concrete type.
    fn as_any(&self) -> &dyn Any;

    /// Whether its second derivative is the same everywhere.
    fn is_constant(&self) -> bool;

    /// Makes bending so many times stiffer (bending continuation); other energies stay.
    fn scale_bending(&mut self, by: f64);

    /// Keeps the stress that a linear model predicts for `moves` from `x`, for the next matrix.
    fn predict(&mut self, x: &[Vec3], moves: &[Vec3]);

    /// Whether it is hysteretic, as friction is: such an energy is not stored.
    fn is_hysteretic(&self) -> bool;

    /// Sets the held angle of every element to that at `x`.
    fn hold(&mut self, x: &[Vec3]);

    /// The held angles; empty where there are none.
    fn held(&self) -> &[f64];

    /// Sets the held angles, if there are as many as elements.
    fn hold_at(&mut self, held: &[f64]);

    /// Moves the held angles along with elements that have turned farther than friction holds.
    fn drag(&mut self, x: &[Vec3]);
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

/// A zero matrix with the pattern of the second derivatives of these energies, for `n` nodes, and
/// the places of each energy in it.
#[must_use]
pub fn matrix_of(n: usize, energies: &[&dyn Energy]) -> (BlockMatrix, Vec<Places>) {
    let matrix = BlockMatrix::with_couplings(n, |visit| energies.iter().for_each(|e| e.couplings(visit)));
    let places = energies.iter().map(|e| e.places(matrix.pattern())).collect();
    (matrix, places)
}

/// Writes the sum of the second derivatives at `x`; matrix and places are those of [`matrix_of`].
pub fn write_matrix(
    energies: &[&dyn Energy],
    places: &[Places],
    x: &[Vec3],
    form: Projection,
    matrix: &mut BlockMatrix,
) {
    matrix.clear();
    for (e, places) in energies.iter().zip(places) {
        e.add_matrix(x, form, places, matrix.values_mut());
    }
}
