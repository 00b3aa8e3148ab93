//! The triangles of a body, to find where cloth passes through them.
//!
//! Method: a tree of boxes; each side of one triangle against the other by signs of volumes (Möller
//! 1997 compares intervals, which gives no places). Cost: O(n log n) to build, O(log n) for a
//! triangle that meets few.

use crate::crossing::passing;
use crate::tree::Bvh;
use crate::volume::{Aabb, BoundingVolume};
use crate::{Corners, Vec3};

/// Triangles in a leaf.
const LEAF: usize = 4;

/// The triangles of a body's mesh in a tree.
#[derive(Debug, Clone)]
pub struct Facets {
    corners: Vec<Corners>,
    bvh: Bvh<Aabb>,
}

impl Facets {
    /// Of a mesh whose triangles name vertices that exist; nothing where it has none.
    #[must_use]
    pub fn of(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Option<Self> {
        if triangles.is_empty() {
            return None;
        }
        let corners: Vec<Corners> = triangles.iter().map(|t| t.map(|v| vertices[v as usize])).collect();
        let bvh = Bvh::new(&corners, LEAF);
        Some(Self { corners, bvh })
    }

    /// The places where sides of the triangle pass through those of the body, or sides of these
    /// through the triangle.
    #[must_use]
    pub fn crossings(&self, triangle: &Corners) -> Vec<Vec3> {
        let mut places = Vec::new();
        let around = Aabb::fit(triangle);
        self.bvh.within(&around, 0.0, |k| {
            let other = &self.corners[k as usize];
            if Aabb::fit(other).near(&around, 0.0) {
                for (a, b) in [(triangle, other), (other, triangle)] {
                    places.extend((0..3).filter_map(|k| passing(&a[k], &a[(k + 1) % 3], b)));
                }
            }
        });
        places
    }
}

#[cfg(test)]
mod tests;
