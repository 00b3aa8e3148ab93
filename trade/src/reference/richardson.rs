//! Has a sequence of refinements stopped moving? Richardson's observed order and what is still
//! missing.
//!
//! Of meshes each r_k times finer than the one before let d_k be the distance between result k - 1
//! and k. Where the error is C h^p, d_{k-1} / d_k = (r_{k-1}^p - 1) / (1 - r_k^-p), which grows
//! with p and is r^p where the factors are equal, and the finest result still lacks d_last /
//! (r_last^p - 1) (Richardson 1911; Roache 1998). Factors differ where a resolution is a whole
//! number: of 2, 3 and 4 parts the second is 1.5 times finer than the first, the third 1.33 times
//! than the second.
//!
//! Limits: with exactly two distances nothing tells an order from luck; with more, each of the last
//! three must be smaller for its factor (over its logarithm) than the one before. Where they do not
//! shrink there is no order, and nothing is claimed. An order above that of the method
//! ([`FORMAL_ORDER`]) is luck as well, so what is missing is estimated with no more.

/// Below this order a sequence is not said to converge: the estimate would be many times the last
/// step.
pub const LEAST_ORDER: f64 = 0.2;

/// Order of linear finite elements in the places of their vertices: the estimate counts on no more.
pub const FORMAL_ORDER: f64 = 2.0;

/// Beyond it nobody asks for an order.
const MOST_ORDER: f64 = 64.0;

/// Halvings in which it is found to rounding.
const HALVINGS: usize = 64;

/// What the last distances between refinements say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Convergence {
    /// Observed order p.
    pub order: f64,
    /// What the finest result still lacks, in the unit of the distances.
    pub missing: f64,
}

/// A refinement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefinementStep {
    /// How far it moved the result.
    pub distance: f64,
    /// By which factor it is finer than the one before, above 1.
    pub ratio: f64,
}

/// Order and estimate from the last two refinements.
///
/// None with fewer than two, or where they do not shrink.
pub fn convergence(steps: &[RefinementStep]) -> Option<Convergence> {
    let [.., coarse, fine] = steps else { return None };
    let last = &steps[steps.len().saturating_sub(3)..];
    let pace = |s: &RefinementStep| s.distance / s.ratio.ln();
    if !last.windows(2).all(|w| pace(&w[1]) < pace(&w[0]) || w[1].distance == 0.0) {
        return None;
    }
    if fine.distance == 0.0 && coarse.distance >= 0.0 {
        return Some(Convergence { order: f64::INFINITY, missing: 0.0 });
    }
    let order = order(coarse.distance / fine.distance, [coarse.ratio, fine.ratio]);
    let is_sound = order >= LEAST_ORDER;
    let missing = || fine.distance / (fine.ratio.powf(order.min(FORMAL_ORDER)) - 1.0);
    is_sound.then(|| Convergence { order, missing: missing() })
}

/// What the finest result lacks if its error falls with the first power of the resolution.
pub fn at_first_order(last: RefinementStep) -> f64 {
    last.distance / (last.ratio - 1.0)
}

/// The order at which two refinements by these factors move a result by distances of that quotient;
/// between 0 and [`MOST_ORDER`].
fn order(quotient: f64, [first, second]: [f64; 2]) -> f64 {
    let (mut low, mut high) = (0.0, MOST_ORDER);
    for _ in 0..HALVINGS {
        let p: f64 = 0.5 * (low + high);
        let is_below = (first.powf(p) - 1.0) / (1.0 - second.powf(-p)) < quotient;
        if is_below { low = p } else { high = p }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Distances of f(h) = 3 + c h^p at h = 1, 1/r, 1/r^2, ...
    fn series(c: f64, p: f64, r: f64) -> (Vec<RefinementStep>, f64) {
        meshes(c, p, &[1.0, r, r * r, r * r * r])
    }

    /// Distances of f(h) = 3 + c h^p at h = 1 / n.
    fn meshes(c: f64, p: f64, n: &[f64]) -> (Vec<RefinementStep>, f64) {
        let f = |n: f64| 3.0 + c * n.powf(-p);
        let step = |w: &[f64]| RefinementStep { distance: (f(w[1]) - f(w[0])).abs(), ratio: w[1] / w[0] };
        (n.windows(2).map(step).collect(), (f(n[n.len() - 1]) - 3.0).abs())
    }

    fn even(distances: &[f64]) -> Vec<RefinementStep> {
        distances.iter().map(|&distance| RefinementStep { distance, ratio: 2.0 }).collect()
    }

    #[test]
    fn the_order_and_the_rest_of_a_known_series_are_found() {
        for (c, p, r) in [(1.0, 2.0, 2.0), (-4.0, 1.0, 2.0), (0.3, 1.5, f64::sqrt(2.0))] {
            let (distances, rest) = series(c, p, r);
            let found = convergence(&distances).unwrap();
            assert!(
                (found.order - p).abs() < 1e-9 && (found.missing - rest).abs() < 1e-9,
                "{found:?}, {rest}"
            );
        }
    }

    #[test]
    fn parts_of_an_edge_are_no_even_steps() {
        // 4 to 6 parts move a result of first order as far as 3 to 4.
        for parts in [&[2.0, 3.0, 4.0, 6.0][..], &[2.0, 3.0, 4.0, 6.0, 8.0], &[1.0, 2.0, 3.0, 4.0]] {
            for p in [1.0, 1.25, 1.5, 2.0] {
                let (steps, rest) = meshes(5.0, p, parts);
                let found = convergence(&steps).unwrap();
                assert!((found.order - p).abs() < 1e-9, "{p}: {found:?}");
                assert!((found.missing - rest).abs() < 1e-9, "{found:?}, {rest}");
            }
        }
    }

    #[test]
    fn one_step_of_first_order_tells_the_rest() {
        let (steps, rest) = meshes(5.0, 1.0, &[4.0, 6.0]);
        assert!((at_first_order(steps[0]) - rest).abs() < 1e-12);
    }

    #[test]
    fn luck_is_not_counted_on() {
        assert_eq!(convergence(&even(&[0.5, 1.4, 0.3])), None, "it grew before it shrank");
        let found = convergence(&even(&[16.0, 1.0])).unwrap();
        assert!((found.order - 4.0).abs() < 1e-12 && (found.missing - 1.0 / 3.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn what_does_not_shrink_has_no_order() {
        assert_eq!(convergence(&even(&[1.0, 1.0])), None);
        assert_eq!(convergence(&even(&[1.0, 3.0])), None);
        assert_eq!(convergence(&even(&[1.0])), None);
        assert_eq!(convergence(&even(&[f64::NAN, 1.0])), None);
        assert_eq!(convergence(&even(&[1.0, 0.0])).unwrap().missing, 0.0);
    }
}
