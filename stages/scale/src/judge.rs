//! Judges a quadrilateral as the picture of a rectangle of known size.

use crate::object::RoundedRectangle;
use crate::pixels::{colour, inside};
use crate::pose::{self, CameraPose, KnownCamera, Pin, through};
use crate::quads::{Quad, area};
use crate::side::{MeasuredSide, SideSampling, across, continues, median, side};
use image::RgbImage;
use nalgebra::{Matrix3, Point2, Vector2, Vector3};

/// A quadrilateral that passed.
#[derive(Debug, Clone)]
pub(crate) struct Judged {
    /// Clockwise; the first side is a long one.
    pub(crate) corners: [Point2<f64>; 4],
    pub(crate) pose: CameraPose,
    /// Mean share of the sides that is seen, 0 to 1.
    pub(crate) coverage: f64,
    /// Scatter of the edges about the fitted rectangle, pixels.
    pub(crate) residual: f64,
    /// The shorter side, pixels.
    pub(crate) short: f64,
    /// The better, the larger.
    pub(crate) merit: f64,
}

/// The least share of any side that must be seen, and of all.
const SEEN: f64 = 0.6;
const SEEN_MEAN: f64 = 0.78;
/// The largest distance of the fitted rectangle from the measured lines: pixels, and share of the
/// shorter side.
const OFF: f64 = 0.4;
const OFF_SHARE: f64 = 0.003;
/// The most unusual camera (sum of squares over standard deviations).
const UNUSUAL: f64 = 8.0;
/// The most cost of the pose of a card, and of a sheet, whose sides are longer and tell more.
const COST: f64 = 4.0;
const SHEET_COST: f64 = 1.6;
/// Of the eight continuations of the sides beyond the corners, so many may show an edge.
const CONTINUED: usize = 2;
const SHEET_CONTINUED: usize = 1;

/// Whether the aspect may be the object's, with errors of about `pixel` at each corner: by the two
/// columns of the homography with the expected focal length, which must be alike in length and at
/// right angles.
pub(crate) fn may_be(
    corners: &[Point2<f64>; 4],
    shape: &RoundedRectangle,
    camera: &KnownCamera,
    pixel: f64,
) -> bool {
    let Some((a, b)) = columns(corners, camera) else { return false };
    let short = (corners[2] - corners[1]).norm().min((corners[3] - corners[0]).norm());
    let doubt = 0.08 + 8.0 * pixel / short.max(1.0);
    let aspect = (a.norm() / shape.long) / (b.norm() / shape.short);
    let cosine = a.dot(&b) / (a.norm() * b.norm());
    aspect.ln().abs() < doubt && cosine.abs() < doubt
}

/// The pictures of the rectangle's two directions as vectors in space, for the unit square onto the
/// corners (Heckbert, Fundamentals of texture mapping, 1989).
fn columns(c: &[Point2<f64>; 4], camera: &KnownCamera) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let p = c.map(|p| (p - camera.middle) / camera.focal);
    let (d1, d2, d3) = (p[1] - p[2], p[3] - p[2], p[0] - p[1] + p[2] - p[3]);
    let determinant = d1.perp(&d2);
    let (g, h) = (d3.perp(&d2) / determinant, d1.perp(&d3) / determinant);
    let a = p[1] - p[0] + p[1] * g;
    let b = p[3] - p[0] + p[3] * h;
    let (a, b) = (Vector3::new(a.x, a.y, g), Vector3::new(b.x, b.y, h));
    let good = a.norm() > 0.0 && b.norm() > 0.0 && a.iter().chain(b.iter()).all(|v| v.is_finite());
    good.then_some((a, b))
}

/// Measures a candidate in the photo, roughly and then finely, and judges it.
pub(crate) fn judge(
    photo: &RgbImage,
    quad: &Quad,
    k: usize,
    shape: &RoundedRectangle,
    camera: &KnownCamera,
) -> Option<Judged> {
    // Sheets are larger, and a corner may be further off.
    let (step, reach) = if shape.radius > 0.0 { ((k as f64 / 2.0).max(1.0), 4) } else { (k as f64, 5) };
    let inset = 1.3 * shape.radius / shape.short + 0.04;
    let rough = SideSampling { step, reach, inset, most: 60 };
    let sides = sides(photo, &quad.corners, &rough).filter(|s| distinct(s, 0.8))?;
    let corners = crossings(&sides)?;
    let beyond = SideSampling { step, reach: 2, inset: 0.0, most: 12 };
    let run_on = continued(photo, &corners, &sides, &beyond);
    if run_on > CONTINUED + 1 || !may_be(&corners, shape, camera, 0.3 * k as f64) {
        return None;
    }
    let (corners, sides) = finely(photo, corners, &rough)?;
    measured(photo, corners, &sides, shape, camera)
}

/// The sides in ever finer steps, down to a pixel.
fn finely(
    photo: &RgbImage,
    mut corners: [Point2<f64>; 4],
    rough: &SideSampling,
) -> Option<([Point2<f64>; 4], [MeasuredSide; 4])> {
    let mut step = rough.step;
    while step > 1.0 {
        step = (step / 2.0).max(1.0);
        let most = if step > 1.0 { 80 } else { 300 };
        corners = crossings(&sides(photo, &corners, &SideSampling { step, reach: 4, most, ..*rough })?)?;
    }
    let sides = sides(photo, &corners, &SideSampling { step: 1.0, reach: 3, most: 400, ..*rough })?;
    Some((crossings(&sides)?, sides))
}

/// Judges measured sides.
fn measured(
    photo: &RgbImage,
    corners: [Point2<f64>; 4],
    sides: &[MeasuredSide; 4],
    shape: &RoundedRectangle,
    camera: &KnownCamera,
) -> Option<Judged> {
    if !distinct(sides, 1.0) || area(&corners) <= 0.0 {
        return None;
    }
    let pose = posed(&corners, sides, shape, camera)?;
    let h = pose.homography(camera);
    let short = shortest(&corners);
    let off = offs(&h, &pins(&corners, sides, shape));
    let most = if shape.radius > 0.0 { COST } else { SHEET_COST };
    let usual = pose.unusual(camera) <= UNUSUAL && pose.cost <= most && pose.plausible(camera);
    if off > OFF + OFF_SHARE * short || !usual {
        return None;
    }
    let run_on = continued(photo, &corners, sides, &BEYOND);
    let sure = run_on == 0 && pose.slant() < 35.0 && sides.iter().all(|s| s.coverage > 0.9);
    let few = short < FEW && shape.radius == 0.0;
    if run_on > if shape.radius > 0.0 { CONTINUED } else { SHEET_CONTINUED }
        || (few && !sure)
        || (shape.radius > 0.0 && within(photo, &h, shape))
        || !right_corners(photo, &h, shape, sure)
        || !even(photo, &h, shape)
        || (shape.radius == 0.0 && one_sided(photo, &h, shape) < ONE_SIDED)
    {
        return None;
    }
    let coverage = sides.iter().map(|s| s.coverage).sum::<f64>() / 4.0;
    let least = sides.iter().map(|s| s.coverage).fold(1.0, f64::min);
    let squares = sides.iter().map(|s| s.spread * s.spread).sum::<f64>() / 4.0;
    let residual = (squares + off * off).sqrt();
    let merit = coverage + 0.5 * least - 0.1 * run_on as f64 - 0.3 * off / (OFF + OFF_SHARE * short);
    let fitted = shape.corners().map(|p| through(&h, p));
    Some(Judged { corners: fitted, pose, coverage, residual, short, merit })
}

fn sides(photo: &RgbImage, corners: &[Point2<f64>; 4], look: &SideSampling) -> Option<[MeasuredSide; 4]> {
    let measure = |i: usize| side(photo, corners[i], corners[(i + 1) % 4], look);
    Some([measure(0)?, measure(1)?, measure(2)?, measure(3)?])
}

fn distinct(sides: &[MeasuredSide; 4], share: f64) -> bool {
    let mean = sides.iter().map(|s| s.coverage).sum::<f64>() / 4.0;
    sides.iter().all(|s| s.coverage >= share * SEEN) && mean >= share * SEEN_MEAN
}

/// Where the sides' lines cross: corner i lies on sides i - 1 and i.
fn crossings(sides: &[MeasuredSide; 4]) -> Option<[Point2<f64>; 4]> {
    let cross = |i: usize| crossing(&sides[(i + 3) % 4], &sides[i]);
    Some([cross(0)?, cross(1)?, cross(2)?, cross(3)?])
}

fn crossing(one: &MeasuredSide, two: &MeasuredSide) -> Option<Point2<f64>> {
    let (u, v) = (one.b - one.a, two.b - two.a);
    let t = (two.a - one.a).perp(&v) / u.perp(&v);
    let at = one.a + u * t;
    at.iter().all(|x| x.is_finite() && x.abs() < 1e6).then_some(at)
}

pub(crate) fn shortest(corners: &[Point2<f64>; 4]) -> f64 {
    (0..4).map(|i| (corners[(i + 1) % 4] - corners[i]).norm()).fold(f64::INFINITY, f64::min)
}

fn posed(
    corners: &[Point2<f64>; 4],
    sides: &[MeasuredSide; 4],
    shape: &RoundedRectangle,
    camera: &KnownCamera,
) -> Option<CameraPose> {
    let start = pose::homography(&shape.corners(), corners)?;
    pose::fit(&start, &pins(corners, sides, shape), camera)
}

/// Two pins a side, where the errors of a line that is seen evenly along its length do not depend
/// on each other.
fn pins(corners: &[Point2<f64>; 4], sides: &[MeasuredSide; 4], shape: &RoundedRectangle) -> Vec<Pin> {
    let model = shape.corners();
    let mut pins = Vec::with_capacity(8);
    for (i, s) in sides.iter().enumerate() {
        let (a, b) = (model[i], model[(i + 1) % 4]);
        let Some(normal) = across(corners[i], corners[(i + 1) % 4]) else { continue };
        for t in [0.5 - APART, 0.5 + APART] {
            pins.push(Pin {
                model: a + (b - a) * t,
                at: s.a,
                normal,
                error: 2f64.sqrt() * s.error.hypot(BIAS),
            });
        }
    }
    pins
}

/// Error of an edge's place that more profiles do not lessen: shadows under the rim, print near it,
/// pixels.
const BIAS: f64 = 0.08;
/// Half the root of a third: where the two ends of a fitted line err independently.
const APART: f64 = 0.288_675;

/// Root mean square distance of the fitted rectangle from the measured lines, pixels.
fn offs(h: &Matrix3<f64>, pins: &[Pin]) -> f64 {
    let squares: f64 = pins.iter().map(|p| p.normal.dot(&(through(h, p.model) - p.at)).powi(2)).sum();
    (squares / pins.len().max(1) as f64).sqrt()
}

/// How the sides' continuations are looked at.
const BEYOND: SideSampling = SideSampling { step: 1.0, reach: 2, inset: 0.0, most: 40 };

/// How many sides run on beyond their corners, of eight.
fn continued(
    photo: &RgbImage,
    corners: &[Point2<f64>; 4],
    sides: &[MeasuredSide; 4],
    look: &SideSampling,
) -> usize {
    let mut count = 0;
    for (i, s) in sides.iter().enumerate() {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        let length = (b - a).norm();
        let (near, far) = (3.0 * look.step / length + 0.02, (0.25f64).max(12.0 * look.step / length));
        for (from, to) in [(a, b), (b, a)] {
            let beyond = |t: f64| from + (from - to) * t;
            let seen = inside(photo, beyond(far));
            count += usize::from(seen && continues(photo, beyond(near), beyond(far), look, s.slope) > 0.7);
        }
    }
    count
}

/// How the corners look.
#[derive(Debug, Clone, Copy, PartialEq)]
enum CornerLook {
    /// There are too few pixels to tell.
    Small,
    /// The object has the ground's colour at its corners.
    Unseen,
    /// 0 for corners as round as a card's, 1 for sharp ones.
    Seen(f64),
}

/// Whether the corners are as round or as sharp as the object's, as far as the photo shows it.
/// Where it does not, all else must be sure.
fn right_corners(photo: &RgbImage, h: &Matrix3<f64>, shape: &RoundedRectangle, sure: bool) -> bool {
    match sharpness(photo, h, shape) {
        CornerLook::Small | CornerLook::Unseen => sure,
        CornerLook::Seen(s) => (shape.radius > 0.0 && s < 0.5) || (shape.radius == 0.0 && s > 0.45),
    }
}

/// How far beyond a side another edge is looked for, as shares of the shorter side.
const JUST_BEYOND: [f64; 2] = [0.06, 0.3];
/// It is one from this share of the side's own step of colour on, and this many levels.
const ANOTHER: [f64; 2] = [0.25, 10.0];
/// Steps in which the way beyond is walked.
const WALKED: usize = 24;

/// Whether another edge runs along a side just beyond it: then that side is a stripe printed on a
/// card, and the card is larger.
fn within(photo: &RgbImage, h: &Matrix3<f64>, shape: &RoundedRectangle) -> bool {
    let corners = shape.corners();
    (0..4).any(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        let Some(out) = nalgebra::center(&a, &b).coords.try_normalize(1e-9) else { return false };
        // The mean colour along the side, so far beyond it.
        let at = |share: f64| {
            let along = (0..WALKED).map(|n| a + (b - a) * (0.15 + 0.7 * n as f64 / (WALKED - 1) as f64));
            let seen = along.map(|p| through(h, p + out * (share * shape.short)));
            let sum =
                seen.map(|p| Vector3::from(colour(photo, p.x, p.y).map(f64::from))).sum::<Vector3<f64>>();
            sum / WALKED as f64
        };
        let own = (at(JUST_BEYOND[0]) - at(-JUST_BEYOND[0])).norm();
        let step = (JUST_BEYOND[1] - JUST_BEYOND[0]) / WALKED as f64;
        let beyond: Vec<Vector3<f64>> = (0..=WALKED).map(|n| at(JUST_BEYOND[0] + step * n as f64)).collect();
        let most = beyond.windows(4).map(|w| (w[3] - w[0]).norm()).fold(0.0, f64::max);
        most > (ANOTHER[0] * own).max(ANOTHER[1])
    })
}

/// Sheets of fewer pixels on their shorter side are taken where all is sure alone, as tiles and
/// prints are like them.
const FEW: f64 = 80.0;

/// Whether a sheet is of one hue, as paper is whatever the ink and shadow; cards may have any
/// print.
fn even(photo: &RgbImage, h: &Matrix3<f64>, shape: &RoundedRectangle) -> bool {
    if shape.radius > 0.0 {
        return true;
    }
    let place = |n: i32, side: f64| (f64::from(n) / 15.0 - 0.5) * 0.94 * side;
    let hue = |i: i32, j: i32| {
        let p = through(h, Point2::new(place(i, shape.long), place(j, shape.short)));
        let c = colour(photo, p.x, p.y).map(|v| f64::from(v) + 8.0);
        let sum: f64 = c.iter().sum();
        [c[0] / sum, c[1] / sum]
    };
    let hues: Vec<[f64; 2]> = (0..=15).flat_map(|i| (0..=15).map(move |j| hue(i, j))).collect();
    let [Some(r), Some(g)] = [0, 1].map(|c| median(hues.iter().map(|h| h[c]).collect())) else {
        return false;
    };
    let like = hues.iter().filter(|h| (h[0] - r).abs() < HUE && (h[1] - g).abs() < HUE).count();
    like as f64 >= 0.8 * hues.len() as f64
}

/// The least of [`one_sided`] of a sheet's outline.
const ONE_SIDED: f64 = 0.6;

/// How far a sheet is lighter all along its outline than what it lies on, or darker: 1 all along, 0
/// as often the one as the other, as is the outline of some tiles of a floor.
fn one_sided(photo: &RgbImage, h: &Matrix3<f64>, shape: &RoundedRectangle) -> f64 {
    let corners = shape.corners();
    let (mut sum, mut sizes) = (0.0, 1e-9);
    for (i, n) in (0..4).flat_map(|i| (0..40).map(move |n| (i, n))) {
        let at = corners[i] + (corners[(i + 1) % 4] - corners[i]) * (0.04 + 0.023 * f64::from(n));
        let p = through(h, at);
        let Some(out) = (p - through(h, at * 0.98)).try_normalize(1e-9) else { continue };
        let [inner, outer] = [-3.5, 3.5].map(|d| colour(photo, p.x + d * out.x, p.y + d * out.y));
        let step = f64::from(inner.iter().sum::<f32>() - outer.iter().sum::<f32>());
        sum += step;
        sizes += step.abs();
    }
    (sum / sizes).abs()
}

/// How much the share of red or green of a paper's colour may differ from the median.
const HUE: f64 = 0.035;

/// Radius of a card's corners as a share of its shorter side.
const ROUND: f64 = 0.0589;

/// Where the edge lies on rays from the centres of a card's corners.
fn sharpness(photo: &RgbImage, h: &Matrix3<f64>, shape: &RoundedRectangle) -> CornerLook {
    let radius = ROUND * shape.short;
    let mut values = Vec::new();
    for corner in shape.corners() {
        let centre = corner - Vector2::new(corner.x.signum(), corner.y.signum()) * radius;
        let pixels = (through(h, corner) - through(h, centre)).norm() / 2f64.sqrt();
        if pixels < 2.6 {
            return CornerLook::Small;
        }
        for degrees in [35.0f64, 40.0, 45.0, 50.0, 55.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let ray = Vector2::new(corner.x.signum() * cos, corner.y.signum() * sin) * radius;
            let sharp = 1.0 / sin.max(cos);
            let edge = half_way(photo, h, centre, ray);
            values.extend(edge.map(|d| (d - 1.0) / (sharp - 1.0)));
        }
    }
    let seen = values.len() >= 8;
    median(values).filter(|_| seen).map_or(CornerLook::Unseen, CornerLook::Seen)
}

/// Where along a ray from a corner's centre the colour is half that of outside; in radii.
fn half_way(photo: &RgbImage, h: &Matrix3<f64>, centre: Point2<f64>, ray: Vector2<f64>) -> Option<f64> {
    let at = |d: f64| {
        let p = through(h, centre + ray * d);
        colour(photo, p.x, p.y).map(f64::from)
    };
    let mean = |ds: [f64; 3]| ds.map(at).iter().fold(Vector3::zeros(), |s, c| s + Vector3::from(*c) / 3.0);
    let (within, beyond) = (mean([0.3, 0.5, 0.65]), mean([1.75, 1.95, 2.2]));
    let d = beyond - within;
    if d.norm() < 9.0 {
        return None;
    }
    let share = |t: f64| (Vector3::from(at(t)) - within).dot(&d) / d.norm_squared();
    let steps = (0..=40).map(|i| 0.6 + 1.2 * f64::from(i) / 40.0);
    let values: Vec<(f64, f64)> = steps.map(|t| (t, share(t))).collect();
    values.windows(2).find(|w| w[0].1 < 0.5 && w[1].1 >= 0.5).map(|w| w[0].0)
}
