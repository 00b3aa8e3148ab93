//! Meshes as OBJ text.

use nalgebra::Vector3;
use std::fmt::Write as _;
use std::path::Path;

/// Vertices in their order, then the triangles; nine digits, so that a micrometre in a metre
/// survives.
#[must_use]
pub fn to_text(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> String {
    let mut text = String::with_capacity(48 * vertices.len() + 24 * triangles.len());
    for p in vertices {
        let _ = writeln!(text, "v {:.9} {:.9} {:.9}", p.x, p.y, p.z);
    }
    for t in triangles {
        let _ = writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    text
}

/// Writes them to a file.
///
/// # Errors
/// What the system says.
pub fn write(path: &Path, vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> std::io::Result<()> {
    std::fs::write(path, to_text(vertices, triangles))
}
