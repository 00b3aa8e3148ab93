//! The edges of an outline as a file draws them: one curve each, those that end where they begin in
//! two.
//!
//! Readers take a line whose ends meet for a closed one. Cost: linear.

use kurbo::{CubicBez, ParamCurve, QuadBez};
use toile_core::artifact::{EdgeCurve, EdgePath, PatternLoop, Point2};

/// A curve of a file, a part of an edge.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EdgePart {
    /// The number of the edge in its loop.
    pub edge: usize,
    pub start: Point2,
    pub end: Point2,
    pub curve: EdgeCurve,
}

/// The parts of a loop in its order; an edge is halved where `closes` says of its chord and its
/// length, metres, that its ends are too near to each other.
pub(crate) fn parts(l: &PatternLoop, closes: impl Fn(f64, f64) -> bool) -> Vec<EdgePart> {
    let n = l.corners.len();
    let mut out = Vec::with_capacity(n);
    for (edge, e) in l.edges.iter().enumerate() {
        let (start, end) = (l.corners[edge], l.corners[(edge + 1) % n]);
        let whole = EdgePart { edge, start, end, curve: e.curve.clone() };
        match closes((end - start).norm(), l.path(edge).length()) {
            true => out.extend(halved(whole)),
            false => out.push(whole),
        }
    }
    out
}

/// Both halves of a curve; it alone where it has none.
fn halved(whole: EdgePart) -> Vec<EdgePart> {
    let EdgePart { edge, start, end, curve } = whole;
    let k = |p: Point2| kurbo::Point::new(p.x, p.y);
    let p = |q: kurbo::Point| Point2::new(q.x, q.y);
    let (middle, first, second) = match &curve {
        EdgeCurve::Quadratic { control } => {
            let (a, b) = QuadBez::new(k(start), k(*control), k(end)).subdivide();
            let one = |q: QuadBez| EdgeCurve::Quadratic { control: p(q.p1) };
            (p(a.p2), one(a), one(b))
        }
        EdgeCurve::Cubic { controls: [c, d] } => {
            let (a, b) = CubicBez::new(k(start), k(*c), k(*d), k(end)).subdivide();
            let one = |q: CubicBez| EdgeCurve::Cubic { controls: [p(q.p1), p(q.p2)] };
            (p(a.p3), one(a), one(b))
        }
        EdgeCurve::Polyline { points } if !points.is_empty() => {
            let m = points.len() / 2;
            let one = |points: &[Point2]| match points.is_empty() {
                true => EdgeCurve::Line,
                false => EdgeCurve::Polyline { points: points.to_vec() },
            };
            (points[m], one(&points[..m]), one(&points[m + 1..]))
        }
        EdgeCurve::Arc { bulge } if bulge.abs() > 0.5 => {
            let path = EdgePath::new(start, end, &curve);
            let half = EdgeCurve::Arc { bulge: (bulge.atan() / 2.0).tan() };
            (path.at(path.length() / 2.0), half.clone(), half)
        }
        EdgeCurve::Line | EdgeCurve::Arc { .. } | EdgeCurve::Polyline { .. } => {
            return vec![EdgePart { edge, start, end, curve }];
        }
    };
    vec![
        EdgePart { edge, start, end: middle, curve: first },
        EdgePart { edge, start: middle, end, curve: second },
    ]
}
