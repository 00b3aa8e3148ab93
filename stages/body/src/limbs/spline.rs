//! Monotone cubic interpolation (Fritsch and Carlson, 1980): a curve through given knots that never
//! overshoots them, so that a waist between two wider levels stays the narrowest place.
//!
//! Cost: a binary search and one cubic a look-up. Limit: the second derivative jumps at knots.

/// A smooth curve through knots, constant outside of them.
#[derive(Debug, Clone)]
pub(crate) struct KnotSpline {
    x: Vec<f64>,
    y: Vec<f64>,
    slope: Vec<f64>,
}

impl KnotSpline {
    /// A curve through `(x, y)` knots with strictly rising `x`.
    pub(crate) fn new(knots: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let (x, y): (Vec<f64>, Vec<f64>) = knots.into_iter().unzip();
        let secants: Vec<f64> =
            x.windows(2).zip(y.windows(2)).map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0])).collect();
        let slope = (0..x.len()).map(|i| knot_slope(&x, &secants, i)).collect();
        KnotSpline { x, y, slope }
    }

    /// The greatest value: that of a knot, for it never overshoots.
    pub(crate) fn greatest(&self) -> f64 {
        self.y.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The curve's value.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let (Some(&first), Some(&last)) = (self.x.first(), self.x.last()) else { return 0.0 };
        let x = x.clamp(first, last);
        let i = self.x.partition_point(|&k| k <= x).clamp(1, (self.x.len() - 1).max(1)) - 1;
        let Some(&next) = self.x.get(i + 1) else { return self.y[i] };
        let h = next - self.x[i];
        let t = (x - self.x[i]) / h;
        let (t2, t3) = (t * t, t * t * t);
        (2.0 * t3 - 3.0 * t2 + 1.0) * self.y[i]
            + (t3 - 2.0 * t2 + t) * h * self.slope[i]
            + (3.0 * t2 - 2.0 * t3) * self.y[i + 1]
            + (t3 - t2) * h * self.slope[i + 1]
    }
}

/// The weighted harmonic mean of the neighbouring secants; zero at an extreme and at the ends.
fn knot_slope(x: &[f64], secants: &[f64], i: usize) -> f64 {
    if i == 0 || i + 1 >= x.len() || secants[i - 1] * secants[i] <= 0.0 {
        return 0.0;
    }
    let (before, after) = (x[i] - x[i - 1], x[i + 1] - x[i]);
    let (w1, w2) = (2.0 * after + before, after + 2.0 * before);
    (w1 + w2) / (w1 / secants[i - 1] + w2 / secants[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn passes_through_its_knots_and_is_constant_beyond() {
        let s = KnotSpline::new([(0.0, 1.0), (1.0, 3.0), (3.0, 2.0)]);
        for (x, y) in [(-5.0, 1.0), (0.0, 1.0), (1.0, 3.0), (3.0, 2.0), (9.0, 2.0)] {
            assert!((s.at(x) - y).abs() < 1e-12, "{x}: {}", s.at(x));
        }
    }

    proptest! {
        #[test]
        fn never_overshoots(ys in prop::collection::vec(-2.0..2.0f64, 2..8), t in 0.0..1.0f64) {
            let s = KnotSpline::new(ys.iter().enumerate().map(|(i, &y)| (i as f64, y)));
            let x = t * (ys.len() - 1) as f64;
            let i = (x as usize).min(ys.len() - 2);
            let (lo, hi) = (ys[i].min(ys[i + 1]), ys[i].max(ys[i + 1]));
            prop_assert!(s.at(x) >= lo - 1e-12 && s.at(x) <= hi + 1e-12);
            prop_assert!(s.at(x) <= s.greatest() + 1e-12);
        }
    }
}
