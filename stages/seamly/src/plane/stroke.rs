//! One part of a curve.

use super::arc::DraftArc;
use super::{ACCURACY, accuracy};
use kurbo::{
    Affine, CubicBez, ParamCurve, ParamCurveArclen, ParamCurveDeriv, ParamCurveNearest, Point, Vec2,
};

/// A part of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DraftStroke {
    /// A cubic Bézier curve.
    Cubic(CubicBez),
    /// An arc of a circle.
    Arc(DraftArc),
}

impl DraftStroke {
    /// Its point at a parameter from 0 to 1.
    pub fn at(&self, t: f64) -> Point {
        match self {
            DraftStroke::Cubic(c) => c.eval(t),
            DraftStroke::Arc(a) => a.at(t),
        }
    }

    /// Its length.
    pub fn length(&self) -> f64 {
        match self {
            DraftStroke::Cubic(c) => c.arclen(within(c)),
            DraftStroke::Arc(a) => a.length(),
        }
    }

    /// The parameter at a length from its start.
    pub(super) fn parameter(&self, length: f64) -> f64 {
        let whole = self.length();
        match self {
            _ if length <= 0.0 || whole <= 0.0 => 0.0,
            _ if length >= whole => 1.0,
            DraftStroke::Cubic(c) => c.inv_arclen(length, within(c)),
            DraftStroke::Arc(_) => length / whole,
        }
    }

    /// The parameter at which it is nearest to a point.
    pub(super) fn nearest(&self, p: Point) -> f64 {
        match self {
            DraftStroke::Cubic(c) => c.nearest(p, within(c)).t,
            DraftStroke::Arc(a) => a.nearest(p),
        }
    }

    /// The part of it between two parameters.
    pub(super) fn part(&self, from: f64, to: f64) -> Self {
        match self {
            _ if from <= 0.0 && to >= 1.0 => *self,
            DraftStroke::Cubic(c) => DraftStroke::Cubic(c.subsegment(from..to)),
            DraftStroke::Arc(a) => DraftStroke::Arc(a.part(from, to)),
        }
    }

    /// From its end to its start.
    pub fn reversed(&self) -> Self {
        match self {
            DraftStroke::Cubic(c) => DraftStroke::Cubic(CubicBez::new(c.p3, c.p2, c.p1, c.p0)),
            DraftStroke::Arc(a) => DraftStroke::Arc(a.part(1.0, 0.0)),
        }
    }

    /// Moved by what keeps lengths.
    pub(super) fn moved(&self, by: Affine) -> Self {
        match self {
            DraftStroke::Cubic(c) => DraftStroke::Cubic(by * *c),
            DraftStroke::Arc(a) => DraftStroke::Arc(a.moved(by)),
        }
    }

    /// The direction in which it leaves its start.
    pub(crate) fn leaves(&self) -> Vec2 {
        match self {
            DraftStroke::Cubic(c) => {
                let first = [c.p1, c.p2, c.p3].into_iter().map(|p| p - c.p0).find(|d| d.hypot() > 1e-9);
                first.unwrap_or_else(|| c.deriv().eval(0.0).to_vec2())
            }
            DraftStroke::Arc(a) => a.tangent(0.0),
        }
    }

    /// It as cubics, near to it.
    pub(crate) fn cubics(&self) -> Vec<CubicBez> {
        match self {
            DraftStroke::Cubic(c) => vec![*c],
            DraftStroke::Arc(a) => a.cubics(accuracy(ACCURACY, a.radius)),
        }
    }
}

/// The greatest error of a length along a curve.
fn within(c: &CubicBez) -> f64 {
    accuracy(ACCURACY, (c.p1 - c.p0).hypot() + (c.p2 - c.p1).hypot() + (c.p3 - c.p2).hypot())
}
