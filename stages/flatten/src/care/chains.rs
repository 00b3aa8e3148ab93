//! Boundary loops cut into chains at corners and seam ends.

use crate::surface::PieceSurface;
use nalgebra::Point2;
use std::f64::consts::PI;

/// Cuts every boundary loop of a flat piece at vertices whose inner angle differs from a straight
/// line by more than `corner` (radians), and at `ends`. Chains are open, both ends in them, the
/// piece on their left; a loop without any cut is one chain that ends where it begins.
#[must_use]
pub fn boundary_chains(
    surface: &PieceSurface,
    flat: &[Point2<f64>],
    ends: &[u32],
    corner: f64,
) -> Vec<Vec<u32>> {
    let mut is_end = corner_vertices(surface, flat, corner);
    ends.iter().for_each(|&v| is_end[v as usize] = true);
    let cuts = |v: u32| is_end[v as usize];
    surface.loops().iter().flat_map(|vertices| cut_loop(vertices, cuts)).collect()
}

/// For each vertex whether it is a boundary vertex with an inner angle that differs from a straight
/// line by more than `corner`.
pub(super) fn corner_vertices(surface: &PieceSurface, flat: &[Point2<f64>], corner: f64) -> Vec<bool> {
    let angles = inner_angles(surface, flat);
    let mut is_corner = vec![false; flat.len()];
    for &v in surface.loops().iter().flatten() {
        is_corner[v as usize] = (angles[v as usize] - PI).abs() > corner;
    }
    is_corner
}

fn cut_loop(vertices: &[u32], cuts: impl Fn(u32) -> bool) -> Vec<Vec<u32>> {
    let first = vertices.iter().position(|&v| cuts(v)).unwrap_or(0);
    let mut chains = Vec::new();
    let mut chain = vec![vertices[first]];
    for k in 1..=vertices.len() {
        let v = vertices[(first + k) % vertices.len()];
        chain.push(v);
        if cuts(v) || k == vertices.len() {
            chains.push(std::mem::replace(&mut chain, vec![v]));
        }
    }
    chains
}

/// The sum of the angles of the triangles at each vertex.
fn inner_angles(surface: &PieceSurface, flat: &[Point2<f64>]) -> Vec<f64> {
    let mut angles = vec![0.0; flat.len()];
    for corners in surface.triangles() {
        for k in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|i| corners[(k + i) % 3] as usize);
            let (u, v) = (flat[b] - flat[a], flat[c] - flat[a]);
            angles[a] += u.perp(&v).atan2(u.dot(&v));
        }
    }
    angles
}
