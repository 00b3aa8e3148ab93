//! Exact solutions, independent of the engine: elastica, elastic catenary, hanging strips, plates,
//! vibrations, friction.
//!
//! Each function's limit cases are tested in `tests`. All quantities of a sheet are per unit width.

mod beam;
mod cable;
mod chain;
mod elastica;
mod plate;
mod stretch;
mod swing;

#[cfg(test)]
mod tests;

pub use beam::{Elastica, cantilever};
pub use cable::{Catenary, catenary};
pub use chain::chain;
pub use elastica::{Curve, heart_loop, lateral_buckling, plate_pendulum, pressed_column};
pub use plate::{clamped_plate, supported_plate};
pub use stretch::{Orthotropic, hanging_linear, hanging_piecewise, hanging_stvk};
pub use swing::{
    HangingSwing, backward_euler_loss, backward_euler_period, bessel_zero, hanging_omega, hanging_swing,
    membrane_frequency,
};

/// A root of a function that changes sign between `low` and `high`, by bisection to the last bits.
pub(crate) fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let rising = f(high) > 0.0;
    for _ in 0..200 {
        let (middle, before) = (0.5 * (low + high), (low, high));
        if (f(middle) > 0.0) == rising {
            high = middle
        } else {
            low = middle
        }
        // Between neighbours nothing lies: no further step would change anything.
        if (low, high) == before {
            break;
        }
    }
    0.5 * (low + high)
}

/// Simpson's rule with `2 n` intervals.
pub(crate) fn integral(low: f64, high: f64, n: usize, f: impl Fn(f64) -> f64) -> f64 {
    let h = (high - low) / (2 * n) as f64;
    let term = |k: usize| {
        let weight = if k == 0 || k == 2 * n { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
        weight * f(low + h * k as f64)
    };
    (0..=2 * n).map(term).sum::<f64>() * h / 3.0
}
