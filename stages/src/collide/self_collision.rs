//! Cloth against itself: contacts, and how far vertices may move.
//!
//! Broad phase: self-traversal of the cloth's hierarchy. Narrow phase: each pair of triangles tests
//! the features it owns, after a cheap test of boxes. Cost O(n + pairs), about six pairs a
//! triangle for its neighbours alone.
//!
//! The bounds are those of offset geometric contact (Chen, Hsu, Yuksel et al. 2025) and, before
//! it, of Wu et al. 2020: two pieces at distance d cannot meet while all their vertices move by
//! less than d/2.

use super::cloth_tree::ClothTree;
use super::proximity::{Proximity, edge_edge, vertex_triangle};
use super::volume::{Aabb, BoundingVolume};
use toile_core::artifact::{Point3, SelfContact};

/// A pair of features that share no node, at less than the distance asked for.
struct Pair {
    nodes: [u32; 4],
    found: Proximity,
    kind: PairKind,
}

#[derive(Clone, Copy)]
enum PairKind {
    VertexTriangle,
    /// True where both closest points lie between the ends.
    EdgeEdge(bool),
}

/// Vertex-triangle and edge-edge contacts nearer than `reach`, each pair of closest features once.
pub(super) fn contacts<V: BoundingVolume>(
    tree: &ClothTree<V>,
    positions: &[Point3],
    reach: f64,
    out: &mut Vec<SelfContact>,
) {
    let (pairs, _) = close_pairs(tree, positions, reach);
    let mut keyed: Vec<([u32; 4], &Pair)> = pairs.iter().filter_map(|p| key(p).map(|k| (k, p))).collect();
    keyed.sort_unstable_by_key(|(key, p)| (*key, p.nodes));
    keyed.dedup_by_key(|(key, _)| *key);
    let mut edges: Vec<&Pair> = pairs.iter().filter(|p| matches!(p.kind, PairKind::EdgeEdge(true))).collect();
    edges.sort_unstable_by_key(|p| p.nodes);
    let mut vertices: Vec<&Pair> = keyed.into_iter().map(|(_, p)| p).collect();
    vertices.sort_unstable_by_key(|p| p.nodes);
    out.extend(vertices.into_iter().chain(edges).map(|p| SelfContact {
        vertices: p.nodes,
        weights: p.found.weights,
        normal: p.found.normal,
        distance: p.found.distance,
    }));
}

/// For each vertex the least distance of what it belongs to from anything else, at most `reach`.
pub(super) fn conservative_bounds<V: BoundingVolume>(
    tree: &ClothTree<V>,
    positions: &[Point3],
    reach: f64,
) -> Vec<f64> {
    let mut bounds = vec![reach; positions.len()];
    for pair in close_pairs(tree, positions, reach).0 {
        for node in pair.nodes {
            let bound = &mut bounds[node as usize];
            *bound = bound.min(pair.found.distance);
        }
    }
    bounds
}

/// How many pairs of volumes a query tests, and how many pairs of features it finds.
pub(super) fn count_tests<V: BoundingVolume>(
    tree: &ClothTree<V>,
    positions: &[Point3],
    reach: f64,
) -> (u64, usize) {
    let (pairs, tests) = close_pairs(tree, positions, reach);
    (tests, pairs.len())
}

/// What makes a vertex-triangle pair the same as another: the nodes that carry weight, whichever
/// triangle they were seen in and from whichever side. A side's end that carries none does not
/// count, or a vertex nearest to a corner would be found both there and on the side.
fn key(pair: &Pair) -> Option<[u32; 4]> {
    let PairKind::VertexTriangle = pair.kind else { return None };
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

fn close_pairs<V: BoundingVolume>(tree: &ClothTree<V>, positions: &[Point3], reach: f64) -> (Vec<Pair>, u64) {
    tree.bvh.self_pairs(reach, |a, b, out| {
        let narrow = Narrow { tree, positions, reach, out };
        narrow.triangles(a, b);
    })
}

/// The narrow phase of one pair of triangles.
struct Narrow<'a, V> {
    tree: &'a ClothTree<V>,
    positions: &'a [Point3],
    reach: f64,
    out: &'a mut Vec<Pair>,
}

impl<V> Narrow<'_, V> {
    fn triangles(mut self, a: u32, b: u32) {
        self.vertices_of(a, b);
        self.vertices_of(b, a);
        let (ta, tb) = (self.tree.triangles[a as usize], self.tree.triangles[b as usize]);
        for i in self.tree.owned[a as usize].edges() {
            for j in self.tree.owned[b as usize].edges() {
                self.edges([ta[i], ta[(i + 1) % 3]], [tb[j], tb[(j + 1) % 3]]);
            }
        }
    }

    /// The vertices that `a` owns against the triangle `b`.
    fn vertices_of(&mut self, a: u32, b: u32) {
        let (ta, tb) = (self.tree.triangles[a as usize], self.tree.triangles[b as usize]);
        for v in self.tree.owned[a as usize].corners().map(|k| ta[k]).filter(|v| !tb.contains(v)) {
            let (p, t) = (self.positions[v as usize], tb.map(|i| self.positions[i as usize]));
            if !Aabb::fit(&t).near(&Aabb { min: p, max: p }, self.reach) {
                continue;
            }
            let (found, _) = vertex_triangle(&p, &t);
            self.keep([v, tb[0], tb[1], tb[2]], found, PairKind::VertexTriangle);
        }
    }

    fn edges(&mut self, e: [u32; 2], f: [u32; 2]) {
        if e.contains(&f[0]) || e.contains(&f[1]) {
            return;
        }
        let (e, f) = (sorted(e), sorted(f));
        let (e, f) = if e <= f { (e, f) } else { (f, e) };
        let (a, b) = (e.map(|i| self.positions[i as usize]), f.map(|i| self.positions[i as usize]));
        if !Aabb::fit(&a).near(&Aabb::fit(&b), self.reach) {
            return;
        }
        let (found, inside) = edge_edge(&a, &b);
        self.keep([e[0], e[1], f[0], f[1]], found, PairKind::EdgeEdge(inside));
    }

    // Written so that a distance that is no number is not kept.
    fn keep(&mut self, nodes: [u32; 4], found: Proximity, kind: PairKind) {
        if found.distance < self.reach {
            self.out.push(Pair { nodes, found, kind });
        }
    }
}

fn sorted(e: [u32; 2]) -> [u32; 2] {
    [e[0].min(e[1]), e[0].max(e[1])]
}
