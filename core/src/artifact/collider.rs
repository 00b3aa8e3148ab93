//! What keeps cloth out of the body and out of itself, as a service to the solvers.

use super::{Artifact, ArtifactType, Digester, Kind, Measures, Point3, Vector3};
use crate::artifact::store::sound::{ensure, positive};
use crate::choice;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A vertex near or inside the body.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
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
#[repr(C)]
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
    /// The force that pushes cloth off the body; `None` where contacts are resolved by impulses.
    pub penalty: Option<Penalty>,
}

/// The force with which a body pushes off cloth that is near it, outwards.
#[choice]
#[derive(Copy)]
pub enum Penalty {
    /// c (thickness - distance) within the thickness: the stiffness c, N/m per vertex.
    Linear(f64),
    /// c exp(-distance / thickness): the force c at the skin, N per vertex.
    Exponential(f64),
}

/// The mesh of a body, lent: closed, facing outwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface<'a> {
    /// Its vertices, metres.
    pub positions: &'a [Point3],
    /// Its triangles, as indices of vertices.
    pub triangles: &'a [[u32; 3]],
}

/// A collision scheme. Called in the solver's inner loop, so it works on slices and may keep
/// scratch memory in `&self`; no lock is held while a query runs, so that queries may be made from
/// inside a thread pool.
///
/// Results are in the order that each method states, for any number of threads and any earlier
/// queries. A vertex that is not finite is in no result, nor are triangles that name a vertex twice
/// or one that does not exist.
pub trait Collide: Send + Sync + std::fmt::Debug {
    /// Its settings.
    fn card(&self) -> ColliderCard;

    /// Vertices within `reach` metres of the skin or inside the body, ascending, appended to `out`.
    fn body_contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>);

    /// The first places where paths `from[i] -> to[i]` enter the body (path against triangle, Fan
    /// et al. 1999), ascending, appended to `out`; the contact is at the skin, `distance` the
    /// signed distance of the end of the path. A path that only leaves the body is no hit.
    fn body_hits(&self, from: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>);

    /// Vertex-triangle and edge-edge pairs of the cloth nearer than `reach`, appended to `out`:
    /// first the vertex-triangle pairs, `[vertex, corners of the triangle]`, then the edge-edge
    /// pairs, `[first edge, second edge]`, each in ascending order of their vertices.
    ///
    /// Triangles hold node indices: pairs that share a node are no contact. Each pair of closest
    /// features comes once, so that penalties do not add up: a vertex nearest to a corner or side
    /// that several triangles share is paired with the first of them, two vertices nearest to each
    /// other make one contact, and two edges count where both closest points lie between the ends.
    fn self_contacts(
        &self,
        positions: &[Point3],
        triangles: &[[u32; 3]],
        reach: f64,
        out: &mut Vec<SelfContact>,
    );

    /// For each vertex, how near any triangle or edge that holds it (or the vertex itself) is to
    /// a vertex, edge or triangle with which it shares no node, metres; at most `reach`.
    ///
    /// Vertices that move by less than half of this on a straight line make no crossing (Wu et al.
    /// 2020; Chen et al. 2025). A `reach` below twice the greatest step wanted only costs steps.
    fn conservative_bounds(&self, positions: &[Point3], triangles: &[[u32; 3]], reach: f64) -> Vec<f64>;

    /// Pairs of cloth triangles that cross each other, lower index first, ascending: an edge of one
    /// pierces the other, the two sharing no node. Touching is no crossing.
    fn self_crossings(&self, positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]>;

    /// The body's mesh, from which a solver finds edges and corners that are too sharp for the
    /// distances of single vertices. `None` where there is no body or the scheme keeps no mesh:
    /// cloth may then cross sharp edges of the body between its vertices. The C interface has no
    /// place for it: a scheme of a plugin answers `None`.
    fn surface(&self) -> Option<Surface<'_>> {
        None
    }

    /// Named places on the body, which messages use to say where something is. `None` where the
    /// scheme knows none, as that of a plugin.
    fn landmarks(&self) -> Option<&BTreeMap<String, Point3>> {
        None
    }
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
        let Collider { scheme, signature } = self;
        let ColliderCard { thickness, friction, restitution, self_collision, penalty } = scheme.card();
        d.text(Self::KIND.0).text(signature).floats([thickness, friction, restitution]);
        let (law, coefficient) = match penalty {
            None => (0, None),
            Some(Penalty::Linear(c)) => (1, Some(c)),
            Some(Penalty::Exponential(c)) => (2, Some(c)),
        };
        d.count(usize::from(self_collision)).count(law).floats(coefficient);
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.push("thickness", self.scheme.card().thickness * 1e3, "mm", 1e-9);
        m
    }

    fn check(&self) -> Result<(), String> {
        let card = self.scheme.card();
        positive("thickness", card.thickness)?;
        ensure(card.friction.is_finite() && card.friction >= 0.0, || {
            format!("the friction is {}, it must be at least 0", card.friction)
        })?;
        let Some(Penalty::Linear(c) | Penalty::Exponential(c)) = card.penalty else { return Ok(()) };
        ensure(c.is_finite() && c >= 0.0, || format!("the penalty is {c}, it must be at least 0"))
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}
