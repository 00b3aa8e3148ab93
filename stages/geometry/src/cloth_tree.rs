//! Which parts of a sheet may meet during a step: a tree of volumes over its triangles.
//!
//! The tree's shape is made once, best where the sheet lies flat; each query only fits the volumes
//! to the swept triangles. Each vertex and edge belongs to one triangle, so that every pair is
//! found once (representative triangles: Curtis, Tamstorf, Manocha 2008). Cost O(n + pairs): in a
//! sheet that touches nothing, some ten pairs a triangle, which the exact test then drops. Where
//! nothing moves, all volumes give the same pairs; where cloth moves, they differ in pairs that do
//! not come within reach.

mod lie;
mod part;
mod slab;

use crate::Vec3;
use crate::ccd::approach;
use crate::crossing::{self, pierces_clearly};
use crate::pair::{Kind, Pair};
use crate::tree::{Meeting, VolumeTree};
use crate::volume::{Aabb, BoundingVolume};
use rayon::prelude::*;

/// Triangles in a leaf: leaves are tested against the tree as a whole.
const LEAF_TRIANGLES: usize = 4;

/// The tree over one sheet.
#[derive(Debug, Clone)]
pub struct ClothTree<V = Aabb> {
    tree: VolumeTree,
    /// In the order of the tree.
    triangles: Vec<[u32; 3]>,
    /// The number of each as it was given.
    order: Vec<u32>,
    /// Which corners and which sides (k to k + 1) each triangle answers for.
    owns: Vec<Owned>,
    /// Nodes with equal numbers are sewn to each other, or about to be: their triangles are
    /// neighbours.
    point: Vec<u32>,
    /// Which parts and triangles look for others, where not all do.
    active: Option<Active>,
    volume: std::marker::PhantomData<V>,
}

/// Corners and sides (k to k + 1) that a triangle answers for.
type Owned = ([bool; 3], [bool; 3]);

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
        let triangles: Vec<[u32; 3]> = order.iter().map(|&t| all[t as usize]).collect();
        let owns = owners(&triangles, layout.len());
        let point = (0..layout.len() as u32).collect();
        Self { tree, triangles, order, owns, point, active: None, volume: std::marker::PhantomData }
    }

    /// The same, where nodes with equal numbers are about to be sewn: features that share one are
    /// no pair.
    #[must_use]
    pub fn sewing(self, point: Vec<u32>) -> Self {
        Self { point, ..self }
    }

    /// Whether a node is one of the others, or will be.
    fn is_one_of(&self, v: u32, others: &[u32]) -> bool {
        others.iter().any(|&o| self.point[o as usize] == self.point[v as usize])
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
        let mut pairs = self.meetings(active, &swept, reach, &|s, t, out| self.narrow(s, t, &search, out));
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
        self.triangles.par_iter().with_min_len(256).map(swept).collect()
    }

    /// The volumes of the triangles where they are.
    fn still(&self, x: &[Vec3]) -> Vec<V> {
        self.triangles.iter().map(|t| V::fit(&t.map(|v| x[v as usize]))).collect()
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
            !e.iter().any(|&v| self.is_one_of(v, t)) && pierces_clearly(&p, &q, &t.map(|v| x[v as usize]))
        };
        let crossing = |s: usize, t: usize, out: &mut Vec<_>| {
            let (s, t) = (&self.triangles[s], &self.triangles[t]);
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
        let nodes = |t: usize| self.triangles[t].map(|v| self.point[v as usize]);
        let corners = |t: usize| self.triangles[t].map(|v| x[v as usize]);
        let crossing = |s: usize, t: usize, out: &mut Vec<_>| {
            if crossing::cross_at(&nodes(s), &corners(s), &nodes(t), &corners(t)) {
                let (a, b) = (self.order[s], self.order[t]);
                out.push([a.min(b), a.max(b)]);
            }
        };
        let mut all = self.meetings(None, &self.still(x), 0.0, &crossing);
        all.sort_unstable();
        all
    }

    /// Adds the pairs of features that two triangles answer for and that may come within reach.
    fn narrow(&self, s: usize, t: usize, search: &PairSearch<'_>, out: &mut Vec<Pair>) {
        let (a, b) = (&self.triangles[s], &self.triangles[t]);
        if search.is_far(a, b) {
            return;
        }
        for (k, other, owner) in [(s, b, a), (t, a, b)] {
            for (own, v) in self.owns[k].0.iter().zip(owner) {
                if *own && !self.is_one_of(*v, other) {
                    let nodes = [*v, other[0], other[1], other[2]];
                    search.keep(Pair { kind: Kind::VertexTriangle, nodes }, out);
                }
            }
        }
        for i in (0..3).filter(|&i| self.owns[s].1[i]) {
            let e = [a[i], a[(i + 1) % 3]];
            for j in (0..3).filter(|&j| self.owns[t].1[j]) {
                let f = [b[j], b[(j + 1) % 3]];
                if !self.is_one_of(f[0], &e) && !self.is_one_of(f[1], &e) {
                    search.keep(Pair { kind: Kind::EdgeEdge, nodes: [e[0], e[1], f[0], f[1]] }, out);
                }
            }
        }
    }
}

/// What pairs are sought by.
struct PairSearch<'s> {
    x: &'s [Vec3],
    moves: &'s [Vec3],
    /// Lengths of the moves.
    ways: &'s [f64],
    reach: f64,
}

impl PairSearch<'_> {
    /// Keeps a pair that may come within reach; tests from cheap to exact.
    fn keep(&self, pair: Pair, out: &mut Vec<Pair>) {
        let at = pair.at(self.x);
        // No side approaches faster than its fastest node and the mean of all.
        let [a, b, c, d] = pair.nodes.map(|i| self.ways[i as usize]);
        let mean = 0.25 * (a + b + c + d);
        let (first, second) = match pair.kind {
            Kind::VertexTriangle => (a, b.max(c).max(d)),
            Kind::EdgeEdge => (a.max(b), c.max(d)),
        };
        if far(pair.kind, &at, self.reach + first + second + 2.0 * mean) {
            return;
        }
        let reach = self.reach + approach(pair.kind, &pair.at(self.moves));
        if !far(pair.kind, &at, reach) && pair.kind.closest(&at).distance < reach {
            out.push(pair);
        }
    }
}

/// A quick test that two features are further apart than `reach`: their boxes are.
fn far(kind: Kind, x: &[Vec3; 4], reach: f64) -> bool {
    let first = if kind == Kind::VertexTriangle { 1 } else { 2 };
    let (mut low, mut high) = (x[0], x[0]);
    x[1..first].iter().for_each(|p| (low, high) = (low.inf(p), high.sup(p)));
    let (mut low2, mut high2) = (x[3], x[3]);
    x[first..3].iter().for_each(|p| (low2, high2) = (low2.inf(p), high2.sup(p)));
    (0..3).any(|k| low[k] - high2[k] > reach || low2[k] - high[k] > reach)
}

/// Corners and sides go to the first triangle that has them.
fn owners(triangles: &[[u32; 3]], nodes: usize) -> Vec<Owned> {
    let mut owns = vec![([false; 3], [false; 3]); triangles.len()];
    let mut taken = vec![false; nodes];
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (k, (t, own)) in triangles.iter().zip(&mut owns).enumerate() {
        for c in 0..3 {
            let next = t[(c + 1) % 3];
            own.0[c] = !std::mem::replace(&mut taken[t[c] as usize], true);
            sides.push((t[c].min(next), t[c].max(next), k as u32, c as u8));
        }
    }
    sides.sort_unstable();
    sides.dedup_by_key(|s| (s.0, s.1));
    sides.iter().for_each(|&(_, _, k, c)| owns[k as usize].1[c as usize] = true);
    owns
}

#[cfg(test)]
mod tests;
