//! The body that wears the garment.

use super::{Artifact, ArtifactType, Hand, Kind, Measures, Point3, Vector3};
use crate::artifact::store::sound::{ensure, finite, finite_figure, indices};
use std::collections::BTreeMap;

/// A named point on the body's skin or skeleton.
pub type Landmark = Point3;

/// A closed triangle mesh with outward normals, metres, Y up, feet at 0, facing +Z; the wearer's
/// left is +X.
///
/// Landmarks that placement relies on: `neck_base_front`, `neck_base_back`, `neck_left`,
/// `neck_right` (where a shoulder seam meets the neck), `shoulder_left`, `shoulder_right` (the
/// shoulder's outer point), `armpit_left`, `armpit_right`, `elbow_left`, `elbow_right`,
/// `wrist_left`, `wrist_right`, `bust_front`, `bust_back`, `waist_front`, `waist_back`,
/// `hip_front`, `hip_back`, `crotch`.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Vertices, metres.
    pub positions: Vec<Point3>,
    /// Triangles, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Named points.
    pub landmarks: BTreeMap<String, Landmark>,
    /// Named lengths, metres: `height`, `bust`, `waist`, `hip`, ...
    pub measurements: BTreeMap<String, f64>,
}

impl Body {
    /// A landmark that it has on both sides: `neck`, `shoulder`, `armpit`, `elbow` or `wrist`.
    pub fn landmark(&self, name: &str, hand: Hand) -> Option<Landmark> {
        self.landmarks.get(&hand.name(name)).copied()
    }

    /// Enclosed volume, cubic metres (divergence theorem).
    pub fn volume(&self) -> f64 {
        self.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| self.positions[i as usize].coords);
                a.dot(&b.cross(&c)) / 6.0
            })
            .sum()
    }

    /// Area-weighted unit normals of the vertices.
    pub fn vertex_normals(&self) -> Vec<Vector3> {
        vertex_normals(&self.positions, &self.triangles)
    }
}

/// Area-weighted unit vertex normals; zero where a vertex has no triangle.
pub(crate) fn vertex_normals(positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<Vector3> {
    let mut normals = vec![Vector3::zeros(); positions.len()];
    for t in triangles {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let n = (b - a).cross(&(c - a));
        t.iter().for_each(|&i| normals[i as usize] += n);
    }
    normals.into_iter().map(|n| n.try_normalize(0.0).unwrap_or_else(Vector3::zeros)).collect()
}

/// Vertices and triangles as Wavefront OBJ text.
pub(crate) fn obj_text(positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<u8> {
    use std::fmt::Write;
    let mut s = String::from("# metres, Y up\n");
    for p in positions {
        let _ = writeln!(s, "v {} {} {}", p.x, p.y, p.z);
    }
    for t in triangles {
        let _ = writeln!(s, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    s.into_bytes()
}

impl ArtifactType for Body {
    const KIND: Kind = Kind("body");
    const IN_SETS: bool = false;
}

impl Artifact for Body {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.count("vertices", self.positions.len()).count("triangles", self.triangles.len());
        m.push("volume", self.volume() * 1e3, "l", 0.05).count("landmarks", self.landmarks.len());
        for (name, length) in &self.measurements {
            m.push(name, length * 1e3, "mm", 1.0);
        }
        m
    }

    fn check(&self) -> Result<(), String> {
        finite("vertex", self.positions.iter().map(|p| &p.coords))?;
        indices("a triangle", self.positions.len(), self.triangles.iter().flatten())?;
        for (name, p) in &self.landmarks {
            ensure(p.iter().all(|c| c.is_finite()), || format!("landmark {name} is not a finite number"))?;
        }
        self.measurements.iter().try_for_each(|(name, length)| finite_figure(name, *length))
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        vec![("obj", obj_text(&self.positions, &self.triangles))]
    }
}
