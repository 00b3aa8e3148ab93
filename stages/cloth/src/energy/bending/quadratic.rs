//! Quadratic bending for sheets that hardly stretch: a fold angle is replaced by the vector
//! `c = sum w_i x_i`, which for a flat sheet is the angle times the normal, so the energy
//! `k |c|² / 2` is a quadratic form with a constant matrix (Bergou, Wardetzky, Harmon, Zorin,
//! Grinspun, 2006).
//!
//! One hinge an inner edge, `k = f D |e|² / (A1 + A2)`: the weight that makes a sheet of
//! equilateral triangles bend with rigidity D in every direction, times a factor f that takes out
//! what the mesh makes of it (see `calibrate`). Such hinges bend with Poisson's ratio -1/3;
//! [`super::FreeEdge`] takes that out of free edges. Cost: a few products an edge; the matrix is
//! summed once a pattern. Limits: flat at rest; the angle counts as 2 sin(theta/2); stretching
//! counts as bending to second order.

use super::angle::{Leaf, angle};
use super::calibrate::Calibration;
use super::flap::{Flap, flaps};
use crate::energy::{Assembled, Blocks, Cloth, Element, Projection, Subset, Vec3};
use crate::error::ClothError;
use crate::fabric::Rigidity;
use crate::mesh::{Edge, Sheet, Side};
use nalgebra::{Matrix3, Vector2};

/// One hinge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fold {
    /// Edge start, edge end, left tip, right tip.
    pub nodes: [u32; 4],
    /// The small fold angle by the nodes' lifts, 1/m; their sum is zero.
    pub weights: [f64; 4],
    /// Calibrated, N m per squared radian.
    pub stiffness: f64,
    /// The angle that a curvature of 1/m makes, m.
    pub(super) span: f64,
}

impl Fold {
    /// The fold angle, rad, and its derivative by the four nodes.
    #[must_use]
    pub fn angle(&self, x: &[Vec3; 4]) -> (f64, [Vec3; 4]) {
        let (left, right) = (Leaf::new(&x[0], &x[1], &x[2], false), Leaf::new(&x[0], &x[1], &x[3], true));
        let (l, r) = (left.gradient(), right.gradient());
        (angle(&x[0], &x[1], &x[2], &x[3]), [l[0] + r[0], l[1] + r[1], l[2], r[2]])
    }

    /// Adds so many times the second derivative of the fold angle.
    pub(super) fn add_hessian_of_angle(&self, x: &[Vec3; 4], times: f64, blocks: &mut Blocks<4>) {
        let leaves = [Leaf::new(&x[0], &x[1], &x[2], false), Leaf::new(&x[0], &x[1], &x[3], true)];
        for (leaf, at) in leaves.iter().zip([[0, 1, 2], [0, 1, 3]]) {
            for (row, i) in leaf.hessian().iter().zip(at) {
                row.iter().zip(at).for_each(|(block, j)| blocks[i][j] += block * times);
            }
        }
    }

    /// The angle times the normal of a flat sheet.
    pub(super) fn curvature(&self, x: &[Vec3; 4]) -> Vec3 {
        x.iter().zip(&self.weights).map(|(x, w)| x * *w).sum()
    }
}

/// All inner edges of a cloth as calibrated hinges, in the order of the sheet's edges.
pub(super) fn folds(cloth: &Cloth<'_>) -> Vec<Fold> {
    calibrated(cloth.sheet, cloth.calibration(), |t| cloth.rigidity(t))
}

/// The same of a sheet of one rigidity, for solvers that go from constraint to constraint.
///
/// # Errors
/// [`ClothError::InvalidParameter`] for a negative rigidity.
pub fn folds_of(sheet: &Sheet, rigidity: &Rigidity) -> Result<Vec<Fold>, ClothError> {
    rigidity.check()?;
    Ok(calibrated(sheet, &Calibration::of(sheet), |_| *rigidity))
}

fn calibrated(sheet: &Sheet, calibration: &Calibration, rigidity: impl Fn(usize) -> Rigidity) -> Vec<Fold> {
    let across = |side: &Side| {
        let (r, k) = (&sheet.rest()[side.triangle as usize], side.corner as usize);
        let e = (r[(k + 2) % 3] - r[(k + 1) % 3]).normalize();
        calibration.corrected(&rigidity(side.triangle as usize)).along(&Vector2::new(e.y, -e.x))
    };
    let both = |e: &Edge| Some(0.5 * (across(&e.sides.0) + across(&e.sides.1?)));
    let fold = |(f, bend): (Flap, f64)| Fold {
        nodes: f.vertices,
        weights: f.weights,
        stiffness: calibration.factor * bend * f.slenderness,
        span: (f.area / f.slenderness).sqrt(),
    };
    flaps(sheet).into_iter().zip(sheet.edges().iter().filter_map(both)).map(fold).collect()
}

/// Quadratic hinges of all inner edges.
#[derive(Debug, Clone)]
pub struct Quadratic {
    folds: Vec<Fold>,
}

impl Quadratic {
    /// Flat at rest, calibrated for the mesh.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>) -> Assembled<4, Self> {
        Assembled(Self { folds: folds(cloth) })
    }
}

impl Element<4> for Quadratic {
    type State = ();

    fn name(&self) -> &'static str {
        "quadratic bending"
    }

    fn count(&self) -> usize {
        self.folds.len()
    }

    #[inline]
    fn nodes(&self, e: usize) -> [u32; 4] {
        self.folds[e].nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 4]) -> f64 {
        0.5 * self.folds[e].stiffness * self.folds[e].curvature(x).norm_squared()
    }

    fn gradient(&self, e: usize, x: &[Vec3; 4]) -> [Vec3; 4] {
        let moment = self.folds[e].curvature(x) * self.folds[e].stiffness;
        self.folds[e].weights.map(|w| moment * w)
    }

    fn state(&self, _: usize, _: &[Vec3; 4], _: Projection) {}

    fn add_block(&self, e: usize, (): &(), row: usize, column: usize, sum: &mut Matrix3<f64>) {
        let f = &self.folds[e];
        let (low, high) = (row.min(column), row.max(column));
        let k = f.stiffness * f.weights[high] * f.weights[low];
        (0..3).for_each(|c| sum[(c, c)] += k);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let fold = |&e: &usize| Fold { nodes: subset.renumbered(self.folds[e].nodes), ..self.folds[e] };
        Self { folds: elements.iter().map(fold).collect() }
    }

    fn is_constant(&self) -> bool {
        true
    }

    fn scale_bending(&mut self, by: f64) {
        self.folds.iter_mut().for_each(|f| f.stiffness *= by);
    }
}
