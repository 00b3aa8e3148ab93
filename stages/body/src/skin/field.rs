//! Smooth solids as scalar fields: negative inside, zero on the skin, about the distance near it.
//!
//! Parts ([lofts](crate::limbs::loft), ellipsoids, and [limbs](crate::limbs::limb)) are
//! joined by a smooth minimum (after Quilez, 2008), so that no crease shows where an arm leaves the
//! trunk. Every part is symmetric about x = 0 and is asked at x >= 0 only.
//!
//! Cost: some tens of nanoseconds a part and point. Limit: values are distances to first order
//! only; whoever needs the skin itself steps onto it with [`ScalarField::onto_skin`].

use toile_core::artifact::{Point3, Vector3};

/// A solid given by a scalar field.
pub(crate) trait ScalarField: Sync {
    /// Negative inside, positive outside, about the distance near the skin.
    fn value(&self, p: Point3) -> f64;

    /// The value of a solid near this one without parts that are thinner than the cells of a first,
    /// coarse mesh.
    fn coarse(&self, p: Point3) -> f64 {
        self.value(p)
    }

    /// The share of the mesh's edge that the edges at a point shall have.
    fn fineness(&self, _p: Point3) -> f64 {
        1.0
    }

    /// The field's mean and gradient at a point, from the corners of a small tetrahedron.
    fn gradient(&self, p: Point3) -> (f64, Vector3) {
        const STEP: f64 = 2e-5;
        const CORNERS: [[f64; 3]; 4] =
            [[1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, 1.0]];
        let (mut mean, mut g) = (0.0, Vector3::zeros());
        for corner in CORNERS.map(Vector3::from) {
            let v = self.value(p + corner * STEP);
            mean += v / 4.0;
            g += corner * (v / (4.0 * STEP));
        }
        (mean, g)
    }

    /// The point of the skin near `p`, by `steps` Newton steps along the gradient.
    ///
    /// A step is never longer than `reach`, so that a flat spot of the field cannot throw a point
    /// away.
    fn onto_skin(&self, mut p: Point3, steps: usize, reach: f64) -> Point3 {
        for _ in 0..steps {
            let (value, g) = self.gradient(p);
            let step = g * (value / g.norm_squared().max(1e-6));
            p -= step * (reach / step.norm().max(reach));
        }
        p
    }
}

/// Minimum with the corner rounded over a width `k`; twice continuously differentiable.
pub(crate) fn smooth_min(a: f64, b: f64, k: f64) -> f64 {
    let h = (1.0 - (a - b).abs() / k).max(0.0);
    a.min(b) - h * h * h * k / 6.0
}

/// Maximum with the corner rounded over a width `k`.
pub(crate) fn smooth_max(a: f64, b: f64, k: f64) -> f64 {
    -smooth_min(-a, -b, k)
}

/// An ellipsoid with axes along x, y and z.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ellipsoid {
    /// Centre, metres.
    pub centre: Point3,
    /// Half axes, metres.
    pub half_axes: Vector3,
}

impl Ellipsoid {
    /// The value: the implicit form divided by its slope.
    pub(crate) fn value(&self, p: Point3) -> f64 {
        let q = (p - self.centre).component_div(&self.half_axes);
        let (r, slope) = (q.norm(), q.component_div(&self.half_axes).norm());
        if slope > 0.0 { r * (r - 1.0) / slope } else { -self.half_axes.min() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct UnitBall;
    impl ScalarField for UnitBall {
        fn value(&self, p: Point3) -> f64 {
            p.coords.norm_squared() - 1.0
        }
    }

    #[test]
    fn newton_steps_reach_the_skin() {
        let p = UnitBall.onto_skin(Point3::new(0.9, 0.5, -0.2), 5, 0.5);
        assert!((p.coords.norm() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn smooth_minimum_is_the_minimum_away_from_the_corner() {
        assert_eq!(smooth_min(0.3, 0.1, 0.1), 0.1);
        assert!(smooth_min(0.1, 0.1, 0.06) < 0.1);
    }

    #[test]
    fn ellipsoids_vanish_on_their_skin() {
        let e = Ellipsoid { centre: Point3::origin(), half_axes: Vector3::new(1.0, 2.0, 3.0) };
        assert!(e.value(Point3::new(0.0, 2.0, 0.0)).abs() < 1e-12);
    }
}
