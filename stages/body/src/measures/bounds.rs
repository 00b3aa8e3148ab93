//! Boxes around parts of a figure: far from a part its value need not be computed.

use toile_core::artifact::{Point3, Vector3};

/// The share of the distance to its box that a part's value is at least: values are distances to
/// first order only.
const SURE: f64 = 0.7;

/// A box along the axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounds {
    /// Least coordinates, metres.
    pub lo: Point3,
    /// Greatest coordinates.
    pub hi: Point3,
}

impl Bounds {
    /// The least box around points.
    pub(crate) fn of(points: impl IntoIterator<Item = Point3>) -> Self {
        let none = Bounds { lo: Point3::from([f64::INFINITY; 3]), hi: Point3::from([f64::NEG_INFINITY; 3]) };
        points.into_iter().fold(none, |b, p| Bounds { lo: b.lo.inf(&p), hi: b.hi.sup(&p) })
    }

    /// Whether a point lies inside.
    pub(crate) fn holds(&self, p: &Point3) -> bool {
        (0..3).all(|k| p[k] > self.lo[k] && p[k] < self.hi[k])
    }

    /// A lower bound of the value of what lies inside.
    pub(crate) fn at_least(&self, p: Point3) -> f64 {
        let out = (self.lo - p).sup(&(p - self.hi)).sup(&Vector3::zeros());
        out.norm() * SURE
    }
}
