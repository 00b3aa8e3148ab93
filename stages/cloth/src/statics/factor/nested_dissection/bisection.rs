//! Bisection of a set of nodes with a small separator.
//!
//! Method: for all cuts across an axis near the middle, one sweep counts the nodes on either side
//! that have a neighbour on the other. The smallest separator is chosen, with a penalty for unequal
//! halves. Cost: O(n) for n nodes with few neighbours, and O(w log w) for the w nodes near the
//! middle.

use super::NodeNeighbours;
use nalgebra::Vector3;
use std::cmp::Ordering;

/// Greatest distance of a cut from the middle, as a share of the nodes.
const MIDDLE: f64 = 0.1;

/// Axes along which the set is shorter than this share of the longest are not tried.
const LEAST_SIDE: f64 = 0.5;

/// Penalty for a cut away from the middle: it adds to the separator, by the square of its distance
/// as a share of half of the nodes.
const CROOKED: f64 = 2.0;

/// Bisects sets of nodes.
pub(super) struct Bisector<'h> {
    layout: &'h [Vector3<f64>],
    neighbours: &'h NodeNeighbours,
    /// The set that each node is in; 0 for none.
    set: Vec<u32>,
    sets: u32,
    /// The rank of each node of the present set along the present axis.
    rank: Vec<u32>,
}

/// A cut across an axis.
struct AxisCut {
    axis: usize,
    /// The number of nodes before it.
    before: usize,
    /// The size of its separator, with the penalty.
    cost: f64,
}

impl<'h> Bisector<'h> {
    pub(super) fn new(layout: &'h [Vector3<f64>], neighbours: &'h NodeNeighbours) -> Self {
        Self { layout, neighbours, set: vec![0; layout.len()], sets: 0, rank: vec![0; layout.len()] }
    }

    /// Both halves without the separator, and the separator, each sorted by node.
    pub(super) fn of(&mut self, mut nodes: Vec<u32>) -> [Vec<u32>; 3] {
        let half = self.sort(&mut nodes);
        let mut high = nodes.split_off(half);
        let mut low = nodes;
        let (in_low, in_high) = (self.mark(&low), self.mark(&high));
        let mut from_low: Vec<u32> = low.iter().copied().filter(|&i| self.meets(i, in_high)).collect();
        let mut from_high: Vec<u32> = high.iter().copied().filter(|&i| self.meets(i, in_low)).collect();
        let separator = if from_low.len() < from_high.len() { &mut from_low } else { &mut from_high };
        separator.iter().for_each(|&i| self.set[i as usize] = 0);
        low.retain(|&i| self.set[i as usize] == in_low);
        high.retain(|&i| self.set[i as usize] == in_high);
        let mut parts = [low, high, std::mem::take(separator)];
        parts.iter_mut().for_each(|p| p.sort_unstable());
        parts
    }

    /// Makes a set of these nodes.
    fn mark(&mut self, nodes: &[u32]) -> u32 {
        self.sets += 1;
        nodes.iter().for_each(|&i| self.set[i as usize] = self.sets);
        self.sets
    }

    /// Whether a node has a neighbour in this set.
    fn meets(&self, i: u32, set: u32) -> bool {
        self.neighbours.of(i).iter().any(|&j| self.set[j as usize] == set)
    }

    /// Sorts the nodes so that those before the best cut come first; returns how many these are.
    fn sort(&mut self, nodes: &mut [u32]) -> usize {
        let sides = sides(nodes, self.layout);
        let set = self.mark(nodes);
        let long = (0..3).filter(|&axis| sides[axis] >= LEAST_SIDE * sides.max());
        let cuts: Vec<AxisCut> = long.map(|axis| self.best_across(axis, nodes, set)).collect();
        let Some(best) = cuts.iter().min_by(|a, b| a.cost.total_cmp(&b.cost)) else { return nodes.len() / 2 };
        nodes.select_nth_unstable_by(best.before, |a, b| self.order(best.axis, a, b));
        best.before
    }

    /// The order of two nodes along an axis.
    fn order(&self, axis: usize, a: &u32, b: &u32) -> Ordering {
        let at = |i: u32| self.layout[i as usize][axis];
        at(*a).total_cmp(&at(*b)).then(a.cmp(b))
    }

    /// The best cut across an axis.
    fn best_across(&mut self, axis: usize, nodes: &mut [u32], set: u32) -> AxisCut {
        let half = nodes.len() / 2;
        let reach = (nodes.len() as f64 * MIDDLE).ceil() as usize;
        let (from, to) = (half - reach, half + reach);
        nodes.select_nth_unstable_by(from, |a, b| self.order(axis, a, b));
        nodes[from..].select_nth_unstable_by(to - from, |a, b| self.order(axis, a, b));
        nodes[from..=to].sort_unstable_by(|a, b| self.order(axis, a, b));
        // The order of the other nodes does not matter.
        nodes.iter().enumerate().for_each(|(k, &i)| self.rank[i as usize] = k.clamp(from, to) as u32);
        let cuts =
            self.separators(nodes, set, from, to).into_iter().zip(from..).map(|(separator, before)| {
                let off = before.abs_diff(half) as f64 / half as f64;
                AxisCut { axis, before, cost: f64::from(separator) * (1.0 + CROOKED * off * off) }
            });
        // The nodes before the first of them share a rank.
        let best = cuts.skip(1).min_by(|a, b| a.cost.total_cmp(&b.cost));
        best.unwrap_or(AxisCut { axis, before: half, cost: f64::INFINITY })
    }

    /// The size of the smaller separator of each cut with `from` to `to` nodes before it.
    fn separators(&self, nodes: &[u32], set: u32, from: usize, to: usize) -> Vec<u32> {
        // The change, from the cut before, of the number of nodes before a cut with a neighbour
        // behind it, and the other way round.
        let mut more = vec![[0i32; 2]; to - from + 2];
        let place = |rank: u32| rank as usize - from + 1;
        for &i in nodes {
            let own = self.rank[i as usize];
            let (mut least, mut most) = (own, own);
            for &j in self.neighbours.of(i).iter().filter(|&&j| self.set[j as usize] == set) {
                let rank = self.rank[j as usize];
                (least, most) = (least.min(rank), most.max(rank));
            }
            more[place(own)][0] += 1;
            more[place(most)][0] -= 1;
            more[place(least)][1] += 1;
            more[place(own)][1] -= 1;
        }
        let mut across = [0i32; 2];
        let count = |more: &[i32; 2]| {
            across = [across[0] + more[0], across[1] + more[1]];
            across[0].min(across[1]).unsigned_abs()
        };
        more[..to - from + 1].iter().map(count).collect()
    }
}

/// The side lengths of the bounding box of the nodes.
fn sides(nodes: &[u32], layout: &[Vector3<f64>]) -> Vector3<f64> {
    let places = || nodes.iter().map(|&i| layout[i as usize]);
    let (low, high) = (places().reduce(|a, b| a.inf(&b)), places().reduce(|a, b| a.sup(&b)));
    low.zip(high).map_or_else(Vector3::zeros, |(low, high)| high - low)
}
