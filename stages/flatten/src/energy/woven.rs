//! Woven cloth: stiff along warp and weft, soft in shear.
//!
//! The pattern's x is the weft, its y the warp. From the flat pattern to the garment a unit vector
//! along the weft stretches to `w = |J^-1 e_x|`, one along the warp to `p = |J^-1 e_y|`, and their
//! angle leaves a right angle by `g`. The density is
//! `kw/8 (w - 1/w)^2 + kp/8 (p - 1/p)^2 + ks/2 tan^2 g`: to second order in the strains the elastic
//! energy of a membrane of these three stiffnesses, and infinite where a triangle loses its area.
//! With the gradients a and b of the flat x and y on the garment, P = a.a, Q = b.b, R = a.b, D = P
//! Q - R^2: w^2 = Q / D, p^2 = P / D, tan^2 g = R^2 / D. Cost: some 200 operations a triangle, and
//! 4 x 4 eigenvalues where the Hessian is not positive.

use super::{Derivatives, EnergyDensity, Hessian, project};
use crate::error::FlattenError;
use nalgebra::{Matrix2, Matrix3, Matrix4, SMatrix, Vector2, Vector3, Vector4};

/// Stiffnesses of a cloth in N/m: force by width and strain. Only their ratios matter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WovenStiffness {
    /// Along the pattern's y.
    pub warp: f64,
    /// Along the pattern's x.
    pub weft: f64,
    /// In shear: force by width and tangent of the angle.
    pub shear: f64,
}

impl WovenStiffness {
    /// A plain cotton weave: shear gives forty times more easily than the threads.
    pub const COTTON: Self = Self { warp: 800.0, weft: 800.0, shear: 20.0 };
}

/// Most by which stiffnesses may differ: beyond it the softest is lost in the rounding of the
/// stiffest.
const MOST_RATIO: f64 = 1e6;

/// The energy of [`WovenStiffness`], its stiffest direction counted as 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WovenEnergy {
    warp: f64,
    weft: f64,
    shear: f64,
}

impl WovenEnergy {
    /// An energy by stiffnesses, each above zero.
    ///
    /// # Errors
    /// [`FlattenError::InvalidParameter`] if one is not above zero, or not within a factor of 10^6
    /// of the others.
    pub fn new(stiffness: WovenStiffness) -> Result<Self, FlattenError> {
        let WovenStiffness { warp, weft, shear } = stiffness;
        let most = warp.max(weft).max(shear);
        for (name, value) in [("warp", warp), ("weft", weft), ("shear", shear)] {
            if !(value > 0.0 && value.is_finite() && value * MOST_RATIO >= most) {
                let range = "stiffnesses are above zero and within a factor of 1000000 of each other";
                return Err(FlattenError::InvalidParameter { name, value, range });
            }
        }
        let scale = 4.0 / most;
        Ok(Self { warp: warp * scale, weft: weft * scale, shear: shear * scale })
    }

    /// Value, gradient and Hessian by P, Q and R.
    fn by_metric(&self, p: f64, q: f64, r: f64) -> (f64, Vector3<f64>, Matrix3<f64>) {
        let d = p * q - r * r;
        let (kw, kp, ks) = (self.weft / 8.0, self.warp / 8.0, self.shear / 2.0);
        // The part over D: N / D with N = kw Q + kp P + ks R^2.
        let n = kw * q + kp * p + ks * r * r;
        let (n1, d1) = (Vector3::new(kp, kw, 2.0 * ks * r), Vector3::new(q, p, -2.0 * r));
        let n2 = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 2.0 * ks));
        let d2 = Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -2.0);
        let mixed = n1 * d1.transpose();
        let over = n2 / d - (mixed + mixed.transpose()) / (d * d) - d2 * (n / (d * d))
            + d1 * d1.transpose() * (2.0 * n / (d * d * d));
        // The inverse squares: kw (P - R^2/Q) + kp (Q - R^2/P).
        let (i, j) = (r / q, r / p);
        let inverse = kw * (p - r * i) + kp * (q - r * j);
        let inverse1 = Vector3::new(kw + kp * j * j, kp + kw * i * i, -2.0 * (kw * i + kp * j));
        let inverse2 = Matrix3::new(
            -2.0 * kp * j * j / p,
            0.0,
            2.0 * kp * j / p,
            0.0,
            -2.0 * kw * i * i / q,
            2.0 * kw * i / q,
            2.0 * kp * j / p,
            2.0 * kw * i / q,
            -2.0 * (kw / q + kp / p),
        );
        let value = n / d + inverse - 2.0 * (kw + kp);
        (value, n1 / d - d1 * (n / (d * d)) + inverse1, over + inverse2)
    }
}

impl EnergyDensity for WovenEnergy {
    fn value(&self, _: usize, j: &Matrix2<f64>) -> f64 {
        let d = j.determinant();
        if d <= 0.0 || d.is_nan() {
            return f64::INFINITY;
        }
        let (a, b) = (Vector2::new(j.m11, j.m12), Vector2::new(j.m21, j.m22));
        let (p, q, r) = (a.norm_squared(), b.norm_squared(), a.dot(&b));
        let (weft, warp) = (q.sqrt() / d, p.sqrt() / d);
        let thread = |k: f64, s: f64| k / 8.0 * (s - 1.0 / s).powi(2);
        thread(self.weft, weft) + thread(self.warp, warp) + self.shear / 2.0 * (r / d).powi(2)
    }

    fn derivatives(&self, _: usize, j: &Matrix2<f64>, wanted: Hessian) -> Derivatives {
        let (a, b) = (Vector2::new(j.m11, j.m12), Vector2::new(j.m21, j.m22));
        let (p, q, r) = (a.norm_squared(), b.norm_squared(), a.dot(&b));
        let (value, g, h) = self.by_metric(p, q, r);
        let jacobian = SMatrix::<f64, 3, 4>::new(
            2.0 * a.x,
            2.0 * a.y,
            0.0,
            0.0,
            0.0,
            0.0,
            2.0 * b.x,
            2.0 * b.y,
            b.x,
            b.y,
            a.x,
            a.y,
        );
        let mut hessian: Matrix4<f64> = jacobian.transpose() * h * jacobian;
        for k in 0..2 {
            hessian[(k, k)] += 2.0 * g.x;
            hessian[(k + 2, k + 2)] += 2.0 * g.y;
            hessian[(k, k + 2)] += g.z;
            hessian[(k + 2, k)] += g.z;
        }
        let gradient: Vector4<f64> = jacobian.transpose() * g;
        let hessian = if wanted == Hessian::Exact { hessian } else { project(hessian) };
        Derivatives { value, gradient, hessian }
    }

    fn turns_freely(&self) -> bool {
        false
    }
}
