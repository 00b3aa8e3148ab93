//! Meshers: outline to panel.
//!
//! They share everything but the filling of the inside: [`check`](self) of the outline, its
//! division into segments that no mesher may change, constrained triangulation, mending of angles,
//! assembly.

mod angles;
mod assemble;
mod check;
pub(crate) mod crossing;
mod delaunay;
mod divide;
#[cfg(test)]
pub(crate) mod fixtures;
mod graded;
mod grid;
mod lattice;
mod layout;
mod polyline;
pub(crate) mod predicates;
mod refine;
#[cfg(test)]
mod tests;
mod triangulate;
mod trimesh;

pub(crate) use angles::least_angle;
pub use delaunay::DelaunayMesher;
pub use graded::GradedMesher;
pub use grid::GridMesher;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<GridMesher>();
    registry.add::<DelaunayMesher>();
    registry.add::<GradedMesher>();
}
