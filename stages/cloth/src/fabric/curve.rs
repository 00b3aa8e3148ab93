//! A piecewise-linear force-strain curve, as read off a test sheet.
//!
//! Through (0, 0), rising, continued by its last slope; under compression by its first slope.
//! Evaluation is a search among a handful of points. The energy is the exact integral, so that
//! force and energy agree to rounding.

use crate::error::ClothError;

/// Force over strain.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Strain, force and energy at each break; the first is the origin.
    points: Vec<[f64; 3]>,
    last_slope: f64,
}

impl Curve {
    /// A straight line of this slope.
    #[must_use]
    pub fn linear(slope: f64) -> Self {
        Self { points: vec![[0.0; 3]], last_slope: slope }
    }

    /// Through the origin and these (strain, force) points.
    ///
    /// # Errors
    /// [`ClothError::NonFiniteInput`] for NaN; [`ClothError::InvalidParameter`] unless strains and
    /// forces rise from above 0.
    pub fn through(points: &[[f64; 2]]) -> Result<Self, ClothError> {
        let mut kept = vec![[0.0; 3]];
        let mut last_slope = 0.0;
        for (index, &[strain, force]) in points.iter().enumerate() {
            if !(strain.is_finite() && force.is_finite()) {
                return Err(ClothError::NonFiniteInput { field: "curve", index });
            }
            let [s, f, e] = kept[kept.len() - 1];
            if strain <= s {
                let range = "strains that rise from above 0";
                return Err(ClothError::InvalidParameter { name: "curve strain", value: strain, range });
            }
            if force <= f {
                let range = "forces that rise from above 0";
                return Err(ClothError::InvalidParameter { name: "curve force", value: force, range });
            }
            last_slope = (force - f) / (strain - s);
            kept.push([strain, force, e + 0.5 * (f + force) * (strain - s)]);
        }
        Ok(Self { points: kept, last_slope })
    }

    /// The (strain, force) points that it goes through after the origin; a straight line has one,
    /// at strain 1.
    #[must_use]
    pub fn points(&self) -> Vec<[f64; 2]> {
        match self.points.len() {
            0 | 1 => vec![[1.0, self.last_slope]],
            _ => self.points[1..].iter().map(|p| [p[0], p[1]]).collect(),
        }
    }

    /// Force at `strain`.
    #[inline]
    #[must_use]
    pub fn force(&self, strain: f64) -> f64 {
        let ([s, f, _], slope) = self.piece(strain);
        f + slope * (strain - s)
    }

    /// Slope of the force at `strain`.
    #[inline]
    #[must_use]
    pub fn slope(&self, strain: f64) -> f64 {
        self.piece(strain).1
    }

    /// Work per unit of rest area up to `strain`.
    #[inline]
    #[must_use]
    pub fn energy(&self, strain: f64) -> f64 {
        let ([s, f, e], slope) = self.piece(strain);
        let d = strain - s;
        e + d * (f + 0.5 * slope * d)
    }

    /// Every force times `by`.
    #[must_use]
    pub fn scaled(&self, by: f64) -> Self {
        let points = self.points.iter().map(|&[s, f, e]| [s, f * by, e * by]).collect();
        Self { points, last_slope: self.last_slope * by }
    }

    /// The greatest slope anywhere: bounds the explicit time step.
    #[must_use]
    pub fn steepest(&self) -> f64 {
        self.points
            .windows(2)
            .map(|w| (w[1][1] - w[0][1]) / (w[1][0] - w[0][0]))
            .fold(self.last_slope, f64::max)
    }

    #[inline]
    fn piece(&self, strain: f64) -> ([f64; 3], f64) {
        if let [start] = self.points[..] {
            return (start, self.last_slope);
        }
        let above = self.points.partition_point(|p| p[0] <= strain).clamp(1, self.points.len());
        let start = self.points[above - 1];
        let slope = match self.points.get(above) {
            Some(end) => (end[1] - start[1]) / (end[0] - start[0]),
            None => self.last_slope,
        };
        (start, slope)
    }
}
