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
}

impl Projection {
    /// The share of compressive stress that counts.
    #[must_use]
    pub fn compression(self) -> f64 {
        match self {
            Self::Exact => 1.0,
            Self::PositiveSemiDefinite => 0.0,
            Self::Compressed(share) => share,
        }
    }
}

/// A potential energy of the nodes' positions, in joules.
///
/// All results are the same bits for any number of threads. An energy without a second derivative
/// needs its value and its gradient alone.
pub trait Energy: Send + Sync {
    /// What it is called in reports.
    fn name(&self) -> &'static str;

    /// Energy at `x`, joules.
    fn value(&self, x: &[Vec3]) -> f64;

    /// Adds dE/dx (that is, minus the force, newtons) to `gradient`.
    fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]);

    /// Hands each group of nodes that the second derivative couples to `visit`, so that the
    /// sparsity pattern can be built.
    fn couplings(&self, _visit: &mut dyn FnMut(&[u32])) {}

    /// Where its blocks are among those of a pattern that holds its couplings: looked up once a
    /// pattern.
    fn places(&self, _pattern: &Pattern) -> Places {
        Places::default()
    }

    /// Adds the 3 x 3 blocks of the second derivative (N/m) to the values of a matrix, at its
    /// places there.
    fn add_matrix(&self, _x: &[Vec3], _form: Projection, _places: &Places, _values: &mut [Matrix3<f64>]) {}
}

/// What a sheet itself resists with, as the static solver needs it: an energy of elements that can
/// be cut to some of its nodes, made stiffer, and that may remember.
pub trait Resistance: Energy {
    /// A copy.
    fn boxed(&self) -> Box<dyn Resistance>;

    /// The same of the elements that an active node is in.
    fn part(&self, subset: &Subset) -> Box<dyn Resistance>;

    /// Takes over what such a part has learnt of its elements.
    fn merge(&mut self, subset: &Subset, part: &dyn Resistance);

    /// To find its kind again.
    fn as_any(&self) -> &dyn Any;

    /// Whether its second derivative is the same everywhere.
    fn is_constant(&self) -> bool;

    /// Makes bending so many times stiffer (bending continuation); other energies stay.
    fn scale_bending(&mut self, by: f64);

    /// Remembers the stress that a linear model predicts for `moves` from `x`: the next matrix has
    /// that one.
    fn predict(&mut self, x: &[Vec3], moves: &[Vec3]);

    /// Whether it holds the sheet where it has been, as friction does: such an energy is not
    /// stored.
    fn is_hysteretic(&self) -> bool;

    /// Holds every element as it is at `x`.
    fn hold(&mut self, x: &[Vec3]);

    /// Where it holds each element; nothing where it holds none.
    fn held(&self) -> &[f64];

    /// Holds each element there, if there are as many.
    fn hold_at(&mut self, held: &[f64]);

    /// Lets what it holds follow what has moved farther than it can hold.
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

/// An all-zero matrix with the pattern of these energies' second derivatives, for `n` nodes, and
/// each energy's places in it.
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
