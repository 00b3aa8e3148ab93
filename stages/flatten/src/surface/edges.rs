//! Which half-edge lies opposite which: one sort of all edges.

use crate::error::SurfaceError;
use rayon::slice::ParallelSliceMut;

/// Stands for "no triangle on the other side".
pub const FREE: u32 = u32::MAX;

/// Half-edge `3 t + k` runs from corner k of triangle t to the next corner; the list gives the
/// half-edge on the other side, or [`FREE`].
pub(crate) type OppositeEdges = Vec<u32>;

/// Pairs the half-edges of a mesh, whichever way its triangles run.
///
/// # Errors
/// [`SurfaceError::NonManifoldEdge`] for an edge of three triangles or more.
pub(super) fn opposites(triangles: &[[u32; 3]]) -> Result<OppositeEdges, SurfaceError> {
    let mut opposite = vec![FREE; 3 * triangles.len()];
    let edges = sorted_edges(triangles);
    for group in edges.chunk_by(|a, b| a.0 == b.0) {
        match *group {
            [_] => {}
            [(_, g), (_, h)] => {
                opposite[g as usize] = h;
                opposite[h as usize] = g;
            }
            _ => {
                let (a, b) = ((group[0].0 >> 32) as u32, group[0].0 as u32);
                return Err(SurfaceError::NonManifoldEdge { a, b, triangles: group.len() });
            }
        }
    }
    Ok(opposite)
}

/// Every half-edge with its two vertices as one number (lower first), sorted.
pub(crate) fn sorted_edges(triangles: &[[u32; 3]]) -> Vec<(u64, u32)> {
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for (t, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            edges.push((edge_key(corners[k], corners[(k + 1) % 3]), (3 * t + k) as u32));
        }
    }
    edges.par_sort_unstable();
    edges
}

/// One number for an edge, whichever way it runs.
pub(crate) fn edge_key(a: u32, b: u32) -> u64 {
    (u64::from(a.min(b)) << 32) | u64::from(a.max(b))
}

/// The two ends of a half-edge.
pub(crate) fn ends(triangles: &[[u32; 3]], half_edge: u32) -> [u32; 2] {
    let (t, k) = (half_edge as usize / 3, half_edge as usize % 3);
    [triangles[t][k], triangles[t][(k + 1) % 3]]
}
