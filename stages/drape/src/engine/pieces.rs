//! The pieces of cloth of a garment, which fall each for itself.

use toile_core::artifact::Garment;
use toile_core::artifact::join_pairs;

/// All cloth that hangs together.
pub(super) struct ClothPiece {
    /// Its vertices, ascending.
    pub(super) vertices: Vec<usize>,
    /// Flat, square metres.
    pub(super) area: f64,
    /// Whether a pin holds it.
    pub(super) is_held: bool,
}

/// The pieces of a garment: what hangs together by triangles, welds and seams.
pub(super) fn pieces(garment: &Garment) -> Vec<ClothPiece> {
    let mut root = garment.weld.clone();
    let sides: Vec<[u32; 2]> = garment.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]]]).collect();
    join_pairs(&mut root, sides.iter().chain(garment.seams.iter().flat_map(|s| &s.pairs)));
    let mut number = vec![usize::MAX; root.len()];
    let mut pieces: Vec<ClothPiece> = Vec::new();
    let mut areas = vec![0.0; root.len()];
    for t in &garment.triangles {
        let [a, b, c] = t.map(|i| garment.rest[i as usize]);
        areas[root[t[0] as usize] as usize] += (b - a).perp(&(c - a)).abs() / 2.0;
    }
    for (v, &r) in root.iter().enumerate().filter(|(_, r)| areas[**r as usize] > 0.0) {
        let k = &mut number[r as usize];
        if *k == usize::MAX {
            *k = pieces.len();
            pieces.push(ClothPiece { vertices: vec![], area: areas[r as usize], is_held: false });
        }
        pieces[*k].vertices.push(v);
    }
    for &v in &garment.pinned {
        if let Some(piece) = pieces.get_mut(number[root[v as usize] as usize]) {
            piece.is_held = true;
        }
    }
    pieces
}
