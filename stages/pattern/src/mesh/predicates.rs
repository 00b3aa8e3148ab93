//! Exact geometric tests on points of the plane.
//!
//! Method: Shewchuk's adaptive predicates (1997) through the `robust` crate: the sign of every
//! orientation and in-circle test is exact, so no decision depends on rounding.

use toile_core::artifact::Point2;

fn coord(p: Point2) -> robust::Coord<f64> {
    robust::Coord { x: p.x, y: p.y }
}

/// Positive where a, b, c turn left, negative where they turn right, zero on one line.
pub(crate) fn orient(a: Point2, b: Point2, c: Point2) -> f64 {
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Positive where `d` lies inside the circle through the counter-clockwise points a, b, c.
pub(crate) fn in_circle(a: Point2, b: Point2, c: Point2, d: Point2) -> f64 {
    robust::incircle(coord(a), coord(b), coord(c), coord(d))
}

/// True where the closed segments ab and cd share a point.
pub(crate) fn segments_meet(a: Point2, b: Point2, c: Point2, d: Point2) -> bool {
    let (c_side, d_side) = (orient(a, b, c), orient(a, b, d));
    let (a_side, b_side) = (orient(c, d, a), orient(c, d, b));
    let opposite = |s: f64, t: f64| (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0);
    (opposite(c_side, d_side) && opposite(a_side, b_side))
        || (c_side == 0.0 && in_box(a, b, c))
        || (d_side == 0.0 && in_box(a, b, d))
        || (a_side == 0.0 && in_box(c, d, a))
        || (b_side == 0.0 && in_box(c, d, b))
}

/// True where `p`, known to lie on the line ab, lies between them.
fn in_box(a: Point2, b: Point2, p: Point2) -> bool {
    let within = |p: f64, a: f64, b: f64| p >= a.min(b) && p <= a.max(b);
    within(p.x, a.x, b.x) && within(p.y, a.y, b.y)
}

/// True where the segments `from`-`a` and `from`-`b` run over each other.
pub(crate) fn fold_back(from: Point2, a: Point2, b: Point2) -> bool {
    orient(from, a, b) == 0.0 && (a - from).dot(&(b - from)) > 0.0
}

/// Distance of `p` to the segment ab, and the share of the way from a to b of the closest point.
pub(crate) fn distance_to_segment(p: Point2, a: Point2, b: Point2) -> (f64, f64) {
    let ab = b - a;
    let t = ((p - a).dot(&ab) / ab.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    ((p - (a + ab * t)).norm(), t)
}

/// True where `p` lies inside the closed polygon (even-odd, half-open in y so that a vertex on
/// the scan line counts once).
pub(crate) fn inside(polygon: &[Point2], p: Point2) -> bool {
    let n = polygon.len();
    let crosses = |i: &usize| {
        let (a, b) = (polygon[*i], polygon[(*i + 1) % n]);
        (a.y <= p.y) != (b.y <= p.y) && (orient(a, b, p) > 0.0) == (b.y > a.y)
    };
    (0..n).filter(crosses).count() % 2 == 1
}
