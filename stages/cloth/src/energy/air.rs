//! Air: drag and wind on every triangle.
//!
//! `F = rho A / 2 (c_n |v_n| v_n + c_t |v_t| v_t)`, v the wind less the triangle's velocity, v_n
//! and v_t its parts across and along the triangle, A its area now; a third to each corner. That
//! the two parts act each for itself is the cross-flow principle (Taylor, 1952; Hoerner, 1965);
//! cloth in wind by triangles: Ling, Damodaran, Gay (1996); Keckeisen, Kimmerle, Thomaszewski,
//! Wacker (2004).
//!
//! Solvers take one linear step of it: the triangle's velocity before the step says how firmly the
//! air grips it ([`AirDrag::grips`]), and each corner is held by a third of that at its velocity
//! after the step. The sum is the law, a state that lasts keeps it exactly, and so does a sheet
//! that the wind carries off face on (Kahan, 1993: `v v'` for `v²`). The grip is never negative, so
//! still air only takes energy, however long the step. Cost: a few flops a triangle and step. Left
//! out: lift, the wake of other cloth, the mass of the air that moves along.

use nalgebra::Matrix3;
use rayon::prelude::*;

use super::places::Places;
use super::potential::{Energy, Projection};
use crate::error::{ClothError, check_parameter};
use crate::linear::Vec3;

/// Denser than water no fluid is that cloth moves in, kg/m³.
const DENSEST: f64 = 2000.0;
/// Greatest coefficient of drag.
const GREATEST_COEFFICIENT: f64 = 100.0;
/// Strongest wind, m/s.
const STRONGEST: f64 = 1000.0;

/// What the sheet moves in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// kg/m³: 1.2 for air at 20 °C; 0 for none.
    pub density: f64,
    /// Drag coefficient across the cloth: 1.17 for a square plate face on (Hoerner, 1965).
    pub normal: f64,
    /// Drag coefficient along the cloth, both sides together: 0.008 for a smooth plate at Reynolds
    /// number 1e5 (Blasius, 1908).
    pub tangential: f64,
    /// Velocity of the air, m/s.
    pub wind: Vec3,
}

impl Air {
    /// Coefficient across, where nothing else is said.
    pub const NORMAL: f64 = 1.17;
    /// Coefficient along, where nothing else is said.
    pub const TANGENTIAL: f64 = 0.008;

    /// Still air of this density, kg/m³, with the standard coefficients.
    #[must_use]
    pub fn still(density: f64) -> Self {
        Self { density, normal: Self::NORMAL, tangential: Self::TANGENTIAL, wind: Vec3::zeros() }
    }

    /// The same air without wind.
    #[must_use]
    pub fn calmed(self) -> Self {
        Self { wind: Vec3::zeros(), ..self }
    }

    /// Whether it does anything at all.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.density > 0.0 && (self.normal > 0.0 || self.tangential > 0.0)
    }

    /// Checks the ranges.
    ///
    /// # Errors
    /// [`ClothError::NonFiniteInput`], [`ClothError::InvalidParameter`].
    pub fn check(&self) -> Result<(), ClothError> {
        check_parameter(
            "air density",
            self.density,
            |d| (0.0..=DENSEST).contains(&d),
            "from 0 to 2000 kg/m^3",
        )?;
        let coefficient = |c: f64| (0.0..=GREATEST_COEFFICIENT).contains(&c);
        check_parameter("normal drag coefficient", self.normal, coefficient, "from 0 to 100")?;
        check_parameter("tangential drag coefficient", self.tangential, coefficient, "from 0 to 100")?;
        if let Some(index) = self.wind.iter().position(|w| !w.is_finite()) {
            return Err(ClothError::NonFiniteInput { field: "wind", index });
        }
        let speed = self.wind.x.hypot(self.wind.y).hypot(self.wind.z);
        check_parameter("wind speed", speed, |s| s <= STRONGEST, "at most 1000 m/s")
    }

    /// What solvers of rest ask: still air does not change where cloth rests, wind does, and has no
    /// potential.
    ///
    /// # Errors
    /// [`ClothError::Wind`].
    pub fn check_still(&self) -> Result<(), ClothError> {
        let speed = self.wind.norm();
        if self.acts() && speed > 0.0 { Err(ClothError::Wind { speed }) } else { Ok(()) }
    }
}

/// Air around the triangles of one sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct AirDrag {
    /// The air.
    pub air: Air,
    triangles: Vec<[u32; 3]>,
}

impl AirDrag {
    /// Air around these triangles.
    #[must_use]
    pub fn new(air: Air, triangles: &[[u32; 3]]) -> Self {
        Self { air, triangles: triangles.to_vec() }
    }

    /// The force of the air on each vertex, N, where vertices are at `x` (m) and move with `v`
    /// (m/s): the law itself.
    #[must_use]
    pub fn forces(&self, x: &[Vec3], v: &[Vec3]) -> Vec<Vec3> {
        let mut forces = vec![Vec3::zeros(); x.len()];
        for t in &self.triangles {
            let (corners, slip) = (t.map(|k| x[k as usize]), self.slip(t, v));
            let third = grip(&self.air, &corners, &slip) * slip / 3.0;
            t.iter().for_each(|&k| forces[k as usize] += third);
        }
        forces
    }

    /// How firmly the air holds each vertex, N s/m: the force on it is this times (wind - its
    /// velocity). Symmetric, never negative.
    #[must_use]
    pub fn grips(&self, x: &[Vec3], v: &[Vec3]) -> Vec<Matrix3<f64>> {
        let of = |t: &[u32; 3]| grip(&self.air, &t.map(|k| x[k as usize]), &self.slip(t, v)) / 3.0;
        let thirds: Vec<Matrix3<f64>> = self.triangles.par_iter().with_min_len(256).map(of).collect();
        let mut grips = vec![Matrix3::zeros(); x.len()];
        for (t, third) in self.triangles.iter().zip(&thirds) {
            t.iter().for_each(|&k| grips[k as usize] += third);
        }
        grips
    }

    /// Wind less the triangle's velocity, m/s.
    fn slip(&self, t: &[u32; 3], v: &[Vec3]) -> Vec3 {
        self.air.wind - t.iter().map(|&k| v[k as usize]).sum::<Vec3>() / 3.0
    }
}

/// The tensor that takes `slip` to the force on a triangle, N s/m.
fn grip(air: &Air, corners: &[Vec3; 3], slip: &Vec3) -> Matrix3<f64> {
    let cross = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
    let twice = cross.norm();
    if twice <= 0.0 || !twice.is_finite() {
        return Matrix3::zeros();
    }
    let n = cross / twice;
    let across = slip.dot(&n);
    let along = (slip - n * across).norm();
    let half = 0.25 * air.density * twice;
    let (a, b) = (half * air.normal * across.abs(), half * air.tangential * along);
    Matrix3::identity() * b + n * n.transpose() * (a - b)
}

/// How a free vertex of mass `m` (kg) answers an impulse in a step of `h` (s) while the air grips
/// it, 1/kg.
#[must_use]
pub fn mobility(m: f64, grip: &Matrix3<f64>, h: f64) -> Matrix3<f64> {
    let heavy = Matrix3::identity() * m + grip * h;
    heavy.try_inverse().unwrap_or_else(|| Matrix3::identity() / m)
}

/// The velocity of such a vertex after the step, where it would be `v` without air, m/s.
#[must_use]
pub fn carried(v: &Vec3, wind: &Vec3, mobility: &Matrix3<f64>, grip: &Matrix3<f64>, h: f64) -> Vec3 {
    v + mobility * (grip * (wind - v)) * h
}

/// One step of the air's grip as an energy, for solvers that minimise: `d B d / 2h - d B w`, d the
/// way since the start.
#[derive(Debug, Clone)]
pub struct AirStep<'a> {
    /// Where the step starts.
    pub start: &'a [Vec3],
    /// [`AirDrag::grips`] there.
    pub grips: Vec<Matrix3<f64>>,
    /// m/s.
    pub wind: Vec3,
    /// Length of the step, s.
    pub dt: f64,
}

impl Energy for AirStep<'_> {
    fn name(&self) -> &'static str {
        "air"
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        let term = |(v, b): (usize, &Matrix3<f64>)| {
            let d = x[v] - self.start[v];
            d.dot(&(b * (d * (0.5 / self.dt) - self.wind)))
        };
        self.grips.iter().enumerate().map(term).sum()
    }

    fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        for (v, b) in self.grips.iter().enumerate() {
            gradient[v] += b * ((x[v] - self.start[v]) / self.dt - self.wind);
        }
    }

    fn add_matrix(&self, _: &[Vec3], _: Projection, _: &Places, values: &mut [Matrix3<f64>]) {
        values.iter_mut().zip(&self.grips).for_each(|(v, b)| *v += b / self.dt);
    }
}
