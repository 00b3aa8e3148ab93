//! Wavefront OBJ: bodies are read from it and results are written to it.
//!
//! Method: `text` makes lines of bytes in any encoding, [`parse`] takes the `v` and `f` lines (all
//! else is passed over), [`parse_marked`] also what says where a garment's pieces end, `polygon`
//! cuts faces into triangles, [`repair`] mends what exporters leave behind, [`outer_surface`] drops
//! what no cloth can touch. What cannot be mended (holes, edges of three triangles) is left for the
//! check of the body. Cost: linear in the text, and a sort of the edges.

mod foreign;
mod marked;
mod parse;
mod pieces;
mod polygon;
mod repair;
mod surface;
mod text;
mod write;

#[cfg(test)]
mod tests;

pub use foreign::{other_format, without_faces};
pub use marked::{FaceMarks, parse_marked};
pub use parse::{MAX_COORDINATE, MAX_TRIANGLES, MAX_VERTICES, count_triangles, parse};
pub use pieces::is_flat;
pub use repair::{JOIN, Repairs, repair};
pub use repair::{first_of_each, joined};
pub use surface::outer_surface;
pub use text::decode;
pub use write::{to_text, write};

use nalgebra::Vector3;

/// What to do about an OBJ file that cannot be read.
pub const OBJ_HINT: &str =
    "it must be a Wavefront OBJ with `v` and `f` lines; write it again from the program that made it";

/// A mesh as an OBJ file holds it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Its vertices, in the file's unit.
    pub vertices: Vec<Vector3<f64>>,
    /// Its triangles; faces of more corners are cut.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The diagonal of the box around all that triangles use; 0 for none.
    #[must_use]
    pub fn size(&self) -> f64 {
        let mut used = self.triangles.iter().flatten().map(|&v| self.vertices[v as usize]);
        let Some(first) = used.next() else { return 0.0 };
        let (low, high) = used.fold((first, first), |(l, h), p| (l.inf(&p), h.sup(&p)));
        (high - low).norm()
    }
}

/// Why an OBJ file cannot be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ObjError {
    /// A `v` line without three numbers.
    #[error("line {line} of the OBJ: a vertex needs three numbers{}", instead(word))]
    Vertex {
        /// Counted from 1.
        line: usize,
        /// The word that is no number; empty where words are missing.
        word: String,
    },
    /// A coordinate that is not finite or beyond sense.
    #[error("line {line} of the OBJ: the coordinate {word} is not between -1e7 and 1e7")]
    Coordinate {
        /// Counted from 1.
        line: usize,
        /// The coordinate as it is written.
        word: String,
    },
    /// An `f` line with fewer than three corners.
    #[error("line {line} of the OBJ: a face needs three corners")]
    FewCorners {
        /// Counted from 1.
        line: usize,
    },
    /// A corner that is no number.
    #[error("line {line} of the OBJ: `{word}` is no corner of a face")]
    Corner {
        /// Counted from 1.
        line: usize,
        /// The corner as it is written.
        word: String,
    },
    /// A corner that names no vertex.
    #[error("line {line} of the OBJ: there is no vertex {index}, the file has {count}")]
    NoVertex {
        /// Counted from 1.
        line: usize,
        /// The index as it is written.
        index: i64,
        /// Vertices of the file; above the line for a negative index.
        count: usize,
    },
    /// A `vt` line without two numbers that are between -1e7 and 1e7.
    #[error(
        "line {line} of the OBJ: a texture point needs two numbers between -1e7 and 1e7{}",
        instead(word)
    )]
    Texture {
        /// Counted from 1.
        line: usize,
        /// The word that is no such number; empty where words are missing.
        word: String,
    },
    /// A corner that names no texture point.
    #[error("line {line} of the OBJ: there is no texture point {index}, the file has {count}")]
    NoTexture {
        /// Counted from 1.
        line: usize,
        /// The index as it is written.
        index: i64,
        /// Texture points of the file; above the line for a negative index.
        count: usize,
    },
    /// A face that is not convex, of very many corners.
    #[error("line {line} of the OBJ: the face of {corners} corners is not convex; cut it into triangles")]
    Concave {
        /// Counted from 1.
        line: usize,
        /// Its corners.
        corners: usize,
    },
    /// More than any body has.
    #[error("line {line} of the OBJ: there are more than {most} {what}; make the mesh coarser")]
    TooMany {
        /// Counted from 1.
        line: usize,
        /// Vertices or triangles.
        what: &'static str,
        /// How many may be.
        most: usize,
    },
    /// A file without faces.
    #[error("the OBJ holds no faces")]
    NoFaces,
}

fn instead(word: &str) -> String {
    if word.is_empty() { String::new() } else { format!(", `{word}` is none") }
}
