//! Stretching: strips under their own weight, and strips cut at an angle to the warp.

use super::{integral, root};

/// Tip displacement over length of a hanging strip, linear law: `alpha = rho g L / k`.
#[must_use]
pub fn hanging_linear(alpha: f64) -> f64 {
    0.5 * alpha
}

/// The same for St Venant-Kirchhoff: `alpha (1 - X) = s (s² - 1) / 2` at each X, s the stretch.
#[must_use]
pub fn hanging_stvk(alpha: f64) -> f64 {
    let stretch = |load: f64| root(1.0, 2.0 + load, |s| 0.5 * s * (s * s - 1.0) - load);
    integral(0.0, 1.0, 2000, |x| stretch(alpha * (1.0 - x)) - 1.0)
}

/// The same for a piecewise-linear curve through the origin: `points` are (strain, N/m),
/// `weight = rho g` in N/m² , `length` in m.
#[must_use]
pub fn hanging_piecewise(points: &[[f64; 2]], weight: f64, length: f64) -> f64 {
    let top = weight * length;
    let mut from = [0.0, 0.0];
    let mut sum = 0.0;
    for &to in points {
        let slope = (to[1] - from[1]) / (to[0] - from[0]);
        let end = to[1].min(top);
        let strain = from[0] + (end - from[1]) / slope;
        sum += 0.5 * (from[0] + strain) * (end - from[1]);
        if to[1] >= top {
            break;
        }
        from = to;
    }
    sum / (weight * length)
}

/// Engineering constants of an orthotropic sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orthotropic {
    /// Stiffness along 1, N/m.
    pub e1: f64,
    /// Stiffness along 2, N/m.
    pub e2: f64,
    /// Contraction along 2 under tension along 1.
    pub nu12: f64,
    /// Shear stiffness, N/m per radian.
    pub g: f64,
}

impl Orthotropic {
    /// Woven, denim-like, knit-like and isotropic.
    pub const SAMPLES: [Self; 4] = [
        Self { e1: 1000.0, e2: 1000.0, nu12: 0.1, g: 30.0 },
        Self { e1: 2000.0, e2: 900.0, nu12: 0.15, g: 80.0 },
        Self { e1: 60.0, e2: 25.0, nu12: 0.35, g: 12.0 },
        Self { e1: 500.0, e2: 500.0, nu12: 0.3, g: 500.0 / 2.6 },
    ];

    /// Stiffness (N/m) of a free strip cut at `angle` (radians) to direction 1.
    #[must_use]
    pub fn stiffness_at(&self, angle: f64) -> f64 {
        let (s, c) = angle.sin_cos();
        let mixed = 1.0 / self.g - 2.0 * self.nu12 / self.e1;
        1.0 / (c.powi(4) / self.e1 + s.powi(4) / self.e2 + mixed * s * s * c * c)
    }
}
