//! SPLINE entities as curves.
//!
//! Method: a B-spline's Bézier points between two knots are values of its blossom, by de Boor's
//! algorithm with another number in each round (Ramshaw 1989); so curves of up to the third degree
//! are kept as they are. What is rational or of a higher degree is followed by points. Of a spline
//! that has points to go through alone, a cubic curve with continuous curvature goes through them,
//! parametrised by chords, its ends free or in the directions that it says. Cost: linear in the
//! knots.

use toile_core::prelude::*;

/// Points between two knots by which a rational curve is followed.
const POINTS: usize = 48;
/// Degrees of curves.
const MOST_DEGREE: usize = 11;

/// A spline as the file has it.
#[derive(Debug, Default)]
pub(super) struct Spline {
    pub degree: usize,
    pub knots: Vec<f64>,
    pub controls: Vec<Point2>,
    /// As many as controls, or none.
    pub weights: Vec<f64>,
    /// Points to go through.
    pub fits: Vec<Point2>,
    /// The directions at start and end, where they are given.
    pub tangents: [Option<Vector2>; 2],
    pub closed: bool,
}

/// Curves that follow each other, from a start.
pub(super) type Curves = (Point2, Vec<(EdgeCurve, Point2)>);

impl Spline {
    /// Its curves; none where its numbers make no spline.
    pub(super) fn curves(&self) -> Option<Curves> {
        if self.controls.is_empty() { self.through() } else { self.between_knots() }
    }

    fn between_knots(&self) -> Option<Curves> {
        let (p, n) = (self.degree, self.controls.len());
        let ascending = self.knots.windows(2).all(|w| w[0] <= w[1]);
        if p == 0 || p > MOST_DEGREE || n <= p || self.knots.len() != n + p + 1 || !ascending {
            return None;
        }
        let plain =
            self.weights.len() != n || self.weights.iter().all(|w| (w - self.weights[0]).abs() < 1e-12);
        let (mut start, mut out) = (None, Vec::new());
        for k in p..n {
            let (a, b) = (self.knots[k], self.knots[k + 1]);
            if b <= a {
                continue;
            }
            let at = |ends: usize| {
                let args: Vec<f64> = (0..p).map(|i| if i < p - ends { a } else { b }).collect();
                self.blossom(k, &args)
            };
            start.get_or_insert(at(0)?);
            if plain && p <= 3 {
                let curve = match p {
                    1 => EdgeCurve::Line,
                    2 => EdgeCurve::Quadratic { control: at(1)? },
                    _ => EdgeCurve::Cubic { controls: [at(1)?, at(2)?] },
                };
                out.push((curve, at(p)?));
                continue;
            }
            for i in 1..=POINTS {
                let t = a + (b - a) * (i as f64 / POINTS as f64);
                out.push((EdgeCurve::Line, self.blossom(k, &vec![t; p])?));
            }
        }
        Some((start?, out))
    }

    /// The blossom of the stretch behind the knot `k`.
    fn blossom(&self, k: usize, args: &[f64]) -> Option<Point2> {
        let p = self.degree;
        let weight = |i: usize| if self.weights.len() == self.controls.len() { self.weights[i] } else { 1.0 };
        let control = |i: usize| {
            let (c, w) = (self.controls[i], weight(i));
            [c.x * w, c.y * w, w]
        };
        let mut d: Vec<[f64; 3]> = (k - p..=k).map(control).collect();
        for r in 1..=p {
            for j in (r..=p).rev() {
                let (low, high) = (self.knots[k - p + j], self.knots[k + 1 + j - r]);
                let share = if high > low { (args[r - 1] - low) / (high - low) } else { 0.0 };
                d[j] = std::array::from_fn(|i| (1.0 - share) * d[j - 1][i] + share * d[j][i]);
            }
        }
        let [x, y, w] = d[p];
        let point = Point2::new(x / w, y / w);
        point.coords.iter().all(|c| c.is_finite()).then_some(point)
    }

    /// The cubic curve through its points.
    fn through(&self) -> Option<Curves> {
        let mut q = self.fits.clone();
        q.dedup_by(|a, b| (*a - *b).norm() < 1e-9);
        if self.closed && q.len() > 2 && (q[0] - q[q.len() - 1]).norm() > 1e-9 {
            q.push(q[0]);
        }
        let n = q.len().checked_sub(1).filter(|n| *n > 0)?;
        let h: Vec<f64> = q.windows(2).map(|w| (w[1] - w[0]).norm()).collect();
        // The derivatives at the points solve a system of three diagonals.
        let (mut low, mut middle, mut high) = (vec![0.0; n + 1], vec![2.0; n + 1], vec![0.0; n + 1]);
        let mut right: Vec<Vector2> = vec![Vector2::zeros(); n + 1];
        for i in 1..n {
            let (before, behind) = (1.0 / h[i - 1], 1.0 / h[i]);
            (low[i], middle[i], high[i]) = (before, 2.0 * (before + behind), behind);
            right[i] = ((q[i] - q[i - 1]) * (before * before) + (q[i + 1] - q[i]) * (behind * behind)) * 3.0;
        }
        (high[0], right[0]) = (1.0, (q[1] - q[0]) * (3.0 / h[0]));
        (low[n], right[n]) = (1.0, (q[n] - q[n - 1]) * (3.0 / h[n - 1]));
        for (i, tangent) in [0, n].into_iter().zip(&self.tangents) {
            if let Some(way) = tangent.and_then(|t| t.try_normalize(1e-9)) {
                (low[i], middle[i], high[i], right[i]) = (0.0, 1.0, 0.0, way);
            }
        }
        for i in 1..=n {
            let share = low[i] / middle[i - 1];
            middle[i] -= share * high[i - 1];
            right[i] = right[i] - right[i - 1] * share;
        }
        right[n] /= middle[n];
        for i in (0..n).rev() {
            right[i] = (right[i] - right[i + 1] * high[i]) / middle[i];
        }
        let curve = |i: usize| {
            let third = h[i] / 3.0;
            let controls = [q[i] + right[i] * third, q[i + 1] - right[i + 1] * third];
            (EdgeCurve::Cubic { controls }, q[i + 1])
        };
        Some((q[0], (0..n).map(curve).collect()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn p(x: f64, y: f64) -> Point2 {
        Point2::new(x, y)
    }

    fn length((start, parts): &Curves) -> f64 {
        let mut at = *start;
        let mut whole = 0.0;
        for (curve, end) in parts {
            whole += EdgePath::new(at, *end, curve).length();
            at = *end;
        }
        whole
    }

    #[test]
    fn a_cubic_spline_of_two_stretches_is_two_bezier_curves_that_meet_smoothly() {
        let controls = vec![p(0.0, 0.0), p(1.0, 2.0), p(3.0, 2.0), p(4.0, -1.0), p(6.0, 0.0)];
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0];
        let curves = Spline { degree: 3, knots, controls, ..Spline::default() }.curves().unwrap();
        assert_eq!((curves.0, curves.1.len(), curves.1[1].1), (p(0.0, 0.0), 2, p(6.0, 0.0)));
        let (EdgeCurve::Cubic { controls: [a, b] }, middle) = &curves.1[0] else { unreachable!() };
        let (EdgeCurve::Cubic { controls: [c, _] }, _) = &curves.1[1] else { unreachable!() };
        assert_eq!(*a, p(1.0, 2.0));
        assert!(((middle - b) - (c - middle)).norm() < 1e-12);
    }

    #[test]
    fn a_rational_spline_of_a_circle_is_as_long_as_the_circle() {
        let s = std::f64::consts::FRAC_1_SQRT_2;
        let controls = vec![p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
        let spline = Spline {
            degree: 2,
            knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            controls,
            weights: vec![1.0, s, 1.0],
            ..Spline::default()
        };
        let found = length(&spline.curves().unwrap());
        assert!((found - std::f64::consts::FRAC_PI_2).abs() < 1e-4, "{found}");
    }

    #[test]
    fn points_to_go_through_are_met_and_a_circle_is_followed() {
        let at = |k: i32| p(0.3 * (f64::from(k) * 0.2).cos(), 0.3 * (f64::from(k) * 0.2).sin());
        let fits: Vec<Point2> = (0..=10).map(at).collect();
        let tangents = [Some(Vector2::new(0.0, 1.0)), Some(Vector2::new(-(2.0_f64.sin()), 2.0_f64.cos()))];
        let curves = Spline { fits: fits.clone(), tangents, ..Spline::default() }.curves().unwrap();
        assert!(curves.1.iter().zip(&fits[1..]).all(|((_, end), q)| end == q));
        assert!((length(&curves) - 0.6).abs() < 1e-5, "{}", length(&curves));
        assert!(Spline { fits: vec![p(0.0, 0.0)], ..Spline::default() }.curves().is_none());
        assert!(Spline { degree: 3, controls: fits, ..Spline::default() }.curves().is_none());
    }
}
