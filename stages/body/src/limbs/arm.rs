//! The left arm and its hand: four fingers together, a little bent, and a thumb.

use crate::limbs::limb::BentTube;
use crate::limbs::loft::{Loft, LoftSection};
use crate::limbs::spline::KnotSpline;
use crate::limbs::torso::girdle;
use crate::measures::bounds::Bounds;
use crate::shape::FigureShape;
use crate::skin::field::smooth_min;
use toile_core::artifact::{Point3, Vector3};

/// How far the forearm turns forward at the elbow, degrees.
const BEND: f64 = 12.0;

/// Shoulder joint, elbow and wrist of the left arm: the axis, not the skin.
pub(crate) fn axis(shape: &FigureShape) -> [Point3; 3] {
    let joint = girdle(shape).axis()[1] + Vector3::new(0.002, 0.006, 0.002) * shape.stature;
    let (sin, cos) = shape.size.arm_angle.sin_cos();
    let length = shape.aims.arm * shape.stature;
    let bend = BEND.to_radians();
    let upper = Vector3::new(sin, -cos, 0.0) * (0.295 * length);
    let fore = Vector3::new(sin * bend.cos(), -cos * bend.cos(), bend.sin()) * (0.250 * length);
    [joint, joint + upper, joint + upper + fore]
}

/// An arm with its hand.
#[derive(Debug, Clone)]
pub(crate) struct Arm {
    arm: Loft,
    palm: Loft,
    fingers: Vec<BentTube>,
    /// Flesh between fingers, and between thumb and palm.
    webs: Vec<BentTube>,
    thumb: BentTube,
    /// The boxes around all and around the hand.
    bounds: [Bounds; 2],
    scale: f64,
    wrist: Point3,
    along: Vector3,
}

impl Arm {
    pub(crate) fn new(shape: &FigureShape) -> Self {
        let axis = axis(shape);
        let arm = arm(shape, &axis);
        let hand = HandParts::new(shape, &axis);
        let (palm, fingers, webs, thumb) = (hand.palm(), hand.fingers(), hand.webs(), hand.thumb());
        let tips = fingers.iter().chain([&thumb]).flat_map(|l| l.axis().to_vec());
        let pad = Vector3::from([0.015 * hand.scale; 3]);
        let around =
            Bounds::of(tips.chain([palm.bounds().lo, palm.bounds().hi]).flat_map(|p| [p - pad, p + pad]));
        let whole = Bounds::of([around.lo, around.hi, arm.bounds().lo, arm.bounds().hi]);
        let (scale, wrist, along) = (hand.scale, axis[2], hand.along);
        Arm { arm, palm, fingers, webs, thumb, bounds: [whole, around], scale, wrist, along }
    }

    /// The box around arm and hand.
    pub(crate) fn bounds(&self) -> &Bounds {
        &self.bounds[0]
    }

    /// The value where the hand is thicker by a length.
    pub(crate) fn value(&self, p: Point3, thicker: f64) -> f64 {
        let (arm, k) = (self.arm.value(p), 0.02 * self.scale);
        let far = self.bounds[1].at_least(p) - thicker > arm + k;
        if far { arm } else { smooth_min(arm, self.hand(p) - thicker, k) }
    }

    fn hand(&self, p: Point3) -> f64 {
        let k = self.scale;
        let join = |v: f64, l: &BentTube| l.joined(v, p, 0.006 * k);
        let fingers = self.fingers.iter().chain(&self.webs).fold(f64::INFINITY, join);
        let hand = smooth_min(self.palm.value(p), fingers, 0.010 * k);
        smooth_min(hand, self.thumb.value(p), 0.016 * k)
    }

    /// How far beyond the wrist a point of the hand lies, in lengths of a hand; negative elsewhere.
    pub(crate) fn beyond_wrist(&self, p: Point3) -> f64 {
        let on_hand = self.bounds[1].holds(&p);
        if on_hand { (p - self.wrist).dot(&self.along) / (0.17 * self.scale) } else { -1.0 }
    }
}

fn arm(shape: &FigureShape, [joint, elbow, wrist]: &[Point3; 3]) -> Loft {
    let (r, whole) = (shape.arm_build(), (wrist - joint).norm());
    let unit = shape.aims.arm * shape.stature;
    let along = (wrist - joint).normalize();
    let bow = (elbow - joint) - along * (elbow - joint).dot(&along);
    let bow = bow.norm() * bow.z.signum();
    // Share of the way, side, thickness, depth in front and behind.
    let rows = [
        (-0.02, 0.047, 0.050, 0.051),
        (0.03, 0.047, 0.050, 0.051),
        (0.09, 0.0440, 0.0465, 0.047),
        (0.16, 0.0415, 0.044, 0.042),
        (0.23, 0.0385, 0.040, 0.0385),
        (0.295, 0.0355, 0.0365, 0.037),
        (0.345, 0.0365, 0.0395, 0.036),
        (0.39, 0.0350, 0.0385, 0.034),
        (0.45, 0.0290, 0.0325, 0.030),
        (0.51, 0.0225, 0.0270, 0.0265),
        (0.545, 0.0205, 0.0265, 0.0265),
        (0.575, 0.0190, 0.0265, 0.0265),
    ];
    // The elbow lies before or behind the straight line.
    let middle = KnotSpline::new([(0.0, 0.0), (0.16, 0.42), (0.295, 1.0), (0.42, 0.5), (0.545, 0.0)]);
    let knot = |&(l, side, ahead, behind): &(f64, f64, f64, f64)| -> (f64, LoftSection) {
        (l * unit, [0.0, bow * middle.at(l), side * r, ahead * r, behind * r])
    };
    let knots: Vec<_> = rows.iter().map(knot).collect();
    let s = shape.stature;
    Loft::new([*joint, *wrist], Vector3::z(), &knots, [-0.012 * s, whole + 0.012 * s], 0.04 * s)
}

/// Makes the parts of a hand.
struct HandParts {
    wrist: Point3,
    along: Vector3,
    /// To the thumb.
    out: Vector3,
    /// To the side of the palm.
    down: Vector3,
    scale: f64,
}

impl HandParts {
    fn new(shape: &FigureShape, axis: &[Point3; 3]) -> Self {
        let along = (axis[2] - axis[1]).normalize();
        let out = (Vector3::z() - along * along.z).normalize();
        let scale = shape.stature * shape.form.hand;
        HandParts { wrist: axis[2], along, out, down: along.cross(&out), scale }
    }

    fn at(&self, along: f64, out: f64, down: f64) -> Point3 {
        self.wrist + (self.along * along + self.out * out + self.down * down) * self.scale
    }

    fn palm(&self) -> Loft {
        let rows = [
            (-0.015, [0.0, 0.0, 0.0185, 0.0250, 0.0250]),
            (0.010, [0.0, 0.0, 0.0175, 0.0265, 0.0260]),
            (0.035, [0.001, 0.0, 0.0175, 0.0330, 0.0330]),
            (0.065, [0.001, 0.0, 0.0160, 0.0365, 0.0360]),
            (0.090, [0.000, 0.0, 0.0135, 0.0370, 0.0350]),
            (0.105, [0.000, 0.0, 0.0110, 0.0350, 0.0330]),
        ];
        let knots = rows.map(|(l, s)| (l * self.scale, s.map(|v| v * self.scale)));
        let span = [-0.01, 0.098].map(|l| l * self.scale);
        Loft::new([self.wrist, self.wrist + self.along], self.out, &knots, span, 0.014 * self.scale)
    }

    /// From the knuckles: where across the palm, how long, how thick.
    fn fingers(&self) -> Vec<BentTube> {
        let rows = [
            (0.0275, 0.070, 0.0095),
            (0.0095, 0.080, 0.0100),
            (-0.0090, 0.074, 0.0095),
            (-0.0265, 0.056, 0.0083),
        ];
        rows.map(|(across, length, r)| self.finger(across, length, r)).to_vec()
    }

    /// Between the fingers, thinner and shorter, and between thumb and palm.
    fn webs(&self) -> Vec<BentTube> {
        let rows = [(0.0185, 0.066, 0.0084), (0.0, 0.073, 0.0084), (-0.018, 0.057, 0.0076)];
        let mut webs = rows.map(|(across, length, r)| self.finger(across, length, r)).to_vec();
        let k = self.scale;
        let axis = vec![self.at(0.045, 0.028, 0.006), self.at(0.100, 0.032, 0.008)];
        webs.push(BentTube::new(
            axis,
            KnotSpline::new([(0.0, 0.012 * k), (0.055 * k, 0.0095 * k)]),
            [1.0, 1.0],
        ));
        webs
    }

    fn finger(&self, across: f64, length: f64, radius: f64) -> BentTube {
        let mut points = vec![(0.086, 0.0)];
        for (share, turn) in [(0.15, 4.0_f64), (0.30, 10.0), (0.30, 24.0), (0.25, 38.0)] {
            let (l, d) = points[points.len() - 1];
            let (sin, cos) = turn.to_radians().sin_cos();
            points.push((l + share * length * cos, d + share * length * sin));
        }
        let gather = |l: f64| across * (1.0 - 0.10 * ((l - 0.086) / 0.08));
        let axis = points.iter().map(|&(l, d)| self.at(l, gather(l), d)).collect();
        let k = self.scale;
        let radius = [(0.0, radius * 1.05), (0.5 * length, radius), (length, 0.78 * radius)];
        BentTube::new(axis, KnotSpline::new(radius.map(|(l, r)| (l * k, r * k))), [1.0, 1.0])
    }

    fn thumb(&self) -> BentTube {
        let k = self.scale;
        let axis =
            vec![self.at(0.022, 0.016, 0.006), self.at(0.058, 0.034, 0.014), self.at(0.100, 0.038, 0.017)];
        let radius = [(0.0, 0.0150), (0.045, 0.0130), (0.090, 0.0092)];
        BentTube::new(axis, KnotSpline::new(radius.map(|(l, r)| (l * k, r * k))), [1.0, 1.0])
    }
}
