//! A binary tree of bounding volumes over triangles.
//!
//! Built top-down by the surface-area heuristic on 12 bins along the longest axis (Wald 2007), in
//! an order that depends on the input alone; O(n log n). Nodes lie in depth-first order, so a
//! refit is one backward sweep. The tree knows triangles by number; their corners come from the
//! caller.
//!
//! Limits: up to 2^32 triangles. Depth stays under [`MAX_DEPTH`] + 32, so recursion is safe.

use super::volume::{Aabb, BoundingVolume};
use rayon::prelude::*;
use toile_core::artifact::Point3;

/// Bins of the surface-area heuristic: more make slightly better trees, slower.
const BINS: usize = 12;

/// Depth from which on nodes are halved by count, whatever the heuristic says.
const MAX_DEPTH: usize = 40;

/// Pairs that a self-traversal is split into before it goes parallel: enough for many cores,
/// and the same for any number of threads.
const TASKS: usize = 256;

/// Leaves that one parallel task of a refit takes at least.
const REFIT_CHUNK: usize = 512;

/// The corners of a triangle.
pub type Corners = [Point3; 3];

#[derive(Debug, Clone, Copy)]
struct Node {
    /// First item of a leaf.
    first: u32,
    /// Number of items; 0 for an inner node, whose left child follows it.
    count: u32,
    /// Right child of an inner node.
    right: u32,
}

/// The tree.
#[derive(Debug, Clone)]
pub struct Bvh<V> {
    nodes: Vec<Node>,
    volumes: Vec<V>,
    items: Vec<u32>,
}

impl<V: BoundingVolume> Bvh<V> {
    /// The tree over `items`, at most `leaf` of them together, each node fitted to its points.
    pub fn fitted(items: Vec<u32>, leaf: usize, corners: impl Fn(u32) -> Corners + Sync) -> Self {
        let mut tree = Self::topology(items, leaf, &corners);
        let ranges = tree.ranges();
        let fit = |&(from, to): &(u32, u32)| {
            let points: Vec<Point3> =
                tree.items[from as usize..to as usize].iter().flat_map(|&i| corners(i)).collect();
            V::fit(&points)
        };
        tree.volumes = ranges.par_iter().map(fit).collect();
        tree
    }

    /// The tree over `items` with its inner volumes merged from their children.
    pub fn merged(items: Vec<u32>, leaf: usize, corners: impl Fn(u32) -> Corners + Sync) -> Self {
        let mut tree = Self::topology(items, leaf, &corners);
        tree.refit(corners);
        tree
    }

    fn topology(mut items: Vec<u32>, leaf: usize, corners: &(impl Fn(u32) -> Corners + Sync)) -> Self {
        let count = items.iter().max().map_or(0, |&m| m as usize + 1);
        let mut boxes = vec![Aabb::empty(); count];
        items.iter().for_each(|&i| boxes[i as usize] = Aabb::fit(&corners(i)));
        let mut nodes = Vec::with_capacity(2 * items.len());
        if !items.is_empty() {
            grow(&mut nodes, &mut items, 0, leaf.max(1), &boxes, 0);
        }
        Bvh { nodes, volumes: Vec::new(), items }
    }

    /// The items below each node, as a range.
    fn ranges(&self) -> Vec<(u32, u32)> {
        let mut ranges = vec![(0, 0); self.nodes.len()];
        for (i, node) in self.nodes.iter().enumerate().rev() {
            ranges[i] = match node.count {
                0 => (ranges[i + 1].0, ranges[node.right as usize].1),
                n => (node.first, node.first + n),
            };
        }
        ranges
    }

    /// Fits all volumes to moved triangles.
    pub fn refit(&mut self, corners: impl Fn(u32) -> Corners + Sync) {
        let leaf = |points: &mut Vec<Point3>, node: &Node| match node.count {
            0 => None,
            n => {
                let items = &self.items[node.first as usize..(node.first + n) as usize];
                points.clear();
                points.extend(items.iter().flat_map(|&i| corners(i)));
                Some(V::fit(points))
            }
        };
        let mut volumes: Vec<Option<V>> =
            self.nodes.par_iter().with_min_len(REFIT_CHUNK).map_init(Vec::new, leaf).collect();
        for (i, node) in self.nodes.iter().enumerate().rev().filter(|(_, n)| n.count == 0) {
            volumes[i] = match (&volumes[i + 1], &volumes[node.right as usize]) {
                (Some(a), Some(b)) => Some(a.merge(b)),
                _ => None,
            };
        }
        // Every leaf has an item, so none is left out.
        self.volumes = Vec::with_capacity(volumes.len());
        self.volumes.extend(volumes.into_iter().flatten());
    }

    /// The volume around everything; `None` for an empty tree.
    pub fn root(&self) -> Option<&V> {
        self.volumes.first()
    }

    /// The sum of all volumes' sizes: how loose the tree is.
    pub fn looseness(&self) -> f64 {
        self.volumes.iter().map(V::size).sum()
    }

    fn children(&self, node: u32) -> Option<(u32, u32)> {
        let n = self.nodes[node as usize];
        (n.count == 0).then_some((node + 1, n.right))
    }

    fn leaf_items(&self, node: u32) -> &[u32] {
        let n = self.nodes[node as usize];
        &self.items[n.first as usize..(n.first + n.count) as usize]
    }

    /// Visits the items nearest to `p` first. `visit` takes an item and the squared distance beyond
    /// which nothing matters, and returns that bound, lowered where the item is nearer.
    pub fn nearest(&self, p: &Point3, bound: f64, mut visit: impl FnMut(u32, f64) -> f64) {
        if self.root().is_some_and(|root| root.distance_squared(p) <= bound) {
            self.nearest_below(0, p, bound, &mut visit);
        }
    }

    fn nearest_below(
        &self,
        node: u32,
        p: &Point3,
        bound: f64,
        visit: &mut impl FnMut(u32, f64) -> f64,
    ) -> f64 {
        let Some((l, r)) = self.children(node) else {
            return self.leaf_items(node).iter().fold(bound, |bound, &i| visit(i, bound));
        };
        let dl = self.volumes[l as usize].distance_squared(p);
        let dr = self.volumes[r as usize].distance_squared(p);
        let ((near, dn), (far, df)) = if dl <= dr { ((l, dl), (r, dr)) } else { ((r, dr), (l, dl)) };
        let mut bound = bound;
        // At equal distance both sides are looked into: the caller settles ties by number.
        if dn <= bound {
            bound = self.nearest_below(near, p, bound, visit);
        }
        if df <= bound {
            bound = self.nearest_below(far, p, bound, visit);
        }
        bound
    }

    /// Visits the items whose leaves are within `reach` of a volume, in the order of the tree.
    pub fn within(&self, volume: &V, reach: f64, mut visit: impl FnMut(u32)) {
        if !self.nodes.is_empty() {
            self.within_below(0, volume, reach, &mut visit);
        }
    }

    fn within_below(&self, node: u32, volume: &V, reach: f64, visit: &mut impl FnMut(u32)) {
        if !self.volumes[node as usize].near(volume, reach) {
            return;
        }
        match self.children(node) {
            Some((l, r)) => {
                self.within_below(l, volume, reach, visit);
                self.within_below(r, volume, reach, visit);
            }
            None => self.leaf_items(node).iter().for_each(|&i| visit(i)),
        }
    }

    /// Visits each pair of different items whose leaves are within `reach` of each other once, in
    /// parallel, collecting what `visit` pushes; the order depends on the tree alone.
    ///
    /// Returns as well how many pairs of volumes were tested.
    pub fn self_pairs<T: Send>(
        &self,
        reach: f64,
        visit: impl Fn(u32, u32, &mut Vec<T>) + Sync,
    ) -> (Vec<T>, u64) {
        let (tasks, tests) = self.tasks(reach);
        let run = |&pair: &(u32, u32)| {
            let (mut out, mut tests) = (Vec::new(), 0);
            self.pairs_below(pair, reach, &mut tests, &mut |a, b| visit(a, b, &mut out));
            (out, tests)
        };
        let parts: Vec<(Vec<T>, u64)> = tasks.par_iter().map(run).collect();
        let tests = tests + parts.iter().map(|p| p.1).sum::<u64>();
        (parts.into_iter().flat_map(|p| p.0).collect(), tests)
    }

    /// The first levels of the self-traversal, as pairs of nodes that are near each other.
    fn tasks(&self, reach: f64) -> (Vec<(u32, u32)>, u64) {
        let mut tasks: Vec<(u32, u32)> = if self.nodes.is_empty() { vec![] } else { vec![(0, 0)] };
        let mut tests = 0;
        for _ in 0..MAX_DEPTH {
            if tasks.len() >= TASKS {
                break;
            }
            let (old, mut new) = (tasks.len(), Vec::with_capacity(3 * tasks.len()));
            let open = tasks.iter().filter(|&&pair| self.open(pair).is_none()).count();
            for pair in tasks {
                match self.open(pair) {
                    Some(parts) => {
                        new.extend(parts.into_iter().flatten().filter(|&p| self.admits(p, reach, &mut tests)))
                    }
                    None => new.push(pair),
                }
            }
            tasks = new;
            if open == old {
                break;
            }
        }
        (tasks, tests)
    }

    /// False where the pair can be skipped.
    fn admits(&self, (a, b): (u32, u32), reach: f64, tests: &mut u64) -> bool {
        if a == b {
            return true;
        }
        *tests += 1;
        self.volumes[a as usize].near(&self.volumes[b as usize], reach)
    }

    /// The pairs that a pair of nodes falls into; `None` for two leaves.
    fn open(&self, (a, b): (u32, u32)) -> Option<[Option<(u32, u32)>; 3]> {
        if a == b {
            return self.children(a).map(|(l, r)| [Some((l, l)), Some((l, r)), Some((r, r))]);
        }
        let larger_first = self.volumes[a as usize].size() >= self.volumes[b as usize].size();
        match (self.children(a), self.children(b)) {
            (None, None) => None,
            (Some((l, r)), None) => Some([Some((l, b)), Some((r, b)), None]),
            (None, Some((l, r))) => Some([Some((a, l)), Some((a, r)), None]),
            (Some((l, r)), Some(_)) if larger_first => Some([Some((l, b)), Some((r, b)), None]),
            (Some(_), Some((l, r))) => Some([Some((a, l)), Some((a, r)), None]),
        }
    }

    fn pairs_below(&self, pair: (u32, u32), reach: f64, tests: &mut u64, visit: &mut impl FnMut(u32, u32)) {
        match self.open(pair) {
            Some(parts) => {
                for part in parts.into_iter().flatten() {
                    if self.admits(part, reach, tests) {
                        self.pairs_below(part, reach, tests, visit);
                    }
                }
            }
            None => self.leaf_pairs(pair, visit),
        }
    }

    fn leaf_pairs(&self, (a, b): (u32, u32), visit: &mut impl FnMut(u32, u32)) {
        let (left, right) = (self.leaf_items(a), self.leaf_items(b));
        for (k, &i) in left.iter().enumerate() {
            let from = if a == b { k + 1 } else { 0 };
            right[from..].iter().for_each(|&j| visit(i.min(j), i.max(j)));
        }
    }
}

/// Appends the subtree over `items`, which start at `first` of the whole list.
fn grow(nodes: &mut Vec<Node>, items: &mut [u32], first: usize, leaf: usize, boxes: &[Aabb], depth: usize) {
    if items.len() <= leaf {
        nodes.push(Node { first: first as u32, count: items.len() as u32, right: 0 });
        return;
    }
    let middle = split(items, boxes, depth);
    let node = nodes.len();
    nodes.push(Node { first: 0, count: 0, right: 0 });
    let (left, right) = items.split_at_mut(middle);
    grow(nodes, left, first, leaf, boxes, depth + 1);
    nodes[node].right = nodes.len() as u32;
    grow(nodes, right, first + middle, leaf, boxes, depth + 1);
}

/// Orders the items in two parts, neither empty, and returns where the second starts.
fn split(items: &mut [u32], boxes: &[Aabb], depth: usize) -> usize {
    let center = |i: u32| boxes[i as usize].center();
    let span = items.iter().fold(Aabb::empty(), |b, &i| b.with(&center(i)));
    let axis = span.extent().imax();
    let width = span.extent()[axis];
    if depth < MAX_DEPTH && width > 0.0 && width.is_finite() {
        let scale = BINS as f64 / width;
        let bin = |i: u32| (((center(i)[axis] - span.min[axis]) * scale) as usize).min(BINS - 1);
        if let Some(cut) = best_cut(items, boxes, bin) {
            items.sort_by_key(|&i| bin(i) >= cut);
            return items.partition_point(|&i| bin(i) < cut);
        }
    }
    let middle = items.len() / 2;
    items
        .select_nth_unstable_by(middle, |&i, &j| center(i)[axis].total_cmp(&center(j)[axis]).then(i.cmp(&j)));
    middle
}

/// The bin before which to cut, by least sum of surface times count; `None` where all is in one bin.
fn best_cut(items: &[u32], boxes: &[Aabb], bin: impl Fn(u32) -> usize) -> Option<usize> {
    let mut bins = [(Aabb::empty(), 0usize); BINS];
    for &i in items {
        let b = &mut bins[bin(i)];
        *b = (b.0.merge(&boxes[i as usize]), b.1 + 1);
    }
    let add = |s: &mut (Aabb, usize), b: &(Aabb, usize)| {
        *s = (s.0.merge(&b.0), s.1 + b.1);
        Some(*s)
    };
    let start = (Aabb::empty(), 0);
    let below: Vec<_> = bins.iter().scan(start, add).collect();
    let mut above: Vec<_> = bins.iter().rev().scan(start, add).collect();
    above.reverse();
    let cost = |s: &(Aabb, usize)| s.0.half_area() * s.1 as f64;
    (1..BINS).filter(|&cut| below[cut - 1].1 > 0 && above[cut].1 > 0).min_by(|&i, &j| {
        let at = |cut: usize| cost(&below[cut - 1]) + cost(&above[cut]);
        at(i).total_cmp(&at(j))
    })
}

#[cfg(test)]
mod tests;
