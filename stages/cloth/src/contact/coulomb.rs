//! Regularised Coulomb friction of one point, as a potential of its tangential displacement from an
//! anchor, and what it keeps from step to step.
//!
//! The potential is `limit * tol * (sqrt(1 + (s / tol)^2) - 1)` of the tangential displacement `s`,
//! with the slip tolerance `tol`: a spring at small displacements, whose force approaches Coulomb's
//! limit at large ones. Its matrix is positive semi-definite. Cost: O(1). Limit: a point that holds
//! creeps by about the slip tolerance.

use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// Distance at which a sliding point drags its anchor behind it, in slip tolerances. Friction is
/// then half of its limit, so that a sliding point can stop.
pub(crate) const SLIP_RETURN: f64 = 0.577;

/// Slip tolerance: the tangential displacement at which friction is 0.7 of its limit, m. A longer
/// one converges sooner, but cloth creeps farther before it holds.
const SLIP_TOLERANCE: f64 = 1e-4;

/// What friction at one point keeps from step to step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionMemory {
    /// Where friction holds the point, m.
    pub anchor: Vec3,
    /// The normal force that limits friction, a mean over the last steps, N.
    pub load: f64,
}

impl FrictionMemory {
    /// The load of a contact that presses with `force` now. Contact may alternate from step to
    /// step, so the limit of friction is a mean.
    pub(crate) fn mean_load(&self, force: f64) -> f64 {
        0.5 * (self.load + force)
    }

    /// The friction on a surface with that normal and coefficient.
    pub(crate) fn coulomb(&self, normal: Vec3, coefficient: f64) -> Coulomb {
        Coulomb { normal, anchor: self.anchor, limit: coefficient * self.load }
    }

    /// Drags the anchor along if the point at `p` has slid farther than the slip tolerance since
    /// the start of the step, when its displacement was `slid`. A contact that holds beside sliding
    /// cloth goes on holding.
    pub(crate) fn drag(&mut self, friction: &Coulomb, p: &Vec3, slid: &Vec3) {
        if (friction.displacement(p) - slid).norm() > SLIP_TOLERANCE {
            self.anchor = friction.dragged(p);
        }
    }
}

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
    /// The tangential displacement from the anchor, m.
    pub(crate) fn displacement(&self, p: &Vec3) -> Vec3 {
        let d = p - self.anchor;
        d - self.normal * self.normal.dot(&d)
    }

    /// The displacement in slip tolerances, and the root of one plus its square.
    fn slide(&self, p: &Vec3) -> (Vec3, f64) {
        let along = self.displacement(p) / SLIP_TOLERANCE;
        (along, (1.0 + along.norm_squared()).sqrt())
    }

    /// The potential, J.
    pub(crate) fn value(&self, p: &Vec3) -> f64 {
        self.limit * SLIP_TOLERANCE * (self.slide(p).1 - 1.0)
    }

    /// The gradient of the potential, N.
    pub(crate) fn gradient(&self, p: &Vec3) -> Vec3 {
        let (along, root) = self.slide(p);
        along * (self.limit / root)
    }

    /// The matrix of second derivatives, N/m.
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

/// The mean of displacements, weighted by their loads; zero without load.
pub(crate) fn mean_by_load(all: impl Iterator<Item = (Vec3, f64)>) -> Vec3 {
    let (mut sum, mut load) = (Vec3::zeros(), 0.0);
    for (displacement, own) in all {
        sum += displacement * own;
        load += own;
    }
    if load > 0.0 { sum / load } else { sum }
}
