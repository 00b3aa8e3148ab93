//! St Venant-Kirchhoff in plane stress: linear elasticity of the Green strain. Exact for small strain at any rotation; stiffens in
//! tension, softens in compression, and is not meant for compression below about 0.6. Cost: a few dozen products a triangle.

use nalgebra::{Matrix2, Matrix3, Matrix3x2, SymmetricEigen};

use super::law::{Law, Tangent};
use crate::error::{ClothError, check_parameter};
use crate::force::Projection;

/// The law, by its plane-stress Lamé values in N/m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StVenantKirchhoff {
    lambda: f64,
    mu: f64,
}

impl StVenantKirchhoff {
    /// From the stiffness `k` (Young's modulus times thickness, N/m) and Poisson's ratio.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for k < 0 or Poisson's ratio outside -1..1.
    pub fn new(k: f64, poisson: f64) -> Result<Self, ClothError> {
        check_parameter("stiffness", k, |v| v >= 0.0, "0 or more N/m")?;
        check_parameter("poisson", poisson, |v| v > -1.0 && v < 1.0, "between -1 and 1")?;
        Ok(Self { lambda: k * poisson / (1.0 - poisson * poisson), mu: 0.5 * k / (1.0 + poisson) })
    }

    /// Second Piola-Kirchhoff stress, N/m.
    #[must_use]
    pub fn second_stress(&self, f: &Matrix3x2<f64>) -> Matrix2<f64> {
        let e = green(f);
        Matrix2::identity() * (self.lambda * e.trace()) + e * (2.0 * self.mu)
    }
}

fn green(f: &Matrix3x2<f64>) -> Matrix2<f64> {
    (f.tr_mul(f) - Matrix2::identity()) * 0.5
}

impl Law for StVenantKirchhoff {
    fn name(&self) -> &'static str {
        "St Venant-Kirchhoff membrane"
    }

    fn density(&self, f: &Matrix3x2<f64>) -> f64 {
        let e = green(f);
        0.5 * self.lambda * e.trace().powi(2) + self.mu * e.norm_squared()
    }

    fn stress(&self, f: &Matrix3x2<f64>) -> Matrix3x2<f64> {
        f * self.second_stress(f)
    }

    fn tangent(&self, f: &Matrix3x2<f64>, projection: Projection) -> Tangent {
        let mut s = self.second_stress(f);
        if projection == Projection::PositiveSemiDefinite {
            s = without_compression(&s);
        }
        let c = [f.column(0).into_owned(), f.column(1).into_owned()];
        let outer = [
            [c[0] * c[0].transpose(), c[0] * c[1].transpose()],
            [c[1] * c[0].transpose(), c[1] * c[1].transpose()],
        ];
        let both = (outer[0][0] + outer[1][1]) * self.mu;
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let own = if i == j { both } else { Matrix3::zeros() };
                Matrix3::identity() * s[(i, j)] + outer[i][j] * self.lambda + outer[j][i] * self.mu + own
            })
        })
    }
}

/// The stress with its negative principal values cut to zero: what keeps the geometric stiffness positive.
pub(super) fn without_compression(s: &Matrix2<f64>) -> Matrix2<f64> {
    let (trace, det) = (s.trace(), s.determinant());
    if det >= 0.0 {
        return if trace >= 0.0 { *s } else { Matrix2::zeros() };
    }
    let eigen = SymmetricEigen::new(*s);
    let kept = eigen.eigenvalues.map(|v| v.max(0.0));
    eigen.eigenvectors * Matrix2::from_diagonal(&kept) * eigen.eigenvectors.transpose()
}
