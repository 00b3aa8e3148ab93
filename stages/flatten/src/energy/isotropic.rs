//! Energies of the two stretches alone, by the eigensystem of Smith, de Goes, Kim (2019).
//!
//! For `J = U diag(s1, s2) V^T` and a density `f(s1, s2)` the Hessian has four known eigenvectors:
//! the two scalings (a 2 x 2 block of second derivatives of `f`), the flip, with
//! `(f1 - f2) / (s1 - s2)`, and the twist, with `(f1 + f2) / (s1 + s2)`. Each is cut off at zero by
//! itself, so no numerical eigenvalues are needed.

use super::{Derivatives, EnergyDensity, Hessian};
use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};

/// A density of the two stretches, both positive.
pub trait Isotropic: Sync {
    /// The value.
    fn value(&self, s: Vector2<f64>) -> f64;

    /// Derivatives at the stretches `s`.
    fn stretches(&self, s: Vector2<f64>) -> Stretches;
}

/// Derivatives of a density without mixed term, and the eigenvalue of the flip, which would be 0 /
/// 0 at equal stretches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretches {
    /// First derivatives.
    pub first: Vector2<f64>,
    /// Second derivatives.
    pub second: Vector2<f64>,
    /// `(f1 - f2) / (s1 - s2)`, or its limit.
    pub flip: f64,
}

impl<E: Isotropic> EnergyDensity for E {
    fn value(&self, _: usize, j: &Matrix2<f64>) -> f64 {
        if j.determinant() > 0.0 { Isotropic::value(self, singular_values(j)) } else { f64::INFINITY }
    }

    fn derivatives(&self, _: usize, j: &Matrix2<f64>, wanted: Hessian) -> Derivatives {
        let (u, s, v) = rotations(j);
        let d = self.stretches(s);
        // Columns of U and V as outer products: the four directions of the eigensystem, unit
        // length.
        let outer =
            |a: Vector2<f64>, b: Vector2<f64>| Vector4::new(a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y);
        let (u1, u2, v1, v2) = (u, Vector2::new(-u.y, u.x), v, Vector2::new(-v.y, v.x));
        let scale = [outer(u1, v1), outer(u2, v2)];
        let (across, back) = (outer(u2, v1), outer(u1, v2));
        let twist = (across - back) * std::f64::consts::FRAC_1_SQRT_2;
        let flip = (across + back) * std::f64::consts::FRAC_1_SQRT_2;
        let twist_value = (d.first.x + d.first.y) / (s.x + s.y);
        let pairs = [(scale[0], d.second.x), (scale[1], d.second.y), (flip, d.flip), (twist, twist_value)];
        let hessian = pairs.iter().fold(Matrix4::zeros(), |sum: Matrix4<f64>, (e, value)| {
            if *value > 0.0 || wanted == Hessian::Exact { sum + (e * *value) * e.transpose() } else { sum }
        });
        let gradient = scale[0] * d.first.x + scale[1] * d.first.y;
        Derivatives { value: Isotropic::value(self, s), gradient, hessian }
    }
}

/// The singular values of a map, the larger first; the second is negative if the map flips.
#[must_use]
pub fn singular_values(j: &Matrix2<f64>) -> Vector2<f64> {
    let (turning, stretching) = parts(j);
    let (q, r) = (turning.norm(), stretching.norm());
    Vector2::new(q + r, q - r)
}

/// The part of a map that turns and scales, and the part that stretches along one direction and
/// shrinks across it.
fn parts(j: &Matrix2<f64>) -> (Vector2<f64>, Vector2<f64>) {
    let turning = Vector2::new(j.m11 + j.m22, j.m21 - j.m12) / 2.0;
    (turning, Vector2::new(j.m11 - j.m22, j.m21 + j.m12) / 2.0)
}

/// First columns of `U` and `V`, both rotations, with the singular values between them.
fn rotations(j: &Matrix2<f64>) -> (Vector2<f64>, Vector2<f64>, Vector2<f64>) {
    let (turning, stretching) = parts(j);
    let (q, r) = (turning.norm(), stretching.norm());
    let unit = |v: Vector2<f64>, length: f64| if length > 0.0 { v / length } else { Vector2::x() };
    let (turn, stretch) = (unit(turning, q), unit(stretching, r));
    // U turns by half the sum of the two angles, U V^T by the first: halving an angle needs a root,
    // not an arc tangent.
    let u =
        half(Vector2::new(turn.x * stretch.x - turn.y * stretch.y, turn.x * stretch.y + turn.y * stretch.x));
    let v = Vector2::new(turn.x * u.x + turn.y * u.y, turn.x * u.y - turn.y * u.x);
    (u, Vector2::new(q + r, q - r), v)
}

/// The direction at half the angle of a unit vector; either of the two that there are.
fn half(d: Vector2<f64>) -> Vector2<f64> {
    if d.x >= 0.0 {
        let c = ((1.0 + d.x) / 2.0).sqrt();
        Vector2::new(c, d.y / (2.0 * c))
    } else {
        let s = ((1.0 - d.x) / 2.0).sqrt();
        Vector2::new(d.y / (2.0 * s), s)
    }
}
