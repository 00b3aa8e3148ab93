//! The woven sheet's law in the form the rest solver wants: second Piola-Kirchhoff stress and a tangent by Green's strain.
//!
//! The energy is that of `membrane::Woven`: `W(e1) + W(e2) + c e1 e2 + G(gamma)`, curves over engineering strain and shear angle. Written
//! by `E = (u.u - 1) / 2` and its like, the first stress is `u S11 + v S12`, and the second derivative falls into a part
//! of the tangent and a part of the stress that can each be made positive semi-definite on its own. Cost: three square roots and an
//! arc sine. Limits: a yarn pressed shorter than half its length and yarns sheared beyond 72 degrees keep the slopes that they have there.

use crate::fabric::{Curve, Fabric};
use crate::scene::StrainLimit;
use nalgebra::Vector3;

/// Length of a yarn direction below which strains no longer follow it: its derivatives would grow without bound.
const SHORTEST: f64 = 0.5;

/// Sine of the shear angle above which the angle goes on in a straight line: no cloth shears so far, but a start may.
const GREATEST_SINE: f64 = 0.95;

/// Share of a strain limit from which cloth stiffens: later is truer to the curve below, earlier is easier to solve.
const STOP_FROM: f64 = 0.8;

/// What a yarn carries at its limit beyond its curve, in strains of the curve's stiffness: ten times what seams pull with, and more
/// than any weight.
const STOP_STRAIN: f64 = 0.5;

/// What one fabric resists with. Weft along the rest x axis, warp along y.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Law {
    weft: Yarn,
    warp: Yarn,
    coupling: f64,
    shear: Curve,
}

/// One yarn direction: its curve, and what stiffens it before its strain limit.
#[derive(Debug, Clone, PartialEq)]
struct Yarn {
    curve: Curve,
    stop: Option<Stop>,
}

/// A tension that grows with the square of the strain beyond `start`; its slope begins at zero.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stop {
    start: f64,
    /// N/m per squared unit of strain.
    growth: f64,
}

impl Yarn {
    fn new(curve: Curve, limit: Option<f64>) -> Self {
        let stop = limit.map(|limit| {
            let span = (1.0 - STOP_FROM) * limit;
            Stop { start: limit - span, growth: STOP_STRAIN * curve.force(limit) / limit / (span * span) }
        });
        Self { curve, stop }
    }

    /// The stop and the strain beyond its start.
    #[inline]
    fn beyond(&self, strain: f64) -> Option<(Stop, f64)> {
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

/// Stress and tangent by (weft, warp, shear) strain, N/m. The tangent is positive semi-definite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Response {
    /// S11, S22, S12.
    pub(super) stress: [f64; 3],
    /// Tangent: 11, 22, 33, 12, 13, 23.
    pub(super) tangent: [f64; 6],
}

/// Lengths of the two yarn directions, the sine between them and the shear angle.
struct Shape {
    length: [f64; 2],
    sine: f64,
    gamma: f64,
    /// Derivative of the angle by the sine.
    turn: f64,
}

impl Shape {
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
}

impl Law {
    /// Of a fabric, stiffened before the limit; the measured tension is that of a free strip, so Poisson's ratio is taken out of it.
    #[must_use]
    pub(super) fn of(fabric: &Fabric, limit: Option<StrainLimit>) -> Self {
        let held = 1.0 / (1.0 - fabric.poisson_squared());
        Self {
            weft: Yarn::new(fabric.weft.scaled(held), limit.map(|l| l.weft)),
            warp: Yarn::new(fabric.warp.scaled(held), limit.map(|l| l.warp)),
            coupling: fabric.poisson * fabric.weft.slope(0.0) * held,
            shear: fabric.shear.clone(),
        }
    }

    /// Energy per rest area at the squares and the product of the yarn directions' images, J/m².
    #[inline]
    #[must_use]
    pub(super) fn density(&self, metric: [f64; 3]) -> f64 {
        let s = Shape::of(metric);
        let [e1, e2] = s.length.map(|l| l - 1.0);
        self.weft.energy(e1)
            + self.warp.energy(e2)
            + self.coupling * e1 * e2
            + self.shear.energy(s.gamma.abs())
    }

    /// Stress there.
    #[inline]
    #[must_use]
    pub(super) fn stress(&self, metric: [f64; 3]) -> [f64; 3] {
        let s = Shape::of(metric);
        let tension = self.tension(&s);
        let shear = s.by_strain() * self.shear.force(s.gamma.abs()).copysign(s.gamma);
        let pull = |k: usize| tension[k] / s.length[k].max(f64::MIN_POSITIVE);
        [pull(0) + shear.x, pull(1) + shear.y, shear.z]
    }

    /// Stress and tangent there.
    #[inline]
    #[must_use]
    pub(super) fn response(&self, metric: [f64; 3]) -> Response {
        let s = Shape::of(metric);
        let tension = self.tension(&s);
        let floor = s.length.map(|l| l.max(SHORTEST));
        let slope = [self.weft.slope(s.length[0] - 1.0), self.warp.slope(s.length[1] - 1.0)];
        // Along a yarn: what its slope gives, less what turning already counts.
        let along = |k: usize| ((slope[k] - tension[k] / floor[k]) / (floor[k] * floor[k])).max(0.0);
        let (c11, c22) = (along(0), along(1));
        let c12 = (self.coupling / (floor[0] * floor[1])).min((c11 * c22).sqrt());
        let d = s.by_strain();
        let g = self.shear.slope(s.gamma.abs());
        let force = self.shear.force(s.gamma.abs()).copysign(s.gamma);
        let pull = |k: usize| tension[k] / s.length[k].max(f64::MIN_POSITIVE);
        Response {
            stress: [pull(0) + d.x * force, pull(1) + d.y * force, d.z * force],
            tangent: [
                c11 + g * d.x * d.x,
                c22 + g * d.y * d.y,
                g * d.z * d.z,
                c12 + g * d.x * d.y,
                g * d.x * d.z,
                g * d.y * d.z,
            ],
        }
    }

    #[inline]
    fn tension(&self, s: &Shape) -> [f64; 2] {
        let [e1, e2] = s.length.map(|l| l - 1.0);
        [self.weft.force(e1) + self.coupling * e2, self.warp.force(e2) + self.coupling * e1]
    }
}
