//! Constrained Delaunay triangulation of a region bounded by loops.
//!
//! Method: `spade` triangulates the points' hull with all segments as constraints; the faces
//! inside are found by flood fill from the triangles to the left of the loops, which run with the
//! region on their left. (spade's own classification counts constraints, and inner lines are
//! constraints that bound nothing.)
//! Cost: n log n.
//! Limits: segments must not cross, and points must not lie on segments they do not end.

use super::trimesh::TriMesh;
use spade::{ConstrainedDelaunayTriangulation, Triangulation};
use toile_core::StageError;
use toile_core::artifact::Point2;

/// Triangles of the region to the left of `loops`, with `loops` and `lines` as walls.
pub(crate) fn triangulate(
    points: Vec<Point2>,
    free: Vec<bool>,
    loops: &[[u32; 2]],
    lines: &[[u32; 2]],
) -> Result<TriMesh, StageError> {
    let hull = hull_triangles(&points, [loops, lines].concat())?;
    let everything = vec![false; points.len()];
    let mesh = TriMesh::new(points, everything, hull, loops)?;
    let inside = mesh.left_of(loops)?;
    let tris = mesh.tris.iter().zip(&inside).filter(|(_, inside)| **inside).map(|(t, _)| *t).collect();
    TriMesh::new(mesh.points, free, tris, &[loops, lines].concat())
}

fn hull_triangles(points: &[Point2], segments: Vec<[u32; 2]>) -> Result<Vec<[u32; 3]>, StageError> {
    let fault = |what: &str| StageError::internal(format!("the triangulation failed: {what}"));
    let vertices = points.iter().map(|p| spade::Point2::new(at_least(p.x), at_least(p.y))).collect();
    let edges = segments.iter().map(|s| s.map(|v| v as usize)).collect();
    let mut conflicts = 0;
    let cdt =
        ConstrainedDelaunayTriangulation::<spade::Point2<f64>>::try_bulk_load_cdt(vertices, edges, |_| {
            conflicts += 1;
        })
        .map_err(|e| fault(&e.to_string()))?;
    if conflicts > 0 || cdt.num_vertices() != points.len() {
        return Err(fault("segments cross or points coincide"));
    }
    Ok(cdt.inner_faces().map(|f| f.vertices().map(|v| v.index() as u32)).collect())
}

/// Coordinates nearer to 0 than this are 0: spade's exact predicates underflow there.
const LEAST_COORDINATE: f64 = 1e-40;

fn at_least(x: f64) -> f64 {
    if x.abs() < LEAST_COORDINATE { 0.0 } else { x }
}
