//! The pose of a flat object before a pin-hole camera.
//!
//! Seven to nine unknowns (rotation, place, focal length, principal point) are fitted to pins:
//! places of the object whose picture lies on a line of the photo. Least squares by Levenberg and
//! Marquardt (1963), with what is known of cameras as further terms: the focal length is near a
//! phone's main lens, or near that which is stated, and the principal point near the middle. A
//! small object fixes the tilt by both its narrowing and its foreshortening (Zhang and He,
//! Whiteboard scanning, 2003, for the constraints); where the photo is straight-on the camera's
//! terms decide.
//!
//! Start: the homography of four corners, split into a pose with the expected focal length, and the
//! same with the tilt reversed (Schweighofer and Pinz, 2006: the two poses that a small object
//! allows).

use nalgebra::{DMatrix, DVector, Matrix3, Point2, Rotation3, SMatrix, SVector, Vector2, Vector3};

/// A place of the object, metres, whose picture lies on a line of the photo.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pin {
    pub(crate) model: Point2<f64>,
    pub(crate) at: Point2<f64>,
    /// Unit vector across the line.
    pub(crate) normal: Vector2<f64>,
    /// Standard error of the line's place, pixels.
    pub(crate) error: f64,
}

/// What is known of the camera, in pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KnownCamera {
    pub(crate) middle: Point2<f64>,
    pub(crate) longer: f64,
    pub(crate) focal: f64,
    /// Standard deviation of the focal length's logarithm.
    pub(crate) doubt: f64,
    /// The least and the most logarithm of the focal length over the expected one.
    pub(crate) bounds: [f64; 2],
    /// The most tilt of the ground, degrees.
    pub(crate) most_tilt: f64,
}

/// Standard deviation of the principal point, as a share of the longer side.
const OFF_MIDDLE: f64 = 0.012;

impl KnownCamera {
    /// The camera of a photo; the focal length on 35 mm film, if it is known.
    pub(crate) fn of(width: u32, height: u32, focal_35mm: Option<f64>) -> Self {
        let (w, h) = (f64::from(width), f64::from(height));
        let focal = focal_35mm.unwrap_or(PHONE) / FILM * w.hypot(h);
        let middle = Point2::new((w - 1.0) / 2.0, (h - 1.0) / 2.0);
        let (doubt, bounds, most_tilt) = match focal_35mm {
            Some(_) => (0.03, [-0.1, 0.1], MOST_TILT),
            None => (0.15, PHONES.map(|mm| (mm / PHONE).ln()), UNKNOWN_TILT),
        };
        KnownCamera { middle, longer: w.max(h), focal, doubt, bounds, most_tilt }
    }
}

/// Focal length of a phone's main lens on 35 mm film, mm.
const PHONE: f64 = 26.5;
/// Those of phones' main lenses lie between these, mm.
const PHONES: [f64; 2] = [22.0, 35.0];
/// The most tilt of the ground where the focal length is known, degrees.
pub(crate) const MOST_TILT: f64 = 60.0;
/// And where it is not: beyond, a tilt makes up for a wrong proportion.
const UNKNOWN_TILT: f64 = 35.0;
/// Diagonal of 35 mm film, mm.
const FILM: f64 = 43.267;
/// Numbers that are fitted.
const N: usize = 9;

/// A fitted pose.
#[derive(Debug, Clone)]
pub(crate) struct CameraPose {
    rotation: Rotation3<f64>,
    place: Vector3<f64>,
    /// Logarithm of the focal length over the expected one.
    focal: f64,
    /// Principal point from the photo's middle, over its longer side.
    shift: Vector2<f64>,
    /// Half the sum of squares, with the camera's terms.
    pub(crate) cost: f64,
}

impl CameraPose {
    /// From the object's metres to the photo's pixels.
    pub(crate) fn homography(&self, camera: &KnownCamera) -> Matrix3<f64> {
        let r = self.rotation.matrix();
        let columns = Matrix3::from_columns(&[r.column(0).into(), r.column(1).into(), self.place]);
        self.lens(camera) * columns
    }

    fn lens(&self, camera: &KnownCamera) -> Matrix3<f64> {
        let f = camera.focal * self.focal.exp();
        let c = camera.middle + self.shift * camera.longer;
        Matrix3::new(f, 0.0, c.x, 0.0, f, c.y, 0.0, 0.0, 1.0)
    }

    /// Angle between the line of sight to the object and the ground's normal, degrees.
    pub(crate) fn slant(&self) -> f64 {
        let normal = self.rotation.matrix().column(2).into_owned();
        (normal.dot(&self.place).abs() / self.place.norm().max(1e-12)).clamp(0.0, 1.0).acos().to_degrees()
    }

    /// Angle between the camera's axis and the ground's normal, degrees.
    pub(crate) fn tilt(&self) -> f64 {
        self.rotation.matrix()[(2, 2)].abs().clamp(0.0, 1.0).acos().to_degrees()
    }

    /// Whether the focal length is within the camera's bounds.
    pub(crate) fn plausible(&self, camera: &KnownCamera) -> bool {
        (camera.bounds[0]..=camera.bounds[1]).contains(&self.focal)
    }

    /// Sum of squares of the camera's own terms: how unusual a camera the pose needs.
    pub(crate) fn unusual(&self, camera: &KnownCamera) -> f64 {
        (self.focal / camera.doubt).powi(2) + (self.shift / OFF_MIDDLE).norm_squared()
    }

    fn moved(&self, step: &SVector<f64, N>) -> CameraPose {
        let turn = Rotation3::new(Vector3::new(step[0], step[1], step[2]));
        let place = self.place + Vector3::new(step[3], step[4], step[5]);
        let shift = self.shift + Vector2::new(step[7], step[8]);
        CameraPose {
            rotation: turn * self.rotation,
            place,
            focal: self.focal + step[6],
            shift,
            cost: self.cost,
        }
    }
}

/// A place through a homography.
pub(crate) fn through(h: &Matrix3<f64>, p: Point2<f64>) -> Point2<f64> {
    let q = h * Vector3::new(p.x, p.y, 1.0);
    Point2::new(q.x / q.z, q.y / q.z)
}

/// The homography that takes four or more places to others, by the direct linear transform with
/// scaled places (Hartley and Zisserman, Multiple View Geometry, 2004, alg. 4.2).
pub(crate) fn homography(from: &[Point2<f64>], to: &[Point2<f64>]) -> Option<Matrix3<f64>> {
    let (s, t) = (scaling(from)?, scaling(to)?);
    let mut rows = DMatrix::zeros((2 * from.len()).max(9), 9);
    for (i, (p, q)) in from.iter().zip(to).enumerate() {
        let (p, q) = (through(&s, *p), through(&t, *q));
        let row = [p.x, p.y, 1.0];
        for c in 0..3 {
            rows[(2 * i, c)] = row[c];
            rows[(2 * i, 6 + c)] = -q.x * row[c];
            rows[(2 * i + 1, 3 + c)] = row[c];
            rows[(2 * i + 1, 6 + c)] = -q.y * row[c];
        }
    }
    let svd = rows.try_svd(false, true, 1e-12, 200)?;
    let v = svd.v_t?;
    let least = svd.singular_values.imin();
    let h = Matrix3::from_row_iterator(v.row(least).iter().copied());
    let whole = t.try_inverse()? * h * s;
    let whole = whole / whole[(2, 2)];
    whole.iter().all(|x| x.is_finite()).then_some(whole)
}

/// Places moved to their middle, at a mean distance of the root of two.
fn scaling(points: &[Point2<f64>]) -> Option<Matrix3<f64>> {
    let n = points.len() as f64;
    let middle = points.iter().map(|p| p.coords).sum::<Vector2<f64>>() / n;
    let far = points.iter().map(|p| (p.coords - middle).norm()).sum::<f64>() / n;
    let k = 2f64.sqrt() / far;
    k.is_finite().then(|| Matrix3::new(k, 0.0, -k * middle.x, 0.0, k, -k * middle.y, 0.0, 0.0, 1.0))
}

/// The pose that fits the pins best, from the homography of metres to pixels.
pub(crate) fn fit(start: &Matrix3<f64>, pins: &[Pin], camera: &KnownCamera) -> Option<CameraPose> {
    let first = split(start, camera)?;
    let other = reversed(&first);
    let poses = [first, other].map(|p| descend(p, pins, camera));
    poses.into_iter().flatten().min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// A homography as a pose, with the expected focal length.
fn split(h: &Matrix3<f64>, camera: &KnownCamera) -> Option<CameraPose> {
    let start = CameraPose {
        rotation: Rotation3::identity(),
        place: Vector3::zeros(),
        focal: 0.0,
        shift: Vector2::zeros(),
        cost: f64::INFINITY,
    };
    let mut m = start.lens(camera).try_inverse()? * h;
    m *= if m[(2, 2)] < 0.0 { -1.0 } else { 1.0 };
    let (a, b) = (m.column(0).into_owned(), m.column(1).into_owned());
    let size = (a.norm() * b.norm()).sqrt();
    let rough = Matrix3::from_columns(&[a / size, b / size, a.cross(&b) / (size * size)]);
    let svd = rough.try_svd(true, true, 1e-12, 200)?;
    let rotation = svd.u? * svd.v_t?;
    let place = m.column(2) / size;
    let good = rotation.iter().chain(place.iter()).all(|v| v.is_finite()) && rotation.determinant() > 0.0;
    good.then(|| CameraPose {
        rotation: Rotation3::from_matrix_unchecked(rotation),
        place: place.into_owned(),
        ..start
    })
}

/// The pose whose normal is mirrored about the line of sight: it looks almost alike.
fn reversed(pose: &CameraPose) -> CameraPose {
    let sight = pose.place.normalize();
    let normal = pose.rotation.matrix().column(2).into_owned();
    let mirrored = 2.0 * normal.dot(&sight) * sight - normal;
    let turn = Rotation3::rotation_between(&normal, &mirrored).unwrap_or_else(Rotation3::identity);
    CameraPose { rotation: turn * pose.rotation, ..pose.clone() }
}

/// Differences over their standard errors; `None` where a place is behind the camera.
fn residuals(pose: &CameraPose, pins: &[Pin], camera: &KnownCamera) -> Option<DVector<f64>> {
    let h = pose.homography(camera);
    let mut out = DVector::zeros(pins.len() + 3);
    for (i, pin) in pins.iter().enumerate() {
        let q = h * Vector3::new(pin.model.x, pin.model.y, 1.0);
        if q.z <= 1e-6 {
            return None;
        }
        out[i] = pin.normal.dot(&(Vector2::new(q.x / q.z, q.y / q.z) - pin.at.coords)) / pin.error;
    }
    out[pins.len()] = pose.focal / camera.doubt;
    (0..2).for_each(|c| out[pins.len() + 1 + c] = pose.shift[c] / OFF_MIDDLE);
    out.iter().all(|v| v.is_finite()).then_some(out)
}

/// Steps of the unknowns for differences: radians, metres, logarithm, shares.
fn small_steps(pose: &CameraPose) -> [f64; N] {
    let far = 1e-6 * pose.place.norm().max(1e-3);
    [1e-6, 1e-6, 1e-6, far, far, far, 1e-6, 1e-6, 1e-6]
}

fn jacobian(
    pose: &CameraPose,
    at: &DVector<f64>,
    pins: &[Pin],
    camera: &KnownCamera,
) -> Option<DMatrix<f64>> {
    let mut j = DMatrix::zeros(at.len(), N);
    for (c, h) in small_steps(pose).into_iter().enumerate() {
        let mut step = SVector::<f64, N>::zeros();
        step[c] = h;
        let moved = residuals(&pose.moved(&step), pins, camera)?;
        j.set_column(c, &((moved - at) / h));
    }
    Some(j)
}

/// Levenberg and Marquardt from one start.
fn descend(mut pose: CameraPose, pins: &[Pin], camera: &KnownCamera) -> Option<CameraPose> {
    let mut at = residuals(&pose, pins, camera)?;
    pose.cost = 0.5 * at.norm_squared();
    let mut damping = 1e-3;
    for _ in 0..40 {
        let j = jacobian(&pose, &at, pins, camera)?;
        let (normal, slope) = (j.transpose() * &j, j.transpose() * &at);
        let before = pose.cost;
        for _ in 0..8 {
            let Some(step) = solve(&normal, &slope, damping) else { break };
            let next = pose.moved(&step);
            let there = residuals(&next, pins, camera);
            if let Some(r) = there.filter(|r| 0.5 * r.norm_squared() < pose.cost) {
                (pose, at) = (CameraPose { cost: 0.5 * r.norm_squared(), ..next }, r);
                damping = (damping * 0.2).max(1e-12);
                break;
            }
            damping = (damping * 5.0).min(1e12);
        }
        if before - pose.cost <= 1e-7 * before {
            break;
        }
    }
    pose.cost.is_finite().then_some(pose)
}

fn solve(normal: &DMatrix<f64>, slope: &DVector<f64>, damping: f64) -> Option<SVector<f64, N>> {
    let mut a = SMatrix::<f64, N, N>::from_iterator(normal.iter().copied());
    (0..N).for_each(|i| a[(i, i)] *= 1.0 + damping);
    let step = a.cholesky()?.solve(&SVector::<f64, N>::from_iterator(slope.iter().map(|v| -v)));
    step.iter().all(|v| v.is_finite()).then_some(step)
}
