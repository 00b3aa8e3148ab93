//! A human figure as a smooth solid: trunk, breasts, shoulders, neck, head, arms, hands, legs, feet.
//!
//! The trunk is a [`Loft`] through a table of sections (mean proportions of standing adults, after
//! the anthropometric tables of Gordon and others, 1989); limbs are [`Limb`]s. Levels are shares of
//! the height up to the chin, so that a child, whose head is larger, still has its waist where the
//! trunk has one. Girths are met by scaling the table between bust, waist and hip.
//!
//! Limit: a dress form, not a portrait: no fingers, no face.

use super::field::{Ellipsoid, Field, Loft, smooth_max, smooth_min};
use super::limb::Limb;
use super::spline::Spline;
use toile_core::artifact::{Point3, Vector3};

/// What a figure is made to, metres and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Size {
    /// Crown to sole.
    pub height: f64,
    /// Girth at the bust.
    pub bust: f64,
    /// Girth at the waist.
    pub waist: f64,
    /// Girth at the hip.
    pub hip: f64,
    /// Shoulder point to shoulder point.
    pub shoulder_width: f64,
    /// Girth of the neck.
    pub neck: f64,
    /// Angle between the upper arm and the vertical.
    pub arm_angle: f64,
}

/// The adult whose sections stand in [`TRUNK`].
const ADULT: Size = Size {
    height: 1.72,
    bust: 0.88,
    waist: 0.70,
    hip: 0.96,
    shoulder_width: 0.386,
    neck: 0.345,
    arm_angle: std::f64::consts::FRAC_PI_4,
};
/// The adult's height up to the chin.
const ADULT_CHIN: f64 = 1.495;

/// Sections of the trunk: level, half width, depth in front and behind the axis (metres).
const TRUNK: [[f64; 4]; 11] = [
    [0.490, 0.150, 0.078, 0.080],
    [0.537, 0.170, 0.092, 0.108],
    [0.598, 0.176, 0.106, 0.124],
    [0.655, 0.156, 0.108, 0.096],
    [0.725, 0.123, 0.097, 0.074],
    [0.775, 0.130, 0.103, 0.086],
    [0.828, 0.144, 0.113, 0.099],
    [0.870, 0.146, 0.104, 0.106],
    [0.910, 0.138, 0.084, 0.101],
    [0.945, 0.112, 0.060, 0.088],
    [0.970, 0.070, 0.040, 0.066],
];
/// Where the trunk's sections stop.
const TRUNK_SPAN: [f64; 2] = [0.515, 0.962];

/// Levels of the tape measures and joints as shares of the height up to the chin.
pub(crate) mod level {
    /// Fork of the legs.
    pub(crate) const CROTCH: f64 = 0.533;
    /// Fullest place of the seat.
    pub(crate) const HIP: f64 = 0.598;
    /// Narrowest place of the trunk.
    pub(crate) const WAIST: f64 = 0.725;
    /// Fullest place of the chest.
    pub(crate) const BUST: f64 = 0.828;
    /// Outer point of the shoulder.
    pub(crate) const SHOULDER: f64 = 0.938;
    /// Where the shoulder line meets the neck.
    pub(crate) const NECK: f64 = 0.974;
}

/// Share of its width that a smooth minimum takes off at most.
const JOINING: f64 = 1.0 / 6.0;

/// Width over which arms and trunk are joined, metres on the adult.
const ARM: f64 = 0.06;

/// The height of the head from chin to crown: from 18 cm at one year to 22.5 cm grown up.
fn head_height(height: f64) -> f64 {
    0.18 + (height - 0.8) * (0.045 / 0.92)
}

/// A figure of given size; `trunk` scales its sections at hip, waist and bust.
#[derive(Debug, Clone)]
pub(crate) struct Figure {
    /// The height up to the chin, metres.
    pub chin: f64,
    /// Shoulder point, elbow and wrist of the left arm (the axis, not the skin).
    pub arm_axis: [Point3; 3],
    size: Size,
    trunk: Loft,
    breast: Option<Ellipsoid>,
    girdle: Limb,
    neck: Limb,
    head: [Ellipsoid; 2],
    arm: Limb,
    hand: [Limb; 2],
    leg: Limb,
    foot: Limb,
    seat: Ellipsoid,
}

impl Figure {
    /// The figure of that size with its trunk scaled by `[hip, waist, bust]`.
    pub(crate) fn new(size: &Size, scale: [f64; 3]) -> Self {
        let chin = size.height - head_height(size.height);
        let shape = Shape { size, scale, chin, stature: chin / ADULT_CHIN };
        let girdle = shape.girdle();
        let arm_axis = shape.arm_axis();
        Figure {
            chin,
            arm_axis,
            size: *size,
            trunk: shape.trunk(),
            breast: shape.breast(),
            girdle,
            neck: shape.neck(),
            head: shape.head(),
            arm: shape.arm(&arm_axis),
            hand: shape.hand(&arm_axis),
            leg: shape.leg(),
            foot: shape.foot(),
            seat: shape.seat(),
        }
    }

    /// The size that it was made to.
    pub(crate) fn size(&self) -> &Size {
        &self.size
    }

    /// Upper x, lower and upper y, lower and upper z of a box that holds the half with x >= 0.
    pub(crate) fn bounds(&self) -> [f64; 5] {
        let deep = |s: &Spline| TRUNK.iter().map(|r| s.at(r[0] * self.chin)).fold(0.0, f64::max);
        let wide = deep(&self.trunk.half_width);
        let reach = self.hand[0].axis().iter().map(|p| p.x).fold(wide, f64::max) + 0.07;
        let toes = self.foot.axis().iter().map(|p| p.z).fold(0.0, f64::max) + 0.06;
        [
            reach,
            0.0,
            self.size.height,
            -(deep(&self.trunk.back) + 0.08),
            toes.max(deep(&self.trunk.front) + 0.1),
        ]
    }

    /// Head, neck and trunk with the shoulders.
    fn upper(&self, p: Point3, s: f64) -> f64 {
        let [skull, jaw] = self.head.map(|e| e.value(p));
        let head = smooth_min(skull, jaw, 0.05 * s);
        let mut trunk = self.girdle.joined(self.trunk.value(p), p, 0.11 * s);
        if let Some(breast) = self.breast {
            trunk = smooth_min(trunk, breast.value(p), 0.075 * s);
        }
        let trunk = smooth_min(trunk, self.seat.value(p), 0.06 * s);
        smooth_min(trunk, self.neck.joined(head, p, 0.04 * s), 0.07 * s)
    }

    /// `value` joined with arm and hand.
    fn with_arm(&self, value: f64, p: Point3, s: f64) -> f64 {
        let [palm, thumb] = &self.hand;
        let least = [&self.arm, palm, thumb].map(|l| l.at_least(p)).into_iter().fold(f64::INFINITY, f64::min);
        if least - JOINING * (0.03 + 0.02) * s > value + ARM * s {
            return value;
        }
        let hand = smooth_min(palm.value(p), thumb.value(p), 0.02 * s);
        smooth_min(value, smooth_min(self.arm.value(p), hand, 0.03 * s), ARM * s)
    }

    /// A leg, its foot cut flat at the ground.
    fn leg(&self, p: Point3, s: f64) -> f64 {
        let leg = self.foot.joined(self.leg.value(p), p, 0.05 * s);
        smooth_max(leg, -p.y, 0.01 * s)
    }
}

impl Figure {
    /// This figure's height against the adult's: widths of smoothing go with it.
    fn size_factor(&self) -> f64 {
        self.size.height / ADULT.height
    }

    /// The field of trunk, head and legs; it is symmetric, so x may have either sign.
    pub(crate) fn without_arms(&self, p: Point3) -> f64 {
        self.joined(p, |p, s| self.upper(p, s))
    }

    /// `upper` above, the legs below, both joined smoothly around the hips.
    fn joined(&self, p: Point3, upper: impl Fn(Point3, f64) -> f64) -> f64 {
        let s = self.size_factor();
        let right = Point3::new(-p.x.abs(), p.y, p.z);
        let p = Point3::new(p.x.abs(), p.y, p.z);
        let legs = || {
            let left = self.leg(p, s);
            let least = self.leg.at_least(right).min(self.foot.at_least(right)) - JOINING * 0.05 * s;
            if least > left + 0.07 * s { left } else { smooth_min(left, self.leg(right, s), 0.07 * s) }
        };
        // Parts that are far above or below cannot be the nearest.
        match p.y / self.chin {
            v if v > 0.72 => upper(p, s),
            v if v < 0.35 => legs(),
            _ => smooth_min(upper(p, s), legs(), 0.07 * s),
        }
    }
}

impl Field for Figure {
    fn value(&self, p: Point3) -> f64 {
        self.joined(p, |p, s| self.with_arm(self.upper(p, s), p, s))
    }
}

/// Makes the parts.
struct Shape<'a> {
    size: &'a Size,
    /// Hip, waist, bust.
    scale: [f64; 3],
    chin: f64,
    /// Skeleton against the adult's.
    stature: f64,
}

impl Shape<'_> {
    fn y(&self, level: f64) -> f64 {
        level * self.chin
    }

    /// Thickness of the arms: mostly by stature, so that the armpits of stout figures stay open.
    fn arm_build(&self) -> f64 {
        self.stature.powf(0.65) * self.scale[2].powf(0.35)
    }

    /// Thickness of the other limbs: half by stature, half by girth.
    fn build(&self, scale: f64) -> f64 {
        (self.stature * scale).sqrt()
    }

    fn trunk(&self) -> Loft {
        let [hip, waist, bust] = self.scale;
        let levels = [(level::CROTCH, hip), (level::HIP, hip), (level::WAIST, waist), (level::BUST, bust)];
        let shoulders = self.size.shoulder_width / ADULT.shoulder_width;
        let girth = Spline::new(levels.into_iter().chain([(TRUNK[9][0], self.build(bust))]));
        let width = Spline::new(levels.into_iter().chain([(TRUNK[9][0], shoulders)]));
        let column = |k: usize, s: &Spline| {
            Spline::new(TRUNK.iter().map(|row| (self.y(row[0]), row[k] * s.at(row[0]))))
        };
        Loft {
            half_width: column(1, &width),
            front: column(2, &girth),
            back: column(3, &girth),
            axis: Spline::new([(0.0, 0.0), (1.0, 0.0)]),
            span: TRUNK_SPAN.map(|v| self.y(v)),
            rounding: 0.05 * self.stature,
        }
    }

    /// Breasts grow with the difference of bust and waist; straight figures and children have none.
    fn breast(&self) -> Option<Ellipsoid> {
        let grown = ((self.size.height - 1.35) / 0.2).clamp(0.0, 1.0);
        let fullness = grown * ((self.size.bust / self.size.waist - 1.08) / 0.18).clamp(0.0, 1.3);
        let bust = self.scale[2];
        (fullness > 0.0).then(|| Ellipsoid {
            centre: Point3::new(0.072 * bust, self.y(level::BUST - 0.002), (0.062 + 0.012 * fullness) * bust),
            half_axes: Vector3::new(0.068, 0.072, 0.052) * bust * (0.7 + 0.3 * fullness.min(1.0)),
        })
    }

    /// The fullness of the seat behind.
    fn seat(&self) -> Ellipsoid {
        let hip = self.scale[0];
        Ellipsoid {
            centre: Point3::new(0.070 * hip, self.y(0.575), -0.055 * hip),
            half_axes: Vector3::new(0.082, 0.095, 0.078) * hip,
        }
    }

    /// The shoulder line: from the neck down to the shoulder joint at about 20 degrees.
    fn girdle(&self) -> Limb {
        let [inner, outer] = [0.052 * self.stature, 0.049 * self.arm_build()];
        let half = self.size.shoulder_width / 2.0;
        let slope = 21.0_f64.to_radians();
        let neck = Point3::new(0.02 * self.stature, self.y(level::NECK) - inner * 0.9, -0.022 * self.stature);
        let joint = Point3::new(half - outer * 0.85, 0.0, -0.016 * self.stature);
        let drop = (joint.x - neck.x) * slope.tan();
        let joint = Point3::new(joint.x, neck.y - drop + (inner - outer) / slope.cos(), joint.z);
        let length = (joint - neck).norm();
        Limb::new(vec![neck, joint], Spline::new([(0.0, inner), (length, outer)]), [1.0, 1.25])
    }

    fn arm_axis(&self) -> [Point3; 3] {
        let girdle = self.girdle();
        let joint = girdle.axis()[1] + Vector3::new(-0.006, -0.002, 0.0) * self.stature;
        let (sin, cos) = self.size.arm_angle.sin_cos();
        let upper = Vector3::new(sin, -cos, 0.0) * (0.285 * self.stature);
        let bend = 12.0_f64.to_radians();
        let fore = Vector3::new(sin * bend.cos(), -cos * bend.cos(), bend.sin()) * (0.245 * self.stature);
        [joint, joint + upper, joint + upper + fore]
    }

    fn arm(&self, axis: &[Point3; 3]) -> Limb {
        let r = self.arm_build();
        let profile = [
            (0.0, 0.050),
            (0.10, 0.0475),
            (0.20, 0.043),
            (0.285, 0.0385),
            (0.34, 0.0405),
            (0.44, 0.033),
            (0.53, 0.0255),
        ];
        Limb::new(axis.to_vec(), Spline::new(profile.map(|(l, v)| (l * self.stature, v * r))), [1.0, 1.05])
    }

    /// A mitten and its thumb.
    fn hand(&self, axis: &[Point3; 3]) -> [Limb; 2] {
        let along = (axis[2] - axis[1]).normalize();
        let wrist = axis[2] - along * (0.01 * self.stature);
        let limb = |from: Point3, to: Vector3, profile: &[(f64, f64)], stretch| {
            let radius = profile.iter().map(|&(l, r)| (l * self.stature, r * self.stature));
            Limb::new(vec![from, from + to], Spline::new(radius), stretch)
        };
        let palm = limb(
            wrist,
            along * (0.155 * self.stature),
            &[(0.0, 0.020), (0.06, 0.030), (0.10, 0.029), (0.155, 0.016)],
            [0.75, 1.3],
        );
        let root = wrist + along * (0.035 * self.stature) + Vector3::new(0.0, 0.0, 0.028 * self.stature);
        let towards = (along + Vector3::new(0.0, 0.0, 0.55)).normalize() * (0.055 * self.stature);
        [palm, limb(root, towards, &[(0.0, 0.017), (0.055, 0.0125)], [1.0, 1.0])]
    }

    fn neck(&self) -> Limb {
        let r = self.size.neck / std::f64::consts::TAU;
        let s = self.stature;
        let axis = vec![
            Point3::new(0.0, self.y(0.93), -0.030 * s),
            Point3::new(0.0, self.y(0.985), -0.014 * s),
            Point3::new(0.0, self.y(1.03), 0.006 * s),
        ];
        Limb::new(axis, Spline::new([(0.0, r * 1.12), (0.08 * s, r), (0.2 * s, r * 0.98)]), [1.0, 1.02])
    }

    /// Skull and jaw.
    fn head(&self) -> [Ellipsoid; 2] {
        let h = head_height(self.size.height) / 0.225;
        let top = self.size.height;
        let skull = Ellipsoid {
            centre: Point3::new(0.0, top - 0.098 * h, 0.010 * h),
            half_axes: Vector3::new(0.077, 0.098, 0.097) * h,
        };
        let jaw = Ellipsoid {
            centre: Point3::new(0.0, top - 0.140 * h, 0.042 * h),
            half_axes: Vector3::new(0.056, 0.085, 0.066) * h,
        };
        [skull, jaw]
    }

    fn leg(&self) -> Limb {
        let (s, hip) = (self.stature, self.scale[0]);
        let out = 0.093 * hip;
        let axis = vec![
            Point3::new(out * 0.98, self.y(0.575), -0.004 * hip),
            Point3::new(out + 0.010 * s, self.y(0.325), 0.004 * s),
            Point3::new(out + 0.020 * s, self.y(0.055), -0.030 * s),
        ];
        let (thigh, shin) = (hip, self.build(hip));
        let radii = [
            (0.575, 0.078 * thigh),
            (0.50, 0.0815 * thigh),
            (0.42, 0.071 * thigh),
            (0.33, 0.054 * shin),
            (0.29, 0.0505 * shin),
            (0.235, 0.055 * shin),
            (0.15, 0.043 * shin),
            (0.09, 0.0345 * shin),
            (0.055, 0.034 * shin),
        ];
        let top = self.y(0.575);
        Limb::new(axis, Spline::new(radii.map(|(v, r)| (top - self.y(v), r))), [1.0, 1.05])
    }

    /// From heel to toes, turned out a little.
    fn foot(&self) -> Limb {
        let (s, r) = (self.stature, self.build(self.scale[0]));
        let x = 0.093 * self.scale[0] + 0.020 * s;
        let axis = vec![
            Point3::new(x - 0.002 * s, 0.024 * s, -0.052 * s),
            Point3::new(x + 0.008 * s, 0.020 * s, 0.06 * s),
            Point3::new(x + 0.018 * s, 0.012 * s, 0.150 * s),
        ];
        let profile = [(0.0, 0.032), (0.06, 0.036), (0.14, 0.034), (0.204, 0.020)];
        Limb::new(axis, Spline::new(profile.map(|(l, v)| (l * s, v * r))), [1.12, 1.0])
    }
}
