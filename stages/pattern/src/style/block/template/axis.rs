//! The axis of symmetry of an outline.
//!
//! Method: the outline is reflected in lines through its centroid, up to [`MAX_TILT`] from upright,
//! and the line is taken about which it differs least from its mirror image. Cost: some
//! milliseconds. Limit: the garment must be roughly symmetric and not upside down.

use nalgebra::Rotation2;
use std::ops::RangeInclusive;
use toile_core::artifact::{Point2, Vector2, polygon_area};

/// How far a garment may lie askew in its photo, degrees.
const MAX_TILT: f64 = 20.0;
/// Outline points that the search for the axis looks at.
const AXIS_POINTS: usize = 160;

/// An axis of symmetry.
pub(crate) struct Axis {
    /// Root of the area, metres.
    pub size: f64,
    /// Tilt, degrees, positive where the garment leans to the left.
    pub tilt: f64,
    /// The centroid, through which it runs.
    pub centre: Point2,
}

impl Axis {
    /// `None` for an outline without area.
    pub(crate) fn of(points: &[Point2]) -> Option<Axis> {
        let size = polygon_area(points).abs().sqrt();
        if points.len() < 8 || !(size.is_finite() && size > 0.0) {
            return None;
        }
        let centre = centroid(points);
        let sample: Vec<Point2> = even_sample(points, AXIS_POINTS);
        Some(Axis { size, tilt: best_tilt(|tilt| asymmetry(&sample, centre, tilt)), centre })
    }

    /// A point of the outline in the frame of the axis: u across, v up.
    pub(crate) fn upright(&self, p: Point2) -> Point2 {
        Point2::from(Rotation2::new(-self.tilt.to_radians()) * (p - self.centre))
    }
}

fn centroid(points: &[Point2]) -> Point2 {
    let n = points.len();
    // About the first point, so that far-off outlines lose no digits.
    let o = points[0];
    let (mut twice, mut sum) = (0.0, Vector2::zeros());
    for i in 0..n {
        let (a, b) = (points[i] - o, points[(i + 1) % n] - o);
        let cross = a.perp(&b);
        twice += cross;
        sum += (a + b) * cross;
    }
    o + sum / (3.0 * twice)
}

fn even_sample(points: &[Point2], count: usize) -> Vec<Point2> {
    let n = points.len();
    let piece = |i: usize| (points[(i + 1) % n] - points[i]).norm();
    let total: f64 = (0..n).map(piece).sum();
    let (mut i, mut passed) = (0, 0.0);
    let place = |k: usize| {
        let s = total * k as f64 / count as f64;
        while i + 1 < n && passed + piece(i) < s {
            passed += piece(i);
            i += 1;
        }
        let t = ((s - passed) / piece(i).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        points[i] + (points[(i + 1) % n] - points[i]) * t
    };
    (0..count).map(place).collect()
}

/// Mean distance between the outline and its mirror image in the line through `centre` that is
/// `tilt` degrees off the vertical.
fn asymmetry(sample: &[Point2], centre: Point2, tilt: f64) -> f64 {
    let axis = Rotation2::new(tilt.to_radians()) * Vector2::y();
    let n = sample.len();
    let reflected = |p: &Point2| {
        let d = p - centre;
        centre + axis * (2.0 * axis.dot(&d)) - d
    };
    let distance = |p: Point2| {
        (0..n).map(|i| to_segment(p, sample[i], sample[(i + 1) % n])).fold(f64::INFINITY, f64::min)
    };
    sample.iter().map(|p| distance(reflected(p))).sum::<f64>() / n as f64
}

fn to_segment(p: Point2, a: Point2, b: Point2) -> f64 {
    let u = b - a;
    let t = ((p - a).dot(&u) / u.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (a + u * t - p).norm()
}

/// Coarse search, then thirds.
fn best_tilt(misfit: impl Fn(f64) -> f64) -> f64 {
    let coarse: RangeInclusive<i32> = -10..=10;
    let step = MAX_TILT / 10.0;
    let start = coarse.map(|k| f64::from(k) * step).min_by(|a, b| misfit(*a).total_cmp(&misfit(*b)));
    let start = start.unwrap_or(0.0);
    let (mut low, mut high) = (start - step, start + step);
    for _ in 0..14 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if misfit(a) <= misfit(b) { high = b } else { low = a }
    }
    (low + high) / 2.0
}
