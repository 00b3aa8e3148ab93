//! Triangles of the cloth that cross each other or the body.
//!
//! A pair of the cloth's crosses where an edge of one pierces the inside of the other, the edge and
//! the pierced triangle sharing no node. A triangle of the cloth crosses one of the body where their
//! insides have a segment in common and their planes differ. Decided by exact signs of volumes
//! (Shewchuk 1997), so that neither rounding nor scale matters; touching and coplanar triangles do
//! not cross. Cost: a tree of boxes over the smaller mesh, O(log n) a triangle of the other.

use super::bvh::Bvh;
use super::cloth_tree::ClothTree;
use super::volume::{Aabb, BoundingVolume};
use rayon::prelude::*;
use robust::{Coord3D, orient3d};
use toile_core::artifact::{Body, Point3};

/// Triangles a leaf of the tree of [`body_crossings`].
const LEAF: usize = 2;

/// Triangles that one parallel task of [`body_crossings`] looks after.
const CHUNK: usize = 256;

/// Pairs of triangles that cross, lower index first, ascending.
pub(super) fn crossings<V: BoundingVolume>(tree: &ClothTree<V>, positions: &[Point3]) -> Vec<[u32; 2]> {
    let (mut pairs, _) = tree.bvh.self_pairs(0.0, |a, b, out| {
        let (ta, tb) = (&tree.triangles[a as usize], &tree.triangles[b as usize]);
        if cross(positions, ta, tb) {
            out.push([a, b]);
        }
    });
    pairs.sort_unstable();
    pairs
}

/// Pairs of a triangle of the cloth and one of the body that cross, in this order, ascending. Triangles
/// with a vertex that is no finite number are in none.
pub fn body_crossings(positions: &[Point3], triangles: &[[u32; 3]], body: &Body) -> Vec<[u32; 2]> {
    let cloth = finite_triangles(positions, triangles);
    let body = finite_triangles(&body.positions, &body.triangles);
    let mut pairs = match cloth.len() <= body.len() {
        true => crossings_of(&cloth, &body),
        false => crossings_of(&body, &cloth).into_iter().map(|[b, c]| [c, b]).collect(),
    };
    pairs.sort_unstable();
    pairs
}

/// The corners of each triangle, with its number.
fn finite_triangles(positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<(u32, [Point3; 3])> {
    let corners = triangles.iter().map(|t| t.map(|i| positions[i as usize]));
    (0..).zip(corners).filter(|(_, t)| t.iter().all(|p| p.iter().all(|x| x.is_finite()))).collect()
}

/// Pairs that cross, one of each mesh; the tree is over the first.
fn crossings_of(few: &[(u32, [Point3; 3])], many: &[(u32, [Point3; 3])]) -> Vec<[u32; 2]> {
    let tree = Bvh::<Aabb>::merged((0..few.len() as u32).collect(), LEAF, |i| few[i as usize].1);
    let found = |(number, corners): &(u32, [Point3; 3])| {
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
/// Guigue, Devillers 2003: each must have corners on both sides of the other's plane; then both meet
/// the line in which the planes meet in an interval, and the intervals overlap where two more volumes
/// have the right sign.
pub fn insides_cross(a: &[Point3; 3], b: &[Point3; 3]) -> bool {
    let Some((a, is_inner)) = lone_corner_first(a, b) else { return false };
    let Some((b, is_inner_b)) = lone_corner_first(b, &a) else { return false };
    // Each looks at the other's lone corner from outside.
    let turned = |t: [Point3; 3], turn: bool| if turn { [t[0], t[2], t[1]] } else { t };
    let (a, b) = (turned(a, is_inner_b), turned(b, is_inner));
    volume(&a[0], &a[1], &b[0], &b[1]) > 0.0 && volume(&a[0], &a[2], &b[2], &b[0]) > 0.0
}

/// The triangle's corners in their order from the one that is alone on its side of the plane of `other`,
/// and whether that is the inner side; `None` where not both sides have a corner.
fn lone_corner_first(t: &[Point3; 3], other: &[Point3; 3]) -> Option<([Point3; 3], bool)> {
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
pub fn cross(positions: &[Point3], a: &[u32; 3], b: &[u32; 3]) -> bool {
    let shared = a.iter().filter(|i| b.contains(i)).count();
    // With two nodes in common every edge of one shares a node with the other.
    if shared > 1 {
        return false;
    }
    let corners = |t: &[u32; 3]| t.map(|i| positions[i as usize]);
    let (pa, pb) = (corners(a), corners(b));
    if !pa.iter().chain(&pb).all(|p| p.iter().all(|x| x.is_finite())) {
        return false;
    }
    Aabb::fit(&pa).near(&Aabb::fit(&pb), 0.0)
        && (any_edge_pierces(a, &pa, b, &pb) || any_edge_pierces(b, &pb, a, &pa))
}

fn any_edge_pierces(a: &[u32; 3], pa: &[Point3; 3], b: &[u32; 3], pb: &[Point3; 3]) -> bool {
    (0..3).any(|k| {
        let next = (k + 1) % 3;
        !b.contains(&a[k]) && !b.contains(&a[next]) && pierces(&pa[k], &pa[next], pb)
    })
}

/// True where the open segment from `p` to `q` passes through the inside of the triangle `t`.
pub fn pierces(p: &Point3, q: &Point3, t: &[Point3; 3]) -> bool {
    let [a, b, c] = t;
    let (sp, sq) = (volume(a, b, c, p), volume(a, b, c, q));
    if sp == 0.0 || sq == 0.0 || (sp > 0.0) == (sq > 0.0) {
        return false;
    }
    let (s1, s2, s3) = (volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a));
    (s1 > 0.0 && s2 > 0.0 && s3 > 0.0) || (s1 < 0.0 && s2 < 0.0 && s3 < 0.0)
}

/// Six times the volume of a tetrahedron, of exact sign: positive where `d` sees a, b, c clockwise.
pub(super) fn volume(a: &Point3, b: &Point3, c: &Point3, d: &Point3) -> f64 {
    let coord = |p: &Point3| Coord3D { x: p.x, y: p.y, z: p.z };
    orient3d(coord(a), coord(b), coord(c), coord(d))
}

#[cfg(test)]
mod tests;
