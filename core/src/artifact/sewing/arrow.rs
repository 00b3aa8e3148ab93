//! The arrow that shows in a drawing which way an edge runs.

use crate::artifact::{Point2, Vector2, polyline_length};

/// How long it is, and half its width, metres.
const LONG: f64 = 0.012;
const HALF: f64 = 0.004;
/// Of an edge it takes this share at most.
const MOST: f64 = 0.5;
/// Where its tip lies, as a share of the edge: beside the name in the middle.
const TIP: f64 = 0.72;

/// The corners of an arrow on a line of points, its tip first.
pub(crate) fn arrow(points: &[Point2]) -> [Point2; 3] {
    let length = polyline_length(points);
    let long = LONG.min(MOST * length);
    let (tip, foot) = (at(points, TIP * length), at(points, (TIP * length - long).max(0.0)));
    let way = (tip - foot).try_normalize(1e-12).unwrap_or_else(Vector2::x);
    let across = Vector2::new(-way.y, way.x) * (HALF * long / LONG);
    [tip, foot + across, foot - across]
}

/// The point at that length along a line.
fn at(points: &[Point2], length: f64) -> Point2 {
    let mut left = length;
    for w in points.windows(2) {
        let step = (w[1] - w[0]).norm();
        if left <= step && step > 0.0 {
            return w[0] + (w[1] - w[0]) * (left / step);
        }
        left -= step;
    }
    points.last().copied().unwrap_or_else(Point2::origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tip_lies_farther_along_the_edge_than_the_foot() {
        let points = [Point2::new(0.0, 0.0), Point2::new(0.1, 0.0), Point2::new(0.1, 0.1)];
        let [tip, left, right] = arrow(&points);
        assert!((tip - Point2::new(0.1, 0.044)).norm() < 1e-12, "{tip}");
        assert!((left - Point2::new(0.096, 0.032)).norm() < 1e-12 && (right.x - 0.104).abs() < 1e-12);
        // On a short edge it is small.
        let [tip, left, _] = arrow(&[Point2::new(0.0, 0.0), Point2::new(0.01, 0.0)]);
        assert!((tip.x - left.x - 0.005).abs() < 1e-12);
    }
}
