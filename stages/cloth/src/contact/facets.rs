//! The triangles of a body, to find where cloth passes through them.
//!
//! Method: a tree of boxes; each side of one triangle against the other by signs of volumes (Möller 1997 compares intervals, which gives
//! no places). Cost: O(n log n) to build, O(log n) for a triangle that meets few.

use super::tree::{Bounds, Over, halves};
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// The triangles of a body's mesh in a tree.
#[derive(Debug, Clone)]
pub struct Facets {
    /// Their corners, in the order of the tree.
    corners: Vec<[Vec3; 3]>,
    over: Over,
}

impl Facets {
    /// Of a mesh whose triangles name vertices that exist; nothing where it has none.
    #[must_use]
    pub fn of(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Option<Self> {
        if triangles.is_empty() {
            return None;
        }
        let (order, branches) = halves(triangles, vertices);
        let corners: Vec<[Vec3; 3]> =
            order.iter().map(|&t| triangles[t as usize].map(|v| vertices[v as usize])).collect();
        let over = Over::new(branches, |k| bounds(&corners[k as usize]));
        Some(Self { corners, over })
    }

    /// The places where sides of the triangle pass through those of the body, or sides of these through the triangle.
    #[must_use]
    pub fn crossings(&self, triangle: &[Vec3; 3]) -> Vec<Vec3> {
        let mut places = Vec::new();
        let around = bounds(triangle);
        self.over.within(&around, |k| {
            let other = &self.corners[k as usize];
            if bounds(other).meets(&around) {
                for (a, b) in [(triangle, other), (other, triangle)] {
                    places.extend((0..3).filter_map(|k| meeting(&a[k], &a[(k + 1) % 3], b)));
                }
            }
        });
        places
    }
}

fn bounds([a, b, c]: &[Vec3; 3]) -> Bounds {
    Bounds { low: a.inf(b).inf(c), high: a.sup(b).sup(c) }
}

/// Where the way from `p` to `q` passes through a triangle.
fn meeting(p: &Vec3, q: &Vec3, [a, b, c]: &[Vec3; 3]) -> Option<Vec3> {
    let volume = |a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3| (b - a).cross(&(c - a)).dot(&(d - a));
    let (start, end) = (volume(a, b, c, p), volume(a, b, c, q));
    if start * end >= 0.0 {
        return None;
    }
    let around = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    let passes = around.iter().all(|v| *v >= 0.0) || around.iter().all(|v| *v <= 0.0);
    passes.then(|| p + (q - p) * (start / (start - end)))
}

#[cfg(test)]
mod tests;
