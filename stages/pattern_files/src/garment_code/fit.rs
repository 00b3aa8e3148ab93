//! Lines from point to point as the curves of the format: straight edges and cubic curves.
//!
//! Method: the line is split where it turns by more than [`CORNER`]; each run becomes one straight
//! line where its points lie on it, else one cubic curve by least squares over its points,
//! parameters and control points improved together by tangent distances (Schneider 1990; Wang,
//! Pottmann and Liu 2006). A run that leaves its curve by more than the tolerance, at points or
//! between them, is divided at the worst point. What no curve fits stays straight from point to
//! point. Cost: points squared, a millisecond for a hundred. Limits: curves that follow each other
//! meet without a gap, but their directions may differ a little there.

use super::curve::FileCurve;
use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv};
use nalgebra::{Matrix4, Vector4};
use toile_core::artifact::{EdgeCurve, Point2, Vector2};

/// The line is split where it turns by more than this, degrees.
const CORNER: f64 = 20.0;
/// A run of fewer points is kept as it is.
const FEWEST: usize = 5;
/// Improvements of the parameters.
const ROUNDS: usize = 24;
/// The share of the whole distance of a point beside that from the tangent.
const SLIDE: f64 = 1e-6;
/// Points of a curve that are compared with the line, for each of the line's; of a line that is
/// drawn more finely than by so many, as many as it has.
const SAMPLES: usize = 6;
const FINE: usize = 600;

/// The curves of a line through these points, at least two; they leave it by no more than
/// `tolerance`, metres.
pub(super) fn fitted(points: &[Point2], tolerance: f64) -> Vec<FileCurve> {
    let mut points: Vec<Point2> = points.to_vec();
    points.dedup();
    let mut out = Vec::new();
    let mut from = 0;
    for k in 1..points.len() {
        if k + 1 == points.len() || turns(&points[k - 1..=k + 1]) {
            run(&points[from..=k], tolerance, &mut out);
            from = k;
        }
    }
    out
}

fn turns(p: &[Point2]) -> bool {
    let (u, v) = (p[1] - p[0], p[2] - p[1]);
    u.perp(&v).atan2(u.dot(&v)).abs() > CORNER.to_radians()
}

fn run(points: &[Point2], tolerance: f64, out: &mut Vec<FileCurve>) {
    let [Some(&start), Some(&end)] = [points.first(), points.last()] else { return };
    let straight = |start, end| FileCurve { start, end, shape: EdgeCurve::Line };
    if is_straight(points, tolerance / 4.0) {
        return out.push(straight(start, end));
    }
    if points.len() < FEWEST {
        return out.extend(points.windows(2).map(|w| straight(w[0], w[1])));
    }
    let (worst, at) = match cubic(points) {
        Some(c) => {
            let (worst, at) = distance(points, &c);
            if worst <= tolerance {
                let shape = EdgeCurve::Cubic { controls: [c.p1, c.p2].map(|p| Point2::new(p.x, p.y)) };
                return out.push(FileCurve { start, end, shape });
            }
            (worst, at)
        }
        None => (f64::INFINITY, points.len() / 2),
    };
    let at = if worst.is_finite() { at.clamp(1, points.len() - 2) } else { points.len() / 2 };
    run(&points[..=at], tolerance, out);
    run(&points[at..], tolerance, out);
}

/// Whether all points lie on the line from the first to the last, one behind the other.
fn is_straight(points: &[Point2], tolerance: f64) -> bool {
    let (first, chord) = (points[0], points[points.len() - 1] - points[0]);
    let length = chord.norm();
    let along = |p: &Point2| (p - first).dot(&chord) / length.max(f64::MIN_POSITIVE);
    let near = points.iter().all(|p| (p - first).perp(&chord).abs() <= tolerance * length);
    near && points.windows(2).all(|w| along(&w[0]) < along(&w[1]))
}

/// The cubic curve from the first point to the last that is nearest to the others.
fn cubic(points: &[Point2]) -> Option<CubicBez> {
    let mut at = vec![0.0];
    for w in points.windows(2) {
        at.push(at[at.len() - 1] + (w[1] - w[0]).norm());
    }
    let length = at[at.len() - 1];
    at.iter_mut().for_each(|t| *t /= length);
    let mut curve = solved(points, &at)?;
    for _ in 0..ROUNDS {
        for (t, p) in at.iter_mut().zip(points).skip(1).take(points.len() - 2) {
            *t = improved(&curve, *p, improved(&curve, *p, *t));
        }
        curve = nearer(points, &at, &curve)?;
    }
    Some(curve)
}

/// The inner control points by least squares over the distances of the points from the curve's
/// tangents, which lets the points slide along the curve.
fn nearer(points: &[Point2], at: &[f64], curve: &CubicBez) -> Option<CubicBez> {
    let (mut matrix, mut right) = (Matrix4::<f64>::zeros(), Vector4::<f64>::zeros());
    for (point, &t) in points.iter().zip(at) {
        let way = curve.deriv().eval(t).to_vec2();
        let normal = Vector2::new(-way.y, way.x).try_normalize(1e-12)?;
        let on = curve.eval(t);
        let off = Vector2::new(point.x - on.x, point.y - on.y);
        let (u, v) = (3.0 * (1.0 - t).powi(2) * t, 3.0 * (1.0 - t) * t * t);
        let row = Vector4::new(u * normal.x, u * normal.y, v * normal.x, v * normal.y);
        matrix += row * row.transpose();
        right += row * off.dot(&normal);
        // A little of the whole distance, which keeps the points from sliding away.
        let (whole, across) = (SLIDE * u, SLIDE * v);
        for k in 0..2 {
            matrix[(k, k)] += whole * u;
            matrix[(k, k + 2)] += whole * v;
            matrix[(k + 2, k)] += whole * v;
            matrix[(k + 2, k + 2)] += across * v;
            right[k] += whole * off[k];
            right[k + 2] += across * off[k];
        }
    }
    let d = matrix.lu().solve(&right)?;
    let moved = CubicBez { p1: curve.p1 + (d.x, d.y), p2: curve.p2 + (d.z, d.w), ..*curve };
    moved.is_finite().then_some(moved)
}

/// The inner control points by least squares for parameters that are known.
fn solved(points: &[Point2], at: &[f64]) -> Option<CubicBez> {
    let (p, q) = (points[0].coords, points[points.len() - 1].coords);
    let (mut a, mut b, mut c) = (0.0, 0.0, 0.0);
    let (mut x, mut y) = (Vector2::zeros(), Vector2::zeros());
    for (point, &t) in points.iter().zip(at) {
        let s = 1.0 - t;
        let (u, v) = (3.0 * s * s * t, 3.0 * s * t * t);
        let rest = point.coords - p * (s * s * s) - q * (t * t * t);
        (a, b, c) = (a + u * u, b + u * v, c + v * v);
        (x, y) = (x + rest * u, y + rest * v);
    }
    let det = a * c - b * b;
    if det <= 1e-12 * a * c {
        return None;
    }
    let (first, second) = ((x * c - y * b) / det, (y * a - x * b) / det);
    let k = |v: Vector2| kurbo::Point::new(v.x, v.y);
    Some(CubicBez::new(k(p), k(first), k(second), k(q)))
}

/// A Newton step of the parameter at which a curve is nearest to a point.
fn improved(curve: &CubicBez, p: Point2, t: f64) -> f64 {
    let (first, second) = (curve.deriv(), curve.deriv().deriv());
    let off = curve.eval(t) - kurbo::Point::new(p.x, p.y);
    let (d, dd) = (first.eval(t).to_vec2(), second.eval(t).to_vec2());
    let slope = d.dot(d) + off.dot(dd);
    if slope > 0.0 { (t - off.dot(d) / slope).clamp(0.0, 1.0) } else { t }
}

/// How far line and curve are apart, and at which of the line's points most.
fn distance(points: &[Point2], curve: &CubicBez) -> (f64, usize) {
    let n = (points.len() * SAMPLES).min(points.len().max(FINE));
    let on = |i: usize| {
        let p = curve.eval(i as f64 / n as f64);
        Point2::new(p.x, p.y)
    };
    let samples: Vec<Point2> = (0..=n).map(on).collect();
    let of_curve = samples.iter().map(|p| nearest(points, *p));
    let of_line = points.iter().enumerate().map(|(k, p)| (nearest(&samples, *p).0, k));
    of_curve.chain(of_line).fold((0.0, 1), |worst, one| if one.0 > worst.0 { one } else { worst })
}

/// The distance of a point from a line, and the number of the line's point that is nearest behind
/// it.
fn nearest(line: &[Point2], p: Point2) -> (f64, usize) {
    let chord = |(k, w): (usize, &[Point2])| {
        let d = w[1] - w[0];
        let t = ((p - w[0]).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        ((p - (w[0] + d * t)).norm(), k + usize::from(t > 0.5))
    };
    line.windows(2).enumerate().map(chord).fold((f64::INFINITY, 0), |a, b| if b.0 < a.0 { b } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flatten::flatten;

    fn p(x: f64, y: f64) -> Point2 {
        Point2::new(x, y)
    }

    #[test]
    fn a_drawn_curve_becomes_one_curve_again() {
        let armhole = EdgeCurve::Cubic { controls: [p(0.05, 0.2), p(0.3, 0.6)] };
        // Points lie far more densely at one of its ends than at the other.
        let uneven = EdgeCurve::Quadratic { control: p(0.04, 0.1) };
        for curve in [armhole, uneven] {
            let points = flatten(p(0.0, 0.0), p(0.8, 0.5), &curve, 1e-5);
            let curves = fitted(&points, 3e-5);
            assert_eq!(curves.iter().map(|c| c.shape.word()).collect::<Vec<_>>(), ["cubic"]);
        }
    }

    #[test]
    fn corners_and_straight_runs_stay() {
        let points = [p(0.0, 0.0), p(0.1, 0.0), p(0.2, 0.0), p(0.2, 0.1), p(0.3, 0.12)];
        let curves = fitted(&points, 2e-5);
        let ends: Vec<(Point2, Point2)> = curves.iter().map(|c| (c.start, c.end)).collect();
        assert_eq!(ends, [(points[0], points[2]), (points[2], points[3]), (points[3], points[4])]);
        assert!(curves.iter().all(|c| c.shape == EdgeCurve::Line));
    }
}
