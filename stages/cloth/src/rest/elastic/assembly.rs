//! Which triangles add to which block of a sheet's matrix.
//!
//! Blocks are summed each by itself, in the order of its triangles, so they can be summed side by side and have the same bits for
//! any number of threads; nothing is kept in between but a few numbers a triangle. Cost O(triangles).

use super::border::Border;
use super::{Hinge, PAIRS, Triangle};
use crate::rest::pattern::{Pattern, Slot};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use rayon::prelude::*;

type Vec3 = Vector3<f64>;

/// Blocks that one task sums.
const CHUNK: usize = 2048;

/// A triangle's share in a block: its corners that are the block's row and column.
#[derive(Debug, Clone, Copy)]
struct Share {
    triangle: u32,
    row: u8,
    column: u8,
}

/// What each block is the sum of.
#[derive(Debug, Clone, Default)]
pub(super) struct Assembly {
    shares: Vec<Share>,
    /// The blocks of the sheet alone.
    own: Blocks,
    /// The same among those of contacts.
    placed: Blocks,
}

/// Blocks in the order of their slots.
#[derive(Debug, Clone, Default)]
struct Blocks {
    /// The first share of each.
    starts: Vec<u32>,
    /// What bending adds to the diagonal of each, N/m; it never changes.
    bending: Vec<f64>,
}

impl Blocks {
    /// The same at other slots, in the same order; between them are blocks without shares.
    fn at(&self, slots: &[u32], count: usize) -> Self {
        let (mut starts, mut bending) = (Vec::with_capacity(count + 1), vec![0.0; count]);
        for ((&slot, start), k) in slots.iter().zip(&self.starts).zip(&self.bending) {
            starts.resize(slot as usize + 1, *start);
            bending[slot as usize] = *k;
        }
        starts.resize(count + 1, self.starts.last().copied().unwrap_or(0));
        Self { starts, bending }
    }
}

/// A deformed triangle: the images of the rest axes, and how its stress changes, times its area.
pub(super) struct Local {
    pub(super) u: Vec3,
    pub(super) v: Vec3,
    /// N: entries 11, 22, 33, 12, 13, 23.
    pub(super) tangent: [f64; 6],
    /// N.
    pub(super) stress: Matrix2<f64>,
}

impl Assembly {
    /// Looks up the blocks of these elements; what is held still has none.
    pub(super) fn new(
        pattern: &Pattern,
        triangles: &[Triangle],
        hinges: &[Hinge],
        borders: &[Border],
    ) -> Self {
        let mut entries: Vec<(u32, Share)> = Vec::with_capacity(PAIRS.len() * triangles.len());
        for (t, triangle) in triangles.iter().enumerate() {
            for (a, b) in PAIRS {
                if let Some(Slot { index, flipped }) = pattern.slot(triangle.nodes[a], triangle.nodes[b]) {
                    let (row, column) = if flipped { (b, a) } else { (a, b) };
                    let share = Share { triangle: t as u32, row: row as u8, column: column as u8 };
                    entries.push((index, share));
                }
            }
        }
        let mut starts = vec![0u32; pattern.blocks() + 1];
        entries.iter().for_each(|(slot, _)| starts[*slot as usize + 1] += 1);
        (0..pattern.blocks()).for_each(|k| starts[k + 1] += starts[k]);
        let mut next = starts.clone();
        let mut shares = vec![Share { triangle: 0, row: 0, column: 0 }; entries.len()];
        for (slot, share) in entries {
            let at = &mut next[slot as usize];
            shares[*at as usize] = share;
            *at += 1;
        }
        let own = Blocks { starts, bending: bending(pattern, hinges, borders) };
        Self { shares, placed: own.clone(), own }
    }

    /// Goes to the `slots` that the blocks have in a wider pattern of so many blocks.
    pub(super) fn place(&mut self, slots: &[u32], count: usize) {
        self.placed = self.own.at(slots, count);
    }

    /// Writes all blocks of triangles in that state.
    pub(super) fn write(&self, triangles: &[Triangle], locals: &[Local], values: &mut [Matrix3<f64>]) {
        let Blocks { starts, bending } = &self.placed;
        let write = |(k, value): (usize, &mut Matrix3<f64>)| {
            let mut sum = Matrix3::from_diagonal_element(bending[k]);
            for share in &self.shares[starts[k] as usize..starts[k + 1] as usize] {
                let (t, local) = (share.triangle as usize, &locals[share.triangle as usize]);
                let shape = &triangles[t].shape;
                local.add_block(&shape[share.row as usize], &shape[share.column as usize], &mut sum);
            }
            *value = sum;
        };
        values[..bending.len()].par_iter_mut().enumerate().with_min_len(CHUNK).for_each(write);
    }
}

impl Local {
    /// Adds the block of two corners, of which `p` and `q` are the derivatives of the deformation gradient's columns.
    #[inline]
    fn add_block(&self, p: &Vector2<f64>, q: &Vector2<f64>, sum: &mut Matrix3<f64>) {
        let [c11, c22, c33, c12, c13, c23] = self.tangent;
        // How the two stretches and the shear change with the corners.
        let rows = [self.u * p.x, self.v * p.y, self.u * p.y + self.v * p.x];
        let [e, f, g] = [self.u * q.x, self.v * q.y, self.u * q.y + self.v * q.x];
        let stresses =
            [e * c11 + f * c12 + g * c13, e * c12 + f * c22 + g * c23, e * c13 + f * c23 + g * c33];
        let geometric = p.dot(&(self.stress * q));
        for c in 0..3 {
            let column = rows[0] * stresses[0][c] + rows[1] * stresses[1][c] + rows[2] * stresses[2][c];
            (0..3).for_each(|r| sum[(r, c)] += column[r]);
            sum[(c, c)] += geometric;
        }
    }
}

/// What bending adds to the diagonal of each block.
fn bending(pattern: &Pattern, hinges: &[Hinge], borders: &[Border]) -> Vec<f64> {
    let mut bending = vec![0.0; pattern.blocks()];
    let mut add = |i: u32, j: u32, k: f64| {
        if let Some(slot) = pattern.slot(i, j) {
            bending[slot.index as usize] += k;
        }
    };
    for h in hinges {
        for a in 0..4 {
            (0..=a).for_each(|b| add(h.nodes[a], h.nodes[b], h.stiffness * h.weights[a] * h.weights[b]));
        }
    }
    borders.iter().for_each(|b| b.add_to(&mut add));
    bending
}
