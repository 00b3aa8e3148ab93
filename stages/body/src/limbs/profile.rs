//! Several lengths as smooth functions of one: the sections of a loft over the length of its axis.
//!
//! Knots are joined by monotone cubics, sampled evenly, smoothed, and read as a uniform cubic
//! B-spline (de Boor, 1978): the second derivative is continuous, so that no band shows on the skin
//! at a knot.
//!
//! Cost: sixteen products a channel and look-up. Limit: a knot's value is met to the width of two
//! samples only.

use crate::limbs::spline::KnotSpline;

/// Samples between the first knot and the last.
const SAMPLES: usize = 44;
/// Rounds of smoothing with weights 1, 2, 1.
const ROUNDS: usize = 2;

/// Values over a length, constant outside of their knots.
#[derive(Debug, Clone)]
pub(crate) struct LengthProfile<const N: usize> {
    start: f64,
    step: f64,
    values: Vec<[f64; N]>,
}

impl<const N: usize> LengthProfile<N> {
    /// Through `(length, values)` knots of strictly rising length.
    pub(crate) fn new(knots: &[(f64, [f64; N])]) -> Self {
        let (start, end) = match knots {
            [first, .., last] => (first.0, last.0),
            _ => (0.0, 1.0),
        };
        let step = (end - start) / (SAMPLES - 1) as f64;
        let channels: [KnotSpline; N] =
            std::array::from_fn(|c| KnotSpline::new(knots.iter().map(|(x, v)| (*x, v[c]))));
        let sample = |k: usize| std::array::from_fn(|c| channels[c].at(start + step * k as f64));
        let mut values: Vec<[f64; N]> = (0..SAMPLES).map(sample).collect();
        (0..ROUNDS).for_each(|_| values = smoothed(&values));
        LengthProfile { start, step, values }
    }

    /// The values at a length.
    pub(crate) fn at(&self, x: f64) -> [f64; N] {
        let last = (SAMPLES - 1) as f64;
        let t = ((x - self.start) / self.step).clamp(0.0, last);
        let i = (t as usize).min(SAMPLES - 2);
        let weights = basis(t - i as f64);
        let rows = [i.saturating_sub(1), i, i + 1, (i + 2).min(SAMPLES - 1)].map(|k| &self.values[k]);
        std::array::from_fn(|c| (0..4).map(|k| weights[k] * rows[k][c]).sum())
    }

    /// Evenly spaced lengths with their values.
    pub(crate) fn samples(&self) -> impl Iterator<Item = (f64, &[f64; N])> {
        self.values.iter().enumerate().map(|(k, v)| (self.start + self.step * k as f64, v))
    }
}

/// The weights of four neighbouring samples.
fn basis(t: f64) -> [f64; 4] {
    let (u, t2, t3) = (1.0 - t, t * t, t * t * t);
    [
        u * u * u / 6.0,
        (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0,
        (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) / 6.0,
        t3 / 6.0,
    ]
}

fn smoothed<const N: usize>(values: &[[f64; N]]) -> Vec<[f64; N]> {
    let last = values.len() - 1;
    let mean = |k: usize, c: usize| {
        (values[k.saturating_sub(1)][c] + 2.0 * values[k][c] + values[(k + 1).min(last)][c]) / 4.0
    };
    (0..=last).map(|k| std::array::from_fn(|c| mean(k, c))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_stays_and_a_slope_is_kept_inside() {
        let p = LengthProfile::new(&[(0.0, [2.0, 0.0]), (1.0, [2.0, 0.5]), (2.0, [2.0, 1.0])]);
        for x in [-1.0, 0.3, 1.0, 1.7, 5.0] {
            assert!((p.at(x)[0] - 2.0).abs() < 1e-12);
        }
        assert!((p.at(1.0)[1] - 0.5).abs() < 1e-3, "{:?}", p.at(1.0));
    }
}
