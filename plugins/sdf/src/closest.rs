//! Closest points of a triangle and of two segments (Ericson, *Real-Time Collision Detection*,
//! 2005, 5.1.5 and 5.1.9), where triangles without area count as their sides and segments without
//! length as points.

use toile_core::artifact::{Point3, Vector3};

/// Squared sine below which two sides count as parallel.
const PARALLEL: f64 = 1e-20;
/// Distances below this share of the coordinates have no direction left in them.
const TOUCHING: f64 = 1e-14;

/// The closest point of a triangle: its barycentric weights, zero for corners that have no part in
/// it.
pub(crate) fn on_triangle(p: &Point3, t: &[Point3; 3]) -> [f64; 3] {
    let (ab, ac) = (t[1] - t[0], t[2] - t[0]);
    if ab.cross(&ac).norm_squared() <= PARALLEL * ab.norm_squared() * ac.norm_squared() {
        return on_sides(p, t);
    }
    let (ap, bp, cp) = (p - t[0], p - t[1], p - t[2]);
    let (d1, d2, d3, d4, d5, d6) =
        (ab.dot(&ap), ac.dot(&ap), ab.dot(&bp), ac.dot(&bp), ab.dot(&cp), ac.dot(&cp));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let s = share(d1, d1 - d3);
        return [1.0 - s, s, 0.0];
    }
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let s = share(d2, d2 - d6);
        return [1.0 - s, 0.0, s];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let s = share(d4 - d3, (d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - s, s];
    }
    let sum = va + vb + vc;
    [1.0 - vb / sum - vc / sum, vb / sum, vc / sum]
}

/// `n / d` for `0 <= n <= d`, zero where `d` is.
fn share(n: f64, d: f64) -> f64 {
    if d > 0.0 { (n / d).clamp(0.0, 1.0) } else { 0.0 }
}

fn on_sides(p: &Point3, t: &[Point3; 3]) -> [f64; 3] {
    let weights = |k: usize| {
        let s = on_segment(p, &t[k], &t[(k + 1) % 3]);
        let mut w = [0.0; 3];
        (w[k], w[(k + 1) % 3]) = (1.0 - s, s);
        w
    };
    let gap = |w: &[f64; 3]| (at(t, w) - p).norm_squared();
    (1..3).map(weights).fold(weights(0), |best, w| if gap(&w) < gap(&best) { w } else { best })
}

/// The point of a triangle with these weights.
pub(crate) fn at(t: &[Point3; 3], w: &[f64; 3]) -> Point3 {
    match w {
        [a, 0.0, 0.0] if *a == 1.0 => t[0],
        [0.0, b, 0.0] if *b == 1.0 => t[1],
        [0.0, 0.0, c] if *c == 1.0 => t[2],
        _ => t[0] + (t[1] - t[0]) * w[1] + (t[2] - t[0]) * w[2],
    }
}

fn on_segment(p: &Point3, a: &Point3, b: &Point3) -> f64 {
    let d = b - a;
    share((p - a).dot(&d).max(0.0), d.norm_squared())
}

/// The shares at which two segments are closest to each other.
fn between_segments(a: &[Point3; 2], b: &[Point3; 2]) -> (f64, f64) {
    let (da, db, r) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let (aa, bb, ab) = (da.norm_squared(), db.norm_squared(), da.dot(&db));
    let det = da.cross(&db).norm_squared();
    if det <= PARALLEL * aa * bb {
        return between_ends(a, b);
    }
    let (ra, rb) = (da.dot(&r), db.dot(&r));
    let s = ((ab * rb - ra * bb) / det).clamp(0.0, 1.0);
    match (ab * s + rb) / bb {
        t if t < 0.0 => ((-ra / aa).clamp(0.0, 1.0), 0.0),
        t if t > 1.0 => (((ab - ra) / aa).clamp(0.0, 1.0), 1.0),
        t => (s, t),
    }
}

fn between_ends(a: &[Point3; 2], b: &[Point3; 2]) -> (f64, f64) {
    let pairs = [
        (0.0, on_segment(&a[0], &b[0], &b[1])),
        (1.0, on_segment(&a[1], &b[0], &b[1])),
        (on_segment(&b[0], &a[0], &a[1]), 0.0),
        (on_segment(&b[1], &a[0], &a[1]), 1.0),
    ];
    let gap = |(s, t): (f64, f64)| ((a[0] + (a[1] - a[0]) * s) - (b[0] + (b[1] - b[0]) * t)).norm_squared();
    pairs[1..].iter().fold(pairs[0], |best, &p| if gap(p) < gap(best) { p } else { best })
}

/// How two small pieces of cloth lie to each other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PieceProximity {
    /// The first side's positive, sum zero.
    pub(crate) weights: [f64; 4],
    /// Unit normal from the second side to the first.
    pub(crate) normal: Vector3,
    /// Distance, never negative.
    pub(crate) distance: f64,
}

/// A vertex against a triangle.
pub(crate) fn vertex_triangle(v: &Point3, t: &[Point3; 3]) -> PieceProximity {
    let w = on_triangle(v, t);
    let gap = v - at(t, &w);
    let (ab, ac) = (t[1] - t[0], t[2] - t[0]);
    let along = if ab.norm_squared() >= ac.norm_squared() { ab } else { ac };
    let normal = direction(&gap, size(v, &t[0]), ab.cross(&ac), &along);
    PieceProximity { weights: [1.0, -w[0], -w[1], -w[2]], normal, distance: gap.norm() }
}

/// An edge against an edge, and whether both closest points lie between the ends.
pub(crate) fn edge_edge(a: &[Point3; 2], b: &[Point3; 2]) -> (PieceProximity, bool) {
    let (s, t) = between_segments(a, b);
    let (da, db) = (a[1] - a[0], b[1] - b[0]);
    let gap = (a[0] + da * s) - (b[0] + db * t);
    let along = if da.norm_squared() >= db.norm_squared() { da } else { db };
    let normal = direction(&gap, size(&a[0], &b[0]), da.cross(&db), &along);
    let inside = |s: f64| s > 0.0 && s < 1.0;
    (
        PieceProximity { weights: [1.0 - s, s, t - 1.0, -t], normal, distance: gap.norm() },
        inside(s) && inside(t),
    )
}

fn size(p: &Point3, q: &Point3) -> f64 {
    p.coords.amax().max(q.coords.amax())
}

/// The unit vector of `gap`; of `normal` where that is nothing; of anything square to `along` else.
fn direction(gap: &Vector3, size: f64, normal: Vector3, along: &Vector3) -> Vector3 {
    let across = || {
        let mut least = Vector3::zeros();
        least[along.iamin()] = 1.0;
        along.cross(&least).try_normalize(0.0).unwrap_or_else(Vector3::y)
    };
    gap.try_normalize(TOUCHING * size)
        .or_else(|| normal.try_normalize(TOUCHING * along.norm_squared()))
        .unwrap_or_else(across)
}
