//! Has a sequence of refinements stopped moving? Richardson's observed order and what is still missing.
//!
//! Of meshes with edges h, h/r, h/r^2, ... let d_k be the distance between result k and k + 1. Where the error is
//! C h^p, d_k / d_{k+1} = r^p, so p = ln(d_k / d_{k+1}) / ln r, and the finest result still lacks d_last / (r^p - 1)
//! (Richardson 1911; Roache 1998).
//!
//! Limits: with exactly two distances nothing tells an order from luck; with more, each of the last three must be smaller
//! than the one before. Where they do not shrink there is no order, and nothing is claimed. An order above that of the
//! method ([`FORMAL_ORDER`]) is luck as well, so what is missing is estimated with no more.

/// Below this order a sequence is not said to converge: the estimate would be many times the last step.
pub const LEAST_ORDER: f64 = 0.2;

/// Order of linear finite elements in the places of their vertices: the estimate counts on no more.
pub const FORMAL_ORDER: f64 = 2.0;

/// What the last distances between refinements say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence {
    /// Observed order p.
    pub order: f64,
    /// What the finest result still lacks, in the unit of the distances.
    pub missing: f64,
}

/// Order and estimate from the last two of the distances between neighbouring refinements, each `ratio` times finer.
///
/// None with fewer than two distances, or where they do not shrink.
pub fn convergence(distances: &[f64], ratio: f64) -> Option<Convergence> {
    let [.., coarse, fine] = distances else { return None };
    let last = &distances[distances.len().saturating_sub(3)..];
    if !last.windows(2).all(|w| w[1] < w[0] || w[1] == 0.0) {
        return None;
    }
    if *fine == 0.0 && *coarse >= 0.0 {
        return Some(Convergence { order: f64::INFINITY, missing: 0.0 });
    }
    let order = (coarse / fine).ln() / ratio.ln();
    let is_sound = order.is_finite() && order >= LEAST_ORDER;
    is_sound.then(|| Convergence { order, missing: fine / (ratio.powf(order.min(FORMAL_ORDER)) - 1.0) })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Distances of f(h) = 3 + c h^p at h = 1, 1/r, 1/r^2, ...
    fn series(c: f64, p: f64, r: f64) -> (Vec<f64>, f64) {
        let f = |k: i32| 3.0 + c * r.powi(-k).powf(p);
        ((0..3).map(|k| f64::abs(f(k) - f(k + 1))).collect(), (f(3) - 3.0).abs())
    }

    #[test]
    fn the_order_and_the_rest_of_a_known_series_are_found() {
        for (c, p, r) in [(1.0, 2.0, 2.0), (-4.0, 1.0, 2.0), (0.3, 1.5, f64::sqrt(2.0))] {
            let (distances, rest) = series(c, p, r);
            let found = convergence(&distances, r).unwrap();
            assert!(
                (found.order - p).abs() < 1e-9 && (found.missing - rest).abs() < 1e-9,
                "{found:?}, {rest}"
            );
        }
    }

    #[test]
    fn luck_is_not_counted_on() {
        assert_eq!(convergence(&[0.5, 1.4, 0.3], 2.0), None, "it grew before it shrank");
        let found = convergence(&[16.0, 1.0], 2.0).unwrap();
        assert!((found.order - 4.0).abs() < 1e-12 && (found.missing - 1.0 / 3.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn what_does_not_shrink_has_no_order() {
        assert_eq!(convergence(&[1.0, 1.0], 2.0), None);
        assert_eq!(convergence(&[1.0, 3.0], 2.0), None);
        assert_eq!(convergence(&[1.0], 2.0), None);
        assert_eq!(convergence(&[f64::NAN, 1.0], 2.0), None);
        assert_eq!(convergence(&[1.0, 0.0], 2.0).unwrap().missing, 0.0);
    }
}
