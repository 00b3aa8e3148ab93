//! Nested dissection: an order of elimination that keeps the factor of a sheet's matrix sparse.
//!
//! Method: the nodes have places (those of the panels before sewing, where they are flat) and are
//! bisected recursively (George 1973). The nodes of one half that are coupled to the other half are
//! the separator and come last. Of the cuts across each axis, the one with the smallest separator
//! is chosen (see `bisection`). Cost: O(n log n). Limit: the order is only as good as the layout,
//! but valid for any.

mod bisection;

use crate::linear::Pattern;
use bisection::Bisector;
use nalgebra::Vector3;

/// Parts of at most this many nodes are not bisected: a dense block of some 50 unknowns is cheaper
/// than more fronts.
const LEAF_NODES: usize = 16;

/// Rounds of [`smoothed`]: an offset of half a cell becomes a twentieth.
const ROUNDS: usize = 8;

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
    let neighbours = NodeNeighbours::new(pattern);
    let mut bisector = Bisector::new(layout, &neighbours);
    let mut parts = Vec::new();
    let all: Vec<u32> = (0..n as u32).filter(|&i| !pattern.is_held(i)).collect();
    cut(all, &mut bisector, &mut parts);
    parts
}

/// The layout after some rounds in which each node moves to the mean of the nodes that it is
/// coupled to, so that uneven rows and irregular meshes can be cut straight.
pub fn smoothed(pattern: &Pattern, layout: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let neighbours = NodeNeighbours::new(pattern);
    let mut layout = layout.to_vec();
    for _ in 0..ROUNDS {
        layout = (0..layout.len() as u32).map(|i| middle(i, neighbours.of(i), &layout)).collect();
    }
    layout
}

/// The mean of a node and its neighbours.
fn middle(i: u32, near: &[u32], layout: &[Vector3<f64>]) -> Vector3<f64> {
    let sum = near.iter().fold(layout[i as usize], |sum, &j| sum + layout[j as usize]);
    sum / (near.len() + 1) as f64
}

/// Adjacency lists of the pattern: each pair in both directions.
struct NodeNeighbours {
    starts: Vec<u32>,
    of: Vec<u32>,
}

impl NodeNeighbours {
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
fn cut(nodes: Vec<u32>, bisector: &mut Bisector<'_>, parts: &mut Vec<Part>) -> usize {
    if nodes.len() <= LEAF_NODES {
        parts.push(Part { nodes, children: Vec::new() });
        return parts.len() - 1;
    }
    let [low, high, separator] = bisector.of(nodes);
    let mut children = Vec::new();
    for half in [low, high] {
        if !half.is_empty() {
            children.push(cut(half, bisector, parts));
        }
    }
    parts.push(Part { nodes: separator, children });
    parts.len() - 1
}
