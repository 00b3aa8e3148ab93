//! Vertices and edges of triangles as they meet: each belongs to one triangle, so that every pair
//! of them is found once (representative triangles: Curtis, Tamstorf, Manocha 2008).
//!
//! Which triangles are near each other is found elsewhere: by [`ClothTree`](super::ClothTree), or
//! by another search, which hands its pairs to [`Features::pairs_among`]. O(n log n) to make, O(1)
//! a pair of triangles.

use crate::Vec3;
use crate::ccd::approach;
use crate::crossing;
use crate::pair::{Kind, Pair};
use rayon::prelude::*;

/// Pairs of triangles that one parallel task takes.
const CHUNK: usize = 512;

/// Corners and sides (k to k + 1) that are tested with this triangle, so that each is tested once.
pub(super) type Owned = ([bool; 3], [bool; 3]);

/// Triangles, and what each answers for.
#[derive(Debug, Clone)]
pub struct Features {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Which corners and which sides (k to k + 1) each triangle answers for.
    pub(super) owns: Vec<Owned>,
    /// Nodes with equal numbers are sewn to each other, or about to be: their triangles are
    /// neighbours.
    pub(super) point: Vec<u32>,
}

impl Features {
    /// Those of triangles that name three of so many nodes.
    #[must_use]
    pub fn of(triangles: Vec<[u32; 3]>, nodes: usize) -> Self {
        let owns = owners(&triangles, nodes);
        Self { triangles, owns, point: (0..nodes as u32).collect() }
    }

    pub(super) fn sewing(self, point: Vec<u32>) -> Self {
        Self { point, ..self }
    }

    /// Pairs nearer than `reach` at `x`, sorted, among pairs of triangles by number: of two
    /// triangles in one order alone, and no triangle with itself.
    #[must_use]
    pub fn pairs_among(&self, met: &[[u32; 2]], x: &[Vec3], reach: f64) -> Vec<Pair> {
        let still = vec![Vec3::zeros(); x.len()];
        let ways = vec![0.0; x.len()];
        let search = PairSearch { x, moves: &still, ways: &ways, reach };
        let of = |met: &[[u32; 2]]| {
            let mut out = Vec::new();
            met.iter().for_each(|&[s, t]| self.narrow(s as usize, t as usize, &search, &mut out));
            out
        };
        let mut pairs: Vec<Pair> = met.par_chunks(CHUNK).flat_map_iter(of).collect();
        pairs.par_sort_unstable();
        pairs
    }

    /// Whether an edge of one triangle pierces the inside of the other at `x`, by exact signs.
    /// Nodes that are sewn to each other count as one.
    #[must_use]
    pub fn cross(&self, s: usize, t: usize, x: &[Vec3]) -> bool {
        let nodes = |t: usize| self.triangles[t].map(|v| self.point[v as usize]);
        let corners = |t: usize| self.triangles[t].map(|v| x[v as usize]);
        crossing::cross_at(&nodes(s), &corners(s), &nodes(t), &corners(t))
    }

    /// Whether a node is one of the others, or will be.
    pub(super) fn is_one_of(&self, v: u32, others: &[u32]) -> bool {
        others.iter().any(|&o| self.point[o as usize] == self.point[v as usize])
    }

    /// Adds the pairs of features that two triangles answer for and that may come within reach.
    pub(super) fn narrow(&self, s: usize, t: usize, search: &PairSearch<'_>, out: &mut Vec<Pair>) {
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
pub(super) struct PairSearch<'s> {
    pub(super) x: &'s [Vec3],
    pub(super) moves: &'s [Vec3],
    /// Lengths of the moves.
    pub(super) ways: &'s [f64],
    pub(super) reach: f64,
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
