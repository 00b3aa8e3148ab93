//! From elements of N vertices to whole-mesh energies.
//!
//! Elements are evaluated in parallel, in chunks of fixed size; their results are added one after the other in the order of
//! the elements. So the sums do not depend on the number of threads. Cost: one pass over the elements.

use nalgebra::Matrix3;
use rayon::prelude::*;

use super::energy::{Energy, Projection, Vec3};
use crate::linear::BlockMatrix;

/// Elements evaluated by one task: large enough to hide the cost of a task, small enough to share 2,000 triangles.
const CHUNK: usize = 256;

/// A family of equal elements with `N` vertices each.
pub trait Element<const N: usize>: Send + Sync {
    /// What it is called in reports.
    fn name(&self) -> &'static str;

    /// How many elements there are.
    fn count(&self) -> usize;

    /// The vertices of element `e`.
    fn vertices(&self, e: usize) -> [u32; N];

    /// Its energy, joules.
    fn value(&self, e: usize, x: &[Vec3; N]) -> f64;

    /// Its derivative by each vertex.
    fn gradient(&self, e: usize, x: &[Vec3; N]) -> [Vec3; N];

    /// Its second derivative: block `[i][j]` by vertices i and j. Only `j >= i` need be filled.
    fn hessian(&self, e: usize, x: &[Vec3; N], projection: Projection) -> [[Matrix3<f64>; N]; N];
}

/// Elements seen as one [`Energy`].
#[derive(Debug, Clone)]
pub struct Assembled<const N: usize, E>(pub E);

impl<const N: usize, E: Element<N>> Assembled<N, E> {
    fn at(&self, e: usize, x: &[Vec3]) -> [Vec3; N] {
        self.0.vertices(e).map(|v| x[v as usize])
    }

    /// One chunk stays on this thread: waking others would cost more than it saves.
    fn chunks<T: Send>(&self, f: impl Fn(usize) -> T + Sync) -> Vec<Vec<T>> {
        let count = self.0.count();
        let chunk = |c: usize| (c * CHUNK..((c + 1) * CHUNK).min(count)).map(&f).collect();
        if count <= CHUNK {
            return vec![chunk(0)];
        }
        (0..count.div_ceil(CHUNK)).into_par_iter().map(chunk).collect()
    }
}

impl<const N: usize, E: Element<N>> Energy for Assembled<N, E> {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        let sums = self.chunks(|e| self.0.value(e, &self.at(e, x)));
        sums.iter().map(|c| c.iter().sum::<f64>()).sum()
    }

    fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        let parts = self.chunks(|e| self.0.gradient(e, &self.at(e, x)));
        for (e, part) in parts.iter().flatten().enumerate() {
            for (v, g) in self.0.vertices(e).into_iter().zip(part) {
                gradient[v as usize] += g;
            }
        }
    }

    fn couplings(&self, visit: &mut dyn FnMut(&[u32])) {
        (0..self.0.count()).for_each(|e| visit(&self.0.vertices(e)));
    }

    fn add_hessian(&self, x: &[Vec3], projection: Projection, hessian: &mut BlockMatrix) {
        let parts = self.chunks(|e| self.0.hessian(e, &self.at(e, x), projection));
        for (e, part) in parts.iter().flatten().enumerate() {
            hessian.add_element(&self.0.vertices(e), part);
        }
    }
}
