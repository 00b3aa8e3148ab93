//! Whether the body comes through the cloth between its vertices.
//!
//! Vertices stay outside the body, but a coarse triangle may be wider than a limb: an arm then comes through its inside, and
//! a finer mesh would be pushed off it on the wrong side. A triangle that only sags into a bulge sees the body's surface on one side; one that a
//! limb comes through reaches the limb's axis (the medial axis, Blum 1967), from where the surface is as near on all sides.
//! So the nearest places of the surface are looked up for a lattice of points on each triangle. Cost: one distance a triangle, and a
//! lattice for those that hang deep. Limits: limbs thinner than twice [`LEAST_RADIUS`].

use super::clear::{LEAST_RADIUS, lattice};
use crate::contact::skin::Skin;
use crate::mesh::Sheet;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Points deeper than this may lie near a limb's axis, m; what lies nearer to an edge of the body has sagged over it.
const DEEP: f64 = 0.5 * LEAST_RADIUS;

/// Cosine of the angle between the surface's normals on both sides of a limb's axis, at most: 120 degrees, over which a
/// chord of a circle hangs half of its radius deep.
const OPPOSED: f64 = -0.5;

/// Triangles with all vertices outside the body that a limb comes through.
#[must_use]
pub(super) fn pierced(sheet: &Sheet, body: &dyn Skin, x: &[Vec3]) -> usize {
    let hanging = hanging(sheet, body, x);
    hanging.iter().filter(|corners| is_pierced(corners, body)).count()
}

/// The corners of triangles that may reach deep into the body.
fn hanging(sheet: &Sheet, body: &dyn Skin, x: &[Vec3]) -> Vec<[Vec3; 3]> {
    let wide = sheet.triangles().iter().map(|t| t.map(|v| x[v as usize])).filter(|t| radius(t) > 2.0 * DEEP);
    let wide: Vec<[Vec3; 3]> = wide.collect();
    let (middles, reach): (Vec<Vec3>, Vec<f64>) = wide.iter().map(|t| (middle(t), radius(t))).unzip();
    let near = body.nearest(&middles, &reach);
    let deep = |i: &usize| near[*i].as_ref().is_some_and(|n| n.distance < reach[*i] - DEEP);
    (0..wide.len()).filter(deep).map(|i| wide[i]).collect()
}

/// Whether the surface is nearest on opposite sides for points of a triangle.
fn is_pierced(corners: &[Vec3; 3], body: &dyn Skin) -> bool {
    let mut points = Vec::new();
    lattice(corners, |p| points.push(p));
    let found = body.nearest(&points, &vec![2.0 * radius(corners); points.len()]);
    let deep: Vec<Vec3> = found.iter().flatten().filter(|n| n.distance < -DEEP).map(|n| n.normal).collect();
    deep.iter().enumerate().any(|(i, a)| deep[..i].iter().any(|b| a.dot(b) < OPPOSED))
}

fn middle([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (a + b + c) / 3.0
}

/// The farthest corner from the middle, m.
fn radius(corners: &[Vec3; 3]) -> f64 {
    let middle = middle(corners);
    corners.iter().map(|c| (c - middle).norm()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
