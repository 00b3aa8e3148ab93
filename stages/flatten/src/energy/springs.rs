//! Springs along the edges of each triangle: `1/2 (l - d)^2 / d^2` of each edge, d its length in
//! 3D, l in the plane.
//!
//! The structural springs of the sewing simulation, `f = c (l - d)`, laid in the plane. Their
//! stiffness c falls with the square of the rest length and grows with the area beside the spring,
//! so that the energy does not depend on the mesh's fineness. Springs alone let a triangle fold to
//! nothing: a thousandth of the symmetric Dirichlet energy keeps its area above zero.

use super::{Derivatives, EnergyDensity, Hessian, SymmetricDirichletEnergy};
use crate::frames::local_edges;
use crate::surface::PieceSurface;
use nalgebra::{Matrix2, Vector2, Vector4};

/// The share of symmetric Dirichlet energy: it moves no vertex by more than a thousandth of the
/// strain there.
const AREA_KEEPER: f64 = 1e-3;

/// Rest vectors of the edges of every triangle, each of unit length in the triangle's plane.
#[derive(Debug, Clone)]
pub struct SpringEnergy {
    edges: Vec<[Vector2<f64>; 3]>,
}

impl SpringEnergy {
    /// The springs of a surface.
    #[must_use]
    pub fn new(surface: &PieceSurface) -> Self {
        let edges = (0..surface.triangles().len()).map(|t| {
            let [b, c] = local_edges(surface, t);
            [b, c - b, -c].map(|e| e.normalize())
        });
        Self { edges: edges.collect() }
    }
}

impl EnergyDensity for SpringEnergy {
    fn value(&self, triangle: usize, j: &Matrix2<f64>) -> f64 {
        let springs: f64 = self.edges[triangle].iter().map(|e| ((j * e).norm() - 1.0).powi(2) / 2.0).sum();
        springs + AREA_KEEPER * EnergyDensity::value(&SymmetricDirichletEnergy, triangle, j)
    }

    fn derivatives(&self, triangle: usize, j: &Matrix2<f64>, wanted: Hessian) -> Derivatives {
        let keeper = SymmetricDirichletEnergy.derivatives(triangle, j, wanted);
        let mut sum = Derivatives {
            value: AREA_KEEPER * keeper.value,
            gradient: keeper.gradient * AREA_KEEPER,
            hessian: keeper.hessian * AREA_KEEPER,
        };
        for e in &self.edges[triangle] {
            let image = j * e;
            let length = image.norm();
            let n = image / length;
            sum.value += (length - 1.0).powi(2) / 2.0;
            // How the entries of j move the image along n and across it.
            let along = Vector4::new(n.x * e.x, n.x * e.y, n.y * e.x, n.y * e.y);
            let across = Vector4::new(-n.y * e.x, -n.y * e.y, n.x * e.x, n.x * e.y);
            sum.gradient += along * (length - 1.0);
            sum.hessian += along * along.transpose();
            // A spring in compression pushes sideways: that is the negative part.
            let sideways = 1.0 - 1.0 / length;
            let kept = if wanted == Hessian::Exact { sideways } else { sideways.max(0.0) };
            sum.hessian += across * across.transpose() * kept;
        }
        sum
    }
}
