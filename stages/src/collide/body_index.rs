//! The body's skin: closest points with a sign, and paths that enter it.
//!
//! A static hierarchy over the skin's triangles. The sign of a distance comes from the angle-weighted
//! normal of the closest feature, which is right for faces, edges and vertices alike (Baerentzen
//! & Aanaes 2005); a path is tested by exact signs of volumes, so that it cannot slip between
//! two triangles. Most vertices never reach the hierarchy: a lattice of distances sorts them out.
//!
//! O(log n) a query, about a microsecond on 20,000 triangles. The mesh must have passed
//! [`check_body`](super::check_body).

use super::asked_distances::Distances;
use super::bvh::{Bvh, Corners};
use super::closest::{Feature, OnTriangle, on_triangle};
use super::crossing::volume;
use super::lattice::Lattice;
use super::volume::BoundingVolume;
use rayon::prelude::*;
use toile_core::artifact::{Body, BodyContact, Point3, Surface, Vector3};
use toile_core::{Context, StageError};

/// Triangles a leaf of the static hierarchy.
const LEAF: usize = 4;

/// Distance below which the direction from skin to point is noise and the feature's own normal is
/// taken, metres.
const ON_SKIN: f64 = 1e-9;

/// Vertices that one parallel task takes at least.
const CHUNK: usize = 128;

/// The skin of a body.
#[derive(Debug)]
pub struct BodyIndex<V> {
    positions: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
    bvh: Bvh<V>,
    corners: Vec<Corners>,
    normals: Vec<FeatureNormals>,
    lattice: Lattice,
}

/// The unit pseudo-normals of a triangle's features.
#[derive(Debug, Clone, Copy)]
struct FeatureNormals {
    face: Vector3,
    sides: [Vector3; 3],
    corners: [Vector3; 3],
}

/// The closest point of the skin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnSkin {
    /// The point.
    pub point: Point3,
    /// Outward unit normal: the direction in which the distance grows.
    pub normal: Vector3,
    /// Signed distance, metres, negative inside.
    pub distance: f64,
}

impl<V: BoundingVolume> BodyIndex<V> {
    /// The index of a body that has passed its checks.
    pub fn new(body: &Body, distances: Distances, cx: &Context) -> Result<Self, StageError> {
        let corners: Vec<Corners> =
            body.triangles.iter().map(|t| t.map(|i| body.positions[i as usize])).collect();
        let items = (0..corners.len() as u32).collect();
        let bvh = Bvh::fitted(items, LEAF, |t| corners[t as usize]);
        cx.check()?;
        let normals = feature_normals(&body.triangles, &corners);
        let lattice = Lattice::around(&body.positions);
        let (positions, triangles) = (body.positions.clone(), body.triangles.clone());
        let index = BodyIndex { positions, triangles, bvh, corners, normals, lattice };
        if distances == Distances::Ahead {
            index.lattice.fill(cx, |p, bound| index.distance_within(p, bound))?;
        }
        Ok(index)
    }

    /// The mesh that it was made of.
    pub fn surface(&self) -> Surface<'_> {
        Surface { positions: &self.positions, triangles: &self.triangles }
    }

    /// The closest point of the skin, where it is within `bound` of `p`.
    pub fn closest(&self, p: &Point3, bound: f64) -> Option<OnSkin> {
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
        best.map(|(_, t, on)| self.on_skin(p, t, &on))
    }

    fn distance_within(&self, p: &Point3, bound: f64) -> Option<f64> {
        self.closest(p, bound).map(|s| s.distance)
    }

    fn bounds(&self, p: &Point3) -> Option<(f64, f64)> {
        self.lattice.bounds(p, |p, bound| self.distance_within(p, bound))
    }

    fn on_skin(&self, p: &Point3, t: u32, on: &OnTriangle) -> OnSkin {
        let normals = &self.normals[t as usize];
        let pseudo = match on.feature {
            Feature::Face => normals.face,
            Feature::Side(k) => normals.sides[k as usize],
            Feature::Corner(k) => normals.corners[k as usize],
        };
        let gap = p - on.point;
        let outside = gap.dot(&pseudo) >= 0.0;
        let distance = if outside { gap.norm() } else { -gap.norm() };
        let straight = on.feature == Feature::Face || distance.abs() <= ON_SKIN;
        let normal = if straight { pseudo } else { gap / distance };
        OnSkin { point: on.point, normal, distance }
    }

    /// Signed distance of a point, metres; infinite where it is no finite number.
    pub fn signed_distance(&self, p: &Point3) -> f64 {
        self.closest(p, f64::INFINITY).map_or(f64::INFINITY, |s| s.distance)
    }

    /// The vertices within `reach` of the skin or inside, ascending.
    pub fn contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>) {
        let contact = |(i, p): (usize, &Point3)| {
            let (least, most) = self.bounds(p)?;
            if least > reach {
                return None;
            }
            // The skin is no farther than the lattice says; outside, no farther than it matters.
            let bound = if least > 0.0 { most.min(reach) } else { most.max(-least).max(reach) };
            let on = self.closest(p, bound).filter(|s| s.distance <= reach)?;
            Some(BodyContact { vertex: i as u32, point: on.point, normal: on.normal, distance: on.distance })
        };
        out.extend(collect(positions.par_iter().enumerate().with_min_len(CHUNK).map(contact)));
    }

    /// The first places where paths enter the body, ascending.
    pub fn hits(&self, from: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>) {
        let hit = |(i, (p, q)): (usize, (&Point3, &Point3))| {
            let (least, _) = self.bounds(p)?;
            if least > (q - p).norm() {
                return None;
            }
            let (t, triangle) = self.entry(p, q)?;
            let normal = self.normals[triangle as usize].face;
            Some(BodyContact {
                vertex: i as u32,
                point: p + (q - p) * t,
                normal,
                distance: self.signed_distance(q),
            })
        };
        out.extend(collect(from.par_iter().zip(to).enumerate().with_min_len(CHUNK).map(hit)));
    }

    /// The share of the path at which it first enters, and the triangle it enters through.
    fn entry(&self, p: &Point3, q: &Point3) -> Option<(f64, u32)> {
        if !is_finite(q) {
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
        first
    }
}

/// Gathers what was found in the order of the vertices.
fn collect<I: ParallelIterator<Item = Option<BodyContact>>>(found: I) -> Vec<BodyContact> {
    found.flatten_iter().collect()
}

fn is_finite(p: &Point3) -> bool {
    p.iter().all(|x| x.is_finite())
}

/// The share at which the path from `p` to `q` passes the triangle from its outer side, its rim
/// counted in.
fn entry_share(p: &Point3, q: &Point3, t: &Corners, normal: &Vector3) -> Option<f64> {
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
    let unit = |v: Vector3| v.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    let faces: Vec<Vector3> = corners.iter().map(|[a, b, c]| unit((b - a).cross(&(c - a)))).collect();
    let count = triangles.iter().flatten().max().map_or(0, |&m| m as usize + 1);
    let mut at_vertex = vec![Vector3::zeros(); count];
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
