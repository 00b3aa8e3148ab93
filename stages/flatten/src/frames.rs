//! The linear map of each triangle from its own plane to the flat pattern.
//!
//! Each triangle of the surface is laid into its plane with the first edge along x. With the
//! gradients `g_i` of the three hat functions there, flat corners `q_i` give the map
//! `J = sum_i q_i g_i^T` (2 x 2): its singular values are the stretches from 3D to 2D. Lengths are
//! counted in the root of the surface's area, so that energies have no unit.

use crate::surface::PieceSurface;
use nalgebra::{Matrix2, Point2, Vector2, Vector3};

/// Triangles in their planes.
#[derive(Debug, Clone)]
pub(crate) struct TriangleFrames {
    /// Gradients of the hat functions of corners 1 and 2; that of corner 0 is minus their sum.
    gradients: Vec<[Vector2<f64>; 2]>,
    /// The share of each triangle in the area.
    shares: Vec<f64>,
    /// The unit of length: the root of the area.
    unit: f64,
}

impl TriangleFrames {
    /// Lays out every triangle.
    #[must_use]
    pub(crate) fn new(surface: &PieceSurface) -> Self {
        let unit = surface.area().sqrt();
        let count = surface.triangles().len();
        let (mut gradients, mut shares) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for t in 0..count {
            let edges = local_edges(surface, t).map(|e| e / unit);
            let twice = edges[0].perp(&edges[1]);
            // The inverse of the matrix whose columns are the two edges.
            gradients.push([
                Vector2::new(edges[1].y, -edges[1].x) / twice,
                Vector2::new(-edges[0].y, edges[0].x) / twice,
            ]);
            shares.push(twice / 2.0);
        }
        Self { gradients, shares, unit }
    }

    /// The unit of length, in the caller's unit.
    #[must_use]
    pub(crate) fn unit(&self) -> f64 {
        self.unit
    }

    /// The share of a triangle in the whole area; all shares sum to 1.
    #[must_use]
    pub(crate) fn share(&self, triangle: usize) -> f64 {
        self.shares[triangle]
    }

    /// Gradients of the hat functions of the three corners, per unit of length.
    #[must_use]
    pub(crate) fn gradients(&self, triangle: usize) -> [Vector2<f64>; 3] {
        let [b, c] = self.gradients[triangle];
        [-(b + c), b, c]
    }

    /// The map of a triangle whose corners lie at `q`, in units of [`TriangleFrames::unit`].
    #[must_use]
    pub(crate) fn map(&self, triangle: usize, q: [Point2<f64>; 3]) -> Matrix2<f64> {
        let [b, c] = self.gradients[triangle];
        let (u, v) = (q[1] - q[0], q[2] - q[0]);
        Matrix2::new(
            u.x * b.x + v.x * c.x,
            u.x * b.y + v.x * c.y,
            u.y * b.x + v.y * c.x,
            u.y * b.y + v.y * c.y,
        )
    }

    /// Flat places in units of [`TriangleFrames::unit`].
    #[must_use]
    pub(crate) fn scaled(&self, flat: &[Point2<f64>]) -> Vec<Point2<f64>> {
        flat.iter().map(|p| p / self.unit).collect()
    }

    /// Flat places in the caller's unit.
    #[must_use]
    pub(crate) fn restored(&self, flat: &[Point2<f64>]) -> Vec<Point2<f64>> {
        flat.iter().map(|p| p * self.unit).collect()
    }
}

/// Two edges from corner 0 of a triangle, in its plane: the first along x, the second above it; as
/// it was cut where that is known.
#[must_use]
pub(crate) fn local_edges(surface: &PieceSurface, triangle: usize) -> [Vector2<f64>; 2] {
    if let Some(edges) = surface.cut_shape(triangle) {
        return edges;
    }
    let [x, y] = local_axes(surface, triangle);
    let [a, b, c] = surface.triangles()[triangle].map(|v| surface.positions()[v as usize]);
    [Vector2::new((b - a).norm(), 0.0), Vector2::new((c - a).dot(&x), (c - a).dot(&y))]
}

/// The axes of a triangle's plane in space: along its first edge, and to the left of it.
#[must_use]
pub(crate) fn local_axes(surface: &PieceSurface, triangle: usize) -> [Vector3<f64>; 2] {
    let [a, b, _] = surface.triangles()[triangle].map(|v| surface.positions()[v as usize]);
    let x = (b - a).normalize();
    [x, surface.area_vector(triangle).normalize().cross(&x)]
}

/// The three places of a triangle's corners.
#[must_use]
pub(crate) fn corners(flat: &[Point2<f64>], triangle: [u32; 3]) -> [Point2<f64>; 3] {
    triangle.map(|v| flat[v as usize])
}

/// Triangles that lie face down in the plane, or without area.
#[must_use]
pub(crate) fn flipped(triangles: &[[u32; 3]], flat: &[Point2<f64>]) -> Vec<usize> {
    let is_flipped = |t: &[u32; 3]| {
        let [a, b, c] = corners(flat, *t);
        let twice = (b - a).perp(&(c - a));
        twice <= 0.0 || twice.is_nan()
    };
    triangles.iter().enumerate().filter(|(_, t)| is_flipped(t)).map(|(i, _)| i).collect()
}

/// The area of the flat triangles, those that lie face down counted as negative.
#[must_use]
pub(crate) fn flat_area(triangles: &[[u32; 3]], flat: &[Point2<f64>]) -> f64 {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = corners(flat, *t);
        (b - a).perp(&(c - a)) / 2.0
    };
    triangles.iter().map(area).sum()
}
