//! Faults of a garment's mesh and numbers.

use super::MessageContext;
use crate::engine::cloth_error;
use toile_cloth::error::ClothError;
use toile_core::StageError;

/// What may help where forces cannot be told from each other.
pub(super) const BEYOND_CLOTH: &str = "look at the fabric: its weight, stretch and bending, or the lengths of the pieces, are beyond those of cloth \
     (see the units of its file)";

/// What may help where the mesh has a fault.
const AGAIN: &str =
    "mesh the piece again with another edge length, or merge points that lie on each other in the file";

impl MessageContext<'_> {
    /// A fault of numbers; triangles and points are told by their panel.
    pub(super) fn numbers(&self, error: &ClothError) -> StageError {
        let told = cloth_error(error);
        let (message, help) = match error {
            ClothError::DegenerateTriangle { index, .. } => {
                (format!("{} has a triangle without area", self.owner(*index)), AGAIN.to_owned())
            }
            ClothError::ZeroLengthEdge { a, .. } => {
                (format!("{} has two points at one place", self.panel_of(*a)), AGAIN.to_owned())
            }
            ClothError::InvertedTriangle { index } => (
                format!("{} has a triangle that is turned over", self.owner(*index)),
                "let all triangles of the piece run counter-clockwise where it lies flat".to_owned(),
            ),
            ClothError::TriangleTwice { first, .. } => (
                format!("{} has a triangle twice", self.owner(*first)),
                "take one of them out of the file".to_owned(),
            ),
            ClothError::NonManifoldEdge { why, .. } => (
                format!("the sewn cloth is no single surface: along one edge of it, {why}"),
                "look for a seam that is listed twice, or that joins more than two edges".to_owned(),
            ),
            ClothError::Wind { speed } => (
                format!("`{}` finds no rest in a wind of {speed} m/s", self.stage),
                "take ImplicitEuler, CentralDifferences, Xpbd or Projective in its place: they move the cloth until it rests"
                    .to_owned(),
            ),
            ClothError::StrainLimitExceeded { index, strain, limit } => (
                format!(
                    "{} is stretched by {:.0} %, its limit is {:.0} %",
                    self.owner(*index),
                    strain * 1e2,
                    limit * 1e2
                ),
                "cut it wider, take a smaller body, or raise the scene's `strain_limit`".to_owned(),
            ),
            ClothError::NotConverged { .. } | ClothError::Factorization { .. } | ClothError::Diverged { .. } => {
                ("the forces in the cloth cannot be balanced".to_owned(), BEYOND_CLOTH.to_owned())
            }
            _ => return told,
        };
        Self::error(told.code, message, error).hint(help)
    }

    /// The panel of a triangle.
    fn owner(&self, triangle: usize) -> String {
        let panel = self.garment.panels.iter().find(|p| p.triangles.contains(&triangle));
        panel.map_or_else(|| "the cloth".into(), |p| format!("'{}'", p.name))
    }

    /// The panel of a vertex.
    fn panel_of(&self, vertex: usize) -> String {
        self.garment.panel_of(vertex).map_or_else(|| "the cloth".into(), |p| format!("'{}'", p.name))
    }
}
