//! Distance to a closed mesh, negative inside, and paths that enter it.
//!
//! A tree over the triangles. The sign comes from the angle-weighted normal of the closest feature,
//! which is right for faces, edges and vertices alike (Baerentzen, Aanaes 2005); a path is tested
//! by exact signs of volumes, so that it cannot slip between two triangles. O(log n) a query, about
//! a microsecond on 20,000 triangles; less where the caller knows an upper bound.
//!
//! The mesh must be closed and face outwards; an empty one is far from everything.

use crate::closest::{Feature, OnTriangle, on_triangle};
use crate::crossing::volume;
use crate::tree::Bvh;
use crate::volume::{Aabb, BoundingVolume};
use crate::{Corners, Vec3};

/// Triangles per leaf of the tree: with fewer, testing them all is cheaper than more volumes.
const LEAF: usize = 4;

/// Distance below which the direction from surface to point is noise and the feature's own normal
/// is taken, m.
const ON_SURFACE: f64 = 1e-9;

/// A closed, static triangle mesh whose triangles face outwards.
#[derive(Debug, Clone)]
pub struct SignedDistance<V = Aabb> {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    corners: Vec<Corners>,
    normals: Vec<FeatureNormals>,
    bvh: Bvh<V>,
}

/// The unit pseudo-normals of a triangle's features.
#[derive(Debug, Clone, Copy)]
struct FeatureNormals {
    face: Vec3,
    sides: [Vec3; 3],
    corners: [Vec3; 3],
}

/// Where a point is in relation to the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Distance, m; negative inside.
    pub distance: f64,
    /// Unit direction in which the distance grows.
    pub normal: Vec3,
    /// The closest point of the surface.
    pub point: Vec3,
}

impl Nearest {
    /// What is known of `p` from the closest point and the unit pseudo-normal of the feature that
    /// it lies on, which is the inside of a triangle or not.
    #[must_use]
    pub fn signed(p: &Vec3, point: Vec3, pseudo: Vec3, in_face: bool) -> Self {
        let gap = p - point;
        let outside = gap.dot(&pseudo) >= 0.0;
        let distance = if outside { gap.norm() } else { -gap.norm() };
        let straight = in_face || distance.abs() <= ON_SURFACE;
        let normal = if straight { pseudo } else { gap / distance };
        Nearest { point, normal, distance }
    }
}

/// Where a path first enters the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathEntry {
    /// The share of the path, 0 to 1.
    pub share: f64,
    /// Unit normal of the triangle that it enters through.
    pub normal: Vec3,
}

impl<V: BoundingVolume> SignedDistance<V> {
    /// Builds the tree. Triangles must refer to vertices that exist and are finite.
    #[must_use]
    pub fn new(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        let corners: Vec<Corners> = triangles.iter().map(|t| t.map(|v| vertices[v as usize])).collect();
        let bvh = Bvh::new(&corners, LEAF);
        let normals = feature_normals(&triangles, &corners);
        Self { vertices, triangles, corners, normals, bvh }
    }

    /// Its vertices.
    #[must_use]
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// Its triangles.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The closest point of the surface, where it is within `bound` of `p`; of equals that of the
    /// first triangle.
    #[must_use]
    pub fn nearest(&self, p: &Vec3, bound: f64) -> Option<Nearest> {
        let mut best: Option<(f64, u32, OnTriangle)> = None;
        self.bvh.nearest(p, bound * bound, |t, bound| {
            let on = on_triangle(p, &self.corners[t as usize]);
            let d = (p - on.point).norm_squared();
            let better = best.as_ref().map_or(d <= bound, |b| d < b.0 || (d == b.0 && t < b.1));
            if better {
                best = Some((d, t, on));
            }
            if better { d } else { bound }
        });
        best.map(|(_, t, on)| self.signed(p, t, &on))
    }

    /// Signed distance of a point, m; infinite where it is no finite number or the mesh is empty.
    #[must_use]
    pub fn distance(&self, p: &Vec3) -> f64 {
        self.nearest(p, f64::INFINITY).map_or(f64::INFINITY, |s| s.distance)
    }

    fn signed(&self, p: &Vec3, t: u32, on: &OnTriangle) -> Nearest {
        let normals = &self.normals[t as usize];
        let pseudo = match on.feature {
            Feature::Face => normals.face,
            Feature::Side(k) => normals.sides[k as usize],
            Feature::Corner(k) => normals.corners[k as usize],
        };
        Nearest::signed(p, on.point, pseudo, on.feature == Feature::Face)
    }

    /// Where the path from `p` to `q` first enters; nothing for a path that only leaves, or is no
    /// finite number.
    #[must_use]
    pub fn entry(&self, p: &Vec3, q: &Vec3) -> Option<PathEntry> {
        if !p.iter().chain(q).all(|x| x.is_finite()) {
            return None;
        }
        let mut first: Option<(f64, u32)> = None;
        self.bvh.within(&V::fit(&[*p, *q]), 0.0, |t| {
            let Some(s) = entry_share(p, q, &self.corners[t as usize], &self.normals[t as usize].face) else {
                return;
            };
            if first.is_none_or(|f| (s, t) < f) {
                first = Some((s, t));
            }
        });
        first.map(|(share, t)| PathEntry { share, normal: self.normals[t as usize].face })
    }
}

/// The share at which the path from `p` to `q` passes the triangle with this unit normal from its
/// outer side, its rim counted in; by exact signs of volumes.
#[must_use]
pub fn entry_share(p: &Vec3, q: &Vec3, t: &Corners, normal: &Vec3) -> Option<f64> {
    let [a, b, c] = t;
    // `volume` is positive on the inner side.
    let (vp, vq) = (volume(a, b, c, p), volume(a, b, c, q));
    if vp > 0.0 || vq < 0.0 || (vp == 0.0 && vq == 0.0) {
        return None;
    }
    let around = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    if around.iter().any(|&v| v > 0.0) && around.iter().any(|&v| v < 0.0) {
        return None;
    }
    let (hp, hq) = (normal.dot(&(p - a)), normal.dot(&(q - a)));
    Some(if hp > hq { (hp / (hp - hq)).clamp(0.0, 1.0) } else { 0.0 })
}

/// Face normals, their sums along edges, and their angle-weighted sums at vertices.
fn feature_normals(triangles: &[[u32; 3]], corners: &[Corners]) -> Vec<FeatureNormals> {
    let unit = |v: Vec3| v.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    let faces: Vec<Vec3> = corners.iter().map(|[a, b, c]| unit((b - a).cross(&(c - a)))).collect();
    let count = triangles.iter().flatten().max().map_or(0, |&m| m as usize + 1);
    let mut at_vertex = vec![Vec3::zeros(); count];
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for (t, nodes) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (here, next, last) = (corners[t][k], corners[t][(k + 1) % 3], corners[t][(k + 2) % 3]);
            at_vertex[nodes[k] as usize] += faces[t] * (next - here).angle(&(last - here));
            let (i, j) = (nodes[k], nodes[(k + 1) % 3]);
            edges.push((i.min(j), i.max(j), t, k));
        }
    }
    let mut normals: Vec<FeatureNormals> = (0..triangles.len())
        .map(|t| FeatureNormals {
            face: faces[t],
            sides: [faces[t]; 3],
            corners: triangles[t].map(|i| unit(at_vertex[i as usize])),
        })
        .collect();
    edges.sort_unstable();
    for uses in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let sum = unit(uses.iter().map(|u| faces[u.2]).sum());
        uses.iter().for_each(|u| normals[u.2].sides[u.3] = sum);
    }
    normals
}

#[cfg(test)]
mod tests;
