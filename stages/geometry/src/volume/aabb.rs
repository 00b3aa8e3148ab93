//! The axis-aligned box.

use super::BoundingVolume;
use crate::Vec3;

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// Least corner.
    pub min: Vec3,
    /// Greatest corner.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing.
    #[inline]
    pub fn empty() -> Self {
        let far = Vec3::repeat(f64::INFINITY);
        Aabb { min: far, max: -far }
    }

    /// The box grown to a point.
    #[inline]
    pub fn with(&self, p: &Vec3) -> Self {
        Aabb { min: self.min.inf(p), max: self.max.sup(p) }
    }

    /// Its edges' lengths.
    #[inline]
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Its middle.
    #[inline]
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) / 2.0
    }

    /// Half of its surface.
    #[inline]
    pub fn half_area(&self) -> f64 {
        let e = self.extent();
        e.x * e.y + e.y * e.z + e.z * e.x
    }
}

impl BoundingVolume for Aabb {
    #[inline]
    fn fit(points: &[Vec3]) -> Self {
        points.iter().fold(Aabb::empty(), |b, p| b.with(p))
    }

    #[inline]
    fn merge(&self, other: &Self) -> Self {
        Aabb { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    // Differences round monotonically, so that no padding is needed.
    #[inline]
    fn near(&self, other: &Self, reach: f64) -> bool {
        (0..3).all(|k| self.min[k] - other.max[k] <= reach && other.min[k] - self.max[k] <= reach)
    }

    #[inline]
    fn distance_squared(&self, p: &Vec3) -> f64 {
        (0..3).map(|k| (self.min[k] - p[k]).max(p[k] - self.max[k]).max(0.0)).map(|d| d * d).sum()
    }

    #[inline]
    fn size(&self) -> f64 {
        self.extent().sum()
    }
}
