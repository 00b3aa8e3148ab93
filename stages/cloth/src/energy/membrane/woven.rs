//! A woven sheet: tension along warp and weft and shear of the angle between them, each with a
//! measured curve.
//!
//! The strains are what the instruments measure: engineering strain of each yarn direction,
//! `e = |f| - 1`, and the shear angle `gamma = asin(f1.f2 / |f1||f2|)`, f1 and f2 the images of the
//! weft and warp axes. Energy per area: `W(e1) + W(e2) + c e1 e2 + G(gamma)`. With straight curves
//! and small strain this is exactly the orthotropic plate with the engineering constants E1, E2,
//! nu12, G. Poisson's ratio couples the linear range only. Cost: three square roots and an arc
//! sine. Limits: a yarn pressed shorter than half its length and yarns sheared beyond 72 degrees
//! keep the slopes that they have there.

use super::triangles::{Law, Response};
use crate::energy::StrainLimit;
use crate::error::ClothError;
use crate::fabric::{Curve, Fabric};
use nalgebra::{Matrix3, Vector3};
use toile_geometry::Vec3;

/// Length of a yarn direction below which strains no longer follow it: its derivatives would grow
/// without bound.
const SHORTEST: f64 = 0.5;

/// Sine of the shear angle above which the angle goes on in a straight line: no cloth shears so
/// far, but a start may.
const GREATEST_SINE: f64 = 0.95;

/// Share of a strain limit from which cloth stiffens: later is truer to the curve below, earlier is
/// easier to solve.
const STOP_FROM: f64 = 0.8;

/// What a yarn carries at its limit beyond its curve, in strains of the curve's stiffness: ten
/// times what seams pull with, and more than any weight.
const STOP_STRAIN: f64 = 0.5;

/// The law. Weft along the rest x axis, warp along y.
#[derive(Debug, Clone, PartialEq)]
pub struct Woven {
    weft: Yarn,
    warp: Yarn,
    coupling: f64,
    shear: Curve,
}

/// One yarn direction: its curve, and what stiffens it before its strain limit.
#[derive(Debug, Clone, PartialEq)]
struct Yarn {
    curve: Curve,
    stop: Option<TensionStop>,
}

/// A tension that grows with the square of the strain beyond `start`; its slope begins at zero.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TensionStop {
    start: f64,
    /// N/m per squared unit of strain.
    growth: f64,
}

impl Yarn {
    fn new(curve: Curve, limit: Option<f64>) -> Self {
        let stop = limit.map(|limit| {
            let span = (1.0 - STOP_FROM) * limit;
            TensionStop {
                start: limit - span,
                growth: STOP_STRAIN * curve.force(limit) / limit / (span * span),
            }
        });
        Self { curve, stop }
    }

    /// The stop and the strain beyond its start.
    #[inline]
    fn beyond(&self, strain: f64) -> Option<(TensionStop, f64)> {
        self.stop.map(|s| (s, strain - s.start)).filter(|(_, over)| *over > 0.0)
    }

    #[inline]
    fn force(&self, strain: f64) -> f64 {
        self.curve.force(strain) + self.beyond(strain).map_or(0.0, |(s, over)| s.growth * over * over)
    }

    #[inline]
    fn slope(&self, strain: f64) -> f64 {
        self.curve.slope(strain) + self.beyond(strain).map_or(0.0, |(s, over)| 2.0 * s.growth * over)
    }

    #[inline]
    fn energy(&self, strain: f64) -> f64 {
        self.curve.energy(strain) + self.beyond(strain).map_or(0.0, |(s, over)| s.growth * over.powi(3) / 3.0)
    }
}

/// Lengths of the two yarn directions, the sine between them and the shear angle.
struct YarnShape {
    length: [f64; 2],
    sine: f64,
    gamma: f64,
    /// Derivative of the angle by the sine.
    turn: f64,
}

impl YarnShape {
    #[inline]
    fn of([uu, vv, uv]: [f64; 3]) -> Self {
        let length = [uu.sqrt(), vv.sqrt()];
        let floor = length.map(|l| l.max(SHORTEST));
        let sine = uv / (floor[0] * floor[1]);
        let held = sine.clamp(-GREATEST_SINE, GREATEST_SINE);
        let turn = 1.0 / (1.0 - held * held).sqrt();
        Self { length, sine, gamma: held.asin() + (sine - held) * turn, turn }
    }

    /// Derivative of the shear angle by Green's strains; a yarn at its floor has no part in it.
    #[inline]
    fn by_strain(&self) -> Vector3<f64> {
        let floor = self.length.map(|l| l.max(SHORTEST));
        let own = |k: usize| {
            if self.length[k] > SHORTEST { -self.sine * self.turn / (floor[k] * floor[k]) } else { 0.0 }
        };
        Vector3::new(own(0), own(1), self.turn / (floor[0] * floor[1]))
    }

    /// Second derivative of the shear angle: 11, 22, 33, 12, 13, 23; of yarns within the limits.
    fn by_strain_twice(&self) -> [f64; 6] {
        let [a2, b2] = self.length.map(|l| l * l);
        let ab = self.length[0] * self.length[1];
        let sine = Vector3::new(-self.sine / a2, -self.sine / b2, 1.0 / ab);
        let second = [
            3.0 * self.sine / (a2 * a2),
            3.0 * self.sine / (b2 * b2),
            0.0,
            self.sine / (a2 * b2),
            -1.0 / (ab * a2),
            -1.0 / (ab * b2),
        ];
        let bend = self.sine * self.turn.powi(3);
        let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        std::array::from_fn(|k| {
            let (i, j) = pairs[k];
            second[k] * self.turn + bend * sine[i] * sine[j]
        })
    }
}

impl Woven {
    /// From a fabric's curves: the measured tension is that of a free strip, so Poisson's ratio is
    /// taken out of it.
    ///
    /// # Errors
    /// Every error of [`Fabric::check`].
    pub fn new(fabric: &Fabric) -> Result<Self, ClothError> {
        fabric.check()?;
        Ok(Self::limited(fabric, None))
    }

    /// The same of a fabric that is checked, stiffened before a strain limit.
    #[must_use]
    pub fn limited(fabric: &Fabric, limit: Option<StrainLimit>) -> Self {
        let held = 1.0 / (1.0 - fabric.poisson_squared());
        Self {
            weft: Yarn::new(fabric.weft.scaled(held), limit.map(|l| l.weft)),
            warp: Yarn::new(fabric.warp.scaled(held), limit.map(|l| l.warp)),
            coupling: fabric.poisson * fabric.weft.slope(0.0) * held,
            shear: fabric.shear.clone(),
        }
    }

    /// Orthotropic with straight curves: stiffness along x (weft) and y (warp), nu = contraction of
    /// y under tension along x, shear.
    ///
    /// # Errors
    /// Every error of [`Fabric::check`].
    pub fn orthotropic(ex: f64, ey: f64, nu_xy: f64, shear: f64) -> Result<Self, ClothError> {
        let mut fabric = Fabric::isotropic(1.0, ey, 0.0, 0.0);
        fabric.weft = Curve::linear(ex);
        fabric.shear = Curve::linear(shear);
        fabric.poisson = if ex > 0.0 { nu_xy * ey / ex } else { 0.0 };
        Self::new(&fabric)
    }

    /// Stiffness of (weft strain, warp strain, shear angle) at rest, N/m.
    #[must_use]
    pub fn linear_stiffness(&self) -> Matrix3<f64> {
        let (weft, warp, c) = (self.weft.slope(0.0), self.warp.slope(0.0), self.coupling);
        Matrix3::new(weft, c, 0.0, c, warp, 0.0, 0.0, 0.0, self.shear.slope(0.0))
    }

    /// Weft strain, warp strain and shear angle of the images of the weft and warp axes, and the
    /// derivative of each by both.
    #[must_use]
    pub fn strains([u, v]: &[Vec3; 2]) -> (Vector3<f64>, [[Vec3; 2]; 3]) {
        let s = YarnShape::of([u.norm_squared(), v.norm_squared(), u.dot(v)]);
        let unit = |k: usize, f: &Vec3| f / s.length[k].max(f64::MIN_POSITIVE);
        let (d, none) = (s.by_strain(), Vec3::zeros());
        let values = Vector3::new(s.length[0] - 1.0, s.length[1] - 1.0, s.gamma);
        (values, [[unit(0, u), none], [none, unit(1, v)], [u * d.x + v * d.z, v * d.y + u * d.z]])
    }

    #[inline]
    fn tension(&self, s: &YarnShape) -> [f64; 2] {
        let [e1, e2] = s.length.map(|l| l - 1.0);
        [self.weft.force(e1) + self.coupling * e2, self.warp.force(e2) + self.coupling * e1]
    }
}

impl Law for Woven {
    fn name(&self) -> &'static str {
        "woven membrane"
    }

    #[inline]
    fn density(&self, metric: [f64; 3]) -> f64 {
        let s = YarnShape::of(metric);
        let [e1, e2] = s.length.map(|l| l - 1.0);
        self.weft.energy(e1)
            + self.warp.energy(e2)
            + self.coupling * e1 * e2
            + self.shear.energy(s.gamma.abs())
    }

    #[inline]
    fn stress(&self, metric: [f64; 3]) -> [f64; 3] {
        let s = YarnShape::of(metric);
        let tension = self.tension(&s);
        let shear = s.by_strain() * self.shear.force(s.gamma.abs()).copysign(s.gamma);
        let pull = |k: usize| tension[k] / s.length[k].max(f64::MIN_POSITIVE);
        [pull(0) + shear.x, pull(1) + shear.y, shear.z]
    }

    #[inline]
    fn response(&self, metric: [f64; 3], exact: bool) -> Response {
        let s = YarnShape::of(metric);
        let tension = self.tension(&s);
        let floor = s.length.map(|l| l.max(SHORTEST));
        let slope = [self.weft.slope(s.length[0] - 1.0), self.warp.slope(s.length[1] - 1.0)];
        // Along a yarn: what its slope gives, less what turning already counts.
        let along = |k: usize| (slope[k] - tension[k] / floor[k]) / (floor[k] * floor[k]);
        let mixed = self.coupling / (floor[0] * floor[1]);
        let (c11, c22, c12) = match exact {
            true => (along(0), along(1), mixed),
            false => {
                let (c11, c22) = (along(0).max(0.0), along(1).max(0.0));
                (c11, c22, mixed.min((c11 * c22).sqrt()))
            }
        };
        let d = s.by_strain();
        let g = self.shear.slope(s.gamma.abs());
        let force = self.shear.force(s.gamma.abs()).copysign(s.gamma);
        let pull = |k: usize| tension[k] / s.length[k].max(f64::MIN_POSITIVE);
        let mut tangent = [
            c11 + g * d.x * d.x,
            c22 + g * d.y * d.y,
            g * d.z * d.z,
            c12 + g * d.x * d.y,
            g * d.x * d.z,
            g * d.y * d.z,
        ];
        if exact {
            tangent.iter_mut().zip(s.by_strain_twice()).for_each(|(t, curl)| *t += force * curl);
        }
        Response { stress: [pull(0) + d.x * force, pull(1) + d.y * force, d.z * force], tangent }
    }
}
