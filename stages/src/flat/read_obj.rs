//! A garment from a Wavefront OBJ text.

use super::raw::{NO_POINT, RawMesh};
use crate::engine::OBJ_HINT;
use toile_core::prelude::*;
use toile_geometry::obj::{Marks, parse_marked};

/// The mesh of a file's bytes, in its own unit and axes.
pub(super) fn read_obj(bytes: &[u8], file: &str) -> Result<RawMesh, StageError> {
    let (mesh, marks) = parse_marked(bytes).map_err(|e| {
        StageError::new(ErrorCode::PatternLoading, format!("\"{file}\": {e}")).hint(OBJ_HINT).at("file")
    })?;
    let point = |c: u32| if c == Marks::NONE { NO_POINT } else { c };
    Ok(RawMesh {
        positions: mesh.vertices.into_iter().map(Point3::from).collect(),
        triangles: mesh.triangles,
        uv: marks.uv.into_iter().map(Point2::from).collect(),
        corners: marks.corners.into_iter().map(|t| t.map(point)).collect(),
        groups: marks.groups,
        materials: marks.materials,
        group_names: marks.group_names,
        material_names: marks.material_names,
        lines: marks.lines,
    })
}
