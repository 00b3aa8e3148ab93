//! Trunk, breasts, seat, shoulder line and neck.

use crate::form::TrunkRow;
use crate::limbs::limb::BentTube;
use crate::limbs::loft::{Loft, LoftSection};
use crate::limbs::spline::KnotSpline;
use crate::measures::bounds::Bounds;
use crate::shape::{ADULT, ADULT_CHIN, FigureShape, level};
use crate::skin::field::{Ellipsoid, smooth_min};
use toile_core::artifact::{Point3, Vector3};

/// Where the trunk's sections stop, as levels.
const SPAN: [f64; 2] = [0.515, 0.962];

/// The body without head and limbs.
#[derive(Debug, Clone)]
pub(crate) struct Torso {
    trunk: Loft,
    breasts: Vec<Ellipsoid>,
    seat: Ellipsoid,
    girdle: BentTube,
    neck: Loft,
    bounds: Bounds,
    stature: f64,
}

impl Torso {
    pub(crate) fn new(shape: &FigureShape) -> Self {
        let trunk = trunk(shape);
        let bounds = *trunk.bounds();
        Torso {
            breasts: breasts(shape),
            seat: seat(shape),
            girdle: girdle(shape),
            neck: neck(shape),
            trunk,
            bounds,
            stature: shape.stature,
        }
    }

    /// The box around the trunk.
    pub(crate) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The value of trunk, breasts, seat and shoulder line.
    pub(crate) fn value(&self, p: Point3) -> f64 {
        let s = self.stature;
        let right = Point3::new(-p.x, p.y, p.z);
        // Both of a pair, so that no crease shows in the middle.
        let pair = |e: &Ellipsoid, k: f64| smooth_min(e.value(p), e.value(right), k);
        let trunk = self.girdle.joined(self.trunk.value(p), p, 0.10 * s);
        let front = self.breasts.iter().fold(trunk, |v, e| smooth_min(v, pair(e, 0.045 * s), 0.06 * s));
        smooth_min(front, pair(&self.seat, 0.02 * s), 0.055 * s)
    }

    /// The value of the neck.
    pub(crate) fn neck(&self, p: Point3) -> f64 {
        self.neck.value(p)
    }
}

fn trunk(shape: &FigureShape) -> Loft {
    let [hip, waist, bust] = shape.aims.trunk;
    let levels = [(level::CROTCH, hip), (level::HIP, hip), (level::WAIST, waist), (level::BUST, bust)];
    let shoulders = shape.size.shoulder_width / ADULT.shoulder_width;
    let top = 0.945;
    let depth = KnotSpline::new(levels.into_iter().chain([(top, shape.build(bust))]));
    let width = KnotSpline::new(levels.into_iter().chain([(top, shoulders)]));
    let section = |r: &TrunkRow| -> (f64, LoftSection) {
        let d = depth.at(r[0]);
        (shape.y(r[0]), [0.0, 0.0, r[1] * width.at(r[0]), r[2] * d, r[3] * d])
    };
    let knots: Vec<(f64, LoftSection)> = shape.form.trunk.iter().map(section).collect();
    let ends = [Point3::origin(), Point3::new(0.0, 1.0, 0.0)];
    Loft::new(ends, Vector3::z(), &knots, SPAN.map(|l| shape.y(l)), 0.05 * shape.stature).boxy()
}

/// A fuller lower and a flatter upper half; breasts grow with the difference of bust and waist.
fn breasts(shape: &FigureShape) -> Vec<Ellipsoid> {
    let ratio = shape.size.bust / shape.size.waist;
    let fullness = shape.form.breast * ((ratio - 1.0) / 0.24).clamp(0.35, 1.25);
    if shape.form.breast <= 0.0 {
        return Vec::new();
    }
    let b = shape.bust();
    let y = |l: f64| shape.y(level::BUST + l);
    let size = 0.72 + 0.28 * fullness.min(1.1);
    let at = |x: f64, l: f64, z: f64| Point3::new(x * b, y(l), z * b);
    vec![
        Ellipsoid {
            centre: at(0.073, -0.004, 0.048 + 0.022 * fullness),
            half_axes: Vector3::new(0.058, 0.056, 0.052) * b * size,
        },
        Ellipsoid {
            centre: at(0.068, 0.030, 0.034 + 0.012 * fullness),
            half_axes: Vector3::new(0.056, 0.080, 0.042) * b * size,
        },
    ]
}

/// The fullness of the seat behind.
fn seat(shape: &FigureShape) -> Ellipsoid {
    let (hip, k) = (shape.hip(), shape.form.seat);
    Ellipsoid {
        centre: Point3::new(0.074 * hip, shape.y(0.578), (-0.056 - 0.008 * (k - 0.9)) * hip),
        half_axes: Vector3::new(0.080, 0.092, 0.076 * k) * hip,
    }
}

/// The shoulder line: from the neck down to the shoulder joint. The skin over it slopes by some 24
/// degrees from the neck to the shoulder point, as is usual (Taniyama and others 1970: 22 to 24;
/// mean body of GarmentCode: 22).
pub(crate) fn girdle(shape: &FigureShape) -> BentTube {
    let s = shape.stature;
    let [inner, outer] = [0.047 * s, 0.046 * shape.arm_build()];
    let half = shape.size.shoulder_width / 2.0;
    let slope = 18.5_f64.to_radians();
    let neck = Point3::new(0.02 * s, shape.y(level::NECK) - inner * 0.9, -0.026 * s);
    let joint = Point3::new(half - outer * 0.85, 0.0, -0.020 * s);
    let drop = (joint.x - neck.x) * slope.tan();
    let joint = Point3::new(joint.x, neck.y - drop + (inner - outer) / slope.cos(), joint.z);
    let length = (joint - neck).norm();
    BentTube::new(vec![neck, joint], KnotSpline::new([(0.0, inner), (length, outer)]), [1.0, 1.2])
}

/// The neck's axis: it leans forward.
pub(crate) fn neck_axis(shape: &FigureShape) -> [Point3; 2] {
    let s = shape.stature;
    [Point3::new(0.0, shape.y(0.93), -0.040 * s), Point3::new(0.0, shape.chin * 1.03, -0.001 * s)]
}

fn neck(shape: &FigureShape) -> Loft {
    let (r, axis) = (shape.aims.neck, neck_axis(shape));
    let length = (axis[1] - axis[0]).norm();
    let knot = |share: f64, k: f64| (share * length, [0.0, 0.0, 0.97 * k * r, 1.0 * k * r, 1.04 * k * r]);
    let knots = [knot(0.0, 1.14), knot(0.35, 1.03), knot(0.6, 1.0), knot(1.0, 1.0)];
    Loft::new(axis, Vector3::z(), &knots, [0.0, length], 0.02 * shape.stature)
}

/// The middle of the neck where its girth is taken, and the direction of its axis.
pub(crate) fn neck_middle(shape: &FigureShape) -> (Point3, Vector3) {
    let [from, to] = neck_axis(shape);
    let y = level::NECK_GIRTH * ADULT_CHIN * shape.stature;
    (from + (to - from) * ((y - from.y) / (to.y - from.y)), (to - from).normalize())
}
