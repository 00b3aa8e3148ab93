//! Friction of one point: a potential of how far it has slid from its anchor, whose slope nears
//! Coulomb's limit.
//!
//! The potential is `limit * soft * (sqrt(1 + (s / soft)^2) - 1)` of the way `s` along the surface:
//! a spring where the point has hardly moved, the limit where it slides. Its matrix is positive
//! semi-definite.

use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// How far behind an anchor is dragged, in soft ways: friction is then half of its limit, so that
/// what slides stops with some to spare.
const SLIP_RETURN: f64 = 0.577;

/// The way that a point slides before friction comes near its limit, m: at this way it is 0.7 of
/// it. Longer converges sooner; cloth creeps that far before it holds.
pub(crate) const SLIP_TOLERANCE: f64 = 1e-4;

/// A point held near its anchor.
pub(crate) struct Coulomb {
    /// Normal of the surface.
    pub(crate) normal: Vec3,
    /// Where friction holds the point.
    pub(crate) anchor: Vec3,
    /// The greatest force, N.
    pub(crate) limit: f64,
}

impl Coulomb {
    /// The way from the anchor along the surface, m.
    pub(crate) fn way(&self, p: &Vec3) -> Vec3 {
        let d = p - self.anchor;
        d - self.normal * self.normal.dot(&d)
    }

    /// The same in soft ways, and the root of one plus its square.
    fn slide(&self, p: &Vec3) -> (Vec3, f64) {
        let along = self.way(p) / SLIP_TOLERANCE;
        (along, (1.0 + along.norm_squared()).sqrt())
    }

    /// J.
    pub(crate) fn value(&self, p: &Vec3) -> f64 {
        self.limit * SLIP_TOLERANCE * (self.slide(p).1 - 1.0)
    }

    /// N.
    pub(crate) fn gradient(&self, p: &Vec3) -> Vec3 {
        let (along, root) = self.slide(p);
        along * (self.limit / root)
    }

    /// N/m.
    pub(crate) fn matrix(&self, p: &Vec3) -> Matrix3<f64> {
        let (along, root) = self.slide(p);
        let flat = Matrix3::identity() - self.normal * self.normal.transpose();
        (flat - along * along.transpose() / (root * root)) * (self.limit / (SLIP_TOLERANCE * root))
    }

    /// Where the anchor is after it has been dragged along.
    pub(crate) fn dragged(&self, p: &Vec3) -> Vec3 {
        let (along, _) = self.slide(p);
        let r = along.norm();
        if r <= SLIP_RETURN { self.anchor } else { p - along * (SLIP_TOLERANCE * SLIP_RETURN / r) }
    }
}
