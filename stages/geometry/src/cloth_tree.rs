//! Which parts of a sheet may meet during a step: a tree of volumes over its triangles.
//!
//! The tree's shape is made once, best where the sheet lies flat; each query only fits the volumes
//! to the swept triangles. Each vertex and edge belongs to one triangle, so that every pair is
//! found once (representative triangles: Curtis, Tamstorf, Manocha 2008). Cost O(n + pairs): in a
//! sheet that touches nothing, some ten pairs a triangle, which the exact test then drops. Where
//! nothing moves, all volumes give the same pairs; where cloth moves, they differ in pairs that do
//! not come within reach.

pub mod features;
mod lie;
mod part;
mod slab;

use crate::Vec3;
use crate::crossing::pierces_clearly;
use crate::pair::Pair;
use crate::tree::{Meeting, VolumeTree};
use crate::volume::{Aabb, BoundingVolume};
use features::{Features, PairSearch};
use rayon::prelude::*;

/// Triangles in a leaf: leaves are tested against the tree as a whole.
const LEAF_TRIANGLES: usize = 4;

/// The tree over one sheet.
#[derive(Debug, Clone)]
pub struct ClothTree<V = Aabb> {
    tree: VolumeTree,
    /// Of the triangles in the order of the tree.
    features: Features,
    /// The number of each triangle as it was given.
    order: Vec<u32>,
    /// Which parts and triangles look for others, where not all do.
    active: Option<Active>,
    volume: std::marker::PhantomData<V>,
}

/// What of a tree looks for others.
#[derive(Debug, Clone)]
struct Active {
    parts: Vec<bool>,
    triangles: Vec<bool>,
}

impl ClothTree {
    /// Builds the tree with boxes along the axes; `layout` holds a place for each node, best where
    /// the sheet lies flat.
    #[must_use]
    pub fn new(triangles: &[[u32; 3]], layout: &[Vec3]) -> Self {
        Self::of(triangles, layout)
    }
}

impl<V: BoundingVolume> ClothTree<V> {
    /// Builds the tree; `layout` holds a finite place for each node, and triangles name three nodes
    /// that there are.
    #[must_use]
    pub fn of(all: &[[u32; 3]], layout: &[Vec3]) -> Self {
        let corners: Vec<[Vec3; 3]> = all.iter().map(|t| t.map(|v| layout[v as usize])).collect();
        let (tree, order) = VolumeTree::over(&corners, LEAF_TRIANGLES);
        let triangles = order.iter().map(|&t| all[t as usize]).collect();
        let features = Features::of(triangles, layout.len());
        Self { tree, features, order, active: None, volume: std::marker::PhantomData }
    }

    /// The same, where nodes with equal numbers are about to be sewn: features that share one are
    /// no pair.
    #[must_use]
    pub fn sewing(self, point: Vec<u32>) -> Self {
        Self { features: self.features.sewing(point), ..self }
    }

    /// Pairs that may come nearer than `reach` while the nodes move from `x` by `moves`, sorted.
    #[must_use]
    pub fn pairs(&self, x: &[Vec3], moves: &[Vec3], reach: f64) -> Vec<Pair> {
        self.pairs_looked_for(self.active.as_ref(), x, moves, reach)
    }

    /// The same, where only what is active looks for others.
    fn pairs_looked_for(&self, active: Option<&Active>, x: &[Vec3], moves: &[Vec3], reach: f64) -> Vec<Pair> {
        let ways: Vec<f64> = moves.iter().map(Vec3::norm).collect();
        let search = PairSearch { x, moves, ways: &ways, reach };
        let swept = self.swept(x, moves);
        let mut pairs =
            self.meetings(active, &swept, reach, &|s, t, out| self.features.narrow(s, t, &search, out));
        pairs.par_sort_unstable();
        pairs
    }

    /// The volumes of the triangles on their way.
    fn swept(&self, x: &[Vec3], moves: &[Vec3]) -> Vec<V> {
        let swept = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| x[v as usize]);
            let [d, e, f] = t.map(|v| x[v as usize] + moves[v as usize]);
            V::fit(&[a, b, c, d, e, f])
        };
        self.features.triangles.par_iter().with_min_len(256).map(swept).collect()
    }

    /// The volumes of the triangles where they are.
    fn still(&self, x: &[Vec3]) -> Vec<V> {
        self.features.triangles.iter().map(|t| V::fit(&t.map(|v| x[v as usize]))).collect()
    }

    /// What `visit` adds for every pair of triangles whose volumes are within reach; where not all
    /// look for others, of those that do.
    fn meetings<T: Send>(
        &self,
        active: Option<&Active>,
        things: &[V],
        reach: f64,
        visit: &(dyn Fn(usize, usize, &mut Vec<T>) + Sync),
    ) -> Vec<T> {
        let parts = &self.tree.fit(things);
        let active = active.map(|a| (&a.parts[..], &a.triangles[..]));
        self.tree.meetings(&Meeting { parts, things, reach, active, visit })
    }

    /// Triangles that cross at `x`: pairs of an edge of one and the inside of another, sorted. Ends
    /// that lie in a triangle's plane but for rounding do not cross it: cloth that lies flat does
    /// not cross itself.
    #[must_use]
    pub fn crossings(&self, x: &[Vec3]) -> Vec<([u32; 2], [u32; 3])> {
        let crosses = |e: [u32; 2], t: &[u32; 3]| {
            let [p, q] = e.map(|v| x[v as usize]);
            !e.iter().any(|&v| self.features.is_one_of(v, t))
                && pierces_clearly(&p, &q, &t.map(|v| x[v as usize]))
        };
        let crossing = |s: usize, t: usize, out: &mut Vec<_>| {
            let (s, t) = (&self.features.triangles[s], &self.features.triangles[t]);
            for (a, b) in [(s, t), (t, s)] {
                let sides = (0..3).map(|k| [a[k], a[(k + 1) % 3]]);
                out.extend(sides.filter(|e| crosses(*e, b)).map(|e| (e, *b)));
            }
        };
        let mut all = self.meetings(self.active.as_ref(), &self.still(x), 0.0, &crossing);
        all.iter_mut().for_each(|(e, _)| e.sort_unstable());
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Pairs of triangles of which an edge of one pierces the inside of the other at `x`, by exact
    /// signs: their numbers as they were given, lower first, ascending. Nodes that are sewn to each
    /// other count as one.
    #[must_use]
    pub fn exact_crossings(&self, x: &[Vec3]) -> Vec<[u32; 2]> {
        let crossing = |s: usize, t: usize, out: &mut Vec<_>| {
            if self.features.cross(s, t, x) {
                let (a, b) = (self.order[s], self.order[t]);
                out.push([a.min(b), a.max(b)]);
            }
        };
        let mut all = self.meetings(None, &self.still(x), 0.0, &crossing);
        all.sort_unstable();
        all
    }
}

#[cfg(test)]
mod tests;
