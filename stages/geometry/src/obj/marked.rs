//! What an OBJ file says beside its mesh: texture points, groups, materials and lines.
//!
//! A second pass over the text takes the `vt`, `g`, `o`, `usemtl` and `l` lines and the texture
//! indices of the faces; each triangle takes those of its face. Cost: linear in the text.

use super::parse::{MAX_COORDINATE, MAX_TRIANGLES, clip, corner, parse_faces};
use super::text::{NumberedLines, decode, words};
use super::{Mesh, ObjError};
use std::collections::BTreeMap;

/// What stands beside the mesh.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FaceMarks {
    /// Texture points, in the order of the file.
    pub uv: Vec<[f64; 2]>,
    /// For each corner of each triangle its texture point, [`FaceMarks::NONE`] where it has none.
    pub corners: Vec<[u32; 3]>,
    /// For each triangle its group, by [`FaceMarks::group_names`].
    pub groups: Vec<u32>,
    /// For each triangle its material, by [`FaceMarks::material_names`].
    pub materials: Vec<u32>,
    /// Names of groups and objects (`g`, `o`); the first is empty, for faces above any.
    pub group_names: Vec<String>,
    /// Names of materials; the first is empty, for faces above any.
    pub material_names: Vec<String>,
    /// Edges of `l` lines, by vertices.
    pub lines: Vec<[u32; 2]>,
}

impl FaceMarks {
    /// A corner without a texture point.
    pub const NONE: u32 = u32::MAX;
}

/// The longest name that is kept, characters.
const LONGEST_NAME: usize = 60;

/// Reads as [`parse`](super::parse) does, and the marks.
///
/// # Errors
/// [`ObjError`] with the line.
pub fn parse_marked(bytes: &[u8]) -> Result<(Mesh, FaceMarks), ObjError> {
    let text = decode(bytes);
    let (mesh, face_of) = parse_faces(&text)?;
    let mut reader = MarkedReader::new();
    for (line, content) in NumberedLines::new(&text) {
        reader.line(&content, line)?;
    }
    reader.check(mesh.vertices.len())?;
    let marks = reader.marks(&mesh, &face_of);
    Ok((mesh, marks))
}

/// A corner of a face: its vertex and its texture point.
type FaceCorner = (u32, u32);

struct MarkedFace {
    line: usize,
    corners: std::ops::Range<usize>,
    group: u32,
    material: u32,
}

/// What is known at a line.
struct MarkedReader {
    vertices: usize,
    corners: Vec<FaceCorner>,
    faces: Vec<MarkedFace>,
    /// Lines with the number of theirs in the file.
    lines: Vec<(usize, [u32; 2])>,
    groups: NameList,
    materials: NameList,
    uv: Vec<[f64; 2]>,
}

impl MarkedReader {
    fn new() -> Self {
        Self {
            vertices: 0,
            corners: Vec::new(),
            faces: Vec::new(),
            lines: Vec::new(),
            groups: NameList::new(),
            materials: NameList::new(),
            uv: Vec::new(),
        }
    }

    fn line(&mut self, content: &[u8], line: usize) -> Result<(), ObjError> {
        let mut words = words(content);
        match words.next() {
            Some(b"v") => self.vertices += 1,
            Some(b"vt") => self.uv.push(texture_point(words, line)?),
            Some(b"f") => self.face(words, line)?,
            Some(b"l") => self.polyline(words, line)?,
            Some(b"g" | b"o") => self.groups.enter(words),
            Some(b"usemtl") => self.materials.enter(words),
            _ => {}
        }
        let most = 3 * MAX_TRIANGLES;
        match self.uv.len() > most || self.lines.len() > most {
            true => Err(ObjError::TooMany { line, what: "texture points or lines", most }),
            false => Ok(()),
        }
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>, line: usize) -> Result<(), ObjError> {
        let first = self.corners.len();
        for word in words {
            let vertex = corner(word, self.vertices, line)? as u32;
            self.corners.push((vertex, texture(word, self.uv.len(), line)?));
        }
        let (group, material) = (self.groups.current, self.materials.current);
        self.faces.push(MarkedFace { line, corners: first..self.corners.len(), group, material });
        Ok(())
    }

    fn polyline<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>, line: usize) -> Result<(), ObjError> {
        let mut before = None;
        for word in words {
            let vertex = u32::try_from(corner(word, self.vertices, line)?).unwrap_or(u32::MAX);
            self.lines.extend(before.map(|b| (line, [b, vertex])));
            before = Some(vertex);
        }
        Ok(())
    }

    /// Indices that may name what stands below them.
    fn check(&self, vertices: usize) -> Result<(), ObjError> {
        let count = self.uv.len();
        for face in &self.faces {
            let wrong = |c: &&FaceCorner| c.1 != FaceMarks::NONE && c.1 as usize >= count;
            if let Some(c) = self.corners[face.corners.clone()].iter().find(wrong) {
                return Err(ObjError::NoTexture { line: face.line, index: i64::from(c.1) + 1, count });
            }
        }
        let beyond = |(line, ends): &(usize, [u32; 2])| {
            let v = ends.iter().find(|v| **v as usize >= vertices)?;
            Some(ObjError::NoVertex { line: *line, index: i64::from(*v) + 1, count: vertices })
        };
        self.lines.iter().find_map(beyond).map_or(Ok(()), Err)
    }

    fn marks(self, mesh: &Mesh, face_of: &[u32]) -> FaceMarks {
        let face = |t: usize| &self.faces[face_of[t] as usize];
        let texture_of = |t: usize| {
            let corners = &self.corners[face(t).corners.clone()];
            mesh.triangles[t].map(|v| corners.iter().find(|c| c.0 == v).map_or(FaceMarks::NONE, |c| c.1))
        };
        let count = mesh.triangles.len();
        FaceMarks {
            corners: (0..count).map(texture_of).collect(),
            groups: (0..count).map(|t| face(t).group).collect(),
            materials: (0..count).map(|t| face(t).material).collect(),
            group_names: self.groups.list,
            material_names: self.materials.list,
            lines: self.lines.into_iter().map(|(_, ends)| ends).collect(),
            uv: self.uv,
        }
    }
}

/// Names in the order in which they come up.
struct NameList {
    list: Vec<String>,
    known: BTreeMap<String, u32>,
    current: u32,
}

impl NameList {
    fn new() -> Self {
        Self { list: vec![String::new()], known: BTreeMap::from([(String::new(), 0)]), current: 0 }
    }

    fn enter<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>) {
        let words: Vec<_> = words.map(String::from_utf8_lossy).collect();
        let name: String = words.join(" ").chars().take(LONGEST_NAME).collect();
        let next = self.list.len() as u32;
        self.current = *self.known.entry(name.clone()).or_insert(next);
        if self.current == next {
            self.list.push(name);
        }
    }
}

fn texture_point<'a>(mut words: impl Iterator<Item = &'a [u8]>, line: usize) -> Result<[f64; 2], ObjError> {
    let mut next = || {
        let word = words.next().unwrap_or_default();
        let number = std::str::from_utf8(word).ok().and_then(|w| w.parse::<f64>().ok());
        let within = number.filter(|x| x.abs() <= MAX_COORDINATE);
        within.ok_or_else(|| ObjError::Texture { line, word: clip(word) })
    };
    Ok([next()?, next()?])
}

/// The texture point of `7/1` or `7/1/3`, counted from 0; none of `7` and `7//3`.
fn texture(word: &[u8], count: usize, line: usize) -> Result<u32, ObjError> {
    match word.split(|b| *b == b'/').nth(1) {
        None | Some(b"") => Ok(FaceMarks::NONE),
        Some(second) => {
            let named = corner(second, count, line).map_err(|e| match e {
                ObjError::NoVertex { line, index, count } => ObjError::NoTexture { line, index, count },
                _ => ObjError::Corner { line, word: clip(word) },
            })?;
            u32::try_from(named).map_err(|_| ObjError::NoTexture { line, index: named + 1, count })
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SHEETS: &str = "o top\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
        usemtl red\nf 1/1 2/2 3/3 4/4\ng side panel\nusemtl blue\nf 2/1/9 5/2 6/3\nf 2//1 6 3\nl 2 3\n";

    #[test]
    fn every_triangle_knows_its_texture_points_group_and_material() {
        let (mesh, marks) = parse_marked(SHEETS.as_bytes()).unwrap();
        assert_eq!(mesh, super::super::parse(SHEETS.as_bytes()).unwrap());
        let none = FaceMarks::NONE;
        assert_eq!(marks.corners, [[0, 1, 2], [0, 2, 3], [0, 1, 2], [none; 3]]);
        assert_eq!((marks.groups, marks.materials), (vec![1, 1, 2, 2], vec![1, 1, 2, 2]));
        assert_eq!(marks.group_names, ["", "top", "side panel"]);
        assert_eq!(marks.material_names, ["", "red", "blue"]);
        assert_eq!((marks.lines, marks.uv.len()), (vec![[1, 2]], 4));
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let message = |text: &str| parse_marked(text.as_bytes()).unwrap_err().to_string();
        let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        assert_eq!(
            message(&format!("{mesh}f 1/1 2/2 3/3\n")),
            "line 4 of the OBJ: there is no texture point 1, the file has 0"
        );
        assert_eq!(
            message(&format!("{mesh}vt 0\nf 1 2 3\n")),
            "line 4 of the OBJ: a texture point needs two numbers between -1e7 and 1e7"
        );
        assert_eq!(
            message(&format!("{mesh}vt nan 0\nf 1 2 3\n")),
            "line 4 of the OBJ: a texture point needs two numbers between -1e7 and 1e7, `nan` is none"
        );
        assert_eq!(
            message(&format!("{mesh}f 1 2 3\nl 1 9\n")),
            "line 5 of the OBJ: there is no vertex 9, the file has 3"
        );
        assert_eq!(message(&format!("{mesh}f 1/x 2 3\n")), "line 4 of the OBJ: `1/x` is no corner of a face");
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(noise in "(v|vt|f|l|g|usemtl|[0-9/ .-]|\n){0,200}") {
            if let Ok((mesh, marks)) = parse_marked(noise.as_bytes()) {
                let n = mesh.triangles.len();
                prop_assert_eq!([marks.corners.len(), marks.groups.len(), marks.materials.len()], [n; 3]);
                let corners = marks.corners.iter().flatten().filter(|c| **c != FaceMarks::NONE);
                prop_assert!(corners.into_iter().all(|c| (*c as usize) < marks.uv.len()));
            }
        }
    }
}
