//! A hanging cantilever as a chain: rigid links with an elastic joint between each two, half a link
//! from the clamp to the first.
//!
//! What a row of cells of the same length can do at best: no direction across, no stretch, no
//! grain. Solved exactly, so what a sheet errs beyond it is the sheet's own. Joints `D / h` between
//! links and `2 D / h` at the clamp, half of each link's weight at either end; second order in
//! `h = 1 / links`.

use super::root;

/// How far the tip of the chain is below its clamp under `gamma = rho g L³ / D`, in lengths.
#[must_use]
pub fn chain(gamma: f64, links: usize) -> f64 {
    let half_pi = std::f64::consts::FRAC_PI_2;
    let miss = |log: f64| fold(gamma, links, log.exp()).0 - half_pi;
    let log = root(half_pi.ln() - gamma.sqrt() - 2.0, half_pi.ln(), miss);
    fold(gamma, links, log.exp()).1
}

/// Slope at the clamp (from the vertical) and drop, from the slope of the last link on; stops
/// turning past 2 rad.
fn fold(gamma: f64, links: usize, start: f64) -> (f64, f64) {
    let h = 1.0 / links as f64;
    let (mut slope, mut moment, mut drop) = (start, 0.0, 0.0);
    for k in 0..links {
        // Weight below the middle of link k, counted from the tip.
        moment += gamma * (k as f64 + 0.5) * h * h * slope.sin();
        drop += h * slope.cos();
        slope += moment * if k + 1 < links { h } else { 0.5 * h };
        if slope > 2.0 {
            break;
        }
    }
    (slope, drop)
}
