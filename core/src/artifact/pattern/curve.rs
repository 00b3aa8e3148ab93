//! The shape of an edge between two points.
//!
//! Method: lengths of Bézier curves by `kurbo`'s Gauss-Legendre quadrature with an error below
//! [`ACCURACY`], points at a length by its bisection; arcs in closed form. An arc is kept by its
//! *bulge*, the tangent of a quarter of its angle, as DXF does: that one number is well behaved at
//! a half circle, where centre and radius are not, and mirrors by its sign. Cost: a few
//! microseconds a length. Limits: an arc turns by less than a whole circle.

use super::super::{Point2, Vector2, polyline_length};
use kurbo::{CubicBez, ParamCurve, ParamCurveArclen, QuadBez};

/// The greatest error of a length, metres.
const ACCURACY: f64 = 1e-10;

/// Points at a length are found no more exactly than to this share of the length: doubles of curves
/// that no garment has are no finer, and to look for more took minutes.
const RELATIVE: f64 = 1e-13;

/// Points by which a curve is drawn lie no farther apart than this, metres.
const STEP: f64 = 1e-3;
/// No edge is drawn by more points than this.
const MOST_POINTS: usize = 4000;

/// How an edge runs from its start to its end. Control points are in the piece's own coordinates,
/// metres.
#[derive(Debug, Clone, PartialEq)]
pub enum EdgeCurve {
    /// Straight.
    Line,
    /// A parabola with one control point.
    Quadratic {
        /// The control point.
        control: Point2,
    },
    /// A cubic Bézier curve.
    Cubic {
        /// The control points, that of the start first.
        controls: [Point2; 2],
    },
    /// A part of a circle.
    Arc {
        /// The tangent of a quarter of the angle that it turns by: 1 for a half circle, above 0
        /// where it turns to the left (counter-clockwise), below 0 to the right.
        bulge: f64,
    },
    /// Straight from point to point.
    Polyline {
        /// The points between start and end.
        points: Vec<Point2>,
    },
}

impl EdgeCurve {
    /// Its word in messages, records and drawings.
    pub fn word(&self) -> &'static str {
        match self {
            EdgeCurve::Line => "line",
            EdgeCurve::Quadratic { .. } => "quadratic",
            EdgeCurve::Cubic { .. } => "cubic",
            EdgeCurve::Arc { .. } => "arc",
            EdgeCurve::Polyline { .. } => "polyline",
        }
    }

    /// The same curve with every point moved by `to`; `mirrors` where that turns left into right.
    pub fn moved(&self, to: impl Fn(Point2) -> Point2, mirrors: bool) -> Self {
        match self {
            EdgeCurve::Line => EdgeCurve::Line,
            EdgeCurve::Quadratic { control } => EdgeCurve::Quadratic { control: to(*control) },
            EdgeCurve::Cubic { controls } => EdgeCurve::Cubic { controls: controls.map(to) },
            EdgeCurve::Arc { bulge } => EdgeCurve::Arc { bulge: if mirrors { -bulge } else { *bulge } },
            EdgeCurve::Polyline { points } => {
                EdgeCurve::Polyline { points: points.iter().map(|p| to(*p)).collect() }
            }
        }
    }

    /// The same curve from its end to its start.
    pub fn turned(&self) -> Self {
        match self {
            EdgeCurve::Line => EdgeCurve::Line,
            EdgeCurve::Quadratic { control } => EdgeCurve::Quadratic { control: *control },
            EdgeCurve::Cubic { controls: [a, b] } => EdgeCurve::Cubic { controls: [*b, *a] },
            EdgeCurve::Arc { bulge } => EdgeCurve::Arc { bulge: -bulge },
            EdgeCurve::Polyline { points } => {
                EdgeCurve::Polyline { points: points.iter().rev().copied().collect() }
            }
        }
    }

    /// The bulge of an arc over a chord of that length, metres. A radius below half the chord is
    /// taken as half the chord.
    pub fn bulge(chord: f64, radius: f64, large: bool, left: bool) -> f64 {
        let half = (chord / (2.0 * radius.abs())).clamp(0.0, 1.0).asin();
        let angle = if large { 2.0 * std::f64::consts::PI - 2.0 * half } else { 2.0 * half };
        let bulge = (angle / 4.0).tan();
        if left { bulge } else { -bulge }
    }

    /// Its own points: controls, or those of a polyline.
    pub(super) fn points(&self) -> &[Point2] {
        match self {
            EdgeCurve::Line | EdgeCurve::Arc { .. } => &[],
            EdgeCurve::Quadratic { control } => std::slice::from_ref(control),
            EdgeCurve::Cubic { controls } => controls,
            EdgeCurve::Polyline { points } => points,
        }
    }
}

/// An edge with its ends: what can be measured and drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgePath {
    shape: CurveShape,
    length: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum CurveShape {
    Quadratic(QuadBez),
    Cubic(CubicBez),
    /// Centre, the start seen from it, and the angle that it turns by.
    Arc(Point2, Vector2, f64),
    /// Points and the length at each of them.
    Polyline(Vec<Point2>, Vec<f64>),
}

impl EdgePath {
    /// The edge from `start` to `end`.
    pub fn new(start: Point2, end: Point2, curve: &EdgeCurve) -> Self {
        let k = |p: Point2| kurbo::Point::new(p.x, p.y);
        match curve {
            EdgeCurve::Quadratic { control } => {
                let bezier = QuadBez::new(k(start), k(*control), k(end));
                EdgePath { length: bezier.arclen(ACCURACY), shape: CurveShape::Quadratic(bezier) }
            }
            EdgeCurve::Cubic { controls: [a, b] } => {
                let bezier = CubicBez::new(k(start), k(*a), k(*b), k(end));
                EdgePath { length: bezier.arclen(ACCURACY), shape: CurveShape::Cubic(bezier) }
            }
            EdgeCurve::Arc { bulge } if bulge.abs() > 1e-12 => Self::arc(start, end, *bulge),
            EdgeCurve::Line | EdgeCurve::Arc { .. } => Self::polyline(vec![start, end]),
            EdgeCurve::Polyline { points } => {
                let ends = std::iter::once(start).chain(points.iter().copied()).chain([end]);
                Self::polyline(ends.collect())
            }
        }
    }

    fn arc(start: Point2, end: Point2, bulge: f64) -> Self {
        let chord = end - start;
        let angle = 4.0 * bulge.atan();
        // Half the chord over the tangent of half the angle, to the left of the chord.
        let height = (1.0 - bulge * bulge) / (4.0 * bulge);
        let centre = nalgebra::center(&start, &end) + Vector2::new(-chord.y, chord.x) * height;
        let radius = chord.norm() * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
        EdgePath { shape: CurveShape::Arc(centre, start - centre, angle), length: radius * angle.abs() }
    }

    /// Straight from point to point; at least one point, metres.
    pub fn polyline(points: Vec<Point2>) -> Self {
        let mut along = vec![0.0];
        for w in points.windows(2) {
            along.push(along[along.len() - 1] + (w[1] - w[0]).norm());
        }
        EdgePath { length: polyline_length(&points), shape: CurveShape::Polyline(points, along) }
    }

    /// Its length, metres, to [`ACCURACY`].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The point at that length from its start, metres; before the start and behind the end, those.
    pub fn at(&self, length: f64) -> Point2 {
        self.eval(self.parameter(length))
    }

    /// Points from one length to another, both included, near enough to draw it by: a millimetre
    /// apart on a curve.
    pub fn between(&self, from: f64, to: f64) -> Vec<Point2> {
        if let CurveShape::Polyline(points, along) = &self.shape {
            let inside = points.iter().zip(along).filter(|(_, s)| **s > from && **s < to).map(|(p, _)| *p);
            return std::iter::once(self.at(from)).chain(inside).chain([self.at(to)]).collect();
        }
        let parts = (((to - from) / STEP).ceil() as usize).clamp(2, MOST_POINTS);
        let [a, b] = [from, to].map(|s| self.parameter(s));
        (0..=parts).map(|k| self.eval(a + (b - a) * (k as f64 / parts as f64))).collect()
    }

    /// All of it, as points.
    pub fn points(&self) -> Vec<Point2> {
        self.between(0.0, self.length)
    }

    fn parameter(&self, length: f64) -> f64 {
        let length = length.clamp(0.0, self.length.max(0.0));
        let accuracy = ACCURACY.max(RELATIVE * self.length);
        match &self.shape {
            // The ends are met exactly, so that edges which follow each other share their corner.
            _ if length <= 0.0 => 0.0,
            _ if length >= self.length => 1.0,
            CurveShape::Quadratic(q) => q.inv_arclen(length, accuracy),
            CurveShape::Cubic(c) => c.inv_arclen(length, accuracy),
            CurveShape::Arc(..) | CurveShape::Polyline(..) => length / self.length,
        }
    }

    fn eval(&self, t: f64) -> Point2 {
        let of = |p: kurbo::Point| Point2::new(p.x, p.y);
        match &self.shape {
            CurveShape::Quadratic(q) => of(q.eval(t)),
            CurveShape::Cubic(c) => of(c.eval(t)),
            CurveShape::Arc(centre, start, angle) => centre + nalgebra::Rotation2::new(angle * t) * start,
            CurveShape::Polyline(points, along) => {
                let s = t * self.length;
                let last = points.len() - 1;
                let k = along.partition_point(|a| *a <= s).clamp(1, last.max(1)) - 1;
                let [a, b] = [points[k], points[(k + 1).min(last)]];
                let piece = along[(k + 1).min(last)] - along[k];
                if piece > 0.0 { a + (b - a) * ((s - along[k]) / piece) } else { a }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn p(x: f64, y: f64) -> Point2 {
        Point2::new(x, y)
    }

    fn length(end: Point2, curve: &EdgeCurve) -> f64 {
        EdgePath::new(p(0.0, 0.0), end, curve).length()
    }

    #[test]
    fn lengths_are_those_of_closed_forms() {
        assert_eq!(length(p(0.3, 0.4), &EdgeCurve::Line), 0.5);
        // A parabola y = x^2 over [-1/2, 1/2]: sqrt(2)/2 + asinh(1)/2, its control below its
        // vertex.
        let parabola = EdgeCurve::Quadratic { control: p(0.5, -0.5) };
        let exact = 2.0_f64.sqrt() / 2.0 + 1.0_f64.asinh() / 2.0;
        assert!((length(p(1.0, 0.0), &parabola) - exact).abs() < 1e-9);
        // The same parabola as a cubic.
        let raised = EdgeCurve::Cubic { controls: [p(1.0 / 3.0, -1.0 / 3.0), p(2.0 / 3.0, -1.0 / 3.0)] };
        assert!((length(p(1.0, 0.0), &raised) - exact).abs() < 1e-9);
        for (bulge, angle) in [(1.0, PI), ((PI / 8.0).tan(), PI / 2.0), ((3.0 * PI / 8.0).tan(), 1.5 * PI)] {
            let chord = 2.0 * 0.25 * (angle / 2.0_f64).sin();
            for sign in [1.0, -1.0] {
                let arc = EdgeCurve::Arc { bulge: sign * bulge };
                assert!((length(p(chord, 0.0), &arc) - 0.25 * angle).abs() < 1e-12, "{angle}");
            }
        }
        let bent = EdgeCurve::Polyline { points: vec![p(0.3, 0.4), p(0.3, 1.4)] };
        assert!((length(p(1.3, 1.4), &bent) - 2.5).abs() < 1e-12);
    }

    #[test]
    fn an_arc_by_its_radius_turns_to_the_side_that_is_asked() {
        for (large, left) in [(false, false), (false, true), (true, false), (true, true)] {
            let bulge = EdgeCurve::bulge(0.3, 0.2, large, left);
            let path = EdgePath::new(p(0.0, 0.0), p(0.3, 0.0), &EdgeCurve::Arc { bulge });
            let half = (0.15_f64 / 0.2).asin();
            let angle = if large { 2.0 * PI - 2.0 * half } else { 2.0 * half };
            assert!((path.length() - 0.2 * angle).abs() < 1e-12);
            // What turns to the left bulges to the right of its chord.
            assert_eq!(path.at(path.length() / 2.0).y < 0.0, left);
        }
        let half = EdgeCurve::bulge(0.3, 0.1, false, true);
        assert!((half - 1.0).abs() < 1e-12, "a radius below half the chord: {half}");
    }

    #[test]
    fn points_lie_at_their_lengths_and_ends_are_met_exactly() {
        let (a, b) = (p(0.1, 0.2), p(0.7, 0.4));
        let curves = [
            EdgeCurve::Line,
            EdgeCurve::Quadratic { control: p(0.4, 0.9) },
            EdgeCurve::Cubic { controls: [p(0.0, 0.9), p(0.9, -0.3)] },
            EdgeCurve::Arc { bulge: -0.6 },
            EdgeCurve::Polyline { points: vec![p(0.3, 0.3), p(0.5, 0.1)] },
        ];
        for curve in &curves {
            let path = EdgePath::new(a, b, curve);
            let drawn = path.points();
            assert!(
                (drawn[0] - a).norm() < 1e-15 && (drawn[drawn.len() - 1] - b).norm() < 1e-15,
                "{curve:?}"
            );
            assert!((polyline_length(&drawn) - path.length()).abs() < 1e-5 * path.length(), "{curve:?}");
            for share in [0.1, 0.5, 0.8] {
                let s = share * path.length();
                let there = polyline_length(&path.between(0.0, s));
                assert!((there - s).abs() < 1e-5, "{curve:?}: {there} for {s}");
            }
            let turned = EdgePath::new(b, a, &curve.turned());
            assert!((turned.at(0.1) - path.at(path.length() - 0.1)).norm() < 1e-7, "{curve:?}");
            let mirror = |q: Point2| p(-q.x, q.y);
            let mirrored = EdgePath::new(mirror(a), mirror(b), &curve.moved(mirror, true));
            assert!((mirrored.at(0.2) - mirror(path.at(0.2))).norm() < 1e-9, "{curve:?}");
        }
    }

    #[test]
    fn points_along_a_curve_of_forty_thousand_kilometres_are_those_of_one_of_a_metre() {
        let path = |size: f64| {
            let p = |x: f64, y: f64| Point2::new(x * size, y * size);
            let curve = EdgeCurve::Cubic { controls: [p(0.2, 0.3), p(0.7, -0.4)] };
            EdgePath::new(p(0.0, 0.0), p(1.0, 0.1), &curve)
        };
        let (small, large) = (path(1.0), path(4e7));
        for k in 1..40 {
            let [a, b] = [&small, &large].map(|path| path.at(path.length() * f64::from(k) / 40.0));
            assert!((a.coords - b.coords / 4e7).norm() < 1e-9, "{k}: {a} {b}");
        }
    }
}
