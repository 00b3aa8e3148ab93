//! Frequencies: a hanging sheet's swing, a drumhead, and what backward Euler does to a mode.

use super::{integral, root};

/// The `n`-th zero (from 1) of the Bessel function J0.
#[must_use]
pub fn bessel_zero(n: usize) -> f64 {
    let pi = std::f64::consts::PI;
    let j0 = |x: f64| integral(0.0, pi, 200, |t| (x * t.sin()).cos()) / pi;
    let guess = (n as f64 - 0.25) * pi;
    root(guess - 0.5, guess + 0.5, j0)
}

/// Angular frequency times sqrt(L/g) of the `n`-th transverse swing of a sheet that hangs from an
/// edge.
#[must_use]
pub fn hanging_omega(n: usize) -> f64 {
    0.5 * bessel_zero(n)
}

/// The slowest swing of a sheet that hangs from an edge and stretches under its own weight.
#[derive(Debug, Clone, PartialEq)]
pub struct HangingSwing {
    /// Angular frequency times sqrt(L/g).
    pub omega: f64,
    /// Displacement across the plane at even distances of rest length from the free end (the first)
    /// to the held one; 1 at the free end.
    pub shape: Vec<f64>,
}

impl HangingSwing {
    /// Displacement at this share of the rest length from the free end, by lines between the
    /// samples.
    #[must_use]
    pub fn at(&self, share: f64) -> f64 {
        let place = share.clamp(0.0, 1.0) * (self.shape.len() - 1) as f64;
        let k = (place as usize).min(self.shape.len() - 2);
        let t = place - k as f64;
        self.shape[k] * (1.0 - t) + self.shape[k + 1] * t
    }
}

/// Samples of a swing: their lines are right to seven digits.
const SAMPLES: usize = 2000;

/// For `alpha` = weight over stiffness, linear law of engineering strain: at rest length s from the
/// free end the tension is s weights and the stretch 1 + alpha s, so small motion u solves
/// `(s u' / (1 + alpha s))' + omega² u = 0`.
#[must_use]
pub fn hanging_swing(alpha: f64) -> HangingSwing {
    let held = |omega: f64| swung(alpha, omega).last().copied().unwrap_or(0.0);
    let omega = root(0.8, 1.4, held);
    HangingSwing { omega, shape: swung(alpha, omega) }
}

/// The motion that is 1 at the free end, by Runge and Kutta's fourth-order steps on u and the pull
/// `s u' / (1 + alpha s)`.
fn swung(alpha: f64, omega: f64) -> Vec<f64> {
    let (square, h) = (omega * omega, 1.0 / SAMPLES as f64);
    let slope = |s: f64, [u, pull]: [f64; 2]| {
        let rise = if s > 0.0 { pull * (1.0 + alpha * s) / s } else { -square };
        [rise, -square * u]
    };
    let mut y = [1.0, 0.0];
    let mut shape = vec![1.0];
    for k in 0..SAMPLES {
        let s = k as f64 * h;
        let on = |d: [f64; 2], t: f64| [y[0] + t * d[0], y[1] + t * d[1]];
        let a = slope(s, y);
        let b = slope(s + 0.5 * h, on(a, 0.5 * h));
        let c = slope(s + 0.5 * h, on(b, 0.5 * h));
        let d = slope(s + h, on(c, h));
        y = [0, 1].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        shape.push(y[0]);
    }
    shape
}

/// Frequency (1/s) of mode (m, n) of a square drumhead: side a, tension (N/m), density (kg/m²).
#[must_use]
pub fn membrane_frequency(m: f64, n: f64, a: f64, tension: f64, density: f64) -> f64 {
    m.hypot(n) / (2.0 * a) * (tension / density).sqrt()
}

/// Logarithm of the amplitude lost in one step of backward Euler.
#[must_use]
pub fn backward_euler_loss(omega: f64, dt: f64) -> f64 {
    0.5 * (omega * dt).powi(2).ln_1p()
}

/// Period under backward Euler over the true period.
#[must_use]
pub fn backward_euler_period(omega: f64, dt: f64) -> f64 {
    omega * dt / (omega * dt).atan()
}
