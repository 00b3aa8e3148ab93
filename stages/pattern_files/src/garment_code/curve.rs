//! One edge of the file, and how it is cut.

use kurbo::{CubicBez, ParamCurve, ParamCurveArclen, QuadBez};
use toile_core::artifact::{EdgeCurve, EdgePath, Point2};

/// The error of a length at which a curve is cut, metres.
const ACCURACY: f64 = 1e-10;

/// One edge of the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FileCurve {
    pub start: Point2,
    pub end: Point2,
    pub shape: EdgeCurve,
}

impl FileCurve {
    /// Its length, metres.
    pub(super) fn length(&self) -> f64 {
        EdgePath::new(self.start, self.end, &self.shape).length()
    }

    /// Both parts of it, cut at that length from its start, metres.
    pub(super) fn cut(&self, at: f64) -> [FileCurve; 2] {
        let path = EdgePath::new(self.start, self.end, &self.shape);
        let k = |p: Point2| kurbo::Point::new(p.x, p.y);
        let p = |q: kurbo::Point| Point2::new(q.x, q.y);
        let shapes = match &self.shape {
            EdgeCurve::Quadratic { control } => {
                let whole = QuadBez::new(k(self.start), k(*control), k(self.end));
                let t = whole.inv_arclen(at, ACCURACY);
                let part = |a: f64, b: f64| EdgeCurve::Quadratic { control: p(whole.subsegment(a..b).p1) };
                [part(0.0, t), part(t, 1.0)]
            }
            EdgeCurve::Cubic { controls: [a, b] } => {
                let whole = CubicBez::new(k(self.start), k(*a), k(*b), k(self.end));
                let t = whole.inv_arclen(at, ACCURACY);
                let part = |a: f64, b: f64| {
                    let c = whole.subsegment(a..b);
                    EdgeCurve::Cubic { controls: [p(c.p1), p(c.p2)] }
                };
                [part(0.0, t), part(t, 1.0)]
            }
            EdgeCurve::Arc { bulge } => {
                let share = at / path.length();
                [share, 1.0 - share].map(|s| EdgeCurve::Arc { bulge: (bulge.atan() * s).tan() })
            }
            EdgeCurve::Line | EdgeCurve::Polyline { .. } => [EdgeCurve::Line, EdgeCurve::Line],
        };
        let middle = path.at(at);
        let [first, second] = shapes;
        [
            FileCurve { start: self.start, end: middle, shape: first },
            FileCurve { start: middle, end: self.end, shape: second },
        ]
    }
}
