//! A panel that lies on a piece of the pattern.

use nalgebra::Isometry2;
use std::collections::BTreeMap;

/// Panels that lie on pieces, by the pieces' places in the pattern: each with its own place in the
/// garment.
pub type ByPiece<'a> = BTreeMap<usize, (usize, &'a Laid)>;

/// A panel on its piece.
#[derive(Debug, Clone)]
pub struct Laid {
    /// The piece, by its place in the pattern.
    pub piece: usize,
    /// Takes flat places of the panel to the piece.
    pub to: Isometry2<f64>,
    /// The farthest that either outline is from the other, metres.
    pub deviation: f64,
    /// For each edge of the piece's outer loop the panel's vertices along it, ends included.
    pub edges: Vec<Vec<u32>>,
    /// Loops of the panel beyond those of the piece.
    pub holes: usize,
}
