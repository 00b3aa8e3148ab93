//! Cloth against itself: a uniform grid finds triangles near each other, exact tests decide.
//!
//! Broad phase: each triangle's box, widened by half of the reach, is entered into the cells it
//! overlaps; the list of (cell, triangle) is sorted, and a pair is tested in the one cell that
//! holds the least corner of the boxes' overlap, so that it comes once. Narrow phase: each vertex
//! and edge is owned by the first triangle that has it (Curtis, Tamstorf, Manocha 2008), and a pair
//! of triangles tests what it owns. Cost: n log n for the sorting, then the pairs. Limits:
//! triangles of very different sizes share one cell size, the mean one's.

use crate::closest::{PieceProximity, edge_edge, vertex_triangle};
use rayon::prelude::*;
use robust::{Coord3D, orient3d};
use toile_core::artifact::{Point3, SelfContact, Vector3};

/// A cell is this many mean boxes wide.
const CELL: f64 = 1.5;
/// A triangle is in no more cells than this along an axis, whatever its size.
const MOST_CELLS: f64 = 64.0;
/// Cells that one parallel task takes.
const CHUNK: usize = 512;

#[derive(Debug, Clone, Copy)]
struct Box3 {
    low: Point3,
    high: Point3,
}

impl Box3 {
    fn of(points: &[Point3]) -> Self {
        let start = Box3 { low: points[0], high: points[0] };
        points.iter().fold(start, |b, p| Box3 { low: b.low.inf(p), high: b.high.sup(p) })
    }

    fn widened(&self, by: f64) -> Self {
        Box3 { low: self.low - Vector3::repeat(by), high: self.high + Vector3::repeat(by) }
    }

    fn meets(&self, other: &Box3) -> bool {
        (0..3).all(|a| self.low[a] <= other.high[a] && other.low[a] <= self.high[a])
    }
}

type CellIndex = [i32; 3];

/// What a triangle owns: corners, and edges from each corner to the next.
#[derive(Debug, Clone, Copy, Default)]
struct OwnedFeatures {
    corners: [bool; 3],
    edges: [bool; 3],
}

/// A cloth as it is asked about.
pub(crate) struct ClothCells<'a> {
    positions: &'a [Point3],
    triangles: &'a [[u32; 3]],
    reach: f64,
    boxes: Vec<Option<Box3>>,
    owned: Vec<OwnedFeatures>,
    cell: f64,
    low: Point3,
}

/// A pair of features nearer than the reach.
struct FeaturePair {
    nodes: [u32; 4],
    found: PieceProximity,
    kind: PairKind,
}

#[derive(Clone, Copy, PartialEq)]
enum PairKind {
    VertexTriangle,
    /// Both closest points lie between the ends.
    EdgesInside,
    EdgesAtEnds,
}

impl<'a> ClothCells<'a> {
    pub(crate) fn new(positions: &'a [Point3], triangles: &'a [[u32; 3]], reach: f64) -> Self {
        // A vertex that is no finite number takes its triangles with it.
        let usable = |t: &[u32; 3]| {
            let known =
                t.iter().all(|&i| positions.get(i as usize).is_some_and(|p| p.iter().all(|x| x.is_finite())));
            (known && t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
                .then(|| Box3::of(&t.map(|i| positions[i as usize])).widened(reach.max(0.0) / 2.0))
        };
        let boxes: Vec<Option<Box3>> = triangles.iter().map(usable).collect();
        let sides: Vec<f64> = boxes.iter().flatten().map(|b| (b.high - b.low).max()).collect();
        let mean = sides.iter().sum::<f64>() / sides.len().max(1) as f64;
        let largest = sides.iter().copied().fold(0.0, f64::max);
        let low = boxes.iter().flatten().fold(Point3::from([f64::INFINITY; 3]), |l, b| l.inf(&b.low));
        let high = boxes.iter().flatten().fold(low, |h, b| h.sup(&b.high));
        let whole = (high - low).amax();
        let cell = (CELL * mean).max(largest / MOST_CELLS).max(whole * 1e-6).max(f64::MIN_POSITIVE);
        let owned = ownership(triangles, &boxes, positions.len());
        ClothCells { positions, triangles, reach, boxes, owned, cell, low }
    }

    fn cell_of(&self, p: &Point3) -> CellIndex {
        let q = (p - self.low) / self.cell;
        [q.x.floor() as i32, q.y.floor() as i32, q.z.floor() as i32]
    }

    /// Visits every pair of usable triangles whose boxes meet, lower first; the order of what is
    /// pushed depends on the cloth alone.
    fn pairs<T: Send>(&self, visit: impl Fn(u32, u32, &mut Vec<T>) + Sync) -> Vec<T> {
        let mut entries: Vec<(CellIndex, u32)> = Vec::with_capacity(4 * self.boxes.len());
        for (t, b) in self.boxes.iter().enumerate().filter_map(|(t, b)| b.map(|b| (t, b))) {
            let (from, to) = (self.cell_of(&b.low), self.cell_of(&b.high));
            for x in from[0]..=to[0] {
                for y in from[1]..=to[1] {
                    entries.extend((from[2]..=to[2]).map(|z| ([x, y, z], t as u32)));
                }
            }
        }
        entries.par_sort_unstable();
        let cells: Vec<&[(CellIndex, u32)]> =
            entries.chunk_by(|a, b| a.0 == b.0).filter(|c| c.len() > 1).collect();
        let parts: Vec<Vec<T>> = cells
            .par_chunks(CHUNK)
            .map(|cells| {
                let mut out = Vec::new();
                cells.iter().for_each(|cell| self.pairs_of_cell(cell, &visit, &mut out));
                out
            })
            .collect();
        parts.into_iter().flatten().collect()
    }

    fn pairs_of_cell<T>(
        &self,
        cell: &[(CellIndex, u32)],
        visit: &impl Fn(u32, u32, &mut Vec<T>),
        out: &mut Vec<T>,
    ) {
        for (k, &(at, a)) in cell.iter().enumerate() {
            let Some(box_a) = &self.boxes[a as usize] else { continue };
            for &(_, b) in &cell[k + 1..] {
                let Some(box_b) = &self.boxes[b as usize] else { continue };
                if box_a.meets(box_b) && self.cell_of(&box_a.low.sup(&box_b.low)) == at {
                    visit(a, b, out);
                }
            }
        }
    }

    fn close_pairs(&self) -> Vec<FeaturePair> {
        self.pairs(|a, b, out| {
            self.vertices_of(a, b, out);
            self.vertices_of(b, a, out);
            self.edges_of(a, b, out);
        })
    }

    fn at(&self, i: u32) -> Point3 {
        self.positions[i as usize]
    }

    /// The vertices that `a` owns against the triangle `b`.
    fn vertices_of(&self, a: u32, b: u32, out: &mut Vec<FeaturePair>) {
        let (ta, tb) = (self.triangles[a as usize], self.triangles[b as usize]);
        let corners = tb.map(|i| self.at(i));
        let near = Box3::of(&corners).widened(self.reach);
        for v in (0..3).filter(|&k| self.owned[a as usize].corners[k]).map(|k| ta[k]) {
            let p = self.at(v);
            if !tb.contains(&v) && near.meets(&Box3 { low: p, high: p }) {
                let found = vertex_triangle(&p, &corners);
                self.keep([v, tb[0], tb[1], tb[2]], found, PairKind::VertexTriangle, out);
            }
        }
    }

    fn edges_of(&self, a: u32, b: u32, out: &mut Vec<FeaturePair>) {
        let side = |t: u32, k: usize| {
            let nodes = self.triangles[t as usize];
            let (i, j) = (nodes[k], nodes[(k + 1) % 3]);
            [i.min(j), i.max(j)]
        };
        let owned = |t: u32| (0..3).filter(move |&k| self.owned[t as usize].edges[k]);
        for e in owned(a).map(|k| side(a, k)) {
            let ends = e.map(|i| self.at(i));
            let near = Box3::of(&ends).widened(self.reach);
            for f in owned(b).map(|k| side(b, k)).filter(|f| !e.contains(&f[0]) && !e.contains(&f[1])) {
                if !near.meets(&Box3::of(&f.map(|i| self.at(i)))) {
                    continue;
                }
                let (e, f) = if e <= f { (e, f) } else { (f, e) };
                let (found, inside) = edge_edge(&e.map(|i| self.at(i)), &f.map(|i| self.at(i)));
                let kind = if inside { PairKind::EdgesInside } else { PairKind::EdgesAtEnds };
                self.keep([e[0], e[1], f[0], f[1]], found, kind, out);
            }
        }
    }

    fn keep(&self, nodes: [u32; 4], found: PieceProximity, kind: PairKind, out: &mut Vec<FeaturePair>) {
        if found.distance < self.reach {
            out.push(FeaturePair { nodes, found, kind });
        }
    }

    /// Contacts nearer than the reach, each pair of closest features once, in the order of the
    /// service.
    pub(crate) fn contacts(&self, out: &mut Vec<SelfContact>) {
        let pairs = self.close_pairs();
        let vertices = pairs.iter().filter(|p| p.kind == PairKind::VertexTriangle);
        let mut keyed: Vec<([u32; 4], &FeaturePair)> = vertices.map(|p| (features(p), p)).collect();
        keyed.sort_unstable_by_key(|(key, p)| (*key, p.nodes));
        keyed.dedup_by_key(|(key, _)| *key);
        let mut vertices: Vec<&FeaturePair> = keyed.into_iter().map(|(_, p)| p).collect();
        vertices.sort_unstable_by_key(|p| p.nodes);
        let mut edges: Vec<&FeaturePair> = pairs.iter().filter(|p| p.kind == PairKind::EdgesInside).collect();
        edges.sort_unstable_by_key(|p| p.nodes);
        out.extend(vertices.into_iter().chain(edges).map(|p| SelfContact {
            vertices: p.nodes,
            weights: p.found.weights,
            normal: p.found.normal,
            distance: p.found.distance,
        }));
    }

    /// For each vertex the least distance of what it belongs to from anything else, at most the
    /// reach.
    pub(crate) fn bounds(&self) -> Vec<f64> {
        let mut bounds = vec![self.reach; self.positions.len()];
        for pair in self.close_pairs() {
            for node in pair.nodes {
                let bound = &mut bounds[node as usize];
                *bound = bound.min(pair.found.distance);
            }
        }
        bounds
    }

    /// Pairs of triangles that cross, lower index first, ascending.
    pub(crate) fn crossings(&self) -> Vec<[u32; 2]> {
        let mut pairs = self.pairs(|a, b, out| {
            if self.cross(a, b) {
                out.push([a, b]);
            }
        });
        pairs.sort_unstable();
        pairs
    }

    /// True where an edge of one triangle pierces the other, the two sharing no node.
    fn cross(&self, a: u32, b: u32) -> bool {
        let (ta, tb) = (self.triangles[a as usize], self.triangles[b as usize]);
        let any = |s: [u32; 3], t: [u32; 3]| {
            let corners = t.map(|i| self.at(i));
            (0..3).map(|k| [s[k], s[(k + 1) % 3]]).any(|[i, j]| {
                !t.contains(&i) && !t.contains(&j) && pierces(&self.at(i), &self.at(j), &corners)
            })
        };
        any(ta, tb) || any(tb, ta)
    }
}

/// What makes a vertex-triangle pair the same as another: the nodes that carry weight, from
/// whichever side two single vertices were seen.
fn features(pair: &FeaturePair) -> [u32; 4] {
    const NONE: u32 = u32::MAX;
    let [v, t @ ..] = pair.nodes;
    let mut near = [0, 1, 2].map(|k| if pair.found.weights[k + 1] == 0.0 { NONE } else { t[k] });
    near.sort_unstable();
    match near {
        [w, NONE, NONE] => [v.min(w), v.max(w), NONE, NONE],
        [i, j, k] => [v, i, j, k],
    }
}

/// The first usable triangle that has a corner or an edge owns it.
fn ownership(triangles: &[[u32; 3]], boxes: &[Option<Box3>], vertices: usize) -> Vec<OwnedFeatures> {
    let mut owned = vec![OwnedFeatures::default(); triangles.len()];
    let mut taken = vec![false; vertices];
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for (t, nodes) in triangles.iter().enumerate().filter(|(t, _)| boxes[*t].is_some()) {
        for k in 0..3 {
            let (i, j) = (nodes[k], nodes[(k + 1) % 3]);
            edges.push((i.min(j), i.max(j), t, k));
            owned[t].corners[k] = !std::mem::replace(&mut taken[i as usize], true);
        }
    }
    edges.sort_unstable();
    edges.dedup_by_key(|e| (e.0, e.1));
    edges.iter().for_each(|&(_, _, t, k)| owned[t].edges[k] = true);
    owned
}

/// True where the open segment from `p` to `q` passes through the inside of the triangle; exact
/// signs (Shewchuk 1997), so touching is no crossing.
fn pierces(p: &Point3, q: &Point3, [a, b, c]: &[Point3; 3]) -> bool {
    let coord = |p: &Point3| Coord3D { x: p.x, y: p.y, z: p.z };
    let volume = |a, b, c, d| orient3d(coord(a), coord(b), coord(c), coord(d));
    let (sp, sq) = (volume(a, b, c, p), volume(a, b, c, q));
    if sp == 0.0 || sq == 0.0 || (sp > 0.0) == (sq > 0.0) {
        return false;
    }
    let around = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    around.iter().all(|s| *s > 0.0) || around.iter().all(|s| *s < 0.0)
}
