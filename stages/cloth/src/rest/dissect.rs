//! Nested dissection: an order of elimination that keeps the factor of a sheet's matrix sparse.
//!
//! The nodes are laid out in space (where the panels lay before sewing: flat), cut in half across the longer side again
//! and again (George 1973), where rows of vertices leave a gap near the middle; the nodes of one half that are coupled to
//! the other are the separator and come last.
//! Cost O(n log n) for the cuts. The order is only as good as the layout, but right for any.

use super::pattern::Pattern;
use nalgebra::Vector3;

/// Parts of at most this many nodes are not cut further: a dense block of some 50 unknowns is cheaper than more fronts.
const LEAF_NODES: usize = 16;

/// How far from the middle a cut may lie, as a share of the nodes.
const MIDDLE: f64 = 0.05;

/// One part of the tree: the nodes eliminated there, after those of its children.
#[derive(Debug, Clone, Default)]
pub struct Part {
    /// The nodes, in the order of elimination.
    pub nodes: Vec<u32>,
    /// Indices of the parts below, each smaller than this part's own.
    pub children: Vec<usize>,
}

/// The parts, children before parents; the last is the root. Held nodes are in none.
pub fn dissect(pattern: &Pattern, layout: &[Vector3<f64>]) -> Vec<Part> {
    let n = pattern.nodes();
    let neighbours = Neighbours::new(pattern);
    let mut parts = Vec::new();
    let mut side = vec![0u32; n];
    let mut mark = 0;
    let all: Vec<u32> = (0..n as u32).filter(|&i| !pattern.is_held(i)).collect();
    cut(all, layout, &neighbours, &mut side, &mut mark, &mut parts);
    parts
}

/// Both directions of the pattern.
struct Neighbours {
    starts: Vec<u32>,
    of: Vec<u32>,
}

impl Neighbours {
    fn new(pattern: &Pattern) -> Self {
        let mut starts = vec![0u32; pattern.nodes() + 1];
        for (i, j, _) in pattern.upper() {
            starts[i as usize + 1] += 1;
            starts[j as usize + 1] += 1;
        }
        for i in 0..pattern.nodes() {
            starts[i + 1] += starts[i];
        }
        let mut fill = starts.clone();
        let mut of = vec![0u32; 2 * (pattern.blocks() - pattern.nodes())];
        for (i, j, _) in pattern.upper() {
            for (a, b) in [(i, j), (j, i)] {
                of[fill[a as usize] as usize] = b;
                fill[a as usize] += 1;
            }
        }
        Self { starts, of }
    }

    fn of(&self, i: u32) -> &[u32] {
        &self.of[self.starts[i as usize] as usize..self.starts[i as usize + 1] as usize]
    }
}

/// Adds the parts of `nodes` and returns the index of their root.
fn cut(
    mut nodes: Vec<u32>,
    layout: &[Vector3<f64>],
    neighbours: &Neighbours,
    side: &mut [u32],
    mark: &mut u32,
    parts: &mut Vec<Part>,
) -> usize {
    if nodes.len() <= LEAF_NODES {
        parts.push(Part { nodes, children: Vec::new() });
        return parts.len() - 1;
    }
    let half = cut_at(&mut nodes, layout);
    let (low_mark, high_mark) = (*mark + 1, *mark + 2);
    *mark += 2;
    let mut high = nodes.split_off(half);
    let mut low = nodes;
    low.sort_unstable();
    high.sort_unstable();
    low.iter().for_each(|&i| side[i as usize] = low_mark);
    high.iter().for_each(|&i| side[i as usize] = high_mark);
    let touches = |i: u32, other: u32| neighbours.of(i).iter().any(|&j| side[j as usize] == other);
    let from_low: Vec<u32> = low.iter().copied().filter(|&i| touches(i, high_mark)).collect();
    let from_high: Vec<u32> = high.iter().copied().filter(|&i| touches(i, low_mark)).collect();
    let separator = if from_low.len() < from_high.len() { from_low } else { from_high };
    separator.iter().for_each(|&i| side[i as usize] = 0);
    low.retain(|&i| side[i as usize] == low_mark);
    high.retain(|&i| side[i as usize] == high_mark);
    let mut children = Vec::new();
    for half in [low, high] {
        if !half.is_empty() {
            children.push(cut(half, layout, neighbours, side, mark, parts));
        }
    }
    parts.push(Part { nodes: separator, children });
    parts.len() - 1
}

/// Sorts the nodes about the middle of their longer side and says how many come before the cut: those before the widest gap
/// there, so that rows of vertices that stand a little out of line are cut apart, not through.
fn cut_at(nodes: &mut [u32], layout: &[Vector3<f64>]) -> usize {
    let axis = longest_axis(nodes, layout);
    let at = |i: u32| layout[i as usize][axis];
    let before = |a: &u32, b: &u32| at(*a).total_cmp(&at(*b)).then(a.cmp(b));
    let half = nodes.len() / 2;
    let reach = (nodes.len() as f64 * MIDDLE) as usize;
    let (from, to) = (half - reach, half + reach);
    nodes.select_nth_unstable_by(from, before);
    nodes[from..].select_nth_unstable_by(to - from, before);
    nodes[from..=to].sort_unstable_by(before);
    let gap = |k: usize| at(nodes[k]) - at(nodes[k - 1]);
    let better = |a: &usize, b: &usize| {
        let nearer = b.abs_diff(half).cmp(&a.abs_diff(half));
        gap(*a).total_cmp(&gap(*b)).then(nearer)
    };
    (from + 1..=to).max_by(better).unwrap_or(half)
}

fn longest_axis(nodes: &[u32], layout: &[Vector3<f64>]) -> usize {
    let (mut low, mut high) = (layout[nodes[0] as usize], layout[nodes[0] as usize]);
    for &i in nodes {
        low = low.inf(&layout[i as usize]);
        high = high.sup(&layout[i as usize]);
    }
    (high - low).imax()
}
