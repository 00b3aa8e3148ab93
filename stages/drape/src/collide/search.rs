//! What a scheme asks of a library or kernel: the skin of a body, and cloth near itself.
//!
//! Two carry it out: trees of bounding volumes of our own, here, and parry3d
//! ([`parry`](super::parry)). Everything above them is the same code: which vertices are asked for,
//! what a contact is, and its order.

use std::fmt::Debug;
use toile_geometry::Vec3;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::pair::Pair;
use toile_geometry::signed_distance::{Nearest, PathEntry, SignedDistance};
use toile_geometry::volume::BoundingVolume;

/// A closed mesh that faces outwards.
pub trait BodySkin: Debug + Send + Sync {
    /// That of vertices and triangles; these name vertices that there are and are finite.
    fn over(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self;

    /// Its vertices, m.
    fn vertices(&self) -> &[Vec3];

    /// Its triangles.
    fn triangles(&self) -> &[[u32; 3]];

    /// The closest point of the surface, where it is within `bound` of `p`; nothing where `p` is no
    /// finite number.
    fn nearest(&self, p: &Vec3, bound: f64) -> Option<Nearest>;

    /// Where the path from `p` to `q` first enters; nothing for a path that only leaves, or is no
    /// finite number.
    fn entry(&self, p: &Vec3, q: &Vec3) -> Option<PathEntry>;

    /// Signed distance of a point, m; infinite where it is no finite number.
    fn distance(&self, p: &Vec3) -> f64 {
        self.nearest(p, f64::INFINITY).map_or(f64::INFINITY, |s| s.distance)
    }
}

/// A cloth whose triangles stay and whose vertices move.
pub trait ClothSearch: Debug + Send + Sync {
    /// That of triangles of three nodes that there are, at finite places.
    fn over(x: &[Vec3], triangles: &[[u32; 3]]) -> Self;

    /// Pairs of features that share no node and are nearer than `reach` at `x`, each once, sorted.
    fn pairs(&self, x: &[Vec3], reach: f64) -> Vec<Pair>;

    /// Pairs of triangles that cross at `x`, lower number first, ascending.
    fn crossings(&self, x: &[Vec3]) -> Vec<[u32; 2]>;
}

impl<V: BoundingVolume> BodySkin for SignedDistance<V> {
    fn over(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        SignedDistance::new(vertices, triangles)
    }

    fn vertices(&self) -> &[Vec3] {
        SignedDistance::vertices(self)
    }

    fn triangles(&self) -> &[[u32; 3]] {
        SignedDistance::triangles(self)
    }

    fn nearest(&self, p: &Vec3, bound: f64) -> Option<Nearest> {
        SignedDistance::nearest(self, p, bound)
    }

    fn entry(&self, p: &Vec3, q: &Vec3) -> Option<PathEntry> {
        SignedDistance::entry(self, p, q)
    }
}

impl<V: BoundingVolume> ClothSearch for ClothTree<V> {
    fn over(x: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        ClothTree::of(triangles, x)
    }

    fn pairs(&self, x: &[Vec3], reach: f64) -> Vec<Pair> {
        ClothTree::pairs(self, x, &vec![Vec3::zeros(); x.len()], reach)
    }

    fn crossings(&self, x: &[Vec3]) -> Vec<[u32; 2]> {
        self.exact_crossings(x)
    }
}
