//! What was found in a photo.

use crate::KnownObject;
use nalgebra::{Matrix3, Point2, Vector2};

/// What a found object tells about the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScaleKind {
    /// The ground's plane: lengths hold all over the photo, whatever the tilt.
    Plane,
    /// A scale along the object alone: lengths hold where the camera looked straight down.
    Line,
}

/// An object found in a photo. Places are photo pixels: centres at integers, x to the right, y
/// downwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// What was looked for.
    pub object: KnownObject,
    /// What it tells about the ground.
    pub kind: ScaleKind,
    /// Its corners, clockwise: of a card those of its sides' lines, of a chessboard the outermost
    /// inner ones, of a ruler the ends of its marks' row and of the marks.
    pub corners: [Point2<f64>; 4],
    /// Every place that was measured inside: inner corners of a chessboard, marks of a ruler, else
    /// none.
    pub marks: Vec<Point2<f64>>,
    /// From photo pixels to metres on the ground, with the origin at the object's middle, y
    /// downwards in the photo's sense (no mirror). Of `ScaleKind::Line` a turn and a scale.
    pub homography: Matrix3<f64>,
    /// Photo pixels for a metre at the object's middle (geometric mean over the directions);
    /// above 0.
    pub px_per_metre: f64,
    /// Root mean square of the distances between what was measured and the fitted object, pixels.
    pub residual: f64,
    /// Share of the outline or of the marks that was seen where it must be, 0 to 1.
    pub confidence: f64,
    /// Angle between the line of sight to the object and the ground's normal, degrees, 0 to 60;
    /// `None` of `ScaleKind::Line`.
    pub tilt: Option<f64>,
}

impl Found {
    /// The place on the ground, metres, that a pixel shows; `None` at and beyond the horizon.
    pub fn ground(&self, pixel: Point2<f64>) -> Option<Point2<f64>> {
        place(&self.homography, pixel)
    }

    /// The distance on the ground between two pixels, metres; `None` at and beyond the horizon.
    pub fn distance(&self, a: Point2<f64>, b: Point2<f64>) -> Option<f64> {
        Some((self.ground(a)? - self.ground(b)?).norm())
    }
}

/// A place through a homography whose third row is positive on this side of the horizon.
pub(crate) fn place(h: &Matrix3<f64>, p: Point2<f64>) -> Option<Point2<f64>> {
    let q = h * p.to_homogeneous();
    let at = Point2::new(q.x / q.z, q.y / q.z);
    (q.z > 0.0 && at.iter().all(|v| v.is_finite())).then_some(at)
}

/// The inverse of a homography of metres to pixels, signed so that `z` is positive at the origin's
/// pixel.
pub(crate) fn inverse(to_pixels: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let inverse = to_pixels.try_inverse()?;
    let origin = to_pixels.column(2) / to_pixels[(2, 2)];
    let z = (inverse * origin).z;
    let signed = inverse / z;
    signed.iter().all(|v| v.is_finite()).then_some(signed)
}

/// Pixels a metre at a place on the ground: the root of the area's growth.
pub(crate) fn density(to_pixels: &Matrix3<f64>, at: Point2<f64>) -> Option<f64> {
    let q = to_pixels * at.to_homogeneous();
    // The determinant of a homography's derivative is its own over the cube of the third
    // coordinate.
    let density = (to_pixels.determinant() / q.z.powi(3)).abs().sqrt();
    (density.is_finite() && density > 0.0).then_some(density)
}

/// The middle of four corners.
pub(crate) fn middle(corners: &[Point2<f64>; 4]) -> [f64; 2] {
    let sum: Vector2<f64> = corners.iter().map(|p| p.coords).sum();
    [sum.x / 4.0, sum.y / 4.0]
}
