//! A symmetric matrix of 3x3 blocks: which pairs of nodes it couples, and its values.
//!
//! Only one block of each pair is kept, that of row `i` and column `j` with `i < j`; the diagonal
//! comes first. Elements find their slots once, so that assembly is a sum over slots in a fixed
//! order.

use nalgebra::{Matrix3, Vector3};

/// Which blocks of a symmetric block matrix may differ from zero.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    nodes: usize,
    /// Nodes that are held still: nothing couples them. Empty where none are.
    held: Vec<bool>,
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
    /// The pattern that couples all nodes of each group that `groups` visits; groups may repeat
    /// each other.
    pub fn new(nodes: usize, groups: impl FnOnce(&mut dyn FnMut(&[u32]))) -> Self {
        Self::between_free(nodes, Vec::new(), groups)
    }

    /// The same, where some nodes are held still: what couples them has no slot.
    pub fn holding(held: &[bool], groups: impl FnOnce(&mut dyn FnMut(&[u32]))) -> Self {
        Self::between_free(held.len(), held.to_vec(), groups)
    }

    fn between_free(nodes: usize, held: Vec<bool>, groups: impl FnOnce(&mut dyn FnMut(&[u32]))) -> Self {
        let pairs = pairs(&held, groups);
        let mut starts = vec![0u32; nodes + 1];
        for pair in &pairs {
            starts[(pair >> 32) as usize + 1] += 1;
        }
        for i in 0..nodes {
            starts[i + 1] += starts[i];
        }
        Self { nodes, held, starts, columns: pairs.iter().map(|&p| p as u32).collect() }
    }

    /// This pattern with some groups of nodes coupled besides, and where each of its slots is in
    /// that. Cost O(blocks), but for the groups.
    pub fn with(&self, groups: impl FnOnce(&mut dyn FnMut(&[u32]))) -> (Self, Vec<u32>) {
        let mut more = pairs(&self.held, groups);
        more.retain(|p| self.slot((p >> 32) as u32, *p as u32).is_none());
        let mut more = more.into_iter().peekable();
        let mut starts = vec![0u32];
        let mut columns = Vec::with_capacity(self.columns.len() + more.len());
        let mut slots: Vec<u32> = (0..self.nodes as u32).collect();
        for i in 0..self.nodes {
            for &j in &self.columns[self.starts[i] as usize..self.starts[i + 1] as usize] {
                let before = |p: &u64| *p < (i as u64) << 32 | u64::from(j);
                columns.extend(std::iter::from_fn(|| more.next_if(before)).map(|p| p as u32));
                slots.push((self.nodes + columns.len()) as u32);
                columns.push(j);
            }
            let in_row = |p: &u64| (p >> 32) as usize == i;
            columns.extend(std::iter::from_fn(|| more.next_if(in_row)).map(|p| p as u32));
            starts.push(columns.len() as u32);
        }
        (Self { nodes: self.nodes, held: self.held.clone(), starts, columns }, slots)
    }

    /// Number of block rows.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Whether a node is held still.
    pub fn is_held(&self, i: u32) -> bool {
        self.held.get(i as usize).is_some_and(|h| *h)
    }

    /// Which nodes are held still; empty where none are.
    pub fn held(&self) -> &[bool] {
        &self.held
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

    /// Whether it couples all these nodes that are free.
    #[must_use]
    pub fn couples(&self, nodes: &[u32]) -> bool {
        let couples = |i: u32, j: u32| self.slot(i, j).is_some() || self.is_held(i) || self.is_held(j);
        nodes.iter().enumerate().all(|(k, &i)| nodes[..k].iter().all(|&j| couples(i, j)))
    }

    /// Column and slot of every block of row `i` above the diagonal, columns ascending.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (u32, usize)> + '_ {
        (self.starts[i]..self.starts[i + 1]).map(|k| (self.columns[k as usize], self.nodes + k as usize))
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

/// The free nodes that groups couple, two by two, each once and sorted.
fn pairs(held: &[bool], groups: impl FnOnce(&mut dyn FnMut(&[u32]))) -> Vec<u64> {
    let is_free = |i: u32| !held.get(i as usize).is_some_and(|h| *h);
    let mut pairs: Vec<u64> = Vec::new();
    groups(&mut |group: &[u32]| {
        for (k, &i) in group.iter().enumerate().filter(|(_, i)| is_free(**i)) {
            let others = group[..k].iter().filter(|&&j| i != j && is_free(j));
            pairs.extend(others.map(|&j| pair_key(i, j)));
        }
    });
    pairs.sort_unstable();
    pairs.dedup();
    pairs
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_nodes_have_their_diagonal_alone() {
        let groups = |visit: &mut dyn FnMut(&[u32])| [&[0, 1, 2][..], &[2, 3]].into_iter().for_each(visit);
        let pattern = Pattern::holding(&[false, true, false, false], groups);
        assert_eq!(pattern.upper().map(|(i, j, _)| (i, j)).collect::<Vec<_>>(), [(0, 2), (2, 3)]);
        assert_eq!(pattern.slot(0, 1), None);
        assert_eq!(pattern.slot(1, 1), Some(Slot { index: 1, flipped: false }));
        assert_eq!(pattern.slot(2, 0), Some(Slot { index: 4, flipped: true }));
        assert_eq!(pattern.blocks(), 6);
        // Free nodes that it does not couple; held ones need no coupling.
        assert!(pattern.couples(&[0, 1, 2]) && !pattern.couples(&[0, 1, 3]));
    }

    #[test]
    fn more_groups_make_the_pattern_of_all_and_tell_where_slots_went() {
        let held: Vec<bool> = (0..12).map(|i| i == 5).collect();
        let few: Vec<[u32; 3]> = (0..10).map(|i| [i, i + 1, i + 2]).collect();
        let more = [[0, 7, 3], [4, 5, 9], [11, 1, 2], [8, 9, 10]];
        let pattern = Pattern::holding(&held, |visit| few.iter().for_each(|g| visit(g)));
        let (wider, slots) = pattern.with(|visit| more.iter().for_each(|g| visit(g)));
        let all = |visit: &mut dyn FnMut(&[u32])| {
            few.iter().for_each(|g| visit(g));
            more.iter().for_each(|g| visit(g));
        };
        let whole = Pattern::holding(&held, all);
        assert_eq!((&wider.starts, &wider.columns), (&whole.starts, &whole.columns));
        assert!(wider.blocks() > pattern.blocks());
        for (i, j, slot) in pattern.upper() {
            assert_eq!(wider.slot(i, j), Some(Slot { index: slots[slot as usize], flipped: false }));
        }
        assert_eq!(slots[..12], (0..12).collect::<Vec<u32>>());
    }
}
