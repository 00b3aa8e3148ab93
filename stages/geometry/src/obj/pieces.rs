//! The pieces of a triangle mesh: what hangs together by vertices, and which of it is closed.

use super::Mesh;
use crate::components::groups;
use nalgebra::Vector3;

/// Sine of a triangle's angle below which it counts as having no area: its normal is noise.
const FLAT: f64 = 1e-10;

/// Whether a triangle has no area.
#[must_use]
pub fn is_flat([a, b, c]: [Vector3<f64>; 3]) -> bool {
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    (b - a).cross(&(c - a)).norm() <= FLAT * longest * longest
}

/// The pieces of a mesh, in the order of their first vertices.
pub(super) struct MeshPieces {
    /// The piece of each vertex.
    pub(super) of: Vec<u32>,
    /// Whether each edge of a piece has two triangles that run through it opposite ways, and it has
    /// triangles.
    pub(super) closed: Vec<bool>,
    /// Triangles of each piece.
    pub(super) triangles: Vec<usize>,
}

impl MeshPieces {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let sides = mesh.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]]]);
        let (of, count) = groups(mesh.vertices.len(), sides);
        let mut triangles = vec![0; count];
        mesh.triangles.iter().for_each(|t| triangles[of[t[0] as usize] as usize] += 1);
        let mut closed: Vec<bool> = triangles.iter().map(|n| *n > 0).collect();
        let mut edges: Vec<(u32, u32, bool)> =
            directed(&mesh.triangles).map(|[a, b]| (a.min(b), a.max(b), a < b)).collect();
        edges.sort_unstable();
        for uses in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            if !matches!(uses, [a, b] if a.2 != b.2) {
                closed[of[uses[0].0 as usize] as usize] = false;
            }
        }
        Self { of, closed, triangles }
    }

    /// The piece of a triangle.
    pub(super) fn at(&self, t: &[u32; 3]) -> usize {
        self.of[t[0] as usize] as usize
    }
}

/// The edges of triangles in the direction in which they run through them.
pub(super) fn directed(triangles: &[[u32; 3]]) -> impl Iterator<Item = [u32; 2]> {
    triangles.iter().flat_map(|t| (0..3).map(|k| [t[k], t[(k + 1) % 3]]))
}
