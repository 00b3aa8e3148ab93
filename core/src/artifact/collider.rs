//! What keeps cloth out of the body and out of itself, as a service to the solvers.

use super::{Artifact, ArtifactType, Digester, Kind, Measures, Point3, Vector3};
use std::sync::Arc;

/// A vertex near or inside the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyContact {
    /// The cloth vertex (an index into the slice that was asked about).
    pub vertex: u32,
    /// Closest point of the skin.
    pub point: Point3,
    /// Outward unit normal there.
    pub normal: Vector3,
    /// Signed distance of the vertex to the skin, metres, negative inside.
    pub distance: f64,
}

/// Two pieces of cloth nearer than the thickness: a vertex and a triangle, or two edges.
///
/// The contact acts along `normal` on four vertices with `weights` that sum to zero: the first
/// side's are positive, the other's negative, so `sum weights[i] * x[vertices[i]]` is the
/// separation vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfContact {
    /// The vertices.
    pub vertices: [u32; 4],
    /// Their weights.
    pub weights: [f64; 4],
    /// Unit normal from the second side to the first.
    pub normal: Vector3,
    /// Separation, metres, never negative.
    pub distance: f64,
}

/// Settings that a solver reads from its collider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColliderCard {
    /// Distance at which cloth is held off the body and off itself, metres.
    pub thickness: f64,
    /// Coulomb friction coefficient.
    pub friction: f64,
    /// Normal restitution, 0 to 1.
    pub restitution: f64,
    /// True where cloth against itself is looked for.
    pub self_collision: bool,
    /// Stiffness of the penalty response, N/m; `None` where contacts are resolved by impulses.
    pub penalty: Option<f64>,
}

/// A collision scheme. Called in the solver's inner loop, so it works on slices and keeps its
/// scratch memory in `&self` behind no lock: implementations allocate only in `out`.
///
/// Results are in ascending order of their vertices, whatever the number of threads.
pub trait Collide: Send + Sync + std::fmt::Debug {
    /// Its settings.
    fn card(&self) -> ColliderCard;

    /// Vertices within `reach` metres of the skin or inside the body, appended to `out`.
    fn body_contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>);

    /// The first hits of paths `from[i] -> to[i]` with the body [F: path against triangle]; the
    /// contact is at the skin, `distance` the signed distance of the end of the path.
    fn body_hits(&self, from: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>);

    /// Vertex-triangle and edge-edge pairs of the cloth nearer than `reach`, appended to `out`.
    ///
    /// Triangles hold node indices: pairs that share a node are no contact.
    fn self_contacts(
        &self,
        positions: &[Point3],
        triangles: &[[u32; 3]],
        reach: f64,
        out: &mut Vec<SelfContact>,
    );

    /// Pairs of cloth triangles that cross each other, lower index first, ascending.
    fn self_crossings(&self, positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]>;
}

/// A collision scheme made for one body.
#[derive(Debug, Clone)]
pub struct Collider {
    /// The scheme.
    pub scheme: Arc<dyn Collide>,
    /// A text that names scheme and settings, for digests.
    pub signature: String,
}

impl ArtifactType for Collider {
    const KIND: Kind = Kind("collider");
    const IN_SETS: bool = false;
}

impl Artifact for Collider {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn digest(&self, d: &mut Digester) {
        d.text("collider").text(&self.signature);
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.push("thickness", self.scheme.card().thickness * 1e3, "mm", 1e-9);
        m
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}
