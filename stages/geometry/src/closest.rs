//! Closest points of a triangle and of two segments.
//!
//! Ericson, *Real-Time Collision Detection*, 2005, sections 5.1.5 and 5.1.9, with what is divided
//! by kept away from zero: triangles without area are taken as their sides, segments without length
//! as points, and parallel segments by their ends.

use crate::Vec3;

/// Squared sine of the angle below which two sides or segments count as parallel: the closest point
/// that an inverse of it would give has lost all its digits.
const PARALLEL: f64 = 1e-20;

/// The part of a triangle that a point is closest to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// Its inside.
    Face,
    /// The side from corner `k` to the next.
    Side(u8),
    /// Corner `k`.
    Corner(u8),
}

/// The closest point of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnTriangle {
    /// The point.
    pub point: Vec3,
    /// Its barycentric coordinates: none negative, sum 1.
    pub weights: [f64; 3],
    /// Where it lies.
    pub feature: Feature,
}

/// `n / d` for `0 <= n <= d`, zero where `d` is.
fn share(n: f64, d: f64) -> f64 {
    if d > 0.0 { (n / d).clamp(0.0, 1.0) } else { 0.0 }
}

/// The point of the triangle `t` that is closest to `p`.
#[inline]
#[must_use]
pub fn on_triangle(p: &Vec3, t: &[Vec3; 3]) -> OnTriangle {
    let (ab, ac) = (t[1] - t[0], t[2] - t[0]);
    let flat = ab.cross(&ac).norm_squared() <= PARALLEL * ab.norm_squared() * ac.norm_squared();
    if flat { on_sides(p, t) } else { on_full_triangle(p, t, &ab, &ac) }
}

fn on_full_triangle(p: &Vec3, t: &[Vec3; 3], ab: &Vec3, ac: &Vec3) -> OnTriangle {
    let (ap, bp, cp) = (p - t[0], p - t[1], p - t[2]);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return corner(t, 0);
    }
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return corner(t, 1);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return side(t, 0, share(d1, d1 - d3));
    }
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return corner(t, 2);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return side(t, 2, 1.0 - share(d2, d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return side(t, 1, share(d4 - d3, (d4 - d3) + (d5 - d6)));
    }
    let (v, w) = (vb / (va + vb + vc), vc / (va + vb + vc));
    OnTriangle { point: t[0] + ab * v + ac * w, weights: [1.0 - v - w, v, w], feature: Feature::Face }
}

/// The closest point of the three sides; the first of equals.
fn on_sides(p: &Vec3, t: &[Vec3; 3]) -> OnTriangle {
    let on = |k: u8| {
        let (a, b) = (t[k as usize], t[(k as usize + 1) % 3]);
        match on_segment(p, &a, &b) {
            s if s <= 0.0 => corner(t, k),
            s if s >= 1.0 => corner(t, (k + 1) % 3),
            s => side(t, k, s),
        }
    };
    let nearer = |best: OnTriangle, k: u8| {
        let next = on(k);
        if (next.point - p).norm_squared() < (best.point - p).norm_squared() { next } else { best }
    };
    (1..3).fold(on(0), nearer)
}

fn corner(t: &[Vec3; 3], k: u8) -> OnTriangle {
    let mut weights = [0.0; 3];
    weights[k as usize] = 1.0;
    OnTriangle { point: t[k as usize], weights, feature: Feature::Corner(k) }
}

/// The point at share `s` of the side from corner `k` to the next.
fn side(t: &[Vec3; 3], k: u8, s: f64) -> OnTriangle {
    let (i, j) = (k as usize, (k as usize + 1) % 3);
    let mut weights = [0.0; 3];
    (weights[i], weights[j]) = (1.0 - s, s);
    OnTriangle { point: t[i] + (t[j] - t[i]) * s, weights, feature: Feature::Side(k) }
}

/// The share, 0 to 1, at which the segment from `a` to `b` is closest to `p`.
#[must_use]
pub fn on_segment(p: &Vec3, a: &Vec3, b: &Vec3) -> f64 {
    let d = b - a;
    let (n, d) = ((p - a).dot(&d), d.norm_squared());
    if n <= 0.0 { 0.0 } else { share(n, d) }
}

/// The shares, 0 to 1, at which the segments `a` and `b` are closest to each other.
#[must_use]
pub fn between_segments(a: &[Vec3; 2], b: &[Vec3; 2]) -> (f64, f64) {
    let (da, db, r) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let (aa, bb, ab) = (da.norm_squared(), db.norm_squared(), da.dot(&db));
    // The same as `aa * bb - ab * ab` without its cancellation.
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

/// The same for parallel segments: the closest of the four pairs of an end and a segment.
fn between_ends(a: &[Vec3; 2], b: &[Vec3; 2]) -> (f64, f64) {
    let pairs = [
        (0.0, on_segment(&a[0], &b[0], &b[1])),
        (1.0, on_segment(&a[1], &b[0], &b[1])),
        (on_segment(&b[0], &a[0], &a[1]), 0.0),
        (on_segment(&b[1], &a[0], &a[1]), 1.0),
    ];
    let gap = |(s, t): (f64, f64)| ((a[0] + (a[1] - a[0]) * s) - (b[0] + (b[1] - b[0]) * t)).norm_squared();
    pairs[1..].iter().fold(pairs[0], |best, &p| if gap(p) < gap(best) { p } else { best })
}

#[cfg(test)]
mod tests;
