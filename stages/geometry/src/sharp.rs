//! Edges and corners of a body that are too sharp for distances of single points to keep cloth off
//! them.
//!
//! A vertex of the cloth is held off by its distance from the surface, and so is the cloth between
//! its vertices where the surface bends gently. An edge of a table, a blade or the tip of a cone
//! comes through between them. These features are found once, from the angles of the mesh, and each
//! knows on which side of it a point lies: outside where its closest point of the surface is on the
//! feature (the point is in the feature's normal cone), inside where the point is hidden behind all
//! faces that meet there.
//!
//! Cost: O(n) for the body's triangles, of which only those about vertices where the surface bends
//! are looked at edge by edge; O(log m) for a look at the m features. Limits: a rounded edge of
//! many small angles is none.

use crate::pair::Kind;
use crate::tree::Bvh;
use crate::volume::{Aabb, BoundingVolume};

use crate::{Corners, Vec3};

/// Features in a leaf of the tree.
const LEAF: usize = 4;

/// Cosine of the angle between the normals of two faces from which on their edge is sharp: 44
/// degrees, less than in a prism of eight sides and more than in all but some hundred edges of a
/// mannequin.
const SHARP_EDGE: f64 = 0.719;

/// Cosine of the angle between a face and the mean of all about a corner from which on that is
/// sharp: 45 degrees; a corner of a box has 55.
const SHARP_CORNER: f64 = 0.707;

/// Cosine of half the angle of a sharp edge, and a little less: a vertex of whose faces none stands
/// farther from their mean has no sharp edge, for of two faces one stands from any direction at
/// least half as far as they stand from each other.
const BENDS: f64 = 0.9275;

/// Cosine of the angle from which on an edge of a sharp corner counts: 1 degree.
const BENT: f64 = 0.9998;

/// Share of its distance by which a point may lie beyond a normal cone and still count as in it.
const LENIENT: f64 = 0.02;

/// A sharp edge or corner.
#[derive(Debug, Clone, PartialEq)]
pub struct SharpFeature {
    /// Whether it meets edges of the cloth, or, a corner, its triangles.
    pub kind: Kind,
    /// Its two ends; of a corner the same place.
    pub ends: [Vec3; 2],
    /// Unit directions from it into the surface: into the two faces, or along the edges of a
    /// corner.
    pub into: Vec<Vec3>,
}

/// Where a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Outside, where the feature is the closest part of the surface.
    Out,
    /// Behind every face that meets there.
    In,
    /// Anywhere else.
    Beside,
}

/// The sharp features of a body.
#[derive(Debug, Clone)]
pub struct Sharp {
    features: Vec<SharpFeature>,
    bvh: Bvh<Aabb>,
}

impl SharpFeature {
    /// Where the point lies that is `off` from the closest point of the feature.
    #[must_use]
    pub fn side(&self, off: &Vec3) -> Side {
        let lenient = LENIENT * off.norm();
        let (mut out, mut hidden) = (true, true);
        for into in &self.into {
            let along = into.dot(off);
            out &= along <= lenient;
            hidden &= along > 0.0;
        }
        match (out, hidden) {
            (true, _) => Side::Out,
            (false, true) => Side::In,
            (false, false) => Side::Beside,
        }
    }
}

impl Sharp {
    /// The sharp features of a closed mesh that faces outwards; `None` where there are none.
    #[must_use]
    pub fn of(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Option<Self> {
        let features = features(vertices, triangles);
        if features.is_empty() {
            return None;
        }
        let corners: Vec<Corners> = features.iter().map(|f| [f.ends[0], f.ends[1], f.ends[1]]).collect();
        let bvh = Bvh::new(&corners, LEAF);
        Some(Self { features, bvh })
    }

    /// A feature.
    #[must_use]
    pub fn feature(&self, k: u32) -> &SharpFeature {
        &self.features[k as usize]
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.features.len()
    }

    /// Whether any feature's box meets that from `low` to `high`.
    #[must_use]
    pub fn meets(&self, low: &Vec3, high: &Vec3) -> bool {
        let mut any = false;
        for kind in [Kind::EdgeEdge, Kind::VertexTriangle] {
            self.within(kind, low, high, |_| any = true);
        }
        any
    }

    /// Visits every feature of a kind whose box meets that from `low` to `high`, in the order of
    /// the tree.
    pub fn within(&self, kind: Kind, low: &Vec3, high: &Vec3, mut visit: impl FnMut(u32)) {
        let around = Aabb { min: *low, max: *high };
        self.bvh.within(&around, 0.0, |f| {
            let feature = &self.features[f as usize];
            if feature.kind == kind && Aabb::fit(&feature.ends).near(&around, 0.0) {
                visit(f);
            }
        });
    }
}

/// An edge of the mesh: its ends, the lower one first, and the corners across it.
struct MeshEdge {
    ends: [u32; 2],
    across: [u32; 2],
    /// Cosine of the angle between its faces; less than 1 only where they bend outwards.
    cosine: f64,
}

fn features(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Vec<SharpFeature> {
    let place = |v: u32| vertices[v as usize];
    let face = |t: &[u32; 3]| {
        let [a, b, c] = t.map(place);
        (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default()
    };
    let faces: Vec<Vec3> = triangles.iter().map(face).collect();
    let means = means(vertices.len(), triangles, &faces);
    let bends = far_from_mean(triangles, &faces, &means, BENDS);
    if !bends.contains(&true) {
        return Vec::new();
    }
    let edges = edges(vertices, triangles, &faces, &bends);
    let mut corner = far_from_mean(triangles, &faces, &means, SHARP_CORNER);
    let at_corner = |e: &MeshEdge| e.ends.iter().any(|&v| corner[v as usize]);
    let sharp: Vec<bool> =
        edges.iter().map(|e| e.cosine < SHARP_EDGE || e.cosine < BENT && at_corner(e)).collect();
    for (e, _) in edges.iter().zip(&sharp).filter(|(_, s)| **s) {
        e.ends.iter().for_each(|&v| corner[v as usize] = true);
    }
    let mut sides: Vec<Vec<Vec3>> = vec![Vec::new(); if corner.contains(&true) { vertices.len() } else { 0 }];
    for e in edges.iter().filter(|e| e.ends.iter().any(|&v| corner[v as usize])) {
        let along = (place(e.ends[1]) - place(e.ends[0])).try_normalize(0.0).unwrap_or_default();
        sides[e.ends[0] as usize].push(along);
        sides[e.ends[1] as usize].push(-along);
    }
    let ridge = |e: &MeshEdge| {
        let ends = e.ends.map(place);
        let along = (ends[1] - ends[0]).try_normalize(0.0).unwrap_or_default();
        let into = |v: u32| {
            let way = place(v) - ends[0];
            (way - along * along.dot(&way)).try_normalize(0.0).unwrap_or_default()
        };
        SharpFeature { kind: Kind::EdgeEdge, ends, into: e.across.map(into).to_vec() }
    };
    let ridges = edges.iter().zip(&sharp).filter(|(_, s)| **s).map(|(e, _)| ridge(e));
    let tip = |v: usize| SharpFeature {
        kind: Kind::VertexTriangle,
        ends: [vertices[v]; 2],
        into: std::mem::take(&mut sides[v]),
    };
    let mut all: Vec<SharpFeature> = ridges.collect();
    all.extend((0..vertices.len()).filter(|&v| corner[v]).map(tip));
    all
}

/// The sums of the normals of all faces about each vertex.
fn means(count: usize, triangles: &[[u32; 3]], faces: &[Vec3]) -> Vec<Vec3> {
    let mut means = vec![Vec3::zeros(); count];
    for (t, n) in triangles.iter().zip(faces) {
        t.iter().for_each(|&v| means[v as usize] += n);
    }
    means
}

/// Vertices of which a face stands farther from the mean of all than an angle whose cosine is
/// `least`.
fn far_from_mean(triangles: &[[u32; 3]], faces: &[Vec3], means: &[Vec3], least: f64) -> Vec<bool> {
    let bounds: Vec<f64> = means.iter().map(|m| least * m.norm()).collect();
    let mut far = vec![false; means.len()];
    for (t, n) in triangles.iter().zip(faces) {
        for v in t.map(|v| v as usize) {
            far[v] |= means[v].dot(n) <= bounds[v];
        }
    }
    far
}

/// The edges of two faces each with an end of those `asked`, in the order of their lower ends.
fn edges(vertices: &[Vec3], triangles: &[[u32; 3]], faces: &[Vec3], asked: &[bool]) -> Vec<MeshEdge> {
    let mut halves = Vec::new();
    for (f, t) in triangles.iter().enumerate().filter(|(_, t)| t.iter().any(|&v| asked[v as usize])) {
        for k in 0..3 {
            let (a, b, across) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            if asked[a as usize] || asked[b as usize] {
                halves.push((a.min(b), a.max(b), f as u32, across));
            }
        }
    }
    halves.sort_unstable();
    let mut all = Vec::with_capacity(halves.len() / 2);
    for pair in halves.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let [(low, high, f, v), (_, _, g, w)] = *pair else { continue };
        let (n, m) = (&faces[f as usize], &faces[g as usize]);
        let is_convex = n.dot(&(vertices[w as usize] - vertices[low as usize])) < 0.0;
        let cosine = if is_convex { n.dot(m) } else { 1.0 };
        all.push(MeshEdge { ends: [low, high], across: [v, w], cosine });
    }
    all
}

#[cfg(test)]
mod tests;
