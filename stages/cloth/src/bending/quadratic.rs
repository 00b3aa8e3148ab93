//! Quadratic bending for sheets that hardly stretch: the fold angle is replaced by the vector `sum w_i x_i`, which for a flat sheet
//! is the angle times the normal. `E = k |sum w_i x_i|² / 2`, a constant matrix (Bergou, Wardetzky, Harmon, Zorin, Grinspun, 2006),
//! with the hinge's weights and calibration. Limits: flat at rest; the angle counts as 2 sin(theta/2); stretching counts as bending
//! to second order.

use nalgebra::Matrix3;

use super::Rigidity;
use super::calibrate::Calibration;
use super::flap::{Flap, flaps};
use crate::error::ClothError;
use crate::force::{Assembled, Element, Projection, Vec3};
use crate::mesh::Sheet;

/// Quadratic hinges on all inner edges.
#[derive(Debug, Clone)]
pub struct QuadraticHinge {
    flaps: Vec<Flap>,
    stiffness: Vec<f64>,
}

impl QuadraticHinge {
    /// Flat at rest, calibrated for the mesh.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative rigidity.
    pub fn new(sheet: &Sheet, rigidity: &Rigidity) -> Result<Assembled<4, Self>, ClothError> {
        rigidity.check()?;
        let calibration = Calibration::of(sheet);
        let (flaps, factor) = (flaps(sheet, &calibration.corrected(rigidity)), calibration.factor);
        let stiffness = flaps.iter().map(|f| factor * f.rigidity * f.slenderness).collect();
        Ok(Assembled(Self { flaps, stiffness }))
    }

    fn fold(&self, e: usize, x: &[Vec3; 4]) -> Vec3 {
        let w = &self.flaps[e].weights;
        x[0] * w[0] + x[1] * w[1] + x[2] * w[2] + x[3] * w[3]
    }
}

impl Element<4> for QuadraticHinge {
    fn name(&self) -> &'static str {
        "quadratic bending"
    }

    fn count(&self) -> usize {
        self.flaps.len()
    }

    fn vertices(&self, e: usize) -> [u32; 4] {
        self.flaps[e].vertices
    }

    fn value(&self, e: usize, x: &[Vec3; 4]) -> f64 {
        0.5 * self.stiffness[e] * self.fold(e, x).norm_squared()
    }

    fn gradient(&self, e: usize, x: &[Vec3; 4]) -> [Vec3; 4] {
        let moment = self.fold(e, x) * self.stiffness[e];
        self.flaps[e].weights.map(|w| moment * w)
    }

    fn hessian(&self, e: usize, _: &[Vec3; 4], _: Projection) -> [[Matrix3<f64>; 4]; 4] {
        let w = self.flaps[e].weights.map(|w| Matrix3::identity() * w);
        let k = self.stiffness[e];
        std::array::from_fn(|i| std::array::from_fn(|j| w[i] * self.flaps[e].weights[j] * k))
    }
}
