//! The `v` and `f` lines of an OBJ text.

use super::polygon::cut;
use super::text::{NumberedLines, decode, words};
use super::{Mesh, ObjError};
use nalgebra::Vector3;
use std::collections::HashMap;

/// More vertices than any scanned body has.
pub const MAX_VERTICES: usize = 4_000_000;

/// As many triangles as that many vertices of a closed mesh have.
pub const MAX_TRIANGLES: usize = 2 * MAX_VERTICES;

/// Coordinates reach this far from the origin: ten kilometres in millimetres.
pub const MAX_COORDINATE: f64 = 1e7;

/// A face before it is cut into triangles.
struct Face {
    line: usize,
    /// Its first corner in the list of all, and the one after its last.
    corners: std::ops::Range<usize>,
}

/// Reads vertices and faces: `v x y z` and `f a b c`, with whatever stands behind (colours, texture
/// and normal indices).
///
/// Indices may be negative, faces may stand before their vertices and have any number of corners;
/// [`decode`] and [`NumberedLines`] tell which encodings and line endings are read.
///
/// # Errors
/// [`ObjError`] with the line.
pub fn parse(bytes: &[u8]) -> Result<Mesh, ObjError> {
    parse_faces(&decode(bytes)).map(|(mesh, _)| mesh)
}

/// The mesh of a decoded text, and for each triangle the number of its face, counted from 0.
pub(super) fn parse_faces(text: &[u8]) -> Result<(Mesh, Vec<u32>), ObjError> {
    let mut mesh = Mesh::default();
    let (mut corners, mut faces): (Vec<i64>, Vec<Face>) = (Vec::new(), Vec::new());
    for (line, content) in NumberedLines::new(text) {
        let mut words = words(&content);
        match words.next() {
            Some(b"v") => mesh.vertices.push(vertex(words, line)?),
            Some(b"f") => {
                let first = corners.len();
                for word in words {
                    corners.push(corner(word, mesh.vertices.len(), line)?);
                }
                faces.push(Face { line, corners: first..corners.len() });
            }
            _ => {}
        }
        if mesh.vertices.len() > MAX_VERTICES {
            return Err(ObjError::TooMany { line, what: "vertices", most: MAX_VERTICES });
        }
        if corners.len() > 3 * MAX_TRIANGLES {
            return Err(ObjError::TooMany { line, what: "triangles", most: MAX_TRIANGLES });
        }
    }
    // A face that is listed again, from another corner on or the other way round, is cut as the
    // first time, so that its triangles are found to be the same. Only looked up, never walked
    // through.
    let mut known: HashMap<Vec<u32>, (Vec<u32>, std::ops::Range<usize>)> = HashMap::new();
    let mut faces_of = Vec::new();
    for (number, face) in faces.into_iter().enumerate() {
        let count = mesh.vertices.len();
        let own = &corners[face.corners];
        if let Some(&index) = own.iter().find(|i| **i as usize >= count) {
            return Err(ObjError::NoVertex { line: face.line, index: index + 1, count });
        }
        let own: Vec<u32> = own.iter().map(|&i| i as u32).collect();
        match own.len() {
            0..3 => return Err(ObjError::FewCorners { line: face.line }),
            3 => mesh.triangles.push([own[0], own[1], own[2]]),
            n => {
                let first = mesh.triangles.len();
                let mut key = own.clone();
                key.sort_unstable();
                match known.get(&key) {
                    Some((earlier, range)) => {
                        let again: Vec<[u32; 3]> = mesh.triangles[range.clone()].to_vec();
                        let turned = follower(&own, key[0]) != follower(earlier, key[0]);
                        let as_listed = |t: [u32; 3]| if turned { [t[0], t[2], t[1]] } else { t };
                        mesh.triangles.extend(again.into_iter().map(as_listed));
                    }
                    None => {
                        cut(&own, &mesh.vertices, &mut mesh.triangles)
                            .ok_or(ObjError::Concave { line: face.line, corners: n })?;
                        known.insert(key, (own, first..mesh.triangles.len()));
                    }
                }
            }
        }
        faces_of.resize(mesh.triangles.len(), number as u32);
    }
    if mesh.triangles.is_empty() { Err(ObjError::NoFaces) } else { Ok((mesh, faces_of)) }
}

/// The corner behind another one of a face.
fn follower(face: &[u32], corner: u32) -> Option<u32> {
    let at = face.iter().position(|c| *c == corner)?;
    Some(face[(at + 1) % face.len()])
}

/// How many triangles the faces of an OBJ text have before anything is mended; what is wrong with
/// it is not looked for.
#[must_use]
pub fn count_triangles(bytes: &[u8]) -> usize {
    let of = |(_, line): (usize, std::borrow::Cow<'_, [u8]>)| {
        let mut words = words(&line);
        if words.next() == Some(b"f") { words.count().saturating_sub(2) } else { 0 }
    };
    NumberedLines::new(&decode(bytes)).map(of).sum()
}

fn vertex<'a>(mut words: impl Iterator<Item = &'a [u8]>, line: usize) -> Result<Vector3<f64>, ObjError> {
    let mut next = || {
        let word = words.next().ok_or(ObjError::Vertex { line, word: String::new() })?;
        let number = std::str::from_utf8(word).ok().and_then(|w| w.parse::<f64>().ok());
        match number.ok_or_else(|| ObjError::Vertex { line, word: clip(word) })? {
            x if x.abs() <= MAX_COORDINATE => Ok(x),
            _ => Err(ObjError::Coordinate { line, word: clip(word) }),
        }
    };
    Ok(Vector3::new(next()?, next()?, next()?))
}

/// The vertex of `7`, `7/1`, `7/1/3` or `7//3`, counted from 0; a negative one counts from the last
/// vertex above it. A positive one may come later in the file.
pub(super) fn corner(word: &[u8], count: usize, line: usize) -> Result<i64, ObjError> {
    let first = word.split(|b| *b == b'/').next().unwrap_or_default();
    let index = std::str::from_utf8(first).ok().and_then(|w| w.parse::<i64>().ok());
    let index = index.ok_or_else(|| ObjError::Corner { line, word: clip(word) })?;
    match index {
        1.. => Ok(index - 1),
        i if i < 0 && i >= -(count as i64) => Ok(count as i64 + i),
        _ => Err(ObjError::NoVertex { line, index, count }),
    }
}

/// The start of a word, fit for a message.
pub(super) fn clip(word: &[u8]) -> String {
    String::from_utf8_lossy(word).chars().take(20).collect()
}
