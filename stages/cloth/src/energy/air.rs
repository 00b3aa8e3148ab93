//! Air: drag and wind on every triangle.
//!
//! `F = rho A / 2 (c_n |v_n| v_n + c_t |v_t| v_t)`, v the wind less the triangle's velocity, v_n
//! and v_t its parts across and along the triangle, A its area now; a third to each corner. That
//! the two parts act each for itself is the cross-flow principle (Taylor, 1952; Hoerner, 1965);
//! cloth in wind by triangles: Ling, Damodaran, Gay (1996); Keckeisen, Kimmerle, Thomaszewski,
//! Wacker (2004).
//!
//! Solvers make one linear step of it (Kahan, 1993: `v v'` for `v²`): the velocity of a triangle
//! before the step gives a drag tensor ([`AirDrag::drag_tensors`]), a third of which acts on the
//! velocity of each corner after the step. The sum is the law; it is exact in a steady state, and
//! for a sheet that the wind carries off face on. The tensor is positive semi-definite, so still
//! air only takes energy, for any step. Cost: a few flops per triangle and step. Limits: no lift,
//! no wake of other cloth, no added mass of air.

use nalgebra::Matrix3;
use rayon::prelude::*;

use super::places::Places;
use super::potential::{Energy, Projection};
use crate::error::{ClothError, check_parameter};
use toile_geometry::Vec3;

/// Greatest density of the fluid, that of water, kg/m³.
const DENSEST: f64 = 2000.0;
/// Greatest coefficient of drag.
const GREATEST_COEFFICIENT: f64 = 100.0;
/// Strongest wind, m/s.
const STRONGEST: f64 = 1000.0;

/// The air around a sheet.
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

    /// Whether it acts at all.
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

    /// For static solvers: still air does not change the equilibrium; wind does, and has no
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
            let third = drag_tensor(&self.air, &corners, &slip) * slip / 3.0;
            t.iter().for_each(|&k| forces[k as usize] += third);
        }
        forces
    }

    /// The drag tensor of each vertex, N s/m: the force on it is this times (wind - its velocity).
    /// Symmetric and positive semi-definite.
    #[must_use]
    pub fn drag_tensors(&self, x: &[Vec3], v: &[Vec3]) -> Vec<Matrix3<f64>> {
        let of = |t: &[u32; 3]| drag_tensor(&self.air, &t.map(|k| x[k as usize]), &self.slip(t, v)) / 3.0;
        let thirds: Vec<Matrix3<f64>> = self.triangles.par_iter().with_min_len(256).map(of).collect();
        let mut drag_tensors = vec![Matrix3::zeros(); x.len()];
        for (t, third) in self.triangles.iter().zip(&thirds) {
            t.iter().for_each(|&k| drag_tensors[k as usize] += third);
        }
        drag_tensors
    }

    /// Wind less the triangle's velocity, m/s.
    fn slip(&self, t: &[u32; 3], v: &[Vec3]) -> Vec3 {
        self.air.wind - t.iter().map(|&k| v[k as usize]).sum::<Vec3>() / 3.0
    }
}

/// The drag tensor of a triangle: the force on it is this times `slip`, N s/m.
fn drag_tensor(air: &Air, corners: &[Vec3; 3], slip: &Vec3) -> Matrix3<f64> {
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

/// The change of velocity of a free vertex of mass `m` (kg) per impulse in a step of `h` (s) in
/// air, 1/kg.
#[must_use]
pub fn mobility(m: f64, drag: &Matrix3<f64>, h: f64) -> Matrix3<f64> {
    let heavy = Matrix3::identity() * m + drag * h;
    heavy.try_inverse().unwrap_or_else(|| Matrix3::identity() / m)
}

/// The velocity of such a vertex after the step, where it would be `v` without air, m/s.
#[must_use]
pub fn carried(v: &Vec3, wind: &Vec3, mobility: &Matrix3<f64>, drag: &Matrix3<f64>, h: f64) -> Vec3 {
    v + mobility * (drag * (wind - v)) * h
}

/// One step of drag as an energy, for solvers that minimise: `d B d / 2h - d B w`, with the drag
/// tensor B and the move d since the start.
#[derive(Debug, Clone)]
pub struct AirStep<'a> {
    /// Where the step starts.
    pub start: &'a [Vec3],
    /// [`AirDrag::drag_tensors`] there.
    pub drag_tensors: Vec<Matrix3<f64>>,
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
        self.drag_tensors.iter().enumerate().map(term).sum()
    }

    fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        for (v, b) in self.drag_tensors.iter().enumerate() {
            gradient[v] += b * ((x[v] - self.start[v]) / self.dt - self.wind);
        }
    }

    fn add_matrix(&self, _: &[Vec3], _: Projection, _: &Places, values: &mut [Matrix3<f64>]) {
        values.iter_mut().zip(&self.drag_tensors).for_each(|(v, b)| *v += b / self.dt);
    }
}
