//! Prepared scenes: panels, seams, a body and what the cloth is made of.
//!
//! A scene is the input of every solver; `read` reads the JSON form `garment-scene-1` (described in
//! docs/reference/scene.md), `generate` makes the standard ones.

mod build;
mod check;
pub mod generate;
pub mod held;
mod mend;
mod raw;
mod read;
mod strict;
mod units;
mod write;

#[cfg(test)]
mod tests;

pub use build::GRAVITY;
pub use held::Held;
pub use read::{Load, Loaded, Options, check_form, parse, read};
pub use strict::FieldFault;
pub use write::{body_to_obj, to_json};

use crate::energy::Air;
pub use crate::energy::StrainLimit;
use crate::error::ClothError;
use crate::fabric::Fabric;
use nalgebra::{Vector2, Vector3};
use std::ops::Range;
use std::path::PathBuf;
use toile_geometry::obj::ObjError;

/// A scene, checked: every index points at something and every number is finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Its name.
    pub name: String,
    /// Flat rest coordinates of every vertex, m; warp along y.
    pub rest: Vec<Vector2<f64>>,
    /// The initial position of every vertex, m; y is up.
    pub positions: Vec<Vector3<f64>>,
    /// Vertices of each triangle, counter-clockwise at rest.
    pub triangles: Vec<[u32; 3]>,
    /// The panels.
    pub panels: Vec<Panel>,
    /// The seams.
    pub seams: Vec<Seam>,
    /// Elastic bands sewn to it.
    pub bands: Vec<Band>,
    /// Pinned vertices.
    pub pinned: Vec<u32>,
    /// The body, if any.
    pub body: Option<SceneBody>,
    /// The fabric of panels without one of their own.
    pub material: Fabric,
    /// Strain limit of warp and weft; `None` for that of the fabric alone.
    pub strain_limit: Option<StrainLimit>,
    /// The phases, one after the other.
    pub phases: Vec<Phase>,
    /// Whether the cloth collides with itself.
    pub self_collision: bool,
    /// The history of friction at the start; empty unless the scene starts from an equilibrium.
    pub held: Held,
}

/// A piece of cloth.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Its name.
    pub name: String,
    /// Its vertices.
    pub vertices: Range<usize>,
    /// Its triangles.
    pub triangles: Range<usize>,
    /// Its fabric, if not the scene's material.
    pub material: Option<Fabric>,
    /// Coefficient of friction on the body, if not the body's own.
    pub body_friction: Option<f64>,
    /// Which layer it is worn in: panels of a higher number lie outside those of a lower one,
    /// wherever both are. The outside is the side from which its triangles run counter-clockwise.
    pub layer: u32,
}

/// A seam: pairs of vertices that are sewn together.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    /// Its name.
    pub name: String,
    /// The pairs.
    pub pairs: Vec<[u32; 2]>,
    /// Whether each pair becomes one point, without any gap; else threads keep holding two vertices
    /// together.
    pub joined: bool,
    /// How many times longer one side is than the other, where it is gathered: its folds, too small
    /// for the mesh, then take up the difference, and do not press the other side long. The pairs
    /// must follow the seam.
    pub gather: Option<f64>,
    /// Where the seam is pressed to stay folded: the angle between the outsides of its two sheets
    /// at rest, radians. Pi lies flat, 0 has the outsides face to face, 2 pi the insides.
    pub fold: Option<f64>,
}

/// An elastic band along a path of vertices: a waistband, a cuff.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Its name.
    pub name: String,
    /// The vertices along it; neighbours lie on one panel or are sewn together.
    pub vertices: Vec<u32>,
    /// Its length unstretched, as a share of the cloth's along the path.
    pub ratio: f64,
    /// Force per unit of strain, N. It does not resist being pressed together.
    pub stiffness: f64,
}

/// A closed, static mesh whose triangles face outwards.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneBody {
    /// Its vertices, m.
    pub vertices: Vec<Vector3<f64>>,
    /// Its triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Coefficient of friction of cloth on it.
    pub friction: f64,
}

/// A span of time with one gravity and one air.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// Its name.
    pub name: String,
    /// How long it lasts, s.
    pub seconds: f64,
    /// m/s².
    pub gravity: Vector3<f64>,
    /// The air; `None` for a vacuum.
    pub air: Option<Air>,
}

/// Why a scene cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// A file could not be read.
    #[error("cannot read {}: {why}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The message of the system.
        why: String,
    },
    /// Not JSON, or not of the form.
    #[error("not a garment-scene-1: {why}")]
    Form {
        /// The message of the parser, with line and column.
        why: String,
    },
    /// Another format or version.
    #[error("the format is '{found}', not 'garment-scene-1'")]
    Format {
        /// The format that the file states.
        found: String,
    },
    /// Two lists that must be equally long.
    #[error("{name} has {found} entries, but there are {wanted} vertices")]
    Length {
        /// The list.
        name: &'static str,
        /// Its length.
        found: usize,
        /// The right length.
        wanted: usize,
    },
    /// A range that does not lie within its list.
    #[error("panel '{panel}': {what} {start}..{end} lie outside 0..{count}")]
    PanelRange {
        /// The panel.
        panel: String,
        /// Vertices or triangles.
        what: &'static str,
        /// First.
        start: usize,
        /// One after the last.
        end: usize,
        /// How many there are.
        count: usize,
    },
    /// A vertex sewn to itself, or a pair given twice.
    #[error("seam '{seam}': pair {pair} {why}")]
    SeamPair {
        /// The seam.
        seam: String,
        /// Which pair.
        pair: usize,
        /// The fault.
        why: &'static str,
    },
    /// A seam with threads has two lines of vertices and no fold.
    #[error(
        "seam '{seam}' is to stay folded, but it is held by threads; leave out `joined: false` or `fold`"
    )]
    FoldOpen {
        /// The seam.
        seam: String,
    },
    /// A gathered seam whose sides are not as they are said to be.
    #[error("seam '{seam}' is to gather {stated} to 1, but its sides are {found:.3} to 1")]
    Gather {
        /// The seam.
        seam: String,
        /// The requested ratio.
        stated: f64,
        /// The ratio of its sides.
        found: f64,
    },
    /// A band whose path jumps.
    #[error("band '{band}': {why}")]
    BandPath {
        /// The band.
        band: String,
        /// The fault, with its place.
        why: String,
    },
    /// A material that lacks a value.
    #[error("the material of {of} has neither '{either}' nor both '{first}' and '{second}'")]
    Material {
        /// The scene or a panel.
        of: String,
        /// The value for both directions.
        either: &'static str,
        /// The value along the warp.
        first: &'static str,
        /// The value along the weft.
        second: &'static str,
    },
    /// The body's OBJ.
    #[error(transparent)]
    Obj(#[from] ObjError),
    /// Fields that no scene has, or that stand twice.
    #[error("{}", all(.0))]
    Fields(Vec<FieldFault>),
    /// Another direction up.
    #[error("up is '{found}', but in a scene y is up; turn the scene and its body")]
    Up {
        /// The direction that the file states.
        found: String,
    },
    /// Two panels of one name.
    #[error("panels {first} and {second} are both called '{name}'; give each panel a name of its own")]
    PanelTwice {
        /// The name.
        name: String,
        /// The first of them, counted from 0.
        first: usize,
        /// The second.
        second: usize,
    },
    /// Faces that share no vertices.
    #[error(
        "panel '{panel}' is {faces} faces that hang together nowhere: of its {vertices} vertices {coincident} lie on others that they \
         are not joined to; merge them in the program that wrote the mesh"
    )]
    Unmerged {
        /// The panel.
        panel: String,
        /// Its faces that share no vertex with others.
        faces: usize,
        /// Its vertices.
        vertices: usize,
        /// Those that lie on an earlier one.
        coincident: usize,
    },
    /// A vertex of no triangle that is sewn to cloth and free.
    #[error(
        "seam '{seam}': pair {pair} sews vertex {vertex}, which belongs to no triangle; pin it where the seam is to hang, or leave it out"
    )]
    SewnToNothing {
        /// The seam.
        seam: String,
        /// Which pair.
        pair: usize,
        /// The vertex.
        vertex: u32,
    },
    /// A vertex of no triangle that nothing holds.
    #[error("vertex {vertex} belongs to no triangle, is not pinned and would fall; leave it out or pin it")]
    Loose {
        /// The vertex.
        vertex: usize,
    },
    /// Flat cloth in another unit than where it starts.
    #[error("edges are {times} times longer in {longer} than in {shorter}; write both in metres")]
    RestScale {
        /// The list with the longer edges.
        longer: &'static str,
        /// The other.
        shorter: &'static str,
        /// How many times.
        times: String,
    },
    /// Lengths that no garment has.
    #[error("{what} {length} m {axis}; {hint}")]
    Lengths {
        /// What is as long as that.
        what: &'static str,
        /// How long, m.
        length: String,
        /// In which direction.
        axis: &'static str,
        /// What to do.
        hint: String,
    },
    /// A body without triangles.
    #[error("the body has no triangles; leave it out where there is none")]
    EmptyBody,
    /// A fault of the numbers.
    #[error(transparent)]
    Cloth(#[from] ClothError),
}

fn all(faults: &[FieldFault]) -> String {
    faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}
