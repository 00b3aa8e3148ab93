//! A garment mesh cut into its pieces, and the seams that held them together.
//!
//! Three ways to say where: corners with UV indices (islands of the texture), a group or material a
//! triangle, or marked seam edges, which may end inside a piece (a dart). Each piece becomes a
//! checked [`PieceSurface`]; a seam is a chain of boundary edges of one piece and a chain of
//! another (or the same) that are the same edges of the garment. Cost: two sorts of the 3 t edges
//! of t triangles.

mod cut;
mod facing;
mod seams;
#[cfg(test)]
mod tests;
mod weld;

pub use cut::{islands_by_group, islands_by_labels, islands_by_seams, islands_by_uv, split_components};
pub use seams::{Chain, SurfaceSeam};
pub use weld::{weld_places, weld_uv};

use crate::surface::PieceSurface;

/// The pieces of a garment, in the order of their first triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfacePieces {
    /// The pieces.
    pub pieces: Vec<SurfacePiece>,
    /// The seams between them, in the order of their first edges.
    pub seams: Vec<SurfaceSeam>,
}

/// One piece and where it came from.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfacePiece {
    /// The checked mesh.
    pub surface: PieceSurface,
    /// For each vertex of the surface the garment's vertex.
    pub vertices: Vec<u32>,
    /// For each triangle of the surface the garment's triangle.
    pub triangles: Vec<u32>,
}
