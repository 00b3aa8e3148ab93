//! Triangles that cross.
//!
//! Two of one mesh cross where an edge of one pierces the inside of the other, the edge and the
//! pierced triangle sharing no node. One crosses one of another mesh where their insides have a
//! segment in common and their planes differ. Decided by exact signs of volumes (Shewchuk 1997), so
//! that neither rounding nor scale matters; touching and coplanar triangles do not cross. Cost: a
//! tree of boxes over the smaller mesh, O(log n) a triangle of the other.

use crate::tree::Bvh;
use crate::volume::{Aabb, BoundingVolume};
use crate::{Corners, Vec3};
use rayon::prelude::*;
use robust::{Coord3D, orient3d};

/// Triangles a leaf of the tree of [`between_meshes`].
const LEAF: usize = 2;

/// An end nearer than this to a triangle's plane lies in it for [`pierces_clearly`], m.
const FLAT: f64 = 1e-9;

/// Triangles that one parallel task of [`between_meshes`] looks after.
const CHUNK: usize = 256;

/// A mesh: vertices and triangles.
pub type LentMesh<'a> = (&'a [Vec3], &'a [[u32; 3]]);

/// Pairs of a triangle of one mesh and one of the other that cross, in this order, ascending.
/// Triangles with a vertex that is no finite number are in none.
#[must_use]
pub fn between_meshes(one: LentMesh<'_>, other: LentMesh<'_>) -> Vec<[u32; 2]> {
    let (one, other) = (finite_triangles(one), finite_triangles(other));
    let mut pairs = match one.len() <= other.len() {
        true => crossings_of(&one, &other),
        false => crossings_of(&other, &one).into_iter().map(|[b, c]| [c, b]).collect(),
    };
    pairs.sort_unstable();
    pairs
}

/// The corners of each triangle, with its number.
fn finite_triangles((vertices, triangles): LentMesh<'_>) -> Vec<(u32, Corners)> {
    let corners = triangles.iter().map(|t| t.map(|i| vertices[i as usize]));
    (0..).zip(corners).filter(|(_, t)| t.iter().all(|p| p.iter().all(|x| x.is_finite()))).collect()
}

/// Pairs that cross, one of each mesh; the tree is over the first.
fn crossings_of(few: &[(u32, Corners)], many: &[(u32, Corners)]) -> Vec<[u32; 2]> {
    let corners: Vec<Corners> = few.iter().map(|f| f.1).collect();
    let tree = Bvh::<Aabb>::new(&corners, LEAF);
    let found = |(number, corners): &(u32, Corners)| {
        let (around, mut pairs) = (Aabb::fit(corners), Vec::new());
        tree.within(&around, 0.0, |i| {
            let (other, own) = &few[i as usize];
            if Aabb::fit(own).near(&around, 0.0) && insides_cross(own, corners) {
                pairs.push([*other, *number]);
            }
        });
        pairs
    };
    many.par_iter().with_min_len(CHUNK).flat_map_iter(found).collect()
}

/// True where the insides of two triangles have a segment in common and their planes differ.
///
/// Guigue, Devillers 2003: each must have corners on both sides of the other's plane; then both
/// meet the line in which the planes meet in an interval, and the intervals overlap where two more
/// volumes have the right sign.
#[must_use]
pub fn insides_cross(a: &Corners, b: &Corners) -> bool {
    let Some((a, is_inner)) = lone_corner_first(a, b) else { return false };
    let Some((b, is_inner_b)) = lone_corner_first(b, &a) else { return false };
    // Each looks at the other's lone corner from outside.
    let turned = |t: Corners, turn: bool| if turn { [t[0], t[2], t[1]] } else { t };
    let (a, b) = (turned(a, is_inner_b), turned(b, is_inner));
    volume(&a[0], &a[1], &b[0], &b[1]) > 0.0 && volume(&a[0], &a[2], &b[2], &b[0]) > 0.0
}

/// The triangle's corners in their order from the one that is alone on its side of the plane of
/// `other`, and whether that is the inner side; `None` where not both sides have a corner.
fn lone_corner_first(t: &Corners, other: &Corners) -> Option<(Corners, bool)> {
    let [o, p, q] = other;
    let side = t.map(|corner| volume(o, p, q, &corner));
    let (inner, outer) = (side.map(|s| s > 0.0), side.map(|s| s < 0.0));
    let only = |is: [bool; 3]| match is {
        [true, false, false] => Some(0),
        [false, true, false] => Some(1),
        [false, false, true] => Some(2),
        _ => None,
    };
    if !inner.contains(&true) || !outer.contains(&true) {
        return None;
    }
    let (k, is_inner) = only(inner).map(|k| (k, true)).or_else(|| only(outer).map(|k| (k, false)))?;
    Some(([t[k], t[(k + 1) % 3], t[(k + 2) % 3]], is_inner))
}

/// True where an edge of one triangle pierces the other.
#[must_use]
pub fn cross(positions: &[Vec3], a: &[u32; 3], b: &[u32; 3]) -> bool {
    let corners = |t: &[u32; 3]| t.map(|i| positions[i as usize]);
    cross_at(a, &corners(a), b, &corners(b))
}

/// The same of two triangles by their nodes and corners: nodes of equal numbers are joined, whether
/// or not they are in the very same place.
#[must_use]
pub fn cross_at(a: &[u32; 3], pa: &Corners, b: &[u32; 3], pb: &Corners) -> bool {
    let shared = a.iter().filter(|i| b.contains(i)).count();
    // With two nodes in common every edge of one shares a node with the other.
    if shared > 1 {
        return false;
    }
    if !pa.iter().chain(pb).all(|p| p.iter().all(|x| x.is_finite())) {
        return false;
    }
    Aabb::fit(pa).near(&Aabb::fit(pb), 0.0)
        && (any_edge_pierces(a, pa, b, pb) || any_edge_pierces(b, pb, a, pa))
}

fn any_edge_pierces(a: &[u32; 3], pa: &Corners, b: &[u32; 3], pb: &Corners) -> bool {
    (0..3).any(|k| {
        let next = (k + 1) % 3;
        !b.contains(&a[k]) && !b.contains(&a[next]) && pierces(&pa[k], &pa[next], pb)
    })
}

/// True where the open segment from `p` to `q` passes through the inside of the triangle `t`.
#[must_use]
pub fn pierces(p: &Vec3, q: &Vec3, t: &Corners) -> bool {
    let [a, b, c] = t;
    let (sp, sq) = (volume(a, b, c, p), volume(a, b, c, q));
    if sp == 0.0 || sq == 0.0 || (sp > 0.0) == (sq > 0.0) {
        return false;
    }
    let (s1, s2, s3) = (volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a));
    (s1 > 0.0 && s2 > 0.0 && s3 > 0.0) || (s1 < 0.0 && s2 < 0.0 && s3 < 0.0)
}

/// True where the open segment from `p` to `q` passes through the inside of the triangle `t` and
/// neither end lies in its plane but for rounding ([`FLAT`]): in doubles, for cloth that lies flat
/// and does not cross itself.
#[must_use]
pub fn pierces_clearly(p: &Vec3, q: &Vec3, [a, b, c]: &Corners) -> bool {
    let volume = |o: &Vec3, u: &Vec3, v: &Vec3, w: &Vec3| (u - o).dot(&(v - o).cross(&(w - o)));
    let area = (b - a).cross(&(c - a)).norm();
    let (under, over) = (volume(p, a, b, c), volume(q, a, b, c));
    if under * over >= 0.0 || under.abs().min(over.abs()) < FLAT * area {
        return false;
    }
    let sides = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)
}

/// Where the way from `p` to `q` passes through a triangle, its rim counted in; in doubles.
#[must_use]
pub fn passing(p: &Vec3, q: &Vec3, [a, b, c]: &Corners) -> Option<Vec3> {
    let volume = |a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3| (b - a).cross(&(c - a)).dot(&(d - a));
    let (start, end) = (volume(a, b, c, p), volume(a, b, c, q));
    if start * end >= 0.0 {
        return None;
    }
    let around = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    let passes = around.iter().all(|v| *v >= 0.0) || around.iter().all(|v| *v <= 0.0);
    passes.then(|| p + (q - p) * (start / (start - end)))
}

/// Six times the volume of a tetrahedron, of exact sign: positive where `d` sees a, b, c clockwise.
#[must_use]
pub fn volume(a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3) -> f64 {
    let coord = |p: &Vec3| Coord3D { x: p.x, y: p.y, z: p.z };
    orient3d(coord(a), coord(b), coord(c), coord(d))
}

#[cfg(test)]
mod tests;
