//! A binary tree over triangles or other things with boxes, and what is asked of it.
//!
//! Built top-down by the surface-area heuristic on 12 bins along the longest axis (Wald 2007), in
//! an order that depends on the input alone; O(n log n). Parts lie in depth-first order, so that a
//! fit is one backward sweep. The tree holds no volumes: [`VolumeTree::fit`] gives one a part, so
//! that one tree serves any volume, and cloth that moves. [`Bvh`] is a tree with the volumes of
//! things that stand still.
//!
//! Limits: up to 2^32 things. Depth stays under [`MAX_DEPTH`] + 32, so recursion is safe.

mod build;
mod meet;

use crate::volume::BoundingVolume;
use crate::{Corners, Vec3};
use rayon::prelude::*;

pub use meet::Meeting;

/// Depth from which on parts are halved by count, whatever the heuristic says.
const MAX_DEPTH: usize = 40;

#[derive(Debug, Clone, Copy)]
struct TreePart {
    /// First thing of a leaf.
    first: u32,
    /// Number of things; 0 for an inner part, whose left child follows it.
    count: u32,
    /// Right child of an inner part.
    right: u32,
}

/// The tree. Things are known by their place in the tree's order.
#[derive(Debug, Clone, Default)]
pub struct VolumeTree {
    parts: Vec<TreePart>,
}

impl VolumeTree {
    /// Whether it is over nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    #[inline]
    fn children(&self, part: u32) -> Option<(u32, u32)> {
        let p = self.parts[part as usize];
        (p.count == 0).then_some((part + 1, p.right))
    }

    #[inline]
    fn leaf(&self, part: u32) -> std::ops::Range<usize> {
        let p = self.parts[part as usize];
        p.first as usize..(p.first + p.count) as usize
    }

    /// One value a part: `leaf` makes that of a leaf's things, `both` that of an inner part from
    /// its children's.
    pub fn sweep<V: Copy>(
        &self,
        leaf: impl Fn(std::ops::Range<usize>) -> V,
        both: impl Fn(&V, &V) -> V,
    ) -> Vec<V> {
        let Some(last) = self.parts.len().checked_sub(1) else { return Vec::new() };
        // The last part is a leaf; its value holds the places of those that are not made yet.
        let mut values = vec![leaf(self.leaf(last as u32)); self.parts.len()];
        for k in (0..last).rev() {
            values[k] = match self.children(k as u32) {
                Some((l, r)) => both(&values[l as usize], &values[r as usize]),
                None => leaf(self.leaf(k as u32)),
            };
        }
        values
    }

    /// A volume a part, from one a thing in the tree's order.
    #[must_use]
    pub fn fit<V: BoundingVolume>(&self, things: &[V]) -> Vec<V> {
        let leaf = |r: std::ops::Range<usize>| {
            things[r.start + 1..r.end].iter().fold(things[r.start], |a, b| a.merge(b))
        };
        self.sweep(leaf, V::merge)
    }

    /// A volume a part, each fitted to all points below it: tighter than [`VolumeTree::fit`], for
    /// what stands still.
    #[must_use]
    pub fn fit_tightly<V: BoundingVolume>(&self, corners: &[Corners]) -> Vec<V> {
        let ranges = self.sweep(|r| (r.start, r.end), |a, b| (a.0, b.1));
        let fit = |&(from, to): &(usize, usize)| V::fit(corners[from..to].as_flattened());
        ranges.par_iter().map(fit).collect()
    }

    /// Visits the things nearest to `p` first. `visit` takes a thing and the squared distance
    /// beyond which nothing matters, and returns that bound, lowered where the thing is nearer. At
    /// equal distance both sides are looked into: the caller settles ties.
    pub fn nearest<V: BoundingVolume>(
        &self,
        volumes: &[V],
        p: &Vec3,
        bound: f64,
        mut visit: impl FnMut(usize, f64) -> f64,
    ) {
        if volumes.first().is_some_and(|root| root.distance_squared(p) <= bound) {
            self.nearest_below(0, volumes, p, bound, &mut visit);
        }
    }

    fn nearest_below<V: BoundingVolume>(
        &self,
        part: u32,
        volumes: &[V],
        p: &Vec3,
        bound: f64,
        visit: &mut impl FnMut(usize, f64) -> f64,
    ) -> f64 {
        let Some((l, r)) = self.children(part) else {
            return self.leaf(part).fold(bound, |bound, i| visit(i, bound));
        };
        let [dl, dr] = [l, r].map(|k| volumes[k as usize].distance_squared(p));
        let ((near, dn), (far, df)) = if dl <= dr { ((l, dl), (r, dr)) } else { ((r, dr), (l, dl)) };
        let mut bound = bound;
        if dn <= bound {
            bound = self.nearest_below(near, volumes, p, bound, visit);
        }
        if df <= bound {
            bound = self.nearest_below(far, volumes, p, bound, visit);
        }
        bound
    }

    /// Visits the things whose leaves are within `reach` of a volume, in the order of the tree.
    pub fn within<V: BoundingVolume>(
        &self,
        volumes: &[V],
        around: &V,
        reach: f64,
        mut visit: impl FnMut(usize),
    ) {
        if !self.is_empty() {
            self.within_below(0, volumes, around, reach, &mut visit);
        }
    }

    fn within_below<V: BoundingVolume>(
        &self,
        part: u32,
        volumes: &[V],
        around: &V,
        reach: f64,
        visit: &mut impl FnMut(usize),
    ) {
        if !volumes[part as usize].near(around, reach) {
            return;
        }
        match self.children(part) {
            Some((l, r)) => {
                self.within_below(l, volumes, around, reach, visit);
                self.within_below(r, volumes, around, reach, visit);
            }
            None => self.leaf(part).for_each(visit),
        }
    }
}

/// A tree over triangles that stand still, with its volumes.
#[derive(Debug, Clone)]
pub struct Bvh<V> {
    tree: VolumeTree,
    volumes: Vec<V>,
    /// The number of each triangle, in the order of the tree.
    order: Vec<u32>,
}

impl<V: BoundingVolume> Bvh<V> {
    /// The tree over triangles, at most `leaf` of them together, each part fitted to its points.
    #[must_use]
    pub fn new(corners: &[Corners], leaf: usize) -> Self {
        let (tree, order) = VolumeTree::over(corners, leaf);
        let sorted: Vec<Corners> = order.iter().map(|&i| corners[i as usize]).collect();
        let volumes = tree.fit_tightly(&sorted);
        Self { tree, volumes, order }
    }

    /// As [`VolumeTree::nearest`]; triangles by their numbers.
    pub fn nearest(&self, p: &Vec3, bound: f64, mut visit: impl FnMut(u32, f64) -> f64) {
        self.tree.nearest(&self.volumes, p, bound, |i, bound| visit(self.order[i], bound));
    }

    /// As [`VolumeTree::within`]; triangles by their numbers.
    pub fn within(&self, around: &V, reach: f64, mut visit: impl FnMut(u32)) {
        self.tree.within(&self.volumes, around, reach, |i| visit(self.order[i]));
    }
}

#[cfg(test)]
mod tests;
