//! Triangles of the cloth that cross each other.
//!
//! A pair crosses where an edge of one pierces the inside of the other, the edge and the pierced
//! triangle sharing no node. Decided by exact signs of volumes (Shewchuk 1997), so that neither
//! rounding nor scale matters; touching and coplanar triangles do not cross.

use super::cloth_tree::ClothTree;
use super::volume::{Aabb, BoundingVolume};
use robust::{Coord3D, orient3d};
use toile_core::artifact::Point3;

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
