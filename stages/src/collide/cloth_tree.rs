//! The cloth's side of self-collision: its triangles in a hierarchy, each vertex and edge owned by
//! one triangle.
//!
//! Representative triangles (Curtis, Tamstorf, Manocha 2008): a vertex or an edge is tested only
//! when the triangle that owns it comes up, so each pair of features is tested once although up to
//! six triangles share it.
//!
//! The topology is kept for as long as the same triangles are asked about; a query refits the
//! volumes, O(n). When the cloth has moved so far that the volumes have grown by
//! [`REBUILD_AT`], the tree is built anew. Answers do not depend on the tree.

use super::bvh::{Bvh, Corners};
use super::volume::BoundingVolume;
use toile_core::artifact::Point3;

/// Growth of the volumes' sizes at which the tree is built anew.
const REBUILD_AT: f64 = 1.5;

/// Triangles a leaf: two sharing an edge fit one volume well.
const LEAF: usize = 2;

/// What a triangle owns: bit `k` its corner `k`, bit `3 + k` its edge from corner `k` to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Owned(u8);

impl Owned {
    /// The owned corners.
    pub(super) fn corners(self) -> impl Iterator<Item = usize> {
        (0..3).filter(move |k| self.0 & (1 << k) != 0)
    }

    /// The owned edges, by their first corner.
    pub(super) fn edges(self) -> impl Iterator<Item = usize> {
        (0..3).filter(move |k| self.0 & (8 << k) != 0)
    }
}

/// The cloth's hierarchy.
#[derive(Debug)]
pub(super) struct ClothTree<V> {
    /// The triangles as they were asked about.
    pub(super) triangles: Vec<[u32; 3]>,
    vertices: usize,
    /// What each triangle owns.
    pub(super) owned: Vec<Owned>,
    /// The hierarchy over those that can be used.
    pub(super) bvh: Bvh<V>,
    looseness: f64,
}

impl<V: BoundingVolume> ClothTree<V> {
    /// The tree for a cloth.
    pub(super) fn build(positions: &[Point3], triangles: &[[u32; 3]]) -> Self {
        let usable: Vec<u32> = (0..triangles.len() as u32)
            .filter(|&t| is_usable(&triangles[t as usize], positions.len()))
            .collect();
        let owned = ownership(triangles, &usable, positions.len());
        let bvh = Bvh::merged(usable, LEAF, |t| corners(positions, &triangles[t as usize]));
        let looseness = bvh.looseness();
        ClothTree { triangles: triangles.to_vec(), vertices: positions.len(), owned, bvh, looseness }
    }

    /// The tree brought up to date; built anew for another cloth or one that has moved far.
    pub(super) fn updated(mut self, positions: &[Point3], triangles: &[[u32; 3]]) -> Self {
        if self.vertices != positions.len() || self.triangles != triangles {
            return Self::build(positions, triangles);
        }
        self.bvh.refit(|t| corners(positions, &triangles[t as usize]));
        if self.bvh.looseness() > REBUILD_AT * self.looseness {
            return Self::build(positions, triangles);
        }
        self
    }
}

fn is_usable(t: &[u32; 3], vertices: usize) -> bool {
    t.iter().all(|&i| (i as usize) < vertices) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]
}

/// A triangle's corners; the origin for one that is no finite number, so that volumes stay finite.
fn corners(positions: &[Point3], t: &[u32; 3]) -> Corners {
    t.map(|i| {
        let p = positions[i as usize];
        if p.iter().all(|x| x.is_finite()) { p } else { Point3::origin() }
    })
}

/// The first triangle that has a corner or an edge owns it.
fn ownership(triangles: &[[u32; 3]], usable: &[u32], vertices: usize) -> Vec<Owned> {
    let mut owned = vec![Owned::default(); triangles.len()];
    let mut taken = vec![false; vertices];
    let mut edges = Vec::with_capacity(3 * usable.len());
    for &t in usable {
        let nodes = triangles[t as usize];
        for k in 0..3 {
            let (i, j) = (nodes[k], nodes[(k + 1) % 3]);
            edges.push((i.min(j), i.max(j), t, k));
            if !std::mem::replace(&mut taken[i as usize], true) {
                owned[t as usize].0 |= 1 << k;
            }
        }
    }
    edges.sort_unstable();
    edges.dedup_by_key(|e| (e.0, e.1));
    edges.iter().for_each(|&(_, _, t, k)| owned[t as usize].0 |= 8 << k);
    owned
}

#[cfg(test)]
mod tests;
