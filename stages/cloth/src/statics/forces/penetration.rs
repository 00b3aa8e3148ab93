//! Limb penetration test: whether the body passes through the cloth between its vertices.
//!
//! Vertices stay outside the body, but a coarse triangle may be wider than a limb. An arm then
//! passes through its inside, and a finer mesh would be pushed off it on the wrong side. Method: a
//! triangle that a limb passes through reaches the medial axis of the limb (Blum 1967), where the
//! nearest places of the surface lie on opposite sides. A triangle that only dips into a bulge has
//! them on one side. So the normals at the nearest places are compared for a lattice of points on
//! each triangle. Cost: one distance per triangle, and for deep triangles one for every third point
//! of the lattice, and for those other points for which the first ones do not decide. Limits: limbs
//! thinner than twice [`LEAST_RADIUS`].

use crate::contact::collision_surface::CollisionSurface;
use crate::mesh::Sheet;
use crate::statics::forces::clearance::{LEAST_RADIUS, lattice};
use toile_geometry::Vec3;

/// Least depth of a point that may lie near the axis of a limb, m.
const DEEP: f64 = 0.5 * LEAST_RADIUS;

/// Cosine of the angle between the surface's normals on both sides of a limb's axis, at most: 120
/// degrees, over which a chord of a circle hangs half of its radius deep.
const OPPOSED: f64 = -0.5;

/// One of so many points of a lattice is evaluated first.
const EVERY: usize = 3;

/// A point of the lattice of a triangle.
#[derive(Clone, Copy)]
struct Spot {
    /// The index of the triangle.
    of: usize,
    at: Vec3,
}

/// The number of triangles with all vertices outside the body that a limb passes through.
#[must_use]
pub(crate) fn pierced(sheet: &Sheet, body: &dyn CollisionSurface, x: &[Vec3]) -> usize {
    let hanging = hanging(sheet, body, x);
    let (first, mut rest) = spots(&hanging);
    let mut known = depths(&hanging, body, &first);
    rest.retain(|s| known[s.of].iter().all(|(at, depth, _)| depth + (s.at - at).norm() > DEEP));
    let more = depths(&hanging, body, &rest);
    known.iter_mut().zip(more).for_each(|(k, m)| k.extend(m));
    known.iter().filter(|k| is_pierced(k)).count()
}

/// The lattices of some triangles: every third point, and the others.
fn spots(triangles: &[[Vec3; 3]]) -> (Vec<Spot>, Vec<Spot>) {
    let (mut first, mut rest) = (Vec::new(), Vec::new());
    for (of, corners) in triangles.iter().enumerate() {
        let mut count = 0;
        lattice(corners, |at| {
            let to = if count % EVERY == 0 { &mut first } else { &mut rest };
            to.push(Spot { of, at });
            count += 1;
        });
    }
    (first, rest)
}

/// A place, its depth in the body (m), and the direction out of the body.
type Depth = (Vec3, f64, Vec3);

/// The depths of the points of each triangle; for points far outside, a bound.
fn depths(triangles: &[[Vec3; 3]], body: &dyn CollisionSurface, spots: &[Spot]) -> Vec<Vec<Depth>> {
    let places: Vec<Vec3> = spots.iter().map(|s| s.at).collect();
    let reaches: Vec<f64> = triangles.iter().map(|t| 2.0 * radius(t)).collect();
    let within: Vec<f64> = spots.iter().map(|s| reaches[s.of]).collect();
    let mut of = vec![Vec::new(); triangles.len()];
    for (s, near) in spots.iter().zip(body.nearest(&places, &within)) {
        let (depth, out) = near.map_or((-reaches[s.of], Vec3::zeros()), |n| (-n.distance, n.normal));
        of[s.of].push((s.at, depth, out));
    }
    of
}

/// The corners of triangles that may reach deep into the body.
fn hanging(sheet: &Sheet, body: &dyn CollisionSurface, x: &[Vec3]) -> Vec<[Vec3; 3]> {
    let wide = sheet.triangles().iter().map(|t| t.map(|v| x[v as usize])).filter(|t| radius(t) > 2.0 * DEEP);
    let wide: Vec<[Vec3; 3]> = wide.collect();
    let (middles, reach): (Vec<Vec3>, Vec<f64>) = wide.iter().map(|t| (middle(t), radius(t))).unzip();
    let near = body.nearest(&middles, &reach);
    let deep = |i: &usize| near[*i].as_ref().is_some_and(|n| n.distance < reach[*i] - DEEP);
    (0..wide.len()).filter(deep).map(|i| wide[i]).collect()
}

/// Whether the nearest places of points of a triangle lie on opposite sides.
fn is_pierced(points: &[Depth]) -> bool {
    let deep: Vec<Vec3> = points.iter().filter(|(_, depth, _)| *depth > DEEP).map(|(.., out)| *out).collect();
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
