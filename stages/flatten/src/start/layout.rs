//! Layout by neighbour distances: triangle after triangle, each new vertex from two that are
//! placed.
//!
//! The first step of the published flattening: from a first triangle outwards in breadth, each
//! vertex is placed at its true distances from the two ends of an edge that is placed already; the
//! first triangle that reaches it decides. Exact for developable surfaces, on others the error
//! piles up away from the first triangle, so the triangle nearest the middle is the first. Cost
//! O(n).

use crate::frames::local_edges;
use crate::surface::{FREE, PieceSurface};
use nalgebra::{Point2, Vector2, Vector3};
use std::collections::VecDeque;

/// Flat places in the caller's unit.
#[must_use]
pub(crate) fn neighbour_layout(surface: &PieceSurface) -> Vec<Point2<f64>> {
    let mut flat: Vec<Option<Point2<f64>>> = vec![None; surface.positions().len()];
    let seed = middle_triangle(surface);
    let [a, b, c] = surface.triangles()[seed].map(|v| v as usize);
    let [first, second] = local_edges(surface, seed);
    (flat[a], flat[b], flat[c]) =
        (Some(Point2::origin()), Some(Point2::from(first)), Some(Point2::from(second)));
    let mut seen = vec![false; surface.triangles().len()];
    let mut waiting = VecDeque::from([seed]);
    seen[seed] = true;
    while let Some(t) = waiting.pop_front() {
        for h in 3 * t..3 * t + 3 {
            let o = surface.opposite()[h];
            if o == FREE || seen[o as usize / 3] {
                continue;
            }
            seen[o as usize / 3] = true;
            waiting.push_back(o as usize / 3);
            place_third(surface, o, &mut flat);
        }
    }
    flat.into_iter().map(|p| p.unwrap_or_else(Point2::origin)).collect()
}

/// Places the corner across from half-edge `h`, both ends of which are placed.
fn place_third(surface: &PieceSurface, h: u32, flat: &mut [Option<Point2<f64>>]) {
    let (t, k) = (h as usize / 3, h as usize % 3);
    let [a, b, c] = [k, (k + 1) % 3, (k + 2) % 3].map(|k| surface.triangles()[t][k] as usize);
    let (Some(p), Some(q), None) = (flat[a], flat[b], flat[c]) else { return };
    let x = surface.positions();
    let (along, to) = (x[b] - x[a], x[c] - x[a]);
    let share = to.dot(&along) / along.norm_squared();
    let height = (2.0 * surface.area_vector(t).norm()) / along.norm();
    let edge: Vector2<f64> = q - p;
    let up = Vector2::new(-edge.y, edge.x).try_normalize(0.0).unwrap_or_else(Vector2::y);
    flat[c] = Some(p + edge * share + up * height);
}

/// The triangle nearest the middle of the surface's area.
fn middle_triangle(surface: &PieceSurface) -> usize {
    let centre = |t: usize| {
        let [a, b, c] = surface.triangles()[t].map(|v| surface.positions()[v as usize].coords);
        (a + b + c) / 3.0
    };
    let count = surface.triangles().len();
    let weighted = (0..count).fold(Vector3::zeros(), |s, t| s + centre(t) * surface.area_vector(t).norm());
    let middle = weighted / surface.area();
    let distance = |t: &usize| (centre(*t) - middle).norm_squared();
    (0..count).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}
