//! What every solver of one piece shares: its triangles, the graph of its vertices, and the order
//! of elimination.

use crate::linear::{Graph, elimination_order};
use crate::surface::PieceSurface;

/// Made once a piece, used by all its solvers.
#[derive(Debug, Clone)]
pub(crate) struct PieceSystem {
    triangles: Vec<[u32; 3]>,
    graph: Graph,
    order: Vec<u32>,
}

impl PieceSystem {
    /// The system of a surface; `extra` couples further pairs of its vertices.
    #[must_use]
    pub(crate) fn new(surface: &PieceSurface, extra: &[[u32; 2]]) -> Self {
        let graph = Graph::new(surface.positions().len(), surface.triangles(), extra);
        let order = elimination_order(&graph, surface.positions());
        Self { triangles: surface.triangles().to_vec(), graph, order }
    }

    /// The triangles of the surface.
    #[must_use]
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The coupled vertices.
    #[must_use]
    pub(crate) fn graph(&self) -> &Graph {
        &self.graph
    }

    /// The vertices in the order of elimination.
    #[must_use]
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }
}
