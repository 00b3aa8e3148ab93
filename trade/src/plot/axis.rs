//! Axes.

/// A logarithmic axis.
pub struct Axis {
    lo: f64,
    hi: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// With room for these values between two places of the picture.
    pub fn over(values: &[f64], from: f64, to: f64) -> Self {
        let (lo, hi) = values.iter().fold((f64::INFINITY, 0.0_f64), |(lo, hi), v| (lo.min(*v), hi.max(*v)));
        let (lo, hi) = if lo.is_finite() && lo > 0.0 { (lo, hi) } else { (1.0, 10.0) };
        // Room at both ends, and never less than a factor of three in all.
        let spare = (3.0 / (hi / lo)).max(1.0).sqrt();
        Axis { lo: lo / spare / 1.25, hi: hi * spare * 1.25, from, to }
    }

    /// Between two values exactly.
    pub fn between(lo: f64, hi: f64, from: f64, to: f64) -> Self {
        Axis { lo, hi, from, to }
    }

    /// Where a value is.
    pub fn at(&self, v: f64) -> f64 {
        self.from + (v / self.lo).ln() / (self.hi / self.lo).ln() * (self.to - self.from)
    }

    /// 1, 2 and 5 of every decade within, those that have a number first.
    pub fn ticks(&self) -> Vec<f64> {
        let decades = self.lo.log10().floor() as i32..=self.hi.log10().ceil() as i32;
        let ticks = decades.flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(d)));
        ticks.filter(|t| (self.lo..=self.hi).contains(t)).collect()
    }
}
