//! Strain limits, applied to positions after a step.
//!
//! [`Provot`] (1995) walks over the edges and shortens each that is too long: the free end if one
//! is held, both by half if none is, as the classic systems do. It ignores masses and moves the
//! centre of mass, and knows edges only. [`StrainLimit`] clamps the principal stretches of each
//! triangle and moves its corners by their inverse masses, in a few rounds of Gauss-Seidel
//! (Thomaszewski, Pabst, Strasser, 2009): any direction, momentum kept. Both need tens of rounds
//! for a long chain; both report what is left.

use nalgebra::Matrix3x2;

use crate::error::{ClothError, check_parameter};
use crate::mesh::Sheet;
use toile_geometry::Vec3;

/// The edge-wise correction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Provot {
    limit: f64,
    rounds: usize,
}

/// The triangle-wise correction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrainLimit {
    limit: f64,
    rounds: usize,
}

impl Provot {
    /// No edge longer than 1 + `limit` of its rest length, as far as `rounds` walks reach.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a limit of 0 or less.
    pub fn new(limit: f64, rounds: usize) -> Result<Self, ClothError> {
        check_parameter("strain limit", limit, |l| l > 0.0, "above 0")?;
        Ok(Self { limit, rounds })
    }

    /// Shortens; returns the greatest edge strain left.
    pub fn apply(&self, sheet: &Sheet, fixed: &[bool], x: &mut [Vec3]) -> f64 {
        for _ in 0..self.rounds {
            for e in sheet.edges() {
                let [a, b] = e.vertices.map(|v| v as usize);
                let d = x[b] - x[a];
                let over = d.norm() - e.rest_length * (1.0 + self.limit);
                if over > 0.0 {
                    let back = d.normalize() * over;
                    let (wa, wb) = shares(fixed[a], fixed[b]);
                    x[a] += back * wa;
                    x[b] -= back * wb;
                }
            }
        }
        let strain = |e: &crate::mesh::Edge| {
            (x[e.vertices[1] as usize] - x[e.vertices[0] as usize]).norm() / e.rest_length - 1.0
        };
        sheet.edges().iter().map(strain).fold(0.0, f64::max)
    }
}

fn shares(a_fixed: bool, b_fixed: bool) -> (f64, f64) {
    match (a_fixed, b_fixed) {
        (true, true) => (0.0, 0.0),
        (true, false) => (0.0, 1.0),
        (false, true) => (1.0, 0.0),
        (false, false) => (0.5, 0.5),
    }
}

impl StrainLimit {
    /// No principal stretch above 1 + `limit`, as far as `rounds` walks reach.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a limit of 0 or less.
    pub fn new(limit: f64, rounds: usize) -> Result<Self, ClothError> {
        check_parameter("strain limit", limit, |l| l > 0.0, "above 0")?;
        Ok(Self { limit, rounds })
    }

    /// Clamps; returns the greatest principal strain left.
    pub fn apply(&self, sheet: &Sheet, fixed: &[bool], x: &mut [Vec3]) -> f64 {
        for _ in 0..self.rounds {
            for t in 0..sheet.triangles().len() {
                self.clamp(sheet, fixed, x, t);
            }
        }
        sheet.greatest_strain(x).1.max(0.0)
    }

    fn clamp(&self, sheet: &Sheet, fixed: &[bool], x: &mut [Vec3], t: usize) {
        let f = sheet.deformation(t, x);
        let Some(wanted) = clamped(&f, 1.0 + self.limit) else { return };
        let corners = sheet.triangles()[t].map(|v| v as usize);
        let rest = &sheet.rest()[t];
        let weight = corners.map(|v| if fixed[v] { 0.0 } else { 1.0 / sheet.masses()[v] });
        let sum: f64 = weight.iter().sum();
        if sum == 0.0 {
            return;
        }
        // The clamped shape is placed so that the mass-weighted displacement of the corners is
        // least.
        let shape: [Vec3; 3] = std::array::from_fn(|k| wanted * (rest[k] - rest[0]));
        let hold = corners.map(|v| if fixed[v] { 1e9 } else { sheet.masses()[v] });
        let total: f64 = hold.iter().sum();
        let place: Vec3 = (0..3).map(|k| (x[corners[k]] - shape[k]) * (hold[k] / total)).sum();
        for k in 0..3 {
            if !fixed[corners[k]] {
                x[corners[k]] = shape[k] + place;
            }
        }
    }
}

/// The deformation with its principal stretches cut to `most`, or none if none is above.
fn clamped(f: &Matrix3x2<f64>, most: f64) -> Option<Matrix3x2<f64>> {
    let eigen = nalgebra::SymmetricEigen::new(f.tr_mul(f));
    let stretch = eigen.eigenvalues.map(|v| v.max(0.0).sqrt());
    if stretch.max() <= most {
        return None;
    }
    let cut = stretch.map(|s| if s > most { most / s } else { 1.0 });
    Some(f * eigen.eigenvectors * nalgebra::Matrix2::from_diagonal(&cut) * eigen.eigenvectors.transpose())
}
