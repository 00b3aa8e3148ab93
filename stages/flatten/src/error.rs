//! What the crate refuses: each error says what and where, its `remedy` what can be done.

use thiserror::Error;

/// A fault of a mesh, or of what was requested, that the flatteners cannot work with.
///
/// Numbers of vertices and triangles are those of the caller's lists, from 0.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SurfaceError {
    /// A mesh without triangles.
    #[error("the mesh has no triangles")]
    Empty,
    /// A list that is longer than 32-bit numbers can count.
    #[error("the mesh has {count} {what}, more than {limit}")]
    TooLarge {
        /// "vertices" or "triangles".
        what: &'static str,
        /// How many were given.
        count: usize,
        /// How many are allowed.
        limit: usize,
    },
    /// NaN or infinity, or a number so large that its square overflows.
    #[error("vertex {vertex} is not at a finite place")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A corner that names no vertex.
    #[error("triangle {triangle} names vertex {vertex}, but there are {vertices}")]
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// The index that it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A triangle without area.
    #[error("triangle {triangle} has no area (height / longest edge {quality:.1e})")]
    Degenerate {
        /// The triangle.
        triangle: usize,
        /// Height over the longest edge.
        quality: f64,
    },
    /// An edge of three triangles or more.
    #[error("the edge of vertices {a} and {b} belongs to {triangles} triangles")]
    NonManifoldEdge {
        /// The lower vertex.
        a: u32,
        /// The higher vertex.
        b: u32,
        /// How many triangles meet there.
        triangles: usize,
    },
    /// A surface with one side only, such as a Möbius strip.
    #[error("triangle {triangle} cannot be turned to agree with its neighbours")]
    NotOrientable {
        /// The triangle where the two directions meet.
        triangle: usize,
    },
    /// A surface without boundary.
    #[error("the surface is closed (no edge at triangle {triangle} is free)")]
    Closed {
        /// A triangle of the closed surface.
        triangle: usize,
    },
    /// Several components where one is wanted.
    #[error("the mesh has {count} separate components, the second at triangle {triangle}")]
    Disconnected {
        /// How many components.
        count: usize,
        /// The first triangle of the second component.
        triangle: usize,
    },
    /// A surface with handles (tunnels), which no plane drawing without overlap can show.
    #[error("the surface has {count} handles, so it cannot lie in the plane")]
    Handles {
        /// How many.
        count: usize,
    },
    /// Lists that must be equally long.
    #[error("{what} has {found} entries, but {wanted} are wanted")]
    LengthMismatch {
        /// Which list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that is wanted.
        wanted: usize,
    },
    /// A marked seam that is no edge of the mesh.
    #[error("seam edge {index} joins vertices {a} and {b}, which no triangle does")]
    NoSuchEdge {
        /// Its place in the list.
        index: usize,
        /// One vertex.
        a: u32,
        /// The other vertex.
        b: u32,
    },
}

impl SurfaceError {
    /// What can be done about it.
    #[must_use]
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Empty => "give at least one",
            Self::TooLarge { .. } => "simplify it or split it",
            Self::NotFinite { .. } => "remove it or mend its coordinates",
            Self::IndexOutOfRange { .. } => "mend the index",
            Self::Degenerate { .. } => "remesh or remove it",
            Self::NonManifoldEdge { .. } => "cut the mesh into pieces there",
            Self::NotOrientable { .. } => "cut the surface there",
            Self::Closed { .. } => "cut it along a seam first",
            Self::Disconnected { .. } => "split it into pieces",
            Self::Handles { .. } => "cut it along a seam first",
            Self::LengthMismatch { .. } => "give one for each",
            Self::NoSuchEdge { .. } => "mark edges of the mesh",
        }
    }
}

/// Why a surface could not be flattened.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FlattenError {
    /// A fault of the surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// A parameter outside its range.
    #[error("{name} = {value} is out of range: {range}")]
    InvalidParameter {
        /// The parameter.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed, in words.
        range: &'static str,
    },
    /// A matrix that has no Cholesky factor.
    #[error("the system of {unknowns} unknowns could not be factored ({why})")]
    Factorization {
        /// Its size.
        unknowns: usize,
        /// What the factorisation said.
        why: String,
    },
    /// No start without flipped triangles was found.
    #[error("no start without flipped triangles was found ({flips} are flipped)")]
    NoStart {
        /// How many triangles are flipped in the best start.
        flips: usize,
        /// The first of them.
        triangle: usize,
    },
    /// A triangle so small beside the piece that the digits of its flat places do not keep its
    /// area.
    #[error("triangle {triangle} is too small beside the piece for its flat places")]
    TooSmall {
        /// The triangle.
        triangle: usize,
    },
    /// A seam, chain or vertex that the piece does not have.
    #[error("{what} names vertex {vertex}, but the piece has {vertices}")]
    NoSuchVertex {
        /// What names it.
        what: &'static str,
        /// The vertex.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
}

impl FlattenError {
    /// What can be done about it; none where the message says it.
    #[must_use]
    pub fn remedy(&self) -> Option<String> {
        Some(match self {
            Self::Surface(e) => e.remedy().into(),
            Self::InvalidParameter { .. } => return None,
            Self::Factorization { .. } => "look for slivers and remesh".into(),
            Self::NoStart { triangle, .. } => format!("remesh slivers near triangle {triangle}"),
            Self::TooSmall { .. } => "remesh or remove it".into(),
            Self::NoSuchVertex { .. } => "give vertices of the piece".into(),
        })
    }
}
