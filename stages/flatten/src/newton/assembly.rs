//! Energy, gradient and Hessian of a whole pattern from those of its triangles.
//!
//! Triangles are evaluated in parallel and added one after the other, so the bits are the same for
//! any number of threads.

use super::{NewtonProblem, RIGID};
use crate::energy::Hessian;
use crate::frames::corners;
use crate::linear::block_slots;
use nalgebra::{Matrix2, Point2, Vector2};
use rayon::prelude::*;

/// Triangles that are evaluated between two additions: their results stay in the cache.
const BATCH: usize = 4096;

/// Room for the sums, and where each triangle's share goes.
pub(super) struct Assembly {
    values: Vec<f64>,
    gradient: Vec<f64>,
    diagonals: Vec<[u32; 2]>,
    pairs: Vec<[[u32; 2]; 3]>,
    term_pairs: Vec<[[u32; 2]; 3]>,
    rigid: Vec<f64>,
    batch: Vec<ElementTerms>,
}

/// One triangle's energy, gradient by corner, diagonal blocks, and blocks of corners (0, 1), (1,
/// 2), (2, 0).
#[derive(Clone, Copy)]
struct ElementTerms {
    value: f64,
    gradient: [Vector2<f64>; 3],
    diagonal: [Matrix2<f64>; 3],
    pairs: [Matrix2<f64>; 3],
}

impl Assembly {
    pub(super) fn new(problem: &NewtonProblem<'_>) -> Self {
        let graph = problem.system.graph();
        let diagonals = (0..graph.vertices()).map(|i| block_slots(graph, i).map(|s| s as u32)).collect();
        let slots = |[a, b]: [u32; 2]| {
            let low = a.min(b) as usize;
            let [first, second] = block_slots(graph, low);
            let k = graph.pair(a, b).map_or(0, |p| p - graph.start(low));
            [(first + 2 + 2 * k) as u32, (second + 1 + 2 * k) as u32]
        };
        let pairs = problem.system.triangles().iter().map(|&[a, b, c]| [[a, b], [b, c], [c, a]].map(slots));
        let term_pairs = problem.terms.iter().map(|t| t.pairs().map(slots));
        let mut rigid = vec![0.0; graph.vertices()];
        for (t, corners) in problem.system.triangles().iter().enumerate() {
            corners.iter().for_each(|&v| rigid[v as usize] += RIGID * problem.frames.share(t) / 3.0);
        }
        let values = vec![0.0; 3 * graph.vertices() + 4 * graph.pairs()];
        let gradient = vec![0.0; 2 * graph.vertices()];
        let (pairs, term_pairs) = (pairs.collect(), term_pairs.collect());
        Self { values, gradient, diagonals, pairs, term_pairs, rigid, batch: Vec::new() }
    }

    /// The Hessian's lower triangle, as the factor takes it.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Two numbers a vertex.
    pub(super) fn gradient(&self) -> &[f64] {
        &self.gradient
    }

    /// Sums everything up at `q`; returns the energy.
    pub(super) fn evaluate(
        &mut self,
        problem: &NewtonProblem<'_>,
        q: &[Point2<f64>],
        wanted: Hessian,
    ) -> f64 {
        self.values.fill(0.0);
        self.gradient.fill(0.0);
        for v in 0..self.rigid.len() {
            self.add_diagonal(v as u32, &Matrix2::from_diagonal_element(self.rigid[v]));
        }
        let count = problem.system.triangles().len();
        let mut energy = 0.0;
        let mut batch = std::mem::take(&mut self.batch);
        for first in (0..count).step_by(BATCH) {
            let range = first..(first + BATCH).min(count);
            range
                .clone()
                .into_par_iter()
                .with_min_len(256)
                .map(|t| element(problem, q, t, wanted))
                .collect_into_vec(&mut batch);
            for (t, e) in range.zip(&batch) {
                energy += e.value;
                self.add(problem, t, e);
            }
        }
        self.batch = batch;
        energy + self.add_terms(problem, q)
    }

    /// The largest entry of the diagonal.
    pub(super) fn largest(&self) -> f64 {
        self.diagonals.iter().flatten().map(|&s| self.values[s as usize]).fold(0.0, f64::max)
    }

    /// Adds to every entry of the diagonal.
    pub(super) fn stiffen(&mut self, shift: f64) {
        self.diagonals.iter().flatten().for_each(|&s| self.values[s as usize] += shift);
    }

    fn add(&mut self, problem: &NewtonProblem<'_>, t: usize, e: &ElementTerms) {
        let corners = problem.system.triangles()[t];
        for k in 0..3 {
            self.add_gradient(corners[k], &e.gradient[k]);
            self.add_diagonal(corners[k], &e.diagonal[k]);
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            self.add_pair(self.pairs[t][k], a > b, &e.pairs[k]);
        }
    }

    fn add_terms(&mut self, problem: &NewtonProblem<'_>, q: &[Point2<f64>]) -> f64 {
        let mut energy = 0.0;
        for (i, term) in problem.terms.iter().enumerate() {
            energy += term.value(q);
            let (pull, stiff) = (term.error(q) * (2.0 * term.weight), term.counted() * (2.0 * term.weight));
            for k in 0..3 {
                let (v, c) = (term.vertices[k], term.coefficients[k]);
                self.add_gradient(v, &(pull * c));
                self.add_diagonal(v, &(stiff * (c * c)));
                let (u, other) = (term.vertices[(k + 1) % 3], term.coefficients[(k + 1) % 3]);
                if u != v {
                    self.add_pair(self.term_pairs[i][k], false, &(stiff * (c * other)));
                }
            }
        }
        energy
    }

    fn add_gradient(&mut self, v: u32, g: &Vector2<f64>) {
        self.gradient[2 * v as usize] += g.x;
        self.gradient[2 * v as usize + 1] += g.y;
    }

    fn add_diagonal(&mut self, v: u32, block: &Matrix2<f64>) {
        let [first, second] = self.diagonals[v as usize].map(|s| s as usize);
        self.values[first] += block.m11;
        self.values[first + 1] += block.m21;
        self.values[second] += block.m22;
    }

    /// Adds a block whose rows belong to the first vertex; `first_is_row` if that is the higher
    /// one.
    fn add_pair(&mut self, slots: [u32; 2], first_is_row: bool, block: &Matrix2<f64>) {
        let [first, second] = slots.map(|s| s as usize);
        let (below, above) = if first_is_row { (block.m21, block.m12) } else { (block.m12, block.m21) };
        self.values[first] += block.m11;
        self.values[first + 1] += below;
        self.values[second] += above;
        self.values[second + 1] += block.m22;
    }
}

/// The energy alone.
pub(super) fn energy_at(problem: &NewtonProblem<'_>, q: &[Point2<f64>]) -> f64 {
    let triangles = problem.system.triangles();
    let density = |t: usize| {
        let j = problem.frames.map(t, corners(q, triangles[t]));
        problem.frames.share(t) * problem.energy.value(t, &j)
    };
    let densities: Vec<f64> = (0..triangles.len()).into_par_iter().with_min_len(1024).map(density).collect();
    densities.iter().sum::<f64>() + problem.terms.iter().map(|t| t.value(q)).sum::<f64>()
}

fn element(problem: &NewtonProblem<'_>, q: &[Point2<f64>], t: usize, wanted: Hessian) -> ElementTerms {
    let j = problem.frames.map(t, corners(q, problem.system.triangles()[t]));
    let (share, d) = (problem.frames.share(t), problem.energy.derivatives(t, &j, wanted));
    let [_, b, c] = problem.frames.gradients(t);
    let block = |g: &Vector2<f64>, h: &Vector2<f64>| {
        // Rows of the result by the flat coordinates of the corner with gradient g, columns by
        // those of h.
        let entry = |r: usize, s: usize| {
            let m = |k: usize, l: usize| d.hessian[(2 * r + k, 2 * s + l)];
            g.x * (m(0, 0) * h.x + m(0, 1) * h.y) + g.y * (m(1, 0) * h.x + m(1, 1) * h.y)
        };
        Matrix2::new(entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1)) * share
    };
    let (bb, bc, cc) = (block(&b, &b), block(&b, &c), block(&c, &c));
    // Moving all three corners alike changes nothing, so the blocks of corner 0 are minus sums of
    // the others.
    let ab = -(bb + bc.transpose());
    let ca = -(bc.transpose() + cc);
    let aa = -(ab + ca.transpose());
    let pull = |g: &Vector2<f64>| {
        Vector2::new(d.gradient[0] * g.x + d.gradient[1] * g.y, d.gradient[2] * g.x + d.gradient[3] * g.y)
            * share
    };
    let (gb, gc) = (pull(&b), pull(&c));
    ElementTerms {
        value: share * d.value,
        gradient: [-(gb + gc), gb, gc],
        diagonal: [aa, bb, cc],
        pairs: [ab, bc, ca],
    }
}
