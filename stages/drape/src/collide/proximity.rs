//! Vertex against triangle and edge against edge: distance, weights and normal.
//!
//! The normal points from the second side to the first. Where the two touch it cannot be read off
//! the closest points: then the triangle's normal, or the edges' cross product, stands in, so
//! that no answer is 0/0.

use toile_geometry::Vec3;
use toile_geometry::closest::{Feature, between_segments, on_triangle};

/// Distances below this, relative to the coordinates, have no direction left in them.
const TOUCHING: f64 = 1e-14;

/// How two small pieces of cloth lie to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proximity {
    /// Weights of the four vertices: the first side's positive, sum zero.
    pub weights: [f64; 4],
    /// Unit normal from the second side to the first.
    pub normal: Vec3,
    /// Distance, never negative.
    pub distance: f64,
}

/// A vertex against a triangle, and the part of the triangle that it is closest to.
pub fn vertex_triangle(v: &Vec3, t: &[Vec3; 3]) -> (Proximity, Feature) {
    let on = on_triangle(v, t);
    let [a, b, c] = on.weights;
    let gap = v - on.point;
    let fallback = || (t[1] - t[0]).cross(&(t[2] - t[0]));
    let normal = direction(&gap, size(&[v, &t[0]]), fallback, &longest(t));
    (Proximity { weights: [1.0, -a, -b, -c], normal, distance: gap.norm() }, on.feature)
}

/// An edge against an edge, and whether both closest points lie between the ends.
pub fn edge_edge(a: &[Vec3; 2], b: &[Vec3; 2]) -> (Proximity, bool) {
    let (s, t) = between_segments(a, b);
    let (da, db) = (a[1] - a[0], b[1] - b[0]);
    let gap = (a[0] + da * s) - (b[0] + db * t);
    let along = if da.norm_squared() >= db.norm_squared() { da } else { db };
    let normal = direction(&gap, size(&[&a[0], &b[0]]), || da.cross(&db), &along);
    let inside = |s: f64| s > 0.0 && s < 1.0;
    (Proximity { weights: [1.0 - s, s, t - 1.0, -t], normal, distance: gap.norm() }, inside(s) && inside(t))
}

fn size(points: &[&Vec3]) -> f64 {
    points.iter().map(|p| p.amax()).fold(0.0, f64::max)
}

fn longest(t: &[Vec3; 3]) -> Vec3 {
    let sides = [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    sides[1..].iter().fold(sides[0], |a, b| if b.norm_squared() > a.norm_squared() { *b } else { a })
}

/// The unit vector of `gap`, of `fallback()` where that is nothing, of anything square to `along`
/// else.
fn direction(gap: &Vec3, size: f64, fallback: impl Fn() -> Vec3, along: &Vec3) -> Vec3 {
    gap.try_normalize(TOUCHING * size)
        .or_else(|| fallback().try_normalize(TOUCHING * along.norm_squared()))
        .unwrap_or_else(|| across(along))
}

/// A unit vector square to `v`; upwards where `v` is nothing.
pub(super) fn across(v: &Vec3) -> Vec3 {
    let mut least = Vec3::zeros();
    least[v.iamin()] = 1.0;
    v.cross(&least).try_normalize(0.0).unwrap_or_else(Vec3::y)
}

#[cfg(test)]
mod tests;
