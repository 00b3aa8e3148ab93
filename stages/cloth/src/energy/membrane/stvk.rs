//! St Venant-Kirchhoff in plane stress: linear elasticity of Green's strain,
//! `S = lambda tr(E) I + 2 mu E`.
//!
//! Exact for small strain at any rotation; stiffens in tension, softens in compression, and is not
//! meant for compression below about 0.6. Cost: a few dozen products a triangle.

use super::triangles::{Law, Response};
use crate::error::{ClothError, check_parameter};

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
}

/// E11, E22 and twice E12.
fn green([uu, vv, uv]: [f64; 3]) -> [f64; 3] {
    [0.5 * (uu - 1.0), 0.5 * (vv - 1.0), uv]
}

impl Law for StVenantKirchhoff {
    fn name(&self) -> &'static str {
        "St Venant-Kirchhoff membrane"
    }

    fn density(&self, metric: [f64; 3]) -> f64 {
        let [e1, e2, shear] = green(metric);
        0.5 * self.lambda * (e1 + e2).powi(2) + self.mu * (e1 * e1 + e2 * e2 + 0.5 * shear * shear)
    }

    fn stress(&self, metric: [f64; 3]) -> [f64; 3] {
        let [e1, e2, shear] = green(metric);
        let mean = self.lambda * (e1 + e2);
        [mean + 2.0 * self.mu * e1, mean + 2.0 * self.mu * e2, self.mu * shear]
    }

    fn response(&self, metric: [f64; 3], _exact: bool) -> Response {
        let along = self.lambda + 2.0 * self.mu;
        Response { stress: self.stress(metric), tangent: [along, along, self.mu, self.lambda, 0.0, 0.0] }
    }
}
