//! The axis-aligned box.

use super::BoundingVolume;
use toile_core::artifact::{Point3, Vector3};

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// Least corner.
    pub min: Point3,
    /// Greatest corner.
    pub max: Point3,
}

impl Aabb {
    /// The box that holds nothing.
    pub fn empty() -> Self {
        let far = Vector3::repeat(f64::INFINITY);
        Aabb { min: Point3::from(far), max: Point3::from(-far) }
    }

    /// The box grown to a point.
    pub fn with(&self, p: &Point3) -> Self {
        Aabb { min: self.min.inf(p), max: self.max.sup(p) }
    }

    /// Its edges' lengths.
    pub fn extent(&self) -> Vector3 {
        self.max - self.min
    }

    /// Its middle.
    pub fn center(&self) -> Point3 {
        nalgebra::center(&self.min, &self.max)
    }

    /// Half of its surface.
    pub fn half_area(&self) -> f64 {
        let e = self.extent();
        e.x * e.y + e.y * e.z + e.z * e.x
    }
}

impl BoundingVolume for Aabb {
    fn fit(points: &[Point3]) -> Self {
        points.iter().fold(Aabb::empty(), |b, p| b.with(p))
    }

    fn merge(&self, other: &Self) -> Self {
        Aabb { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    // Differences round monotonically, so that no padding is needed.
    fn near(&self, other: &Self, reach: f64) -> bool {
        (0..3).all(|k| self.min[k] - other.max[k] <= reach && other.min[k] - self.max[k] <= reach)
    }

    fn distance_squared(&self, p: &Point3) -> f64 {
        (0..3).map(|k| (self.min[k] - p[k]).max(p[k] - self.max[k]).max(0.0)).map(|d| d * d).sum()
    }

    fn size(&self) -> f64 {
        self.extent().sum()
    }
}
