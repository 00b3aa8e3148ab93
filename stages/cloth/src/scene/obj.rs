//! The part of OBJ that scenes need: `v` and `f` lines.

use super::SceneError;
use nalgebra::Vector3;
use std::fmt::Write as _;
use std::path::Path;

/// A mesh as an OBJ file holds it: vertices and triangles.
pub type ObjMesh = (Vec<Vector3<f64>>, Vec<[u32; 3]>);

/// Reads vertices and faces; faces of more corners are cut into fans.
///
/// # Errors
/// [`SceneError::Obj`] with the line.
pub fn parse_obj(text: &str) -> Result<ObjMesh, SceneError> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (k, line) in text.lines().enumerate() {
        let fault = |why| SceneError::Obj { line: k + 1, why };
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let mut next = || words.next().and_then(|w| w.parse().ok());
                let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
                    return Err(fault("a vertex needs three numbers"));
                };
                vertices.push(Vector3::new(x, y, z));
            }
            Some("f") => {
                let index = |w: &str| corner(w, vertices.len());
                let corners: Option<Vec<u32>> = words.map(index).collect();
                let corners = corners.ok_or_else(|| fault("a corner is no index of a vertex above it"))?;
                if corners.len() < 3 {
                    return Err(fault("a face needs three corners"));
                }
                triangles.extend((1..corners.len() - 1).map(|k| [corners[0], corners[k], corners[k + 1]]));
            }
            _ => {}
        }
    }
    Ok((vertices, triangles))
}

/// The vertex of `12/3/4` or `-1`, counted from 0.
fn corner(word: &str, count: usize) -> Option<u32> {
    let index: i64 = word.split('/').next()?.parse().ok()?;
    let index = if index < 0 { index + count as i64 } else { index - 1 };
    (0..count as i64).contains(&index).then_some(index as u32)
}

/// Writes vertices in their order, then the triangles; nine digits, so that a micrometre in a metre survives.
///
/// # Errors
/// [`SceneError::File`] where the file cannot be written.
pub fn write_obj(path: &Path, vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Result<(), SceneError> {
    let mut text = String::with_capacity(48 * vertices.len() + 24 * triangles.len());
    for p in vertices {
        let _ = writeln!(text, "v {:.9} {:.9} {:.9}", p.x, p.y, p.z);
    }
    for t in triangles {
        let _ = writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    std::fs::write(path, text).map_err(|e| SceneError::File { path: path.into(), why: e.to_string() })
}
