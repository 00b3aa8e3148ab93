//! The places of elements in the blocks of a matrix.
//!
//! Each block is summed in the order of its elements, so blocks can be summed in parallel and have
//! the same bits for any number of threads. Cost: 8 bytes and one search in the pattern per pair of
//! nodes of an element.

use crate::linear::{Pattern, Slot};
use std::sync::Arc;

/// The contribution of an element to a block: its nodes that are the row and column of the block.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    pub(super) element: u32,
    pub(super) row: u8,
    pub(super) column: u8,
}

/// The places of the second derivative of one energy in a matrix.
#[derive(Debug, Clone, Default)]
pub struct Places {
    /// The first share of each block; empty where there are none at all.
    starts: Vec<u32>,
    shares: Arc<[Share]>,
    /// Blocks of an energy that has no elements, one after the other.
    slots: Vec<u32>,
}

impl Places {
    /// Of so many elements with these nodes; held nodes have no block.
    pub(super) fn of<const N: usize>(
        pattern: &Pattern,
        count: usize,
        nodes: impl Fn(usize) -> [u32; N],
    ) -> Self {
        let mut entries: Vec<(u32, Share)> = Vec::with_capacity(N * (N + 1) / 2 * count);
        for element in 0..count {
            let n = nodes(element);
            for (a, b) in (0..N).flat_map(|a| (a..N).map(move |b| (a, b))) {
                // A node can occur twice in an element: sewing makes the two tips of a hinge one
                // node. Its block gets the pair once, not in both orders, so the matrix is softer
                // there than the second derivative. The gradient is exact, so states of rest do not
                // change.
                if let Some(Slot { index, flipped }) = pattern.slot(n[a], n[b]) {
                    let (row, column) = if flipped { (b, a) } else { (a, b) };
                    let share = Share { element: element as u32, row: row as u8, column: column as u8 };
                    entries.push((index, share));
                }
            }
        }
        let (starts, shares) = by_block(&entries, pattern.blocks());
        Self { starts, shares: shares.into(), slots: Vec::new() }
    }

    /// Single blocks at these slots.
    pub(crate) fn at_slots(slots: Vec<u32>) -> Self {
        Self { slots, ..Self::default() }
    }

    /// The slots of single blocks.
    pub(crate) fn slots(&self) -> &[u32] {
        &self.slots
    }

    /// The shares of block `k`.
    #[inline]
    pub(super) fn shares(&self, k: usize) -> &[Share] {
        &self.shares[self.starts[k] as usize..self.starts[k + 1] as usize]
    }

    /// Whether there are no shares.
    pub(super) fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }

    /// The same in a wider pattern of so many blocks, in which the blocks of this pattern are at
    /// `slots`, ascending.
    #[must_use]
    pub(crate) fn moved(&self, slots: &[u32], blocks: usize) -> Self {
        let single = self.slots.iter().map(|&s| slots[s as usize]).collect();
        Self { starts: moved(&self.starts, slots, blocks), shares: self.shares.clone(), slots: single }
    }
}

/// First shares at other slots; empty where there are none.
fn moved(starts: &[u32], slots: &[u32], blocks: usize) -> Vec<u32> {
    let Some(end) = starts.last() else { return Vec::new() };
    let mut moved = Vec::with_capacity(blocks + 1);
    slots.iter().zip(starts).for_each(|(&slot, start)| moved.resize(slot as usize + 1, *start));
    moved.resize(blocks + 1, *end);
    moved
}

/// Shares by their blocks, each block's in their order, and the first of each block.
fn by_block(entries: &[(u32, Share)], blocks: usize) -> (Vec<u32>, Vec<Share>) {
    let mut starts = vec![0u32; blocks + 1];
    entries.iter().for_each(|(slot, _)| starts[*slot as usize + 1] += 1);
    (0..blocks).for_each(|k| starts[k + 1] += starts[k]);
    let mut next = starts.clone();
    let mut shares = vec![Share { element: 0, row: 0, column: 0 }; entries.len()];
    for (slot, share) in entries {
        let at = &mut next[*slot as usize];
        shares[*at as usize] = *share;
        *at += 1;
    }
    (starts, shares)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_has_the_shares_of_its_elements_in_their_order_here_and_in_a_wider_pattern() {
        let elements = [[0u32, 1, 2], [2, 1, 3]];
        let own = Pattern::new(4, |visit| elements.iter().for_each(|e| visit(e)));
        let places = Places::of(&own, 2, |e| elements[e]);
        let of = |places: &Places, pattern: &Pattern, i, j| -> Vec<(u32, u8, u8)> {
            let slot = pattern.slot(i, j).map_or(0, |s| s.index as usize);
            places.shares(slot).iter().map(|s| (s.element, s.row, s.column)).collect()
        };
        assert_eq!(of(&places, &own, 1, 2), [(0, 1, 2), (1, 1, 0)]);
        assert_eq!(of(&places, &own, 3, 3), [(1, 2, 2)]);
        let (wider, slots) = own.with(|visit| visit(&[0, 3]));
        let moved = places.moved(&slots, wider.blocks());
        assert_eq!(of(&moved, &wider, 1, 2), [(0, 1, 2), (1, 1, 0)]);
        assert!(of(&moved, &wider, 0, 3).is_empty());
    }

    #[test]
    fn a_node_that_stands_twice_in_an_element_meets_itself_once() {
        let pattern = Pattern::new(3, |visit| visit(&[0, 1, 2]));
        let places = Places::of(&pattern, 1, |_| [0u32, 1, 2, 0]);
        let pairs: Vec<(u8, u8)> = places.shares(0).iter().map(|s| (s.row, s.column)).collect();
        assert_eq!(pairs, [(0, 0), (0, 3), (3, 3)]);
        assert_eq!(places.shares(1).len(), 1);
    }
}
