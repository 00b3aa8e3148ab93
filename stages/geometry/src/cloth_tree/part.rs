//! A part of the tree, and a tree of which only a part looks for others: for cloth that moves among
//! cloth that holds still.

use super::features::PairSearch;
use super::{Active, ClothTree};
use crate::Vec3;
use crate::pair::Pair;
use crate::volume::BoundingVolume;

impl<V: BoundingVolume> ClothTree<V> {
    /// The same, but only triangles with `active` nodes search for pairs: a pair without an active
    /// node is not found.
    #[must_use]
    pub fn with_active(self, active: &[bool]) -> Self {
        Self { active: Some(self.active(active)), ..self }
    }

    /// Which parts and triangles have one of these nodes.
    fn active(&self, nodes: &[bool]) -> Active {
        let has = |t: &[u32; 3]| t.iter().any(|&v| nodes[v as usize]);
        let triangles: Vec<bool> = self.features.triangles.iter().map(has).collect();
        let parts = self.tree.sweep(|r| triangles[r].contains(&true), |a, b| *a || *b);
        Active { parts, triangles }
    }

    /// Those of [`ClothTree::pairs`] that have one of these nodes; each of them must be among those
    /// that look for others. Cost: O(n) for the boxes, and what is about the nodes.
    #[must_use]
    pub fn pairs_of(&self, nodes: &[bool], x: &[Vec3], moves: &[Vec3], reach: f64) -> Vec<Pair> {
        if nodes.iter().all(|n| *n) {
            return self.pairs(x, moves, reach);
        }
        let mut pairs = self.pairs_looked_for(Some(&self.active(nodes)), x, moves, reach);
        pairs.retain(|p| p.nodes.iter().any(|&i| nodes[i as usize]));
        pairs
    }

    /// The tree of the triangles all of whose nodes are among `nodes`, ascending; `index` gives
    /// each node's position in that list, and `layout` has one entry for each node of the list. At
    /// least one triangle must be.
    #[must_use]
    pub fn part(&self, nodes: &[u32], index: &[u32], layout: &[Vec3]) -> Self {
        let own = |t: &[u32; 3]| t.map(|v| index[v as usize]);
        let is_known = |t: &[u32; 3]| t.iter().all(|&k| (k as usize) < nodes.len());
        let all: Vec<[u32; 3]> = self.features.triangles.iter().map(own).filter(is_known).collect();
        let part = Self::of(&all, layout);
        part.sewing(nodes.iter().map(|&i| self.features.point[i as usize]).collect())
    }

    /// Which nodes belong to triangles that may come nearer than `reach` to one that looks for
    /// others, at `x`; more are named than are that near, none is left out.
    #[must_use]
    pub fn about(&self, x: &[Vec3], reach: f64) -> Vec<bool> {
        let still = vec![Vec3::zeros(); x.len()];
        let search = PairSearch { x, moves: &still, ways: &[], reach };
        let near = |s: usize, t: usize, out: &mut Vec<u32>| {
            let (a, b) = (&self.features.triangles[s], &self.features.triangles[t]);
            if !search.is_far(a, b) {
                out.extend(a.iter().chain(b));
            }
        };
        let mut named = vec![false; x.len()];
        let found = self.meetings(self.active.as_ref(), &self.still(x), reach, &near);
        found.into_iter().for_each(|v| named[v as usize] = true);
        named
    }
}
