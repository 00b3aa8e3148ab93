//! The left leg and its foot, which is cut flat at the ground.

use crate::limbs::loft::{Loft, LoftSection};
use crate::measures::bounds::Bounds;
use crate::shape::FigureShape;
use crate::skin::field::{smooth_max, smooth_min};
use toile_core::artifact::{Point3, Vector3};

/// How far the foot is turned out, degrees.
const TURNED: f64 = 6.0;

/// A leg with its foot.
#[derive(Debug, Clone)]
pub(crate) struct Leg {
    leg: Loft,
    foot: Loft,
    bounds: Bounds,
    stature: f64,
}

/// Hip and ankle of the left leg.
pub(crate) fn axis(shape: &FigureShape) -> [Point3; 2] {
    let [hip, ankle] = shape.leg_out();
    [
        Point3::new(hip, shape.y(0.575), -0.002 * shape.hip()),
        Point3::new(ankle, shape.y(0.055), -0.032 * shape.stature),
    ]
}

impl Leg {
    pub(crate) fn new(shape: &FigureShape) -> Self {
        let (leg, foot) = (leg(shape), foot(shape));
        let bounds = Bounds::of([leg.bounds().lo, leg.bounds().hi, foot.bounds().lo, foot.bounds().hi]);
        Leg { leg, foot, bounds, stature: shape.stature }
    }

    /// The box around leg and foot.
    pub(crate) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The value.
    pub(crate) fn value(&self, p: Point3) -> f64 {
        let (leg, k) = (self.leg.value(p), 0.045 * self.stature);
        let leg = if self.foot.bounds().at_least(p) > leg + k {
            leg
        } else {
            smooth_min(leg, self.foot.value(p), k)
        };
        smooth_max(leg, -p.y, 0.01 * self.stature)
    }
}

fn leg(shape: &FigureShape) -> Loft {
    let axis = axis(shape);
    let (s, hip) = (shape.stature, shape.hip());
    let (thigh, shin) = (hip * shape.width_of_hip(), shape.build(hip));
    // Level, to the inside, to the front, half width, depth in front and behind.
    let rows = [
        (0.575, 0.0, 0.0, 0.060, 0.060, 0.062),
        (0.548, 0.0, 0.0, 0.073, 0.073, 0.075),
        (0.510, 0.0, 0.003, 0.082, 0.082, 0.083),
        (0.460, 0.0, 0.008, 0.076, 0.079, 0.077),
        (0.400, 0.0, 0.011, 0.066, 0.069, 0.064),
        (0.350, 0.0, 0.009, 0.056, 0.058, 0.053),
        (0.322, 0.0, 0.007, 0.053, 0.055, 0.050),
        (0.292, 0.0, 0.002, 0.051, 0.050, 0.053),
        (0.250, 0.0, -0.002, 0.054, 0.047, 0.061),
        (0.215, 0.0, -0.002, 0.052, 0.044, 0.058),
        (0.155, 0.0, 0.001, 0.040, 0.037, 0.043),
        (0.105, 0.0, 0.002, 0.0310, 0.032, 0.033),
        (0.072, 0.0, 0.003, 0.0295, 0.033, 0.031),
        (0.020, 0.0, 0.006, 0.0300, 0.036, 0.031),
    ];
    let cosine = (axis[0].y - axis[1].y) / (axis[1] - axis[0]).norm();
    let knot = |&(l, u, w, half, ahead, behind): &(f64, f64, f64, f64, f64, f64)| -> (f64, LoftSection) {
        let r = shin + (thigh - shin) * ((l - 0.33) / 0.12).clamp(0.0, 1.0);
        ((axis[0].y - shape.y(l)) / cosine, [u * s, w * s, half * r, ahead * r, behind * r])
    };
    let knots: Vec<_> = rows.iter().map(knot).collect();
    let end = (axis[1] - axis[0]).norm() + 0.045 * s;
    Loft::new(axis, Vector3::z(), &knots, [0.0, end], 0.03 * s)
}

/// From heel to toes; the sections' front is up.
fn foot(shape: &FigureShape) -> Loft {
    let k = shape.stature * shape.form.foot;
    let ankle = axis(shape)[1];
    let (sin, cos) = TURNED.to_radians().sin_cos();
    let heel = Point3::new(ankle.x - 0.004 * k, 0.0, ankle.z - 0.044 * k);
    let rows = [
        (0.000, [0.0, 0.022, 0.024, 0.022, 0.03]),
        (0.025, [0.0, 0.022, 0.031, 0.042, 0.03]),
        (0.060, [0.0, 0.022, 0.033, 0.056, 0.03]),
        (0.100, [-0.001, 0.021, 0.035, 0.046, 0.03]),
        (0.145, [-0.001, 0.017, 0.041, 0.034, 0.03]),
        (0.185, [0.001, 0.013, 0.044, 0.024, 0.03]),
        (0.215, [0.005, 0.012, 0.040, 0.016, 0.03]),
        (0.250, [0.008, 0.011, 0.030, 0.011, 0.03]),
    ];
    let knots = rows.map(|(l, s)| (l * k, s.map(|v| v * k)));
    let ends = [heel, heel + Vector3::new(sin, 0.0, cos)];
    Loft::new(ends, Vector3::y(), &knots, [0.006 * k, 0.240 * k], 0.030 * k)
}
