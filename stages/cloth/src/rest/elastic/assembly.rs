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

/// A hinge's share in a block: the product of the weights of its row and column.
#[derive(Debug, Clone, Copy)]
struct FoldShare {
    hinge: u32,
    weight: f64,
}

/// What each block is the sum of.
#[derive(Debug, Clone, Default)]
pub(super) struct Assembly {
    shares: Vec<Share>,
    /// Of hinges that friction may hold.
    folds: Vec<FoldShare>,
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
    /// The first share of hinges of each; empty where friction holds none.
    folds: Vec<u32>,
    /// What bending adds to the diagonal of each, N/m; it never changes.
    bending: Vec<f64>,
}

impl Blocks {
    /// The same at other slots, in the same order; between them are blocks without shares.
    fn at(&self, slots: &[u32], count: usize) -> Self {
        let mut bending = vec![0.0; count];
        slots.iter().zip(&self.bending).for_each(|(&slot, k)| bending[slot as usize] = *k);
        Self { starts: moved(&self.starts, slots, count), folds: moved(&self.folds, slots, count), bending }
    }
}

/// First shares at other slots; nothing where there are none.
fn moved(starts: &[u32], slots: &[u32], count: usize) -> Vec<u32> {
    let Some(end) = starts.last() else { return Vec::new() };
    let mut moved = Vec::with_capacity(count + 1);
    slots.iter().zip(starts).for_each(|(&slot, start)| moved.resize(slot as usize + 1, *start));
    moved.resize(count + 1, *end);
    moved
}

/// Shares sorted by their blocks, and the first of each block.
fn by_block<T: Copy>(entries: &[(u32, T)], blocks: usize) -> (Vec<u32>, Vec<T>) {
    let mut sorted: Vec<&(u32, T)> = entries.iter().collect();
    sorted.sort_by_key(|(slot, _)| *slot);
    let mut starts = vec![0u32; blocks + 1];
    entries.iter().for_each(|(slot, _)| starts[*slot as usize + 1] += 1);
    (0..blocks).for_each(|k| starts[k + 1] += starts[k]);
    (starts, sorted.into_iter().map(|(_, share)| *share).collect())
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
        holds: bool,
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
        let (starts, shares) = by_block(&entries, pattern.blocks());
        let (first_folds, folds) = match holds {
            true => by_block(&fold_shares(pattern, hinges), pattern.blocks()),
            false => (Vec::new(), Vec::new()),
        };
        let own = Blocks { starts, folds: first_folds, bending: bending(pattern, hinges, borders) };
        Self { shares, folds, placed: own.clone(), own }
    }

    /// Goes to the `slots` that the blocks have in a wider pattern of so many blocks.
    pub(super) fn place(&mut self, slots: &[u32], count: usize) {
        self.placed = self.own.at(slots, count);
    }

    /// Writes all blocks of triangles in that state.
    pub(super) fn write(
        &self,
        triangles: &[Triangle],
        locals: &[Local],
        holds: &[Matrix3<f64>],
        values: &mut [Matrix3<f64>],
    ) {
        let Blocks { starts, folds, bending } = &self.placed;
        let write = |(k, value): (usize, &mut Matrix3<f64>)| {
            let mut sum = Matrix3::from_diagonal_element(bending[k]);
            for share in &self.shares[starts[k] as usize..starts[k + 1] as usize] {
                let (t, local) = (share.triangle as usize, &locals[share.triangle as usize]);
                let shape = &triangles[t].shape;
                local.add_block(&shape[share.row as usize], &shape[share.column as usize], &mut sum);
            }
            if !holds.is_empty() {
                for fold in &self.folds[folds[k] as usize..folds[k + 1] as usize] {
                    sum += holds[fold.hinge as usize] * fold.weight;
                }
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

/// The shares of hinges in the blocks that there are.
fn fold_shares(pattern: &Pattern, hinges: &[Hinge]) -> Vec<(u32, FoldShare)> {
    let mut entries = Vec::with_capacity(10 * hinges.len());
    for (k, h) in hinges.iter().enumerate() {
        for (a, b) in (0..4).flat_map(|a| (0..=a).map(move |b| (a, b))) {
            if let Some(slot) = pattern.slot(h.nodes[a], h.nodes[b]) {
                let weight = h.weights[a] * h.weights[b];
                entries.push((slot.index, FoldShare { hinge: k as u32, weight }));
            }
        }
    }
    entries
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
