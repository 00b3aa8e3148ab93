//! Arms swung about the shoulders, and the space around them with them.
//!
//! Each point keeps its distance from the axis, which goes from the back to the front through the
//! shoulder's middle; its angle about it is changed by a rising function of the angle alone: fixed
//! on the trunk, the whole swing on the arm, between both a monotone cubic (Fritsch and Carlson
//! 1980). So no two points come to lie in one place: what does not cross before does not cross
//! afterwards, but for the error of straight edges between moved vertices.

use crate::skin::slice::{slice, trunk};
use std::f64::consts::{PI, TAU};
use toile_core::artifact::{Body, Point3};
use toile_core::prelude::*;

/// Half the angle in which the arm turns as one piece.
const ARM: f64 = PI / 15.0;
/// Above the shoulder space stays where it is from this angle on, from the downward vertical
/// outwards.
const NECK: f64 = 190.0 * PI / 180.0;
/// The angle at which arms hang where the trunk lets them.
const HANGING: f64 = 28.0 * PI / 180.0;
/// An elbow is as far from its shoulder as another where the difference is less, metres.
const SAME: f64 = 1e-4;
/// Slices of the trunk from the armpit to the crotch.
const SLICES: u32 = 24;
/// The trunk goes around here, metres from the body's origin.
const MIDDLE: f64 = 0.0;
/// The space under the arm may shrink to this share.
const LEAST: f64 = 0.15;

/// The swing of both arms; none of one that stays.
#[derive(Debug, Clone, PartialEq)]
pub struct Swing([Option<SwingSide>; 2]);

#[derive(Debug, Clone, PartialEq)]
struct SwingSide {
    /// The axis passes through here.
    joint: Point3,
    hand: Hand,
    /// Angles and where they come to lie: the trunk's end, the arm's two ends, the neck.
    knots: [[f64; 2]; 4],
    /// Slopes there.
    slopes: [f64; 4],
}

impl Swing {
    /// From the arms of a body to an angle between the upper arms and the vertical, radians.
    ///
    /// Errors: a landmark of an arm is missing; there is no room between arm and trunk, or not so
    /// much of it.
    pub fn to(body: &Body, angle: f64) -> Result<Swing, StageError> {
        let side = |hand| SwingSide::new(ArmAngles::of(body, hand)?, angle).map(Some);
        Ok(Swing([side(Hand::Left)?, side(Hand::Right)?]))
    }

    /// From the arms of a body to [`HANGING`], or as near to it as the trunk lets them; arms that
    /// hang lower stay.
    ///
    /// Errors: a landmark of an arm is missing.
    pub fn hanging(body: &Body) -> Result<Swing, StageError> {
        let side = |hand| {
            let arm = ArmAngles::of(body, hand)?;
            let to = HANGING.max(arm.least());
            if to < arm.from { SwingSide::new(arm, to).map(Some) } else { Ok(None) }
        };
        Ok(Swing([side(Hand::Left)?, side(Hand::Right)?]))
    }

    /// From the arms of a body to those of the same body in another pose.
    ///
    /// Errors: those of [`Swing::to`]; the elbows are not as far from the shoulders as before.
    pub fn between(before: &Body, after: &Body) -> Result<Swing, StageError> {
        let side = |hand| {
            let arm = ArmAngles::of(before, hand)?;
            let [r, to] = arm.joint.polar(&mark(after, "elbow", hand)?);
            let [before_r, _] = arm.joint.polar(&mark(before, "elbow", hand)?);
            if (r - before_r).abs() > SAME {
                return Err(StageError::invalid("the two bodies are not one body in two poses")
                    .hint("let `PoseBody` take the body that the garment was draped on"));
            }
            if (to - arm.from).abs() < 1e-12 { Ok(None) } else { SwingSide::new(arm, to).map(Some) }
        };
        Ok(Swing([side(Hand::Left)?, side(Hand::Right)?]))
    }

    /// Where a point comes to lie.
    pub fn place(&self, p: &Point3) -> Point3 {
        self.0.iter().flatten().fold(*p, |p, side| side.place(&p))
    }
}

/// The middle of a shoulder, from which angles are taken.
struct ShoulderJoint {
    at: Point3,
    hand: Hand,
}

impl ShoulderJoint {
    fn of(body: &Body, hand: Hand) -> Result<ShoulderJoint, StageError> {
        let at = nalgebra::center(&mark(body, "shoulder", hand)?, &mark(body, "armpit", hand)?);
        Ok(ShoulderJoint { at, hand })
    }

    /// Distance from the axis, and the angle from the downward vertical outwards, from -90 to 270
    /// degrees.
    fn polar(&self, p: &Point3) -> [f64; 2] {
        let (out, down) = (self.hand.sign() * (p.x - self.at.x), self.at.y - p.y);
        let angle = out.atan2(down);
        [out.hypot(down), if angle < -PI / 2.0 { angle + TAU } else { angle }]
    }
}

/// An arm as it is.
struct ArmAngles {
    joint: ShoulderJoint,
    /// The angle of the elbow.
    from: f64,
    /// The largest angle of the trunk.
    trunk: f64,
}

impl ArmAngles {
    fn of(body: &Body, hand: Hand) -> Result<ArmAngles, StageError> {
        let joint = ShoulderJoint::of(body, hand)?;
        let from = joint.polar(&mark(body, "elbow", hand)?)[1];
        let trunk = trunk_end(body, &joint, mark(body, "armpit", hand)?);
        Ok(ArmAngles { joint, from, trunk })
    }

    /// The least angle that the arm can be brought to; its own where there is no room between it
    /// and the trunk.
    fn least(&self) -> f64 {
        let room = self.from - ARM - self.trunk;
        if room > 0.0 { self.trunk + ARM + LEAST * room } else { self.from }
    }
}

impl SwingSide {
    fn new(arm: ArmAngles, to: f64) -> Result<SwingSide, StageError> {
        let hand = arm.joint.hand;
        let refused = |what: &str| {
            let text = format!("at {:.0} degrees the {hand} arm does not clear the {what}", to.to_degrees());
            StageError::invalid(text).at("arm_angle")
        };
        if arm.from - ARM <= arm.trunk {
            return Err(StageError::invalid(format!("the body's {hand} arm lies at its trunk"))
                .hint("leave its pose as it is"));
        }
        // The least angle as it was found, but for rounding.
        if to < arm.least() - 1e-6 {
            let least = arm.least().to_degrees().ceil();
            return Err(
                refused("trunk").hint(format!("this body's arms can be brought to {least:.0} degrees"))
            );
        }
        if to + ARM >= NECK {
            return Err(refused("head"));
        }
        let ArmAngles { joint, from, trunk } = arm;
        let knots = [[trunk; 2], [from - ARM, to - ARM], [from + ARM, to + ARM], [NECK; 2]];
        Ok(SwingSide { joint: joint.at, hand, slopes: slopes(&knots), knots })
    }

    fn place(&self, p: &Point3) -> Point3 {
        let joint = ShoulderJoint { at: self.joint, hand: self.hand };
        let [r, angle] = joint.polar(p);
        if angle <= self.knots[0][0] || angle >= self.knots[3][0] {
            return *p;
        }
        let (sin, cos) = self.turned(angle).sin_cos();
        Point3::new(self.joint.x + self.hand.sign() * r * sin, self.joint.y - r * cos, p.z)
    }

    /// Where an angle between the outer knots comes to lie: the arm as one piece, beside it by a
    /// cubic (Hermite).
    fn turned(&self, angle: f64) -> f64 {
        let k = self.knots[1..3].iter().filter(|k| angle >= k[0]).count();
        if k == 1 {
            return angle + self.knots[1][1] - self.knots[1][0];
        }
        let ([x0, y0], [x1, y1]) = (self.knots[k], self.knots[k + 1]);
        let (h, t) = (x1 - x0, (angle - x0) / (x1 - x0));
        let (m0, m1) = (self.slopes[k] * h, self.slopes[k + 1] * h);
        let (t2, t3) = (t * t, t * t * t);
        y0 * (2.0 * t3 - 3.0 * t2 + 1.0)
            + m0 * (t3 - 2.0 * t2 + t)
            + y1 * (3.0 * t2 - 2.0 * t3)
            + m1 * (t3 - t2)
    }
}

/// Slopes with which a cubic rises everywhere: 1 where it may, else twice the secant beside it
/// (Fritsch and Carlson 1980 allow three times).
fn slopes(knots: &[[f64; 2]; 4]) -> [f64; 4] {
    let secant = |k: usize| (knots[k + 1][1] - knots[k][1]) / (knots[k + 1][0] - knots[k][0]);
    [0, 1, 2, 3].map(|k: usize| {
        let beside = [k.checked_sub(1), (k < 3).then_some(k)];
        beside.into_iter().flatten().fold(1.0, |least: f64, k| least.min(2.0 * secant(k)))
    })
}

/// The largest angle at which the trunk lies between armpit and crotch.
fn trunk_end(body: &Body, joint: &ShoulderJoint, armpit: Point3) -> f64 {
    let low = body.landmarks.get("crotch").map_or(armpit.y / 2.0, |p| p.y);
    let height = armpit.y - low;
    let slices = (1..=SLICES).map(|k| armpit.y - height * f64::from(k) / f64::from(SLICES));
    let end = |y: f64| {
        let loops = slice(&body.positions, &body.triangles, y);
        let [left, right, ..] = trunk(&loops, MIDDLE)?.bounds;
        let x = if joint.hand == Hand::Left { right } else { left };
        Some(joint.polar(&Point3::new(x, y, joint.at.z))[1])
    };
    slices.filter_map(end).fold(0.0, f64::max)
}

fn mark(body: &Body, name: &str, hand: Hand) -> Result<Point3, StageError> {
    body.landmark(name, hand).ok_or_else(|| {
        let name = hand.name(name);
        StageError::invalid(format!("the body has no landmark `{name}`, so its arms cannot be moved"))
            .hint("give the body that landmark, or leave its pose as it is")
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Mannequin;
    use proptest::prelude::*;
    use toile_core::Context;

    fn mannequin() -> Body {
        Mannequin::default().run(&Context::quiet()).unwrap()
    }

    /// Angle of an upper arm against the vertical, degrees.
    fn angle(body: &Body) -> f64 {
        ShoulderJoint::of(body, Hand::Left).unwrap().polar(&body.landmarks["elbow_left"])[1].to_degrees()
    }

    #[test]
    fn arms_come_to_the_angle_and_the_trunk_stays() {
        let body = mannequin();
        let joint = ShoulderJoint::of(&body, Hand::Left).unwrap();
        let swing = Swing::to(&body, 25.0_f64.to_radians()).unwrap();
        let elbow = swing.place(&body.landmarks["elbow_left"]);
        assert!((joint.polar(&elbow)[1].to_degrees() - 25.0).abs() < 1e-9);
        for name in ["waist_front", "hip_back", "bust_front", "neck_left", "crotch"] {
            assert_eq!(swing.place(&body.landmarks[name]), body.landmarks[name], "{name}");
        }
        let widest = |level: f64| {
            let near = body.positions.iter().filter(|p| (p.y - level).abs() < 0.02 && p.x < 0.21);
            near.max_by(|a, b| a.x.total_cmp(&b.x)).copied().unwrap()
        };
        let side = widest(body.landmarks["hip_front"].y);
        assert_eq!(swing.place(&side), side, "the hip's side");
    }

    #[test]
    fn lengths_of_the_arms_stay() {
        let body = mannequin();
        let swing = Swing::to(&body, 30.0_f64.to_radians()).unwrap();
        let length = |place: &dyn Fn(&Point3) -> Point3| {
            (place(&body.landmarks["elbow_right"]) - place(&body.landmarks["wrist_right"])).norm()
        };
        let (before, after) = (length(&|p| *p), length(&|p| swing.place(p)));
        assert!((after - before).abs() < 1e-9, "{before} {after}");
    }

    #[test]
    fn a_swing_is_known_again_from_both_bodies() {
        let body = mannequin();
        let swing = Swing::to(&body, 25.0_f64.to_radians()).unwrap();
        let mut after = body.clone();
        after.landmarks.values_mut().for_each(|p| *p = swing.place(p));
        let found = Swing::between(&body, &after).unwrap();
        let worst =
            body.positions.iter().map(|p| (found.place(p) - swing.place(p)).norm()).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{worst}");
        after.landmarks.insert("elbow_left".into(), Point3::origin());
        assert_eq!(
            Swing::between(&body, &after).unwrap_err().message,
            "the two bodies are not one body in two poses"
        );
    }

    #[test]
    fn arms_that_would_meet_the_trunk_or_the_head_are_refused() {
        let body = mannequin();
        let refused = |degrees: f64| Swing::to(&body, degrees.to_radians()).unwrap_err();
        let low = refused(5.0);
        assert_eq!(low.message, "at 5 degrees the left arm does not clear the trunk");
        assert!(low.hint.unwrap().starts_with("this body's arms can be brought to "));
        assert_eq!(refused(185.0).message, "at 185 degrees the left arm does not clear the head");
        let bare = Body { landmarks: std::collections::BTreeMap::new(), ..body };
        assert_eq!(
            Swing::to(&bare, 0.5).unwrap_err().message,
            "the body has no landmark `shoulder_left`, so its arms cannot be moved"
        );
    }

    proptest! {
        #[test]
        fn angles_keep_their_order(to in 20.0..160.0_f64, a in -80.0..260.0_f64, step in 0.01..10.0_f64) {
            let body = BODY.with(Clone::clone);
            let swing = Swing::to(&body, to.to_radians()).unwrap();
            let joint = ShoulderJoint::of(&body, Hand::Left).unwrap();
            let at = |degrees: f64| {
                let (sin, cos) = degrees.to_radians().sin_cos();
                let p = Point3::new(joint.at.x + 0.3 * sin, joint.at.y - 0.3 * cos, 0.0);
                joint.polar(&swing.place(&p))[1].to_degrees()
            };
            prop_assert!(at(a + step) > at(a), "{} {}", at(a), at(a + step));
        }
    }

    #[test]
    fn arms_hang_as_low_as_the_trunk_lets_them() {
        let hung = |body: &Body| {
            let elbow = Swing::hanging(body).unwrap().place(&body.landmarks["elbow_left"]);
            ShoulderJoint::of(body, Hand::Left).unwrap().polar(&elbow)[1].to_degrees()
        };
        assert!((hung(&mannequin()) - 28.0).abs() < 1e-6);
        let wide = Mannequin::made(1.7, [1.2, 1.28, 1.35], 70.0, 0.016).run(&Context::quiet()).unwrap();
        let least = ArmAngles::of(&wide, Hand::Left).unwrap().least().to_degrees();
        assert!((hung(&wide) - least.max(28.0)).abs() < 1e-6, "{least} {}", hung(&wide));
        assert!(Swing::to(&wide, (least + 0.1).to_radians()).is_ok());
        assert!(Swing::to(&wide, (least - 0.1).to_radians()).is_err());
        let low = Mannequin::made(1.7, [0.9, 0.7, 0.95], 40.0, 0.016).run(&Context::quiet()).unwrap();
        assert!(hung(&low) <= 28.0 + 1e-6);
    }

    thread_local! {
        static BODY: Body = mannequin();
    }

    #[test]
    fn arms_stand_off_as_they_were_asked_to() {
        assert!((angle(&mannequin()) - 60.0).abs() < 5.0, "{}", angle(&mannequin()));
    }
}
