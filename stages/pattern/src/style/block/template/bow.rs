//! An edge of a template: a cubic that bows from its chord.
//!
//! Its point at `t` stands `3 t (1 - t) (b0 (1 - t) + b1 t)` chord lengths to the left of the
//! chord. That is the Bézier curve whose inner controls stand over the thirds of the chord, so that
//! a pattern takes it as it is.

use toile_core::artifact::{Point2, Vector2};

/// Parts in which a bow is walked.
const PARTS: usize = 16;

/// Steps to the nearest place, and the least step that is looked at.
const STEPS: usize = 3;
const LEAST: f64 = 1e-4;

/// A cubic edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bow {
    /// Where it starts.
    pub a: Point2,
    /// Where it ends.
    pub b: Point2,
    /// How far its controls stand to the left of its chord, in chord lengths.
    pub bow: [f64; 2],
}

/// What each control adds at `t`.
pub(crate) fn basis(t: f64) -> [f64; 2] {
    let s = 1.0 - t;
    [3.0 * t * s * s, 3.0 * t * t * s]
}

impl Bow {
    /// To the left of the chord, as long as the chord.
    fn left(&self) -> Vector2 {
        let d = self.b - self.a;
        Vector2::new(-d.y, d.x)
    }

    /// The point at `t` from 0 to 1.
    pub(crate) fn at(&self, t: f64) -> Point2 {
        let [p, q] = basis(t);
        self.a + (self.b - self.a) * t + self.left() * (p * self.bow[0] + q * self.bow[1])
    }

    /// The direction of the curve at `t`, not of length 1.
    pub(crate) fn direction(&self, t: f64) -> Vector2 {
        let s = 1.0 - t;
        let (p, q) = (3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t));
        (self.b - self.a) + self.left() * (p * self.bow[0] + q * self.bow[1])
    }

    /// The inner controls of its Bézier form.
    pub(crate) fn controls(&self) -> [Point2; 2] {
        let (d, n) = (self.b - self.a, self.left());
        [self.a + d / 3.0 + n * self.bow[0], self.a + d * (2.0 / 3.0) + n * self.bow[1]]
    }

    /// Points along it, both ends included.
    pub(crate) fn points(&self) -> Vec<Point2> {
        (0..=PARTS).map(|k| self.at(k as f64 / PARTS as f64)).collect()
    }

    /// Its length.
    pub(crate) fn length(&self) -> f64 {
        self.points().windows(2).map(|w| (w[1] - w[0]).norm()).sum()
    }

    /// The parameter of the point nearest to a place, of which the sampled point of that number is
    /// the nearest of its kind.
    fn nearest(&self, p: Point2, sampled: usize) -> f64 {
        let mut t = sampled as f64 / PARTS as f64;
        for _ in 0..STEPS {
            let d = self.direction(t);
            let mut by = (p - self.at(t)).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE);
            // Where the curve bends much, a whole step may lead away.
            while by.abs() > LEAST && (self.at((t + by).clamp(0.0, 1.0)) - p).norm() > (self.at(t) - p).norm()
            {
                by *= 0.25;
            }
            t = (t + by).clamp(0.0, 1.0);
        }
        t
    }
}

/// A bow with its points, so that many places can be compared to it.
pub(crate) struct SampledBow {
    bow: Bow,
    points: Vec<Point2>,
    /// No point of the curve lies farther from the nearest sampled one.
    gap: f64,
}

impl From<Bow> for SampledBow {
    fn from(bow: Bow) -> Self {
        let points = bow.points();
        let gap = points.windows(2).map(|w| (w[1] - w[0]).norm()).fold(0.0, f64::max);
        SampledBow { bow, points, gap }
    }
}

impl SampledBow {
    /// The parameter of the point nearest to a place, and the way from it to the place; none where
    /// all lie farther than `reach`.
    pub(crate) fn nearest(&self, p: Point2, reach: f64) -> Option<(f64, Vector2)> {
        let far = |k: &usize| (self.points[*k] - p).norm_squared();
        let k = (0..=PARTS).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
        if far(&k).sqrt() - self.gap > reach {
            return None;
        }
        let t = self.bow.nearest(p, k);
        Some((t, p - self.bow.at(t)))
    }
}
