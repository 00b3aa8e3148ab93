//! Curves as points.
//!
//! Method: Bézier curves by `kurbo`'s subdivision, arcs by equal angles whose chords leave them by
//! no more than the tolerance. Cost: points grow with the square root of length over tolerance.
//! Limits: [`MOST_ARC`] points an arc.

use kurbo::{BezPath, PathEl};
use toile_core::artifact::{EdgeCurve, EdgePath, PatternLoop, Point2};

/// Points of one arc.
const MOST_ARC: f64 = 4_000.0;

/// The points of an edge from `start` to `end`, both included; the edge is nowhere farther than
/// `tolerance` from them, metres.
pub(crate) fn flatten(start: Point2, end: Point2, curve: &EdgeCurve, tolerance: f64) -> Vec<Point2> {
    let mut points = match curve {
        EdgeCurve::Line => vec![start],
        EdgeCurve::Polyline { points } => [&[start], points.as_slice()].concat(),
        EdgeCurve::Quadratic { control } => {
            bezier(start, |path| path.quad_to(k(*control), k(end)), tolerance)
        }
        EdgeCurve::Cubic { controls: [a, b] } => {
            bezier(start, |path| path.curve_to(k(*a), k(*b), k(end)), tolerance)
        }
        EdgeCurve::Arc { bulge } => arc(start, end, *bulge, tolerance),
    };
    points.push(end);
    points
}

/// A loop as points, not repeating the first, and the index of each corner.
pub(crate) fn loop_points(l: &PatternLoop, tolerance: f64) -> (Vec<Point2>, Vec<usize>) {
    let n = l.corners.len();
    let (mut points, mut corners) = (Vec::new(), Vec::new());
    for (k, e) in l.edges.iter().enumerate() {
        corners.push(points.len());
        let drawn = flatten(l.corners[k], l.corners[(k + 1) % n], &e.curve, tolerance);
        points.extend(&drawn[..drawn.len() - 1]);
    }
    (points, corners)
}

fn k(p: Point2) -> kurbo::Point {
    kurbo::Point::new(p.x, p.y)
}

/// The points of a curve but for its end.
fn bezier(start: Point2, draw: impl FnOnce(&mut BezPath), tolerance: f64) -> Vec<Point2> {
    let mut path = BezPath::new();
    path.move_to(k(start));
    draw(&mut path);
    let mut points = vec![start];
    kurbo::flatten(path, tolerance, |el| {
        if let PathEl::LineTo(p) = el {
            points.push(Point2::new(p.x, p.y));
        }
    });
    if points.len() > 1 {
        points.pop();
    }
    points
}

/// The points of an arc but for its end.
fn arc(start: Point2, end: Point2, bulge: f64, tolerance: f64) -> Vec<Point2> {
    let path = EdgePath::new(start, end, &EdgeCurve::Arc { bulge });
    let angle = 4.0 * bulge.abs().atan();
    let radius = path.length() / angle.max(f64::MIN_POSITIVE);
    let step = 2.0 * (1.0 - (tolerance / radius).min(1.0)).acos();
    let parts = (angle / step.max(f64::MIN_POSITIVE)).ceil().clamp(1.0, MOST_ARC) as usize;
    let at = |i: usize| path.at(path.length() * (i as f64 / parts as f64));
    std::iter::once(start).chain((1..parts).map(at)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_on_the_curve_and_chords_within_the_tolerance() {
        let p = Point2::new;
        let curves = [
            EdgeCurve::Quadratic { control: p(0.2, 0.5) },
            EdgeCurve::Cubic { controls: [p(0.0, 0.4), p(0.5, -0.3)] },
            EdgeCurve::Arc { bulge: 0.7 },
            EdgeCurve::Arc { bulge: -1.6 },
        ];
        for curve in &curves {
            let path = EdgePath::new(p(0.0, 0.0), p(0.4, 0.1), curve);
            let points = flatten(p(0.0, 0.0), p(0.4, 0.1), curve, 2e-5);
            let off = |q: &Point2| {
                let chord = |w: &[Point2]| {
                    let d = w[1] - w[0];
                    let t = ((q - w[0]).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
                    (q - (w[0] + d * t)).norm()
                };
                points.windows(2).map(chord).fold(f64::INFINITY, f64::min)
            };
            let worst = path.points().iter().map(off).fold(0.0, f64::max);
            assert!(worst <= 2e-5 && points.len() < 200, "{curve:?}: {worst} with {} points", points.len());
        }
    }

    #[test]
    fn lines_and_polylines_keep_their_points() {
        let p = Point2::new;
        assert_eq!(flatten(p(0.0, 0.0), p(1.0, 0.0), &EdgeCurve::Line, 1e-5), [p(0.0, 0.0), p(1.0, 0.0)]);
        let bent = EdgeCurve::Polyline { points: vec![p(0.5, 0.2)] };
        assert_eq!(flatten(p(0.0, 0.0), p(1.0, 0.0), &bent, 1e-5), [p(0.0, 0.0), p(0.5, 0.2), p(1.0, 0.0)]);
    }
}
