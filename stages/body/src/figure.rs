//! A human figure as a smooth solid: trunk, breasts, shoulders, neck, head, arms, hands, legs,
//! feet.
//!
//! Parts are [lofts](crate::limbs::loft), [limbs](crate::limbs::limb) and ellipsoids,
//! joined by smooth minima; the [relief](crate::limbs::relief) of bones and muscles moves the
//! skin. Sections and levels follow a [`BodyForm`]. Levels are shares of the height up to the chin,
//! so that a child, whose head is larger, still has its waist where the trunk has one. Girths and
//! lengths are met by [`Aims`].
//!
//! Limit: a shop's dummy, not a portrait: a calm head without eyes and ears, fingers side by side.

use crate::form::BodyForm;
use crate::limbs::arm::{self, Arm};
use crate::limbs::bump::Bump;
use crate::limbs::head::Head;
use crate::limbs::leg::Leg;
use crate::limbs::relief::relief;
use crate::limbs::torso::{Torso, neck_middle};
use crate::shape::{Aims, FigureShape, FigureSize};
use crate::skin::field::{ScalarField, smooth_min};
use toile_core::artifact::{Point3, Vector3};

/// Widths over which parts are joined, metres on the adult.
mod joint {
    pub(super) const ARM: f64 = 0.032;
    pub(super) const NECK: f64 = 0.070;
    pub(super) const HEAD: f64 = 0.035;
    pub(super) const LEG: f64 = 0.065;
    pub(super) const LEGS: f64 = 0.045;
}

/// Nearer to the skin than this the relief counts, metres: it is lower everywhere.
const RELIEF: f64 = 0.06;

/// How far breasts, shoulders and seat stand out of the trunk's sections at most, metres on the
/// adult.
const OUT: f64 = 0.10;

/// How much thicker hands are where the first, coarse mesh is made: fingers are thinner than its
/// cells. Metres on the adult.
const THICKER: f64 = 0.005;

/// Where the mesh is finer than its edge: shares of the edge at fingers, palm, head and feet.
const FINER: [f64; 4] = [0.44, 0.70, 0.68, 0.95];

/// A figure of given size.
#[derive(Debug, Clone)]
pub(crate) struct BodyFigure {
    /// Size, form and aims.
    pub shape: FigureShape,
    /// Shoulder joint, elbow and wrist of the left arm (the axis, not the skin).
    pub arm_axis: [Point3; 3],
    torso: Torso,
    head: Head,
    arm: Arm,
    leg: Leg,
    relief: Vec<Bump>,
}

impl BodyFigure {
    /// The figure of that size and form.
    pub(crate) fn new(size: &FigureSize, form: &BodyForm, aims: &Aims) -> Self {
        let shape = FigureShape::new(size, form, aims);
        BodyFigure {
            arm_axis: arm::axis(&shape),
            torso: Torso::new(&shape),
            head: Head::new(&shape),
            arm: Arm::new(&shape),
            leg: Leg::new(&shape),
            relief: relief(&shape),
            shape,
        }
    }

    /// The size that it was made to.
    pub(crate) fn size(&self) -> &FigureSize {
        &self.shape.size
    }

    /// The height of a level.
    pub(crate) fn y(&self, level: f64) -> f64 {
        self.shape.y(level)
    }

    /// The middle of the neck where its girth is taken, and the direction of its axis.
    pub(crate) fn neck(&self) -> (Point3, Vector3) {
        neck_middle(&self.shape)
    }

    /// The middle of the upper arm, and its direction.
    pub(crate) fn upper_arm(&self) -> (Point3, Vector3) {
        let [joint, elbow, _] = self.arm_axis;
        (joint + (elbow - joint) * 0.55, (elbow - joint).normalize())
    }

    /// Upper x, lower and upper y, lower and upper z of a box that holds the half with x >= 0.
    pub(crate) fn bounds(&self) -> [f64; 5] {
        let boxes = [self.torso.bounds(), self.head.bounds(), self.arm.bounds(), self.leg.bounds()];
        let reach = boxes.iter().map(|b| b.hi.x).fold(0.0, f64::max) + 0.02;
        let back = boxes.iter().map(|b| b.lo.z).fold(0.0, f64::min) - 0.07;
        let front = boxes.iter().map(|b| b.hi.z).fold(0.0, f64::max) + 0.07;
        [reach, 0.0, self.size().height, back, front]
    }

    /// The field of trunk, head and legs; it is symmetric, so x may have either sign.
    pub(crate) fn without_arms(&self, p: Point3) -> f64 {
        let p = Point3::new(p.x.abs(), p.y, p.z);
        self.with_relief(self.body(p), p)
    }

    /// Trunk, head and legs.
    fn body(&self, p: Point3) -> f64 {
        let s = self.shape.stature;
        let (near, k) = (self.torso.bounds().at_least(p) - OUT * s, joint::LEG * s);
        if p.y < self.shape.aims.crotch {
            let legs = self.legs(p);
            return if near > legs + k { legs } else { smooth_min(legs, self.upper(p), k) };
        }
        let upper = self.upper(p);
        if self.leg.bounds().at_least(p) > upper + k { upper } else { smooth_min(upper, self.legs(p), k) }
    }

    /// Trunk, neck and head.
    fn upper(&self, p: Point3) -> f64 {
        let s = self.shape.stature;
        if p.y < self.shape.y(0.80) {
            return self.torso.value(p);
        }
        let (neck, k) = (self.torso.neck(p), joint::HEAD * s);
        let far = self.head.bounds().at_least(p) > neck + k;
        let neck = if far { neck } else { smooth_min(neck, self.head.value(p), k) };
        let k = joint::NECK * s;
        let near = self.torso.bounds().at_least(p) - OUT * s;
        if near > neck + k { neck } else { smooth_min(self.torso.value(p), neck, k) }
    }

    fn legs(&self, p: Point3) -> f64 {
        let (left, k) = (self.leg.value(p), joint::LEGS * self.shape.stature);
        let right = Point3::new(-p.x, p.y, p.z);
        if self.leg.bounds().at_least(right) > left + k {
            left
        } else {
            smooth_min(left, self.leg.value(right), k)
        }
    }

    /// All, with hands that are thicker by a length.
    fn whole(&self, p: Point3, thicker: f64) -> f64 {
        let p = Point3::new(p.x.abs(), p.y, p.z);
        let (body, k) = (self.body(p), joint::ARM * self.shape.stature);
        let far = self.arm.bounds().at_least(p) - thicker > body + k;
        self.with_relief(if far { body } else { smooth_min(body, self.arm.value(p, thicker), k) }, p)
    }

    fn with_relief(&self, value: f64, p: Point3) -> f64 {
        if value.abs() > RELIEF { value } else { value - self.relief.iter().map(|b| b.value(p)).sum::<f64>() }
    }
}

impl ScalarField for BodyFigure {
    fn value(&self, p: Point3) -> f64 {
        self.whole(p, 0.0)
    }

    fn coarse(&self, p: Point3) -> f64 {
        self.whole(p, THICKER * self.shape.stature)
    }

    fn fineness(&self, p: Point3) -> f64 {
        let [fingers, palm, head, feet] = FINER;
        let hand = self.arm.beyond_wrist(p);
        if hand > 0.45 {
            fingers
        } else if hand > -0.05 {
            palm
        } else if p.y > self.shape.chin - 0.01 {
            head
        } else if p.y < 0.05 * self.shape.stature {
            feet
        } else {
            1.0
        }
    }
}
