//! Quadratic bending for sheets that hardly stretch: a fold angle is replaced by the vector `sum w_i x_i`, which for a flat sheet
//! is the angle times the normal, so the energy is a quadratic form with a constant matrix (Bergou, Wardetzky, Harmon, Zorin, Grinspun,
//! 2006), with the coupling and calibration of [`super::Hinge`]. Limits: flat at rest; the angle counts as 2 sin(theta/2); stretching
//! counts as bending to second order.

use nalgebra::Matrix3;

use super::Rigidity;
use super::calibrate::calibrated;
use super::patch::{Beyond, Patch, patches};
use crate::error::ClothError;
use crate::force::{Assembled, Element, Projection, Vec3};
use crate::mesh::Sheet;

#[derive(Debug, Clone, Copy)]
struct Bend {
    vertices: [u32; 6],
    weights: [[f64; 6]; 3],
    /// What a clamp adds to each fold.
    held: [Vec3; 3],
    stiffness: Matrix3<f64>,
}

/// Quadratic hinges of all triangles.
#[derive(Debug, Clone)]
pub struct QuadraticHinge {
    triangles: Vec<Bend>,
}

impl QuadraticHinge {
    /// Flat at rest, calibrated for the mesh.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative rigidity.
    pub fn new(sheet: &Sheet, rigidity: &Rigidity) -> Result<Assembled<6, Self>, ClothError> {
        Self::clamped(sheet, rigidity, |_| None)
    }

    /// The same with held slopes, as [`super::Hinge::clamped`] has them.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative rigidity.
    pub fn clamped(
        sheet: &Sheet,
        rigidity: &Rigidity,
        held: impl Fn([u32; 2]) -> Option<Vec3>,
    ) -> Result<Assembled<6, Self>, ClothError> {
        rigidity.check()?;
        let d = calibrated(sheet, rigidity);
        let outward = |b: Beyond| if let Beyond::Held(out) = b { out } else { Vec3::zeros() };
        let bend = |(p, d): (Patch, &Matrix3<f64>)| Bend {
            vertices: p.vertices,
            weights: p.weights,
            held: p.beyond.map(outward),
            stiffness: p.stiffness(d),
        };
        Ok(Assembled(Self { triangles: patches(sheet, held).into_iter().zip(&d).map(bend).collect() }))
    }
}

impl Bend {
    fn folds(&self, x: &[Vec3; 6]) -> [Vec3; 3] {
        std::array::from_fn(|k| self.held[k] + (0..6).map(|v| x[v] * self.weights[k][v]).sum::<Vec3>())
    }

    fn moments(&self, x: &[Vec3; 6]) -> [Vec3; 3] {
        let folds = self.folds(x);
        std::array::from_fn(|k| (0..3).map(|l| folds[l] * self.stiffness[(k, l)]).sum())
    }
}

impl Element<6> for QuadraticHinge {
    fn name(&self) -> &'static str {
        "quadratic bending"
    }

    fn count(&self) -> usize {
        self.triangles.len()
    }

    fn vertices(&self, e: usize) -> [u32; 6] {
        self.triangles[e].vertices
    }

    fn value(&self, e: usize, x: &[Vec3; 6]) -> f64 {
        let b = &self.triangles[e];
        0.5 * b.folds(x).iter().zip(&b.moments(x)).map(|(f, m)| f.dot(m)).sum::<f64>()
    }

    fn gradient(&self, e: usize, x: &[Vec3; 6]) -> [Vec3; 6] {
        let b = &self.triangles[e];
        let moments = b.moments(x);
        std::array::from_fn(|v| (0..3).map(|k| moments[k] * b.weights[k][v]).sum())
    }

    fn hessian(&self, e: usize, _: &[Vec3; 6], _: Projection) -> [[Matrix3<f64>; 6]; 6] {
        let b = &self.triangles[e];
        let column = |v: usize| nalgebra::Vector3::from_fn(|k, _| b.weights[k][v]);
        let share = |i: usize, j: usize| column(i).dot(&(b.stiffness * column(j)));
        std::array::from_fn(|i| std::array::from_fn(|j| Matrix3::identity() * share(i, j)))
    }
}
