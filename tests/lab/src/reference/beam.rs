//! The heavy elastica: a strip clamped level at one end, hanging under its own weight.
//!
//! With the angle phi from the vertical and u the arc length from the tip,
//! `phi'' = Gamma u sin phi`, `phi'(0) = 0`, `phi(1) = pi/2`. Shooting from the tip is monotone in
//! the logarithm of phi(0), so bisection finds it for any load.

use super::root;

/// Runge-Kutta steps along the strip: the tip is then right to 1e-9.
const STEPS: usize = 4000;

/// Shape of a hanging cantilever, in strip lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastica {
    /// How far the tip is below the clamp.
    pub drop: f64,
    /// How far it reaches out.
    pub reach: f64,
    /// Slope of the tip below the level, radians.
    pub tip_angle: f64,
}

/// The elastica under `gamma = rho g L³ / D`.
#[must_use]
pub fn cantilever(gamma: f64) -> Elastica {
    let half_pi = std::f64::consts::FRAC_PI_2;
    let log = root(half_pi.ln() - gamma.sqrt() - 2.0, half_pi.ln(), |l| shoot(gamma, l.exp())[0] - half_pi);
    let start = log.exp();
    let [_, _, drop, reach] = shoot(gamma, start);
    Elastica { drop, reach, tip_angle: half_pi - start }
}

/// Integrates (phi, phi', integral of cos phi, integral of sin phi) from the tip to the clamp;
/// stops turning past 2 rad.
fn shoot(gamma: f64, start: f64) -> [f64; 4] {
    let rate = |u: f64, y: &[f64; 4]| [y[1], gamma * u * y[0].sin(), y[0].cos(), y[0].sin()];
    let h = 1.0 / STEPS as f64;
    let along = |y: &[f64; 4], k: &[f64; 4], s: f64| std::array::from_fn(|i| y[i] + s * k[i]);
    let mut y = [start, 0.0, 0.0, 0.0];
    for n in 0..STEPS {
        let u = h * n as f64;
        let k1 = rate(u, &y);
        let k2 = rate(u + 0.5 * h, &along(&y, &k1, 0.5 * h));
        let k3 = rate(u + 0.5 * h, &along(&y, &k2, 0.5 * h));
        let k4 = rate(u + h, &along(&y, &k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        if y[0] > 2.0 {
            break;
        }
    }
    y
}
