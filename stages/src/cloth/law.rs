//! A fabric's force-strain curve as a sum of kinks.
//!
//! Method: a piecewise-linear curve through the origin is `k0 e + sum_i dk_i max(e - e_i, 0)`, so
//! one evaluation is a few multiplications without a search [METHODS 2: stiffness piecewise linear
//! in the strain, read off the Kawabata curve]. Cost: one test per kink passed. Limit: slopes may
//! be cut at a greatest stiffness, because the steepest slope in use decides the time step.

use toile_core::artifact::Curve;

/// A force-strain law per metre of width.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    first: f64,
    /// Strain where the slope changes, and by how much (N/m).
    kinks: Vec<(f64, f64)>,
    steepest: f64,
}

impl Law {
    /// The curve's law with no slope above `cut` N/m.
    pub fn new(curve: &Curve, cut: f64) -> Self {
        let mut from = (0.0, 0.0);
        let mut law = Law { first: 0.0, kinks: Vec::new(), steepest: 0.0 };
        let mut last = 0.0;
        for (i, &to) in curve.0.iter().enumerate() {
            let slope = ((to.1 - from.1) / (to.0 - from.0)).min(cut);
            match i {
                0 => law.first = slope,
                _ if slope != last => law.kinks.push((from.0, slope - last)),
                _ => {}
            }
            law.steepest = law.steepest.max(slope);
            (last, from) = (slope, to);
        }
        law
    }

    /// Line force (N/m) at a strain; compression follows the first slope.
    #[inline]
    pub fn force(&self, strain: f64) -> f64 {
        let mut force = self.first * strain;
        for &(at, change) in &self.kinks {
            if strain <= at {
                break;
            }
            force += change * (strain - at);
        }
        force
    }

    /// Line force at a strain whose sign counts as its mirror image, as in shear.
    #[inline]
    pub fn odd_force(&self, strain: f64) -> f64 {
        self.force(strain.abs()).copysign(strain)
    }

    /// Stored energy per area at a strain, J/m2.
    pub fn energy(&self, strain: f64) -> f64 {
        let over = |at: f64| (strain - at).max(0.0);
        let kinks: f64 = self.kinks.iter().map(|&(at, change)| change * over(at).powi(2)).sum();
        (self.first * strain * strain + kinks) / 2.0
    }

    /// The steepest slope, N/m.
    pub fn steepest(&self) -> f64 {
        self.steepest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_is_its_curve() {
        let curve = Curve(vec![(0.01, 5.0), (0.03, 45.0), (0.05, 65.0)]);
        let law = Law::new(&curve, f64::INFINITY);
        for i in -20..100 {
            let e = f64::from(i) * 1e-3;
            assert!((law.force(e) - curve.at(e).0).abs() < 1e-9, "{e}");
            assert!((law.energy(e) - curve.energy(e)).abs() < 1e-9, "{e}");
        }
        assert_eq!(law.steepest(), curve.steepest());
    }

    #[test]
    fn no_slope_is_above_the_cut() {
        let law = Law::new(&Curve(vec![(0.01, 5.0), (0.03, 45.0)]), 800.0);
        assert_eq!(law.steepest(), 800.0);
        assert!((law.force(0.02) - (5.0 + 8.0)).abs() < 1e-12);
    }

    #[test]
    fn shear_is_odd() {
        let law = Law::new(&Curve(vec![(0.1, 5.0), (0.2, 45.0)]), f64::INFINITY);
        assert_eq!(law.odd_force(-0.15), -law.odd_force(0.15));
    }
}
