//! The projection of a surface along its mean normal.

use crate::surface::PieceSurface;
use nalgebra::{Point2, Vector3};

/// Flat places in the caller's unit, seen from the right side; the areas are smaller than in space.
#[must_use]
pub(super) fn projection(surface: &PieceSurface) -> Vec<Point2<f64>> {
    let normal = (0..surface.triangles().len()).fold(Vector3::zeros(), |sum, t| sum + surface.area_vector(t));
    let normal = normal.try_normalize(0.0).unwrap_or_else(Vector3::z);
    let across = Vector3::ith(normal.iamin(), 1.0);
    let x = across.cross(&normal).normalize();
    let y = normal.cross(&x);
    let origin = surface.positions()[0];
    surface.positions().iter().map(|p| Point2::new((p - origin).dot(&x), (p - origin).dot(&y))).collect()
}
