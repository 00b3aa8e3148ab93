//! Measures of a figure: by ISO 8559-1 (2017) on its mesh, and on the smooth solid before it is
//! meshed.
//!
//! Girths are those of a tape, which spans hollows. Arms are measured from the shoulder point over
//! the elbow to the wrist, the inseam from the fork of the legs to the sole.

use crate::figure::BodyFigure;
use crate::measures::landmarks::NamedLandmarks;
use crate::shape::{FigureSize, level};
use crate::skin::slice::{SliceLoop, convex_hull, slice, trunk};
use crate::skin::topology::SkinMesh;
use nalgebra::{Rotation3, Unit};
use toile_core::artifact::{Hand, Point2, Point3, Vector3};

/// Rays of a tape around the smooth figure: a polygon of so many corners is short by 0.04 %.
const RAYS: usize = 64;
/// The least step along a ray, metres.
const STEP: f64 = 0.003;
/// Lines on which the highest or lowest point of the smooth figure is looked for.
const LINES: i32 = 9;

/// Hip, waist, bust, neck, arm and inseam, metres.
pub(crate) type Six = [f64; 6];

/// The measures that a size requires.
pub(crate) fn wanted(size: &FigureSize) -> Six {
    [size.hip, size.waist, size.bust, size.neck, size.arm, size.inseam]
}

/// The measures of the smooth figure.
pub(crate) fn smooth(figure: &BodyFigure) -> Six {
    let level = |l: f64| tape(figure, Point3::new(0.0, figure.y(l), 0.0), Vector3::z());
    let (middle, along) = figure.neck();
    let neck = tape(figure, middle, Vector3::x().cross(&along));
    [level(level::HIP), level(level::WAIST), level(level::BUST), neck, arm(figure), fork(figure)]
}

/// The length of a tape around the figure without arms: rays from `centre` to the sides and to
/// `front` meet the skin.
fn tape(figure: &BodyFigure, centre: Point3, front: Vector3) -> f64 {
    let half = RAYS / 2;
    let ring = (0..half).flat_map(|i| {
        let (sin, cos) = ((i as f64 + 0.5) * std::f64::consts::PI / half as f64).sin_cos();
        let way = Vector3::x() * sin + front * cos;
        let r = skin(|r| figure.without_arms(centre + way * r));
        [Point2::new(r * sin, r * cos), Point2::new(-r * sin, r * cos)]
    });
    let hull = convex_hull(ring.collect());
    (0..hull.len()).map(|i| (hull[(i + 1) % hull.len()] - hull[i]).norm()).sum()
}

/// The first place along a ray from inside at which the value is zero.
fn skin(value: impl Fn(f64) -> f64) -> f64 {
    let (mut near, mut inside) = (0.0, value(0.0));
    for _ in 0..200 {
        let far = near + (-0.7 * inside).max(STEP);
        let outside = value(far);
        if outside >= 0.0 {
            return zero(&value, [near, far], [inside, outside]);
        }
        (near, inside) = (far, outside);
    }
    near
}

/// Where the value between two places is zero: regula falsi, four steps.
fn zero(
    value: impl Fn(f64) -> f64,
    [mut near, mut far]: [f64; 2],
    [mut inside, mut outside]: [f64; 2],
) -> f64 {
    for _ in 0..4 {
        let middle = near + (far - near) * (inside / (inside - outside)).clamp(0.02, 0.98);
        let v = value(middle);
        if v < 0.0 { (near, inside) = (middle, v) } else { (far, outside) = (middle, v) }
    }
    near + (far - near) * inside / (inside - outside)
}

/// Follows a line from outside towards the skin.
fn down(value: impl Fn(f64) -> f64, from: f64, sign: f64, reach: f64) -> Option<f64> {
    let mut y = from;
    for _ in 0..60 {
        let v = value(y);
        if v < 1e-5 {
            return Some(y);
        }
        y += sign * v.min(0.03) * 0.9;
        if (y - from).abs() > reach {
            return None;
        }
    }
    Some(y)
}

fn arm(figure: &BodyFigure) -> f64 {
    use crate::skin::field::ScalarField;
    let [joint, elbow, wrist] = figure.arm_axis;
    let (s, x) = (figure.shape.stature, figure.size().shoulder_width / 2.0);
    let line = |k: i32| {
        let z = joint.z + f64::from(k - LINES / 2) * 0.008 * s;
        let y = down(|y| figure.value(Point3::new(x, y, z)), joint.y + 0.12 * s, -1.0, 0.3)?;
        Some(Point3::new(x, y, z))
    };
    let top = (0..LINES).filter_map(line).reduce(|a, b| if b.y > a.y { b } else { a }).unwrap_or(joint);
    (elbow - top).norm() + (wrist - elbow).norm()
}

fn fork(figure: &BodyFigure) -> f64 {
    let s = figure.shape.stature;
    let from = 0.8 * figure.y(level::CROTCH);
    let line = |k: i32| {
        let z = f64::from(k - LINES / 2) * 0.014 * s;
        down(|y| figure.without_arms(Point3::new(0.0, y, z)), from, 1.0, 0.3)
    };
    (0..LINES).filter_map(line).reduce(f64::min).unwrap_or(from)
}

/// The measures of the mesh with its landmarks.
pub(crate) fn meshed(figure: &BodyFigure, mesh: &SkinMesh, marks: &NamedLandmarks) -> Option<Six> {
    let (positions, triangles) = mesh;
    let level = |l: f64| trunk(&slice(positions, triangles, figure.y(l)), 0.0).map(|r| r.girth);
    let (middle, along) = figure.neck();
    let at = |name: &str| marks.get(&Hand::Left.name(name));
    let (shoulder, elbow, wrist) = (at("shoulder")?, at("elbow")?, at("wrist")?);
    let arm = (shoulder - elbow).norm() + (elbow - wrist).norm();
    Some([
        level(level::HIP)?,
        level(level::WAIST)?,
        level(level::BUST)?,
        around(mesh, middle, along)?,
        arm,
        marks.get("crotch")?.y,
    ])
}

/// Girths of upper arm and thigh, which are reported and not fitted.
pub(crate) fn limbs(figure: &BodyFigure, mesh: &SkinMesh, marks: &NamedLandmarks) -> Option<[f64; 2]> {
    let (middle, along) = figure.upper_arm();
    let fork = marks.get("crotch")?.y;
    let below = slice(&mesh.0, &mesh.1, fork - 0.012 * figure.shape.stature);
    let thigh = below.iter().find(|l| l.bounds[0] > 0.0 && l.centre().x < 0.3 * fork)?;
    Some([around(mesh, middle, along)?, thigh.girth])
}

/// The girth in the plane through a point and square to a direction: that of the loop around the
/// point.
fn around((positions, triangles): &SkinMesh, centre: Point3, along: Vector3) -> Option<f64> {
    let turn = Rotation3::rotation_between(&Unit::new_normalize(along), &Vector3::y_axis())?;
    let turned: Vec<Point3> = positions.iter().map(|p| Point3::from(turn * (p - centre))).collect();
    let holds = |l: &&SliceLoop| {
        let [x0, x1, z0, z1] = l.bounds;
        x0 < 0.0 && x1 > 0.0 && z0 < 0.0 && z1 > 0.0
    };
    let loops = slice(&turned, triangles, 0.0);
    loops.iter().filter(holds).map(|l| l.girth).reduce(f64::min)
}
