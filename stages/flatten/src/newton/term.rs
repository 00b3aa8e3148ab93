//! Quadratic terms beside the triangles: `weight |sum_k c_k q_k - target|^2` of up to three
//! vertices.
//!
//! A vertex held at a place or on a line, a point held on the line between two others, two points
//! held together.

use nalgebra::{Matrix2, Point2, Vector2};

/// One term. Vertices that are not needed repeat another with the coefficient 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct QuadraticTerm {
    /// The vertices.
    pub vertices: [u32; 3],
    /// Their coefficients.
    pub coefficients: [f64; 3],
    /// What the weighted sum should be, in units of length of the problem.
    pub target: Vector2<f64>,
    /// Energy by area and square of length, 0 or more.
    pub weight: f64,
    /// The only direction in which a distance counts, unit length; none where all count.
    pub normal: Option<Vector2<f64>>,
}

impl QuadraticTerm {
    /// Holds a vertex at a place.
    #[must_use]
    pub(crate) fn at(vertex: u32, place: Point2<f64>, weight: f64) -> Self {
        Self {
            vertices: [vertex; 3],
            coefficients: [1.0, 0.0, 0.0],
            target: place.coords,
            weight,
            normal: None,
        }
    }

    /// Holds a vertex on the line through a place across a unit vector; along the line it is free.
    #[must_use]
    pub(crate) fn on_line(vertex: u32, place: Point2<f64>, normal: Vector2<f64>, weight: f64) -> Self {
        Self { normal: Some(normal), ..Self::at(vertex, place, weight) }
    }

    /// Holds a vertex at the share `t` of the way from `from` to `to`.
    #[must_use]
    pub(crate) fn between(vertex: u32, from: u32, to: u32, t: f64, weight: f64) -> Self {
        let coefficients = [1.0, t - 1.0, -t];
        Self { vertices: [vertex, from, to], coefficients, target: Vector2::zeros(), weight, normal: None }
    }

    /// The pairs of vertices that it couples.
    #[must_use]
    pub(crate) fn pairs(&self) -> [[u32; 2]; 3] {
        let [a, b, c] = self.vertices;
        [[a, b], [b, c], [c, a]]
    }

    pub(super) fn error(&self, q: &[Point2<f64>]) -> Vector2<f64> {
        let sum = (0..3).fold(Vector2::zeros(), |sum, k| {
            sum + q[self.vertices[k] as usize].coords * self.coefficients[k]
        });
        self.counted() * (sum - self.target)
    }

    /// The part of a distance that counts: the identity, or a projection.
    pub(super) fn counted(&self) -> Matrix2<f64> {
        self.normal.map_or_else(Matrix2::identity, |n| n * n.transpose())
    }

    pub(super) fn value(&self, q: &[Point2<f64>]) -> f64 {
        self.weight * self.error(q).norm_squared()
    }
}
