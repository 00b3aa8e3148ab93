//! A cubic edge of a piece, which can be parted and turned.

use crate::style::block::template::bow::Bow;
use toile_core::artifact::{Point2, polyline_length};

/// Parts in which lengths are measured.
const PARTS: usize = 24;

/// A Bézier curve by its four points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Curve(pub [Point2; 4]);

impl From<Bow> for Curve {
    fn from(bow: Bow) -> Self {
        let [c, d] = bow.controls();
        Curve([bow.a, c, d, bow.b])
    }
}

impl Curve {
    /// The same curve from its end to its start.
    pub(crate) fn turned(&self) -> Self {
        let [a, b, c, d] = self.0;
        Curve([d, c, b, a])
    }

    /// The same curve with its points moved.
    pub(crate) fn moved(&self, to: impl Fn(Point2) -> Point2) -> Self {
        Curve(self.0.map(to))
    }

    /// The point at `t` from 0 to 1.
    pub(crate) fn at(&self, t: f64) -> Point2 {
        self.parted(t)[0].0[3]
    }

    /// The two parts before and behind `t` (de Casteljau).
    pub(crate) fn parted(&self, t: f64) -> [Curve; 2] {
        let mix = |a: Point2, b: Point2| a + (b - a) * t;
        let [a, b, c, d] = self.0;
        let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
        let (abc, bcd) = (mix(ab, bc), mix(bc, cd));
        let middle = mix(abc, bcd);
        [Curve([a, ab, abc, middle]), Curve([middle, bcd, cd, d])]
    }

    /// Evenly spaced parameters' points, both ends included.
    pub(crate) fn points(&self, parts: usize) -> Vec<Point2> {
        (0..=parts).map(|k| self.at(k as f64 / parts as f64)).collect()
    }

    /// Its length.
    pub(crate) fn length(&self) -> f64 {
        polyline_length(&self.points(PARTS))
    }

    /// The parameter at so long a way from its start.
    pub(crate) fn parameter(&self, way: f64) -> f64 {
        let points = self.points(PARTS);
        let mut gone = 0.0;
        for (k, w) in points.windows(2).enumerate() {
            let step = (w[1] - w[0]).norm();
            if gone + step >= way && step > 0.0 {
                return (k as f64 + ((way - gone) / step).clamp(0.0, 1.0)) / PARTS as f64;
            }
            gone += step;
        }
        1.0
    }
}
