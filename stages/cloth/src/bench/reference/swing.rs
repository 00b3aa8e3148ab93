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

/// Angular frequency times sqrt(L/g) of the `n`-th transverse swing of a sheet that hangs from an edge.
#[must_use]
pub fn hanging_omega(n: usize) -> f64 {
    0.5 * bessel_zero(n)
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
