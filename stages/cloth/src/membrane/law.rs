//! Constant-strain triangles: from a law for the deformation gradient to forces on the corners.

use nalgebra::{Matrix3, Matrix3x2, Vector2};

use crate::force::{Assembled, Element, Projection, Vec3};
use crate::mesh::Sheet;

/// Second derivative by the two columns of the deformation gradient.
pub type Tangent = [[Matrix3<f64>; 2]; 2];

/// A hyperelastic law of a sheet: energy per rest area as a function of the 3 x 2 deformation gradient.
pub trait Law: Send + Sync {
    /// What it is called in reports.
    fn name(&self) -> &'static str;

    /// J/m².
    fn density(&self, f: &Matrix3x2<f64>) -> f64;

    /// First Piola-Kirchhoff stress, N/m.
    fn stress(&self, f: &Matrix3x2<f64>) -> Matrix3x2<f64>;

    /// Derivative of the stress, N/m.
    fn tangent(&self, f: &Matrix3x2<f64>, projection: Projection) -> Tangent;
}

/// Linear triangles with one law.
#[derive(Debug, Clone)]
pub struct Triangles<L> {
    /// The law.
    pub law: L,
    vertices: Vec<[u32; 3]>,
    areas: Vec<f64>,
    shape: Vec<[Vector2<f64>; 3]>,
}

impl<L: Law> Triangles<L> {
    /// The membrane of a sheet.
    #[must_use]
    pub fn new(sheet: &Sheet, law: L) -> Assembled<3, Self> {
        let shape = sheet.inverse_rest().iter().map(shape_gradients).collect();
        let (vertices, areas) = (sheet.triangles().to_vec(), sheet.areas().to_vec());
        Assembled(Self { law, vertices, areas, shape })
    }

    fn deformation(&self, t: usize, x: &[Vec3; 3]) -> Matrix3x2<f64> {
        let [_, g1, g2] = &self.shape[t];
        (x[1] - x[0]) * g1.transpose() + (x[2] - x[0]) * g2.transpose()
    }
}

/// Gradients of the three linear shape functions: they sum to zero.
fn shape_gradients(inverse_rest: &nalgebra::Matrix2<f64>) -> [Vector2<f64>; 3] {
    let (g1, g2) = (inverse_rest.row(0).transpose(), inverse_rest.row(1).transpose());
    [-g1 - g2, g1, g2]
}

impl<L: Law> Element<3> for Triangles<L> {
    fn name(&self) -> &'static str {
        self.law.name()
    }

    fn count(&self) -> usize {
        self.vertices.len()
    }

    fn vertices(&self, t: usize) -> [u32; 3] {
        self.vertices[t]
    }

    fn value(&self, t: usize, x: &[Vec3; 3]) -> f64 {
        self.areas[t] * self.law.density(&self.deformation(t, x))
    }

    fn gradient(&self, t: usize, x: &[Vec3; 3]) -> [Vec3; 3] {
        let stress = self.law.stress(&self.deformation(t, x)) * self.areas[t];
        self.shape[t].map(|g| stress * g)
    }

    fn hessian(&self, t: usize, x: &[Vec3; 3], projection: Projection) -> [[Matrix3<f64>; 3]; 3] {
        let tangent = self.law.tangent(&self.deformation(t, x), projection);
        let (shape, area) = (&self.shape[t], self.areas[t]);
        std::array::from_fn(|a| std::array::from_fn(|b| block(&tangent, &(shape[a] * area), &shape[b])))
    }
}

fn block(t: &Tangent, a: &Vector2<f64>, b: &Vector2<f64>) -> Matrix3<f64> {
    (t[0][0] * b.x + t[0][1] * b.y) * a.x + (t[1][0] * b.x + t[1][1] * b.y) * a.y
}
