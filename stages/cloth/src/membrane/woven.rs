//! A woven sheet: tension along warp and weft and shear of the angle between them, each with a measured curve.
//!
//! The strains are what the instruments measure: engineering strain of each yarn direction, `|f| - 1`, and the shear angle
//! `gamma = asin(f1.f2 / |f1||f2|)`, f1 and f2 the images of the weft and warp axes. Energy per area:
//! `W(e1) + W(e2) + c e1 e2 + G(gamma)`. With straight curves and small strain this is exactly the orthotropic plate with the
//! engineering constants E1, E2, nu12, G. Poisson's ratio couples the linear range only. Limits: a sheet sheared flat
//! (gamma = 90 degrees) has no normal; the angle is held just below.

use nalgebra::{Matrix3, Matrix3x2};

use super::law::{Law, Tangent};
use crate::error::ClothError;
use crate::fabric::{Curve, Fabric};
use crate::force::{Projection, Vec3};

/// The sine of the greatest shear angle that is told apart from 90 degrees.
const GREATEST_SINE: f64 = 0.999_999;
/// A yarn direction shorter than this share of its rest length counts as this long: keeps a collapsed triangle finite.
const SHORTEST: f64 = 1e-6;

/// The law. Weft along the rest x axis, warp along y.
#[derive(Debug, Clone, PartialEq)]
pub struct Woven {
    weft: Curve,
    warp: Curve,
    coupling: f64,
    shear: Curve,
}

impl Woven {
    /// From a fabric's curves: the measured tension is that of a free strip, so Poisson's ratio is taken out of it.
    ///
    /// # Errors
    /// What [`Fabric::check`] finds.
    pub fn new(fabric: &Fabric) -> Result<Self, ClothError> {
        fabric.check()?;
        let held = 1.0 / (1.0 - fabric.poisson_squared());
        Ok(Self {
            weft: fabric.weft.scaled(held),
            warp: fabric.warp.scaled(held),
            coupling: fabric.poisson * fabric.weft.slope(0.0) * held,
            shear: fabric.shear.clone(),
        })
    }

    /// Orthotropic with straight curves: stiffness along x (weft) and y (warp), nu = contraction of y under tension along x, shear.
    ///
    /// # Errors
    /// What [`Fabric::check`] finds.
    pub fn orthotropic(ex: f64, ey: f64, nu_xy: f64, shear: f64) -> Result<Self, ClothError> {
        let mut fabric = Fabric::isotropic(1.0, ey, 0.0, 0.0);
        fabric.weft = Curve::linear(ex);
        fabric.shear = Curve::linear(shear);
        fabric.poisson = if ex > 0.0 { nu_xy * ey / ex } else { 0.0 };
        Self::new(&fabric)
    }
}

impl Woven {
    /// Stiffness of (weft strain, warp strain, shear angle) at rest, N/m.
    #[must_use]
    pub fn linear_stiffness(&self) -> Matrix3<f64> {
        let (weft, warp, c) = (self.weft.slope(0.0), self.warp.slope(0.0), self.coupling);
        Matrix3::new(weft, c, 0.0, c, warp, 0.0, 0.0, 0.0, self.shear.slope(0.0))
    }

    /// Weft strain, warp strain and shear angle of the images of the weft and warp axes, and the derivative of each by both.
    #[must_use]
    pub fn strains(f: &[Vec3; 2]) -> (nalgebra::Vector3<f64>, [[Vec3; 2]; 3]) {
        let s = Strains::of(&Matrix3x2::from_columns(f));
        let none = Vec3::zeros();
        let values = nalgebra::Vector3::new(s.strain(0), s.strain(1), s.gamma);
        (values, [[s.unit[0], none], [none, s.unit[1]], s.gamma_gradient()])
    }
}

/// The strains at one deformation and what their derivatives need.
struct Strains {
    length: [f64; 2],
    unit: [Vec3; 2],
    sine: f64,
    gamma: f64,
}

impl Strains {
    fn of(f: &Matrix3x2<f64>) -> Self {
        let c = [f.column(0).into_owned(), f.column(1).into_owned()];
        let length = c.map(|v| v.norm().max(SHORTEST));
        let unit = [c[0] / length[0], c[1] / length[1]];
        let sine = unit[0].dot(&unit[1]).clamp(-GREATEST_SINE, GREATEST_SINE);
        Self { length, unit, sine, gamma: sine.asin() }
    }

    fn strain(&self, k: usize) -> f64 {
        self.length[k] - 1.0
    }

    /// Derivative of the shear angle by the two columns.
    fn gamma_gradient(&self) -> [Vec3; 2] {
        let cosine = (1.0 - self.sine * self.sine).sqrt();
        std::array::from_fn(|k| (self.unit[1 - k] - self.unit[k] * self.sine) / (self.length[k] * cosine))
    }

    /// Second derivative of the shear angle.
    fn gamma_hessian(&self, gradient: &[Vec3; 2]) -> Tangent {
        let cosine = (1.0 - self.sine * self.sine).sqrt();
        let tangent = self.sine / cosine;
        let (u, l) = (&self.unit, &self.length);
        let across = |k: usize| Matrix3::identity() - u[k] * u[k].transpose();
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let sine_part = if i == j {
                    let p = u[1 - i] - u[i] * self.sine;
                    -(u[i] * p.transpose() + p * u[i].transpose() + across(i) * self.sine) / (l[i] * l[i])
                } else {
                    across(i) * across(j) / (l[0] * l[1])
                };
                sine_part / cosine + gradient[i] * gradient[j].transpose() * tangent
            })
        })
    }
}

impl Law for Woven {
    fn name(&self) -> &'static str {
        "woven membrane"
    }

    fn density(&self, f: &Matrix3x2<f64>) -> f64 {
        let s = Strains::of(f);
        let (e1, e2) = (s.strain(0), s.strain(1));
        self.weft.energy(e1) + self.warp.energy(e2) + self.coupling * e1 * e2 + self.shear_energy(s.gamma)
    }

    fn stress(&self, f: &Matrix3x2<f64>) -> Matrix3x2<f64> {
        let s = Strains::of(f);
        let tension = self.tension(&s);
        let (shear, gamma) = (self.shear_force(s.gamma), s.gamma_gradient());
        let column = |k: usize| s.unit[k] * tension[k] + gamma[k] * shear;
        Matrix3x2::from_columns(&[column(0), column(1)])
    }

    fn tangent(&self, f: &Matrix3x2<f64>, projection: Projection) -> Tangent {
        let s = Strains::of(f);
        let tension = self.tension(&s);
        let slope = [self.weft.slope(s.strain(0)), self.warp.slope(s.strain(1))];
        let gamma = s.gamma_gradient();
        let g = self.shear.slope(s.gamma.abs());
        let exact = projection == Projection::Exact;
        let turn = if exact { self.shear_force(s.gamma) } else { 0.0 };
        let curl = s.gamma_hessian(&gamma);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let uu = s.unit[i] * s.unit[j].transpose();
                let mut h = gamma[i] * gamma[j].transpose() * g + curl[i][j] * turn;
                if i == j {
                    let t = if exact { tension[i] } else { tension[i].max(0.0) };
                    h += uu * slope[i] + (Matrix3::identity() - uu) * (t / s.length[i]);
                } else {
                    h += uu * self.coupling;
                }
                h
            })
        })
    }
}

impl Woven {
    fn tension(&self, s: &Strains) -> [f64; 2] {
        let (e1, e2) = (s.strain(0), s.strain(1));
        [self.weft.force(e1) + self.coupling * e2, self.warp.force(e2) + self.coupling * e1]
    }

    /// Shear curves are measured to one side and hold for both.
    fn shear_force(&self, gamma: f64) -> f64 {
        self.shear.force(gamma.abs()).copysign(gamma)
    }

    fn shear_energy(&self, gamma: f64) -> f64 {
        self.shear.energy(gamma.abs())
    }
}
