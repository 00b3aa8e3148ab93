//! Closest points of a triangle and of two segments: the engine's own, for points of artifacts.

use toile_cloth::contact::closest;
use toile_core::artifact::Point3;

pub use toile_cloth::contact::closest::Feature;

/// The closest point of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnTriangle {
    /// The point.
    pub point: Point3,
    /// Its barycentric coordinates: none negative, sum 1.
    pub weights: [f64; 3],
    /// Where it lies.
    pub feature: Feature,
}

/// The point of the triangle `t` that is closest to `p`.
#[inline]
pub fn on_triangle(p: &Point3, t: &[Point3; 3]) -> OnTriangle {
    let found = closest::on_triangle(&p.coords, &t.map(|c| c.coords));
    OnTriangle { point: found.point.into(), weights: found.weights, feature: found.feature }
}

/// The shares, 0 to 1, at which the segments `a` and `b` are closest to each other.
#[inline]
pub fn between_segments(a: &[Point3; 2], b: &[Point3; 2]) -> (f64, f64) {
    closest::between_segments(&a.map(|p| p.coords), &b.map(|p| p.coords))
}

#[cfg(test)]
mod tests;
