//! Bumps and hollows: a smooth field moved outward or inward around a point or a stretch.
//!
//! Collarbones, shoulder blades, kneecaps, the nose and the groove of the spine are bumps. The
//! kernel is (1 - d²)³, whose second derivative is continuous (Wyvill, 1986), so that no crease
//! shows at a bump's rim.
//!
//! Cost: six comparisons away from a bump. Limit: heights must be small beside the radii.

use crate::measures::bounds::Bounds;
use toile_core::artifact::{Point3, Vector3};

/// A bump, or a hollow where its height is negative.
#[derive(Debug, Clone)]
pub(crate) struct Bump {
    from: Point3,
    /// From the first end to the second, in the space in which all radii are 1.
    way: Vector3,
    shrink: Vector3,
    squared: f64,
    height: f64,
    bounds: Bounds,
    /// Whether it lies beside the plane of symmetry and has an image.
    twin: bool,
}

impl Bump {
    /// A bump around the segment between two points, with radii along x, y and z and a height,
    /// metres.
    pub(crate) fn new([from, to]: [Point3; 2], radii: [f64; 3], height: f64) -> Self {
        let radii = Vector3::from(radii);
        let shrink = radii.map(|r| 1.0 / r);
        let way = (to - from).component_mul(&shrink);
        let bounds = Bounds { lo: from.inf(&to) - radii, hi: from.sup(&to) + radii };
        let twin = from.x != 0.0 || to.x != 0.0;
        Bump { from, way, shrink, squared: way.norm_squared().max(1e-12), height, bounds, twin }
    }

    /// How far it moves the skin outward at a point with x >= 0.
    pub(crate) fn value(&self, p: Point3) -> f64 {
        let own = self.single(p);
        if self.twin { own + self.single(Point3::new(-p.x, p.y, p.z)) } else { own }
    }

    fn single(&self, p: Point3) -> f64 {
        if !self.bounds.holds(&p) {
            return 0.0;
        }
        let q = (p - self.from).component_mul(&self.shrink);
        let t = (q.dot(&self.way) / self.squared).clamp(0.0, 1.0);
        let rest = (1.0 - (q - self.way * t).norm_squared()).max(0.0);
        self.height * rest * rest * rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bump_is_highest_at_its_middle_and_none_beyond_its_radius() {
        let b = Bump::new([Point3::new(1.0, 0.0, 0.0); 2], [0.1, 0.2, 0.3], 0.01);
        assert!((b.value(Point3::new(1.0, 0.0, 0.0)) - 0.01).abs() < 1e-12);
        assert_eq!(b.value(Point3::new(1.11, 0.0, 0.0)), 0.0);
        assert!(b.value(Point3::new(1.0, 0.15, 0.0)) > 0.0);
    }
}
