//! From elements of N nodes to energies of a whole mesh.
//!
//! A model is a file with one [`Element`]: how many there are, their nodes, and the value, gradient
//! and second derivative of one. All else (sums, places in the matrix, parts of a mesh) is here.
//! Elements are evaluated in parallel, in chunks of fixed size; their results are added one after
//! the other in the order of the elements, so the sums do not depend on the number of threads.
//! Cost: one pass over the elements.

use super::places::{Places, Share};
use super::potential::{Energy, Projection, Resistance};
use super::subset::Subset;
use crate::linear::Pattern;
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::any::Any;
use toile_geometry::Vec3;

/// Elements per partial sum.
const CHUNK: usize = 512;

/// Elements per parallel task: starting a thread takes as long as some thousand elements.
const TASK: usize = 2048;

/// Blocks per parallel task.
const BLOCKS: usize = 2048;

/// Block `[i][j]`, `j >= i`, is the second derivative by nodes i and j.
pub type Blocks<const N: usize> = [[Matrix3<f64>; N]; N];

/// Adds the block of that row and column of an element.
#[inline]
pub fn add_block_of<const N: usize>(blocks: &Blocks<N>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
    if column >= row {
        *sum += blocks[row][column];
    } else {
        *sum += blocks[column][row].transpose();
    }
}

/// A family of equal elements with `N` nodes each.
pub trait Element<const N: usize>: Clone + Send + Sync + 'static {
    /// What the blocks of the second derivative of one element are computed from: the [`Blocks`]
    /// themselves, or fewer numbers.
    type State: Send + Sync;

    /// Its name in reports.
    fn name(&self) -> &'static str;

    /// How many elements there are.
    fn count(&self) -> usize;

    /// The nodes of element `e`.
    fn nodes(&self, e: usize) -> [u32; N];

    /// Its energy, joules.
    fn value(&self, e: usize, x: &[Vec3; N]) -> f64;

    /// Its derivative by each node.
    fn gradient(&self, e: usize, x: &[Vec3; N]) -> [Vec3; N];

    /// What its second derivative at `x` is computed from.
    fn state(&self, e: usize, x: &[Vec3; N], form: Projection) -> Self::State;

    /// Adds its block by the nodes `row` and `column`.
    fn add_block(&self, e: usize, state: &Self::State, row: usize, column: usize, sum: &mut Matrix3<f64>);

    /// Some of its elements, with their nodes renumbered.
    #[must_use]
    fn part(&self, elements: &[usize], subset: &Subset) -> Self;

    /// Whether it acts at all; otherwise it has no energy, force or matrix.
    fn acts(&self) -> bool {
        true
    }

    /// Whether it has a second derivative.
    fn has_matrix(&self) -> bool {
        true
    }

    /// Whether its second derivative is constant.
    fn is_constant(&self) -> bool {
        false
    }

    /// See [`Resistance::scale_bending`].
    fn scale_bending(&mut self, _by: f64) {}

    /// See [`Resistance::predict`].
    fn predict(&mut self, _x: &[Vec3], _moves: &[Vec3]) {}

    /// Takes over the history of a copy of some of these elements.
    fn merge(&mut self, _elements: &[usize], _part: &Self) {}

    /// See [`Resistance::is_hysteretic`].
    fn is_hysteretic(&self) -> bool {
        false
    }

    /// See [`Resistance::hold`].
    fn hold(&mut self, _x: &[Vec3]) {}

    /// See [`Resistance::held`].
    fn held(&self) -> &[f64] {
        &[]
    }

    /// See [`Resistance::hold_at`].
    fn hold_at(&mut self, _held: &[f64]) {}

    /// See [`Resistance::drag`].
    fn drag(&mut self, _x: &[Vec3]) {}
}

/// Elements as one [`Energy`].
#[derive(Debug, Clone)]
pub struct Assembled<const N: usize, E>(pub E);

impl<const N: usize, E: Element<N>> Assembled<N, E> {
    #[inline]
    fn at(&self, e: usize, x: &[Vec3]) -> [Vec3; N] {
        self.0.nodes(e).map(|v| x[v as usize])
    }

    fn each<T: Send>(&self, f: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
        let count = self.0.count();
        if count <= TASK {
            return (0..count).map(f).collect();
        }
        (0..count).into_par_iter().with_min_len(TASK).map(f).collect()
    }

    /// The elements with an active node.
    fn touched(&self, subset: &Subset) -> Vec<usize> {
        (0..self.0.count()).filter(|&e| subset.touches(&self.0.nodes(e))).collect()
    }
}

impl<const N: usize, E: Element<N>> Energy for Assembled<N, E> {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        if !self.0.acts() {
            return 0.0;
        }
        let count = self.0.count();
        let chunk = |c: usize| -> f64 {
            (c * CHUNK..((c + 1) * CHUNK).min(count)).map(|e| self.0.value(e, &self.at(e, x))).sum()
        };
        if count <= 2 * TASK {
            return (0..count.div_ceil(CHUNK)).map(chunk).sum();
        }
        let chunks = (0..count.div_ceil(CHUNK)).into_par_iter().with_min_len(2 * TASK / CHUNK);
        let parts: Vec<f64> = chunks.map(chunk).collect();
        parts.iter().sum()
    }

    fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        if !self.0.acts() {
            return;
        }
        let parts = self.each(|e| self.0.gradient(e, &self.at(e, x)));
        for (e, part) in parts.iter().enumerate() {
            for (v, g) in self.0.nodes(e).into_iter().zip(part) {
                gradient[v as usize] += g;
            }
        }
    }

    fn couplings(&self, visit: &mut dyn FnMut(&[u32])) {
        if self.0.has_matrix() {
            (0..self.0.count()).for_each(|e| visit(&self.0.nodes(e)));
        }
    }

    fn places(&self, pattern: &Pattern) -> Places {
        match self.0.has_matrix() && self.0.count() > 0 {
            true => Places::of(pattern, self.0.count(), |e| self.0.nodes(e)),
            false => Places::default(),
        }
    }

    fn add_matrix(&self, x: &[Vec3], form: Projection, places: &Places, values: &mut [Matrix3<f64>]) {
        if places.is_empty() || !self.0.acts() {
            return;
        }
        let states: Vec<E::State> = self.each(|e| self.0.state(e, &self.at(e, x), form));
        let write = |(k, value): (usize, &mut Matrix3<f64>)| {
            let mut sum = *value;
            for Share { element, row, column } in places.shares(k) {
                let e = *element as usize;
                self.0.add_block(e, &states[e], *row as usize, *column as usize, &mut sum);
            }
            *value = sum;
        };
        match values.len() <= BLOCKS {
            true => values.iter_mut().enumerate().for_each(write),
            false => values.par_iter_mut().enumerate().with_min_len(BLOCKS).for_each(write),
        }
    }
}

impl<const N: usize, E: Element<N>> Resistance for Assembled<N, E> {
    fn boxed(&self) -> Box<dyn Resistance> {
        Box::new(self.clone())
    }

    fn part(&self, subset: &Subset) -> Box<dyn Resistance> {
        Box::new(Self(self.0.part(&self.touched(subset), subset)))
    }

    fn merge(&mut self, subset: &Subset, part: &dyn Resistance) {
        let touched = self.touched(subset);
        if let Some(Self(part)) = part.as_any().downcast_ref::<Self>() {
            self.0.merge(&touched, part);
        }
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn is_constant(&self) -> bool {
        self.0.is_constant()
    }

    fn scale_bending(&mut self, by: f64) {
        self.0.scale_bending(by);
    }

    fn predict(&mut self, x: &[Vec3], moves: &[Vec3]) {
        self.0.predict(x, moves);
    }

    fn is_hysteretic(&self) -> bool {
        self.0.is_hysteretic()
    }

    fn hold(&mut self, x: &[Vec3]) {
        self.0.hold(x);
    }

    fn held(&self) -> &[f64] {
        self.0.held()
    }

    fn hold_at(&mut self, held: &[f64]) {
        self.0.hold_at(held);
    }

    fn drag(&mut self, x: &[Vec3]) {
        self.0.drag(x);
    }
}
