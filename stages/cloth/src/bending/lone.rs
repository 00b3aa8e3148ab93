//! The lone hinge (discrete shell): every inner edge resists its own fold angle, `E = k (theta - rest)² / 2`, `k = f D |e|² / (A1 + A2)`.
//!
//! Grinspun, Hirani, Desbrun, Schroeder, 2003, with the weight that makes a sheet of equilateral triangles bend with rigidity D in
//! every direction (their 3 is three times too stiff for it). On other meshes a fold costs more when it must cross the grain of
//! the mesh, and less where vertices can give way; `f` takes the mean of both out, see `calibrate`. What no factor
//! can take out is the difference between directions: 4 % on irregular meshes, 1 : 1.5 on alternating diagonals, 1 : 4 on one diagonal;
//! [`super::Hinge`] couples the angles of a triangle and has none of it on three of the four.
//! The implied Poisson ratio of bending is -1/3 (equilateral). Solvers that go from constraint to constraint use this one.

use nalgebra::Matrix3;

use super::Rigidity;
use super::angle::{Leaf, angle};
use super::calibrate::Calibration;
use super::flap::{Flap, flaps};
use crate::error::ClothError;
use crate::force::{Assembled, Element, Projection, Vec3};
use crate::mesh::Sheet;

/// Lone hinges on all inner edges of a sheet.
#[derive(Debug, Clone)]
pub struct LoneHinge {
    flaps: Vec<Flap>,
    stiffness: Vec<f64>,
    rest: Vec<f64>,
    factor: f64,
}

impl LoneHinge {
    /// Flat at rest, calibrated for the mesh.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative rigidity.
    pub fn new(sheet: &Sheet, rigidity: &Rigidity) -> Result<Assembled<4, Self>, ClothError> {
        let calibration = Calibration::of(sheet);
        Self::with_factor(sheet, &calibration.corrected(rigidity), calibration.factor)
    }

    /// Flat at rest, with `factor` in place of the calibration (1 for the formula as it stands).
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative rigidity.
    pub fn with_factor(
        sheet: &Sheet,
        rigidity: &Rigidity,
        factor: f64,
    ) -> Result<Assembled<4, Self>, ClothError> {
        rigidity.check()?;
        let flaps = flaps(sheet, rigidity);
        let stiffness = flaps.iter().map(|f| factor * f.rigidity * f.slenderness).collect();
        let rest = vec![0.0; flaps.len()];
        Ok(Assembled(Self { flaps, stiffness, rest, factor }))
    }

    /// Takes the fold angles at `x` as the unstressed ones: a pressed crease, a cuff rolled on its form.
    pub fn rest_at(&mut self, x: &[Vec3]) {
        self.rest = (0..self.flaps.len())
            .map(|e| self.angle(&self.flaps[e].vertices.map(|v| x[v as usize])))
            .collect();
    }

    /// The calibration factor in use.
    #[must_use]
    pub fn factor(&self) -> f64 {
        self.factor
    }

    fn angle(&self, x: &[Vec3; 4]) -> f64 {
        angle(&x[0], &x[1], &x[2], &x[3])
    }
}

/// One hinge on its own, for solvers that go from constraint to constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HingeTerm {
    /// Edge start, edge end, left tip, right tip.
    pub vertices: [u32; 4],
    /// Small fold angle = sum of these times the lifts, 1/m.
    pub weights: [f64; 4],
    /// Calibrated stiffness, N m per radian².
    pub stiffness: f64,
}

impl HingeTerm {
    /// The fold angle and its derivative by the four vertices.
    #[must_use]
    pub fn fold(&self, x: &[Vec3; 4]) -> (f64, [Vec3; 4]) {
        let (left, right) = leaves(x);
        (angle(&x[0], &x[1], &x[2], &x[3]), gradient(&left, &right))
    }
}

/// All hinges of a sheet, flat at rest, calibrated.
///
/// # Errors
/// [`ClothError::InvalidParameter`] for a negative rigidity.
pub fn hinge_terms(sheet: &Sheet, rigidity: &Rigidity) -> Result<Vec<HingeTerm>, ClothError> {
    let Assembled(hinge) = LoneHinge::new(sheet, rigidity)?;
    let term =
        |(f, &stiffness): (&Flap, &f64)| HingeTerm { vertices: f.vertices, weights: f.weights, stiffness };
    Ok(hinge.flaps.iter().zip(&hinge.stiffness).map(term).collect())
}

/// Derivative of the angle by edge start, edge end, left tip, right tip.
fn gradient(left: &Leaf, right: &Leaf) -> [Vec3; 4] {
    let (l, r) = (left.gradient(), right.gradient());
    [l[0] + r[0], l[1] + r[1], l[2], r[2]]
}

impl Element<4> for LoneHinge {
    fn name(&self) -> &'static str {
        "lone hinges"
    }

    fn count(&self) -> usize {
        self.flaps.len()
    }

    fn vertices(&self, e: usize) -> [u32; 4] {
        self.flaps[e].vertices
    }

    fn value(&self, e: usize, x: &[Vec3; 4]) -> f64 {
        0.5 * self.stiffness[e] * (self.angle(x) - self.rest[e]).powi(2)
    }

    fn gradient(&self, e: usize, x: &[Vec3; 4]) -> [Vec3; 4] {
        let moment = self.stiffness[e] * (self.angle(x) - self.rest[e]);
        let (left, right) = leaves(x);
        gradient(&left, &right).map(|g| g * moment)
    }

    fn hessian(&self, e: usize, x: &[Vec3; 4], projection: Projection) -> [[Matrix3<f64>; 4]; 4] {
        let (left, right) = leaves(x);
        let g = gradient(&left, &right);
        let k = self.stiffness[e];
        let mut h: [[Matrix3<f64>; 4]; 4] =
            std::array::from_fn(|i| std::array::from_fn(|j| g[i] * g[j].transpose() * k));
        if projection == Projection::Exact {
            let moment = k * (self.angle(x) - self.rest[e]);
            add_leaf(&mut h, &left.hessian(), [0, 1, 2], moment);
            add_leaf(&mut h, &right.hessian(), [0, 1, 3], moment);
        }
        h
    }
}

fn leaves(x: &[Vec3; 4]) -> (Leaf, Leaf) {
    (Leaf::new(&x[0], &x[1], &x[2], false), Leaf::new(&x[0], &x[1], &x[3], true))
}

fn add_leaf(h: &mut [[Matrix3<f64>; 4]; 4], leaf: &[[Matrix3<f64>; 3]; 3], at: [usize; 3], scale: f64) {
    for (i, row) in leaf.iter().enumerate() {
        for (j, block) in row.iter().enumerate() {
            h[at[i]][at[j]] += block * scale;
        }
    }
}
