//! Limbs: tubes of varying radius around a bent axis.
//!
//! Cost: a square root and a cubic for each stretch of the axis that may be the nearest, or a few
//! comparisons where the whole limb is too far away to matter ([`BentTube::joined`]).

use crate::limbs::spline::KnotSpline;
use crate::skin::field::smooth_min;
use toile_core::artifact::{Point3, Vector3};

/// What a bound may be off by rounding, metres.
const ROUNDING: f64 = 1e-9;

/// A tube of varying radius around a bent axis.
#[derive(Debug, Clone)]
pub(crate) struct BentTube {
    axis: Vec<Point3>,
    radius: KnotSpline,
    /// Stretch of the section along x and z: 1 is a circle.
    stretch: [f64; 2],
    segments: Vec<AxisSegment>,
    /// The box around the squeezed axis: its middle and half its sides.
    around: (Point3, Vector3),
    widest: f64,
}

/// A straight stretch of the axis in the space in which sections are circles.
#[derive(Debug, Clone)]
struct AxisSegment {
    from: Point3,
    way: Vector3,
    squared: f64,
    /// Where it begins along the axis, and how long it is, metres.
    start: f64,
    length: f64,
}

impl BentTube {
    /// Of an axis' points, the radius over the length along it, metres, and the stretch of its
    /// sections along x and z.
    pub(crate) fn new(axis: Vec<Point3>, radius: KnotSpline, stretch: [f64; 2]) -> Self {
        let squeezed: Vec<Point3> = axis.iter().map(|&p| squeeze(p, stretch)).collect();
        let mut start = 0.0;
        let segment = |(w, s): (&[Point3], &[Point3])| {
            let (way, length) = (s[1] - s[0], (w[1] - w[0]).norm());
            let segment = AxisSegment { from: s[0], way, squared: way.norm_squared(), start, length };
            start += length;
            segment
        };
        let segments = axis.windows(2).zip(squeezed.windows(2)).map(segment).collect();
        let lo = squeezed.iter().fold(Point3::from([f64::INFINITY; 3]), |l, p| l.inf(p));
        let hi = squeezed.iter().fold(Point3::from([f64::NEG_INFINITY; 3]), |h, p| h.sup(p));
        let widest = radius.greatest();
        BentTube {
            axis,
            radius,
            stretch,
            segments,
            around: (nalgebra::center(&lo, &hi), (hi - lo) / 2.0),
            widest,
        }
    }

    /// The axis' points.
    pub(crate) fn axis(&self) -> &[Point3] {
        &self.axis
    }

    /// The value: the distance to the axis minus the radius there.
    pub(crate) fn value(&self, p: Point3) -> f64 {
        let (p, mut best) = (squeeze(p, self.stretch), f64::INFINITY);
        for s in &self.segments {
            let t = ((p - s.from).dot(&s.way) / s.squared).clamp(0.0, 1.0);
            let distance = (p - (s.from + s.way * t)).norm();
            if distance - self.widest < best {
                best = best.min(distance - self.radius.at(s.start + t * s.length));
            }
        }
        best * self.narrowing()
    }

    /// The smooth minimum over a width `k` of a value and the limb's, which is not asked for where
    /// it is too far away to change the value.
    pub(crate) fn joined(&self, value: f64, p: Point3, k: f64) -> f64 {
        if self.at_least(p) > value + k { value } else { smooth_min(value, self.value(p), k) }
    }

    /// A lower bound of the value: the distance to the box around the axis minus the greatest
    /// radius.
    pub(crate) fn at_least(&self, p: Point3) -> f64 {
        let out = ((squeeze(p, self.stretch) - self.around.0).abs() - self.around.1).sup(&Vector3::zeros());
        (out.norm() - self.widest) * self.narrowing() - ROUNDING
    }

    fn narrowing(&self) -> f64 {
        self.stretch[0].min(self.stretch[1]).min(1.0)
    }
}

fn squeeze(p: Point3, stretch: [f64; 2]) -> Point3 {
    Point3::new(p.x / stretch[0], p.y, p.z / stretch[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn limb() -> BentTube {
        let axis = vec![Point3::origin(), Point3::new(0.1, 1.0, 0.0), Point3::new(0.3, 1.4, 0.5)];
        BentTube::new(axis, KnotSpline::new([(0.0, 0.1), (0.8, 0.2), (1.6, 0.05)]), [0.75, 1.3])
    }

    #[test]
    fn a_straight_limb_of_even_radius_is_a_capsule() {
        let axis = vec![Point3::origin(), Point3::new(0.0, 1.0, 0.0)];
        let limb = BentTube::new(axis, KnotSpline::new([(0.0, 0.1), (1.0, 0.1)]), [1.0, 1.0]);
        assert!((limb.value(Point3::new(0.3, 0.5, 0.0)) - 0.2).abs() < 1e-12);
        assert!((limb.value(Point3::new(0.0, 1.5, 0.0)) - 0.4).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn what_is_left_out_changes_nothing(p in prop::array::uniform3(-2.0..2.0f64), value in -0.5..0.5f64, k in 0.01..0.2f64) {
            let (limb, p) = (limb(), Point3::from(p));
            prop_assert!(limb.at_least(p) <= limb.value(p));
            prop_assert_eq!(limb.joined(value, p, k), smooth_min(value, limb.value(p), k));
        }
    }
}
