//! Cloth against itself: contacts, and how far vertices may move.
//!
//! Pairs come from a [`ClothSearch`], about six per triangle for its neighbours alone; cost O(n +
//! pairs).
//!
//! The bounds are those of offset geometric contact (Chen, Hsu, Yuksel et al. 2025) and, before
//! it, of Wu et al. 2020: two pieces at distance d cannot meet while all their vertices move by
//! less than d/2.

use super::proximity::{Proximity, edge_edge, vertex_triangle};
use super::search::ClothSearch;
use toile_core::artifact::SelfContact;
use toile_geometry::Vec3;
use toile_geometry::pair::{Kind, Pair};

/// A cloth as it is asked about: places, which may be no finite numbers, and triangles, which may
/// name vertices that there are not.
pub(super) struct SearchedCloth<'a, C> {
    /// Places, m.
    pub(super) x: &'a [Vec3],
    /// Those of its triangles that can be used, with their numbers.
    pub(super) usable: &'a [(u32, [u32; 3])],
    /// The search over these.
    pub(super) search: &'a C,
}

/// Pairs that share no node, nearer than `reach`, with their closest points.
struct NearPair {
    nodes: [u32; 4],
    found: Proximity,
    kind: NearKind,
}

#[derive(Clone, Copy)]
enum NearKind {
    VertexTriangle,
    /// True where both closest points lie between the ends.
    EdgeEdge(bool),
}

/// The triangles of three nodes that there are, with their numbers.
pub(super) fn usable(triangles: &[[u32; 3]], nodes: usize) -> Vec<(u32, [u32; 3])> {
    let is_usable = |t: &[u32; 3]| {
        t.iter().all(|&i| (i as usize) < nodes) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]
    };
    (0..).zip(triangles.iter().copied()).filter(|(_, t)| is_usable(t)).collect()
}

/// The search over usable triangles.
pub(super) fn search<C: ClothSearch>(x: &[Vec3], usable: &[(u32, [u32; 3])]) -> C {
    let triangles: Vec<[u32; 3]> = usable.iter().map(|u| u.1).collect();
    C::over(&finite(x), &triangles)
}

/// The places, the origin for one that is no finite number, so that volumes stay finite.
fn finite(x: &[Vec3]) -> Vec<Vec3> {
    x.iter().map(|p| if is_finite(p) { *p } else { Vec3::zeros() }).collect()
}

fn is_finite(p: &Vec3) -> bool {
    p.iter().all(|c| c.is_finite())
}

impl<C: ClothSearch> SearchedCloth<'_, C> {
    /// Vertex-triangle and edge-edge contacts nearer than `reach`, each pair of closest features
    /// once.
    pub(super) fn contacts(&self, reach: f64, out: &mut Vec<SelfContact>) {
        let pairs = self.near(reach);
        let mut keyed: Vec<([u32; 4], &NearPair)> =
            pairs.iter().filter_map(|p| key(p).map(|k| (k, p))).collect();
        keyed.sort_unstable_by_key(|(key, p)| (*key, p.nodes));
        keyed.dedup_by_key(|(key, _)| *key);
        let mut edges: Vec<&NearPair> =
            pairs.iter().filter(|p| matches!(p.kind, NearKind::EdgeEdge(true))).collect();
        edges.sort_unstable_by_key(|p| p.nodes);
        let mut vertices: Vec<&NearPair> = keyed.into_iter().map(|(_, p)| p).collect();
        vertices.sort_unstable_by_key(|p| p.nodes);
        out.extend(vertices.into_iter().chain(edges).map(|p| SelfContact {
            vertices: p.nodes,
            weights: p.found.weights,
            normal: p.found.normal,
            distance: p.found.distance,
        }));
    }

    /// For each vertex the least distance of what it belongs to from anything else, at most
    /// `reach`.
    pub(super) fn conservative_bounds(&self, reach: f64) -> Vec<f64> {
        let mut bounds = vec![reach; self.x.len()];
        for pair in self.near(reach) {
            for node in pair.nodes {
                let bound = &mut bounds[node as usize];
                *bound = bound.min(pair.found.distance);
            }
        }
        bounds
    }

    /// Pairs of triangles that cross, lower number first, ascending.
    pub(super) fn crossings(&self) -> Vec<[u32; 2]> {
        let found = self.search.crossings(&finite(self.x));
        let known = |k: &u32| self.usable[*k as usize].1.iter().all(|&v| is_finite(&self.x[v as usize]));
        found
            .into_iter()
            .filter(|p| p.iter().all(known))
            .map(|p| p.map(|k| self.usable[k as usize].0))
            .collect()
    }

    fn near(&self, reach: f64) -> Vec<NearPair> {
        let x = finite(self.x);
        let pairs = self.search.pairs(&x, reach);
        pairs
            .iter()
            .filter(|p| p.nodes.iter().all(|&i| is_finite(&self.x[i as usize])))
            .map(|p| near(p, &x))
            .collect()
    }
}

/// A pair's closest points; edges in the order of their nodes.
fn near(pair: &Pair, x: &[Vec3]) -> NearPair {
    let at = |i: u32| x[i as usize];
    let [a, b, c, d] = pair.nodes;
    match pair.kind {
        Kind::VertexTriangle => {
            let found = vertex_triangle(&at(a), &[b, c, d].map(at)).0;
            NearPair { nodes: pair.nodes, found, kind: NearKind::VertexTriangle }
        }
        Kind::EdgeEdge => {
            let (e, f) = (sorted([a, b]), sorted([c, d]));
            let (e, f) = if e <= f { (e, f) } else { (f, e) };
            let (found, inside) = edge_edge(&e.map(at), &f.map(at));
            NearPair { nodes: [e[0], e[1], f[0], f[1]], found, kind: NearKind::EdgeEdge(inside) }
        }
    }
}

/// What makes a vertex-triangle pair the same as another: the nodes that carry weight, whichever
/// triangle they were seen in and from whichever side. A side's end that carries none does not
/// count, or a vertex nearest to a corner would be found both there and on the side.
fn key(pair: &NearPair) -> Option<[u32; 4]> {
    let NearKind::VertexTriangle = pair.kind else { return None };
    const NONE: u32 = u32::MAX;
    let [v, t @ ..] = pair.nodes;
    let weight = |k: usize| pair.found.weights[k + 1];
    let mut near = [0, 1, 2].map(|k| if weight(k) == 0.0 { NONE } else { t[k] });
    near.sort_unstable();
    Some(match near {
        [w, NONE, NONE] => [v.min(w), v.max(w), NONE, NONE],
        [i, j, k] => [v, i, j, k],
    })
}

fn sorted(e: [u32; 2]) -> [u32; 2] {
    [e[0].min(e[1]), e[0].max(e[1])]
}
