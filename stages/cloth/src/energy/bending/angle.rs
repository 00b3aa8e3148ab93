//! The angle between two triangles over their common edge, with exact first and second derivatives.
//!
//! Over the edge a -> b with the left triangle's tip p and the right one's tip q, the angle is zero
//! for a flat sheet and positive where the sheet folds away from its normal's side. Each triangle
//! contributes on its own: with n its normal, the derivative by its tip is `-|e| n / |n|²`, and the
//! edge's ends share the opposite by the tip's place along the edge. Second derivatives follow by
//! the product rule (after Tamstorf and Grinspun, 2013).

use nalgebra::Matrix3;

use toile_geometry::Vec3;

/// Least length of a triangle's normal, as a share of the squared edge: keeps a collapsed triangle
/// finite.
const LEAST_NORMAL: f64 = 1e-9;

/// Signed angle between the triangles (a, b, p) and (b, a, q), in radians, -pi to pi.
pub(super) fn angle(a: &Vec3, b: &Vec3, p: &Vec3, q: &Vec3) -> f64 {
    let e = b - a;
    let (n1, n2) = (e.cross(&(p - a)), (q - a).cross(&e));
    let length = e.norm();
    (n1.cross(&n2).dot(&e)).atan2(n1.dot(&n2) * length)
}

/// What one triangle adds to the derivatives of the angle.
pub(super) struct Leaf {
    edge: Vec3,
    to_a: Vec3,
    to_b: Vec3,
    normal: Vec3,
    square: f64,
    length: f64,
    along: f64,
    sign: f64,
}

impl Leaf {
    /// The triangle on edge a -> b with tip p; `right` for the triangle whose normal is the other
    /// way round.
    pub(super) fn new(a: &Vec3, b: &Vec3, p: &Vec3, right: bool) -> Self {
        let (edge, to_a, to_b) = (b - a, p - a, p - b);
        let normal = edge.cross(&to_a);
        let e2 = edge.norm_squared();
        let square = normal.norm_squared().max(LEAST_NORMAL * e2 * e2);
        let sign = if right { 1.0 } else { -1.0 };
        Self { edge, to_a, to_b, normal, square, length: e2.sqrt(), along: edge.dot(&to_a) / e2, sign }
    }

    /// Derivative of the angle by a, b and the tip.
    pub(super) fn gradient(&self) -> [Vec3; 3] {
        let tip = self.normal * (self.sign * self.length / self.square);
        [tip * (self.along - 1.0), tip * -self.along, tip]
    }

    /// Second derivative of the angle by (a, b, tip).
    pub(super) fn hessian(&self) -> [[Matrix3<f64>; 3]; 3] {
        let tip = self.gradient()[2];
        let e2 = self.length * self.length;
        let reflect = (Matrix3::identity() - self.normal * self.normal.transpose() * (2.0 / self.square))
            * (self.sign * self.length / self.square);
        let stretch = self.normal * self.edge.transpose() * (self.sign / (self.length * self.square));
        let of_tip = [
            reflect * self.to_b.cross_matrix() - stretch,
            stretch - reflect * self.to_a.cross_matrix(),
            reflect * self.edge.cross_matrix(),
        ];
        let by_b = (self.to_a - self.edge * (2.0 * self.along)) / e2;
        let by_tip = self.edge / e2;
        let of_along = [-by_b - by_tip, by_b, by_tip];
        let row = |share: f64, turn: f64| -> [Matrix3<f64>; 3] {
            std::array::from_fn(|k| of_tip[k] * share + tip * of_along[k].transpose() * turn)
        };
        [row(self.along - 1.0, 1.0), row(-self.along, -1.0), of_tip]
    }
}
