//! A garment from a Wavefront OBJ text.

use super::raw::{NO_POINT, RawMesh};
use toile_core::prelude::*;
use toile_geometry::obj::OBJ_HINT;
use toile_geometry::obj::{FaceMarks, ObjError, other_format, parse_marked, without_faces};

/// How the OBJ files of this program begin.
const OURS: &[u8] = b"# metres, Y up\nmtllib ";

/// The mesh of a file's bytes, in its own unit and axes.
pub(in crate::flat) fn read_obj(bytes: &[u8], file: &str) -> Result<RawMesh, StageError> {
    let bad =
        |what: String| StageError::new(ErrorCode::PatternLoading, format!("\"{file}\": {what}")).at("file");
    if let Some(format) = format_of(bytes, file) {
        return Err(bad(format!("it is {format}, which is not read"))
            .hint("export the garment as OBJ, or as one glTF file (.glb), and name that"));
    }
    let (mesh, marks) = parse_marked(bytes).map_err(|e| match (&e, without_faces(bytes)) {
        (ObjError::NoFaces, Some(holds)) => {
            bad(format!("the OBJ holds {holds}")).hint("export the garment as a mesh with faces")
        }
        _ => bad(e.to_string()).hint(OBJ_HINT),
    })?;
    let point = |c: u32| if c == FaceMarks::NONE { NO_POINT } else { c };
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
        is_ours: bytes.starts_with(OURS),
        has_own_vertices: false,
    })
}

/// The format of a file that is no OBJ: by its bytes, else by a name that no OBJ has.
fn format_of(bytes: &[u8], file: &str) -> Option<&'static str> {
    let lower = file.to_ascii_lowercase();
    let is_clo = [".zprj", ".zpac"].iter().any(|end| lower.ends_with(end));
    match other_format(bytes) {
        _ if is_clo => Some("a project of CLO or Marvelous Designer"),
        None if bytes.trim_ascii().is_empty() => Some("an empty file"),
        format => format,
    }
}
