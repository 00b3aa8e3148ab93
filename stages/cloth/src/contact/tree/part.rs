//! A part of the tree, and a tree of which only a part looks for others: for cloth that moves among cloth that holds still.

use super::{Awake, ClothTree, Search, halves};
use crate::contact::pair::Pair;
use nalgebra::Vector3;
use std::collections::BTreeSet;

type Vec3 = Vector3<f64>;

impl ClothTree {
    /// The same, where only triangles of `awake` nodes look for what they may meet: what sleeps meets nothing else that sleeps.
    #[must_use]
    pub fn waking(self, awake: &[bool]) -> Self {
        Self { awake: Some(self.awake(awake)), ..self }
    }

    /// Which branches and triangles have one of these nodes.
    fn awake(&self, nodes: &[bool]) -> Awake {
        let wakes = |t: &[u32; 3]| t.iter().any(|&v| nodes[v as usize]);
        let triangles: Vec<bool> = self.triangles.iter().map(wakes).collect();
        let mut branches = vec![false; self.branches.len()];
        for (k, b) in self.branches.iter().enumerate().rev() {
            let first = b.first as usize;
            branches[k] = match b.count {
                0 => branches[first] || branches[first + 1],
                n => triangles[first..first + n as usize].contains(&true),
            };
        }
        Awake { branches, triangles }
    }

    /// Those of [`ClothTree::pairs`] that have one of these nodes; each of them must be among those that look for others. Cost:
    /// O(n) for the boxes, and what is about the nodes.
    #[must_use]
    pub fn pairs_of(&self, nodes: &[bool], x: &[Vec3], moves: &[Vec3], reach: f64) -> Vec<Pair> {
        if nodes.iter().all(|n| *n) {
            return self.pairs(x, moves, reach);
        }
        let mut pairs = self.pairs_looked_for(Some(&self.awake(nodes)), x, moves, reach);
        pairs.retain(|p| p.nodes.iter().any(|&i| nodes[i as usize]));
        pairs
    }

    /// The tree of the triangles all of whose nodes are among `nodes`, ascending; `index` tells where in that list each node of
    /// the whole comes, and `layout` holds a place for each of the list. At least one triangle must be.
    #[must_use]
    pub fn part(&self, nodes: &[u32], index: &[u32], layout: &[Vec3]) -> Self {
        let own = |t: &[u32; 3]| t.map(|v| index[v as usize]);
        let is_known = |t: &[u32; 3]| t.iter().all(|&k| (k as usize) < nodes.len());
        let all: Vec<[u32; 3]> = self.triangles.iter().map(own).filter(is_known).collect();
        let (order, branches) = halves(&all, layout);
        let triangles: Vec<[u32; 3]> = order.iter().map(|&t| all[t as usize]).collect();
        let point = nodes.iter().map(|&i| self.point[i as usize]).collect();
        Self { owns: owners(&triangles), triangles, branches, point, awake: None }
    }

    /// Which nodes belong to triangles that may come nearer than `reach` to one that looks for others, at `x`; more are named than
    /// are that near, none is left out.
    #[must_use]
    pub fn about(&self, x: &[Vec3], reach: f64) -> Vec<bool> {
        let still = vec![Vec3::zeros(); x.len()];
        let boxes = self.swept(x, &still, reach);
        let search = Search { x, moves: &still, ways: &[], reach };
        let near = |s: usize, t: usize, out: &mut Vec<u32>| {
            let (a, b) = (&self.triangles[s], &self.triangles[t]);
            if !search.is_far(a, b) {
                out.extend(a.iter().chain(b));
            }
        };
        let mut named = vec![false; x.len()];
        let found = self.meetings(self.awake.as_ref(), &boxes, &self.fit(&boxes), &near);
        found.into_iter().for_each(|v| named[v as usize] = true);
        named
    }
}

impl Awake {
    /// Whether neither of two branches looks for others.
    pub(super) fn sleep(&self, a: u32, b: u32) -> bool {
        !self.branches[a as usize] && !self.branches[b as usize]
    }

    /// Whether neither of two triangles does.
    pub(super) fn are_still(&self, s: usize, t: usize) -> bool {
        !self.triangles[s] && !self.triangles[t]
    }
}

/// Corners and sides go to the first triangle that has them.
fn owners(triangles: &[[u32; 3]]) -> Vec<([bool; 3], [bool; 3])> {
    let (mut corners, mut sides) = (BTreeSet::new(), BTreeSet::new());
    let one = |t: &[u32; 3]| {
        let side = |k: usize| (t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3]));
        let own: [bool; 3] = std::array::from_fn(|k| corners.insert(t[k]));
        (own, std::array::from_fn(|k| sides.insert(side(k))))
    };
    triangles.iter().map(one).collect()
}
