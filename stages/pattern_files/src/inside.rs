//! Where things lie inside of a polygon. Cost: linear in its points.

use toile_core::artifact::Point2;

/// The least and the greatest corner of the box around points; both at the origin where there are
/// none.
pub(crate) fn bounds(points: &[Point2]) -> (Point2, Point2) {
    let Some(&first) = points.first() else { return (Point2::origin(), Point2::origin()) };
    points.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)))
}

/// The parts of an upright line that lie inside, from below, each by its ends.
pub(crate) fn upright_parts(polygon: &[Point2], x: f64) -> Vec<[f64; 2]> {
    let n = polygon.len();
    let crossing = |k: usize| {
        let (a, b) = (polygon[k], polygon[(k + 1) % n]);
        ((a.x <= x) != (b.x <= x)).then(|| a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x))
    };
    let mut ys: Vec<f64> = (0..n).filter_map(crossing).collect();
    ys.sort_by(f64::total_cmp);
    ys.chunks_exact(2).map(|w| [w[0], w[1]]).collect()
}

/// Whether a point lies inside; on the boundary it may do either.
pub(crate) fn contains(polygon: &[Point2], p: Point2) -> bool {
    upright_parts(polygon, p.x).iter().any(|[a, b]| (*a..*b).contains(&p.y))
}

/// Whether a line from `a` to `b` touches a box.
pub(crate) fn crosses(a: Point2, b: Point2, (lo, hi): (Point2, Point2)) -> bool {
    let d = b - a;
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for k in 0..2 {
        if d[k].abs() < f64::MIN_POSITIVE {
            if a[k] < lo[k] || a[k] > hi[k] {
                return false;
            }
            continue;
        }
        let (s, t) = ((lo[k] - a[k]) / d[k], (hi[k] - a[k]) / d[k]);
        (from, to) = (from.max(s.min(t)), to.min(s.max(t)));
    }
    from <= to
}
