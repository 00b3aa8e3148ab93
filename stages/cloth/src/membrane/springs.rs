//! Springs along the mesh edges, by family: structural (near warp or weft) and shear (the diagonals).
//!
//! A spring's stiffness is that of the cloth it stands for, `k A / l²` (van Gelder, 1998), A the area of its triangles; a shear
//! spring takes 4 G in place of k, which is exact for squares with one diagonal. Piecewise-linear stiffness as in
//! Fan et al., 1999. Cost: one square root an edge. Limit: exact for stretch along mesh lines only; Poisson's ratio and the
//! stiffness off the mesh lines are what the mesh makes of them.

use nalgebra::{Matrix3, Vector2};

use crate::error::ClothError;
use crate::fabric::{Curve, Fabric};
use crate::force::{Assembled, Element, Projection, Vec3};
use crate::mesh::{Edge, Sheet};

/// An edge within this angle of warp or weft (radians) is structural: half way between the axes and the diagonal of a square.
const STRUCTURAL_ANGLE: f64 = std::f64::consts::FRAC_PI_8;

/// Which measured curve a spring follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    Warp,
    Weft,
    Shear,
}

#[derive(Debug, Clone, Copy)]
struct Spring {
    vertices: [u32; 2],
    rest: f64,
    family: Family,
    /// Cloth width that the spring stands for, m: tension times width is its force.
    width: f64,
}

/// All springs of a sheet.
#[derive(Debug, Clone)]
pub struct Springs {
    springs: Vec<Spring>,
    curves: [Curve; 3],
}

impl Springs {
    /// Structural and shear springs on every edge.
    ///
    /// # Errors
    /// What [`Fabric::check`] finds.
    pub fn new(sheet: &Sheet, fabric: &Fabric) -> Result<Assembled<2, Self>, ClothError> {
        fabric.check()?;
        let springs = sheet.edges().iter().map(|e| spring(sheet, e)).collect();
        let curves = [fabric.warp.clone(), fabric.weft.clone(), fabric.shear.scaled(4.0)];
        Ok(Assembled(Self { springs, curves }))
    }

    /// Vertices, rest length and present stiffness (N/m) of each spring: what bounds the explicit time step.
    pub fn stiffness(&self) -> impl Iterator<Item = ([u32; 2], f64)> {
        self.springs.iter().map(|s| (s.vertices, self.curve(s.family).slope(0.0) * s.width / s.rest))
    }

    fn curve(&self, family: Family) -> &Curve {
        &self.curves[family as usize]
    }
}

fn spring(sheet: &Sheet, e: &Edge) -> Spring {
    let mut area = sheet.areas()[e.sides.0.triangle as usize];
    if let Some(other) = e.sides.1 {
        area += sheet.areas()[other.triangle as usize];
    }
    let corners = &sheet.rest()[e.sides.0.triangle as usize];
    let k = e.sides.0.corner as usize;
    let family = family(&(corners[(k + 2) % 3] - corners[(k + 1) % 3]));
    Spring { vertices: e.vertices, rest: e.rest_length, family, width: area / e.rest_length }
}

fn family(direction: &Vector2<f64>) -> Family {
    let from_warp = direction.x.abs().atan2(direction.y.abs());
    if from_warp < STRUCTURAL_ANGLE {
        Family::Warp
    } else if from_warp > std::f64::consts::FRAC_PI_2 - STRUCTURAL_ANGLE {
        Family::Weft
    } else {
        Family::Shear
    }
}

impl Element<2> for Springs {
    fn name(&self) -> &'static str {
        "springs"
    }

    fn count(&self) -> usize {
        self.springs.len()
    }

    fn vertices(&self, e: usize) -> [u32; 2] {
        self.springs[e].vertices
    }

    fn value(&self, e: usize, x: &[Vec3; 2]) -> f64 {
        let s = &self.springs[e];
        let strain = (x[1] - x[0]).norm() / s.rest - 1.0;
        self.curve(s.family).energy(strain) * s.width * s.rest
    }

    fn gradient(&self, e: usize, x: &[Vec3; 2]) -> [Vec3; 2] {
        let s = &self.springs[e];
        let (length, unit) = direction(x);
        let pull = unit * (self.curve(s.family).force(length / s.rest - 1.0) * s.width);
        [-pull, pull]
    }

    fn hessian(&self, e: usize, x: &[Vec3; 2], projection: Projection) -> [[Matrix3<f64>; 2]; 2] {
        let s = &self.springs[e];
        let (length, unit) = direction(x);
        let (curve, strain) = (self.curve(s.family), length / s.rest - 1.0);
        let mut across = if length > 0.0 { curve.force(strain) * s.width / length } else { 0.0 };
        if projection == Projection::PositiveSemiDefinite {
            across = across.max(0.0);
        }
        let along = curve.slope(strain) * s.width / s.rest;
        let h = Matrix3::identity() * across + unit * unit.transpose() * (along - across);
        [[h, -h], [-h, h]]
    }
}

/// Length and direction; the direction of a spring without length is zero, so that it pulls nowhere.
fn direction(x: &[Vec3; 2]) -> (f64, Vec3) {
    let d = x[1] - x[0];
    let length = d.norm();
    (length, if length > 0.0 { d / length } else { Vec3::zeros() })
}
