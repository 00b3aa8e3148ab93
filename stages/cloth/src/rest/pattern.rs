//! A symmetric matrix of 3x3 blocks: which pairs of nodes it couples, and its values.
//!
//! Only one block of each pair is kept, that of row `i` and column `j` with `i < j`; the diagonal comes first. Elements
//! find their slots once, so that assembly is a sum over slots in a fixed order.

use nalgebra::{Matrix3, Vector3};

/// Which blocks of a symmetric block matrix may differ from zero.
#[derive(Debug, Clone)]
pub struct Pattern {
    nodes: usize,
    /// First entry of each row in `columns`.
    starts: Vec<u32>,
    /// Columns above the diagonal, ascending in each row.
    columns: Vec<u32>,
}

/// Where an element's block goes: its slot, and whether it must be transposed on the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot {
    /// Index into the values.
    pub index: u32,
    /// True where the element's row node is the larger one.
    pub flipped: bool,
}

impl Pattern {
    /// The pattern that couples all nodes of each group; groups may repeat each other.
    pub fn new<'a>(nodes: usize, groups: impl Iterator<Item = &'a [u32]>) -> Self {
        let mut pairs: Vec<u64> = Vec::new();
        for group in groups {
            for (k, &i) in group.iter().enumerate() {
                pairs.extend(group[..k].iter().filter(|&&j| i != j).map(|&j| pair_key(i, j)));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = vec![0u32; nodes + 1];
        for pair in &pairs {
            starts[(pair >> 32) as usize + 1] += 1;
        }
        for i in 0..nodes {
            starts[i + 1] += starts[i];
        }
        Self { nodes, starts, columns: pairs.iter().map(|&p| p as u32).collect() }
    }

    /// Number of block rows.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Number of blocks kept.
    pub fn blocks(&self) -> usize {
        self.nodes + self.columns.len()
    }

    /// The slot of the block of row `i` and column `j`; `None` where the pattern has none.
    #[inline]
    pub fn slot(&self, i: u32, j: u32) -> Option<Slot> {
        if i == j {
            return Some(Slot { index: i, flipped: false });
        }
        let (low, high) = (i.min(j), i.max(j));
        let start = self.starts[low as usize] as usize;
        let row = &self.columns[start..self.starts[low as usize + 1] as usize];
        let found = row.binary_search(&high).ok()?;
        Some(Slot { index: (self.nodes + start + found) as u32, flipped: i > j })
    }

    /// Whether it couples all these nodes.
    #[must_use]
    pub fn couples(&self, nodes: &[u32]) -> bool {
        nodes.iter().enumerate().all(|(k, &i)| nodes[..k].iter().all(|&j| self.slot(i, j).is_some()))
    }

    /// Row, column and slot of every block above the diagonal.
    pub fn upper(&self) -> impl Iterator<Item = (u32, u32, u32)> + '_ {
        (0..self.nodes).flat_map(move |i| {
            (self.starts[i]..self.starts[i + 1])
                .map(move |k| (i as u32, self.columns[k as usize], self.nodes as u32 + k))
        })
    }

    /// Adds the matrix times `x` to `y`.
    pub fn multiply_add(&self, values: &[Matrix3<f64>], x: &[Vector3<f64>], y: &mut [Vector3<f64>]) {
        for i in 0..self.nodes {
            let mut sum = values[i] * x[i];
            for k in self.starts[i] as usize..self.starts[i + 1] as usize {
                let j = self.columns[k] as usize;
                let block = &values[self.nodes + k];
                sum += block * x[j];
                y[j] += block.tr_mul(&x[i]);
            }
            y[i] += sum;
        }
    }
}

fn pair_key(i: u32, j: u32) -> u64 {
    (u64::from(i.min(j)) << 32) | u64::from(i.max(j))
}

/// Adds `block`, meant for the element's own order of nodes, at its slot.
#[inline]
pub fn add_at(values: &mut [Matrix3<f64>], slot: Slot, block: &Matrix3<f64>) {
    let value = &mut values[slot.index as usize];
    if slot.flipped {
        *value += block.transpose();
    } else {
        *value += block;
    }
}
