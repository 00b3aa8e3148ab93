//! Which parts of a sheet may meet during a step: a tree of boxes over its triangles.
//!
//! The tree's shape is made once, where the sheet lies flat; each step only refits the boxes to the swept triangles. Each
//! vertex and edge belongs to one triangle, so that every pair is found once (Curtis, Tamstorf, Manocha 2008). Cost
//! O(n + pairs): in a sheet that touches nothing, some ten pairs a triangle, which the exact test then drops.

mod lie;
mod meet;
mod over;
mod part;
mod slab;

pub(super) use over::Over;

use super::ccd::approach;
use super::pair::{Kind, Pair};
use crate::mesh::Sheet;
use nalgebra::Vector3;
use rayon::prelude::*;

type Vec3 = Vector3<f64>;

/// Triangles in a leaf: leaves are tested against the tree as a whole.
const LEAF_TRIANGLES: usize = 4;

/// An end nearer than this to a triangle's plane lies in it: cloth that lies flat does not cross itself, m.
const FLAT: f64 = 1e-9;

#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub(super) low: Vec3,
    pub(super) high: Vec3,
}

impl Bounds {
    pub(super) fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }

    pub(super) fn with(&self, other: &Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }
}

/// A part of the tree: a leaf's triangles, or the left child; the right one follows it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Branch {
    pub(super) first: u32,
    pub(super) count: u32,
}

/// The tree over one sheet.
#[derive(Debug, Clone)]
pub struct ClothTree {
    triangles: Vec<[u32; 3]>,
    /// Which corners and which sides (k to k + 1) each triangle answers for.
    owns: Vec<([bool; 3], [bool; 3])>,
    branches: Vec<Branch>,
    /// Nodes with equal numbers are sewn to each other, or about to be: their triangles are neighbours.
    point: Vec<u32>,
    /// Which branches and triangles look for others, where not all do.
    awake: Option<Awake>,
}

/// What of a tree looks for others.
#[derive(Debug, Clone)]
struct Awake {
    branches: Vec<bool>,
    triangles: Vec<bool>,
}

impl ClothTree {
    /// Builds the tree; `layout` holds a place for each node, best where the sheet lies flat.
    #[must_use]
    pub fn new(sheet: &Sheet, layout: &[Vec3]) -> Self {
        let all = sheet.triangles();
        let (order, branches) = halves(all, layout);
        let triangles: Vec<[u32; 3]> = order.iter().map(|&t| all[t as usize]).collect();
        let mut place = vec![0u32; all.len()];
        order.iter().enumerate().for_each(|(k, &t)| place[t as usize] = k as u32);
        let owns = ownership(sheet, &triangles, &place);
        let point = (0..layout.len() as u32).collect();
        Self { triangles, owns, branches, point, awake: None }
    }

    /// The same, where nodes with equal numbers are about to be sewn: features that share one are no pair.
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
        self.pairs_looked_for(self.awake.as_ref(), x, moves, reach)
    }

    /// The same, where only what is awake looks for others.
    fn pairs_looked_for(&self, awake: Option<&Awake>, x: &[Vec3], moves: &[Vec3], reach: f64) -> Vec<Pair> {
        let boxes = self.swept(x, moves, reach);
        let fitted = self.fit(&boxes);
        let ways: Vec<f64> = moves.iter().map(Vec3::norm).collect();
        let search = Search { x, moves, ways: &ways, reach };
        let mut pairs = self.meetings(awake, &boxes, &fitted, &|s, t, out| self.narrow(s, t, &search, out));
        pairs.par_sort_unstable();
        pairs
    }

    /// The boxes of the triangles on their way, wider by half of `reach`.
    fn swept(&self, x: &[Vec3], moves: &[Vec3], reach: f64) -> Vec<Bounds> {
        let margin = Vec3::repeat(0.5 * reach);
        let swept = |t: &[u32; 3]| {
            let mut b = Bounds { low: x[t[0] as usize], high: x[t[0] as usize] };
            for &v in t {
                let (p, q) = (x[v as usize], x[v as usize] + moves[v as usize]);
                b = Bounds { low: b.low.inf(&p).inf(&q), high: b.high.sup(&p).sup(&q) };
            }
            Bounds { low: b.low - margin, high: b.high + margin }
        };
        self.triangles.par_iter().with_min_len(256).map(swept).collect()
    }

    /// Triangles that cross at `x`: pairs of an edge of one and the inside of another, sorted.
    #[must_use]
    pub fn crossings(&self, x: &[Vec3]) -> Vec<([u32; 2], [u32; 3])> {
        let still = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| x[v as usize]);
            Bounds { low: a.inf(&b).inf(&c), high: a.sup(&b).sup(&c) }
        };
        let boxes: Vec<Bounds> = self.triangles.iter().map(still).collect();
        let fitted = self.fit(&boxes);
        let crossing = |s: usize, t: usize, out: &mut Vec<_>| {
            for (a, b) in [(&self.triangles[s], &self.triangles[t]), (&self.triangles[t], &self.triangles[s])]
            {
                out.extend(
                    (0..3)
                        .map(|k| [a[k], a[(k + 1) % 3]])
                        .filter(|e| !e.iter().any(|&v| self.is_one_of(v, b)) && crosses(*e, b, x))
                        .map(|e| (e, *b)),
                );
            }
        };
        let mut all = self.meetings(self.awake.as_ref(), &boxes, &fitted, &crossing);
        all.iter_mut().for_each(|(e, _)| e.sort_unstable());
        all.sort_unstable();
        all.dedup();
        all
    }

    fn fit(&self, boxes: &[Bounds]) -> Vec<Bounds> {
        let mut fitted = vec![Bounds { low: Vec3::zeros(), high: Vec3::zeros() }; self.branches.len()];
        for (k, b) in self.branches.iter().enumerate().rev() {
            let first = b.first as usize;
            fitted[k] = match b.count {
                0 => fitted[first].with(&fitted[first + 1]),
                n => boxes[first + 1..first + n as usize].iter().fold(boxes[first], |a, b| a.with(b)),
            };
        }
        fitted
    }

    /// Adds the pairs of features that two triangles answer for and that may come within reach.
    fn narrow(&self, s: usize, t: usize, search: &Search<'_>, out: &mut Vec<Pair>) {
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
struct Search<'s> {
    x: &'s [Vec3],
    moves: &'s [Vec3],
    /// Lengths of the moves.
    ways: &'s [f64],
    reach: f64,
}

impl Search<'_> {
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

/// Whether the edge passes through the triangle; features that share a node do not count.
fn crosses(e: [u32; 2], t: &[u32; 3], x: &[Vec3]) -> bool {
    let (p, q) = (x[e[0] as usize], x[e[1] as usize]);
    let [a, b, c] = t.map(|v| x[v as usize]);
    let volume = |o: &Vec3, u: &Vec3, v: &Vec3, w: &Vec3| (u - o).dot(&(v - o).cross(&(w - o)));
    let area = (b - a).cross(&(c - a)).norm();
    let (under, over) = (volume(&p, &a, &b, &c), volume(&q, &a, &b, &c));
    if under * over >= 0.0 || under.abs().min(over.abs()) < FLAT * area {
        return false;
    }
    let sides = [volume(&p, &q, &a, &b), volume(&p, &q, &b, &c), volume(&p, &q, &c, &a)];
    sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)
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

/// The order of the triangles in the tree, and its branches.
pub(super) fn halves(all: &[[u32; 3]], layout: &[Vec3]) -> (Vec<u32>, Vec<Branch>) {
    let centres: Vec<Vec3> =
        all.iter().map(|t| t.iter().map(|&v| layout[v as usize]).sum::<Vec3>() / 3.0).collect();
    let mut order: Vec<u32> = (0..all.len() as u32).collect();
    let mut branches = vec![Branch { first: 0, count: 0 }];
    split(0, &mut order, 0, &centres, &mut branches);
    (order, branches)
}

fn split(k: usize, order: &mut [u32], offset: usize, centres: &[Vec3], branches: &mut Vec<Branch>) {
    if order.len() <= LEAF_TRIANGLES {
        branches[k] = Branch { first: offset as u32, count: order.len() as u32 };
        return;
    }
    let (mut low, mut high) = (centres[order[0] as usize], centres[order[0] as usize]);
    order.iter().for_each(|&t| (low, high) = (low.inf(&centres[t as usize]), high.sup(&centres[t as usize])));
    let axis = (high - low).imax();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&a, &b| {
        centres[a as usize][axis].total_cmp(&centres[b as usize][axis]).then(a.cmp(&b))
    });
    let left = branches.len();
    branches[k] = Branch { first: left as u32, count: 0 };
    branches.extend([Branch { first: 0, count: 0 }; 2]);
    let (a, b) = order.split_at_mut(half);
    split(left, a, offset, centres, branches);
    split(left + 1, b, offset + half, centres, branches);
}

fn ownership(sheet: &Sheet, triangles: &[[u32; 3]], place: &[u32]) -> Vec<([bool; 3], [bool; 3])> {
    let mut owns = vec![([false; 3], [false; 3]); triangles.len()];
    let mut seen = vec![false; sheet.vertex_count()];
    for (t, own) in triangles.iter().zip(&mut owns) {
        for c in 0..3 {
            own.0[c] = !std::mem::replace(&mut seen[t[c] as usize], true);
        }
    }
    for edge in sheet.edges() {
        let k = place[edge.sides.0.triangle as usize] as usize;
        // The side opposite corner c runs from corner c + 1.
        owns[k].1[(edge.sides.0.corner as usize + 1) % 3] = true;
    }
    owns
}
