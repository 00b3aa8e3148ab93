//! Point location: the coarse triangle in which a fine vertex lies, and its weights there.
//!
//! Method: a grid of cells as large as a triangle. Cost: O(1) a vertex.

use super::Pieces;
use nalgebra::Vector2;
use std::collections::BTreeMap;

/// Finds the coarse triangle that a fine vertex lies in.
pub(super) struct CoarseLocator<'a> {
    pieces: &'a Pieces,
    cell: f64,
    cells: BTreeMap<(u32, i64, i64), Vec<u32>>,
}

impl<'a> CoarseLocator<'a> {
    pub(super) fn new(pieces: &'a Pieces) -> Self {
        let area: f64 = pieces
            .triangles
            .iter()
            .map(|t| corners(pieces, t))
            .map(|[a, b, c]| 0.5 * (b - a).perp(&(c - a)))
            .sum();
        let cell = (2.0 * area / pieces.triangles.len() as f64).sqrt().max(1e-9);
        let mut cells: BTreeMap<(u32, i64, i64), Vec<u32>> = BTreeMap::new();
        for (k, t) in pieces.triangles.iter().enumerate() {
            let c = corners(pieces, t);
            let (low, high) = (c[0].inf(&c[1]).inf(&c[2]) / cell, c[0].sup(&c[1]).sup(&c[2]) / cell);
            for i in low.x.floor() as i64..=high.x.floor() as i64 {
                for j in low.y.floor() as i64..=high.y.floor() as i64 {
                    cells.entry((pieces.piece[t[0] as usize], i, j)).or_default().push(k as u32);
                }
            }
        }
        Self { pieces, cell, cells }
    }

    pub(super) fn weights(&self, fine: &Pieces) -> Vec<([u32; 3], [f64; 3])> {
        fine.rest.iter().zip(&fine.piece).map(|(p, &piece)| self.find(p, piece)).collect()
    }

    /// The triangle in which `p` lies, or from which it is least far outside, and its weights
    /// there.
    fn find(&self, p: &Vector2<f64>, piece: u32) -> ([u32; 3], [f64; 3]) {
        let (ci, cj) = ((p.x / self.cell).floor() as i64, (p.y / self.cell).floor() as i64);
        let mut best: Option<(f64, u32, [f64; 3])> = None;
        for ring in 0..4 {
            for i in ci - ring..=ci + ring {
                for j in cj - ring..=cj + ring {
                    for &t in self.cells.get(&(piece, i, j)).map_or(&[][..], |c| c) {
                        let w = barycentric(p, &corners(self.pieces, &self.pieces.triangles[t as usize]));
                        let least = w.iter().copied().fold(f64::INFINITY, f64::min);
                        if best.is_none_or(|b| least > b.0) {
                            best = Some((least, t, w));
                        }
                    }
                }
            }
            if best.is_some_and(|b| b.0 > -1e-9 || ring > 0) {
                break;
            }
        }
        let (_, t, w) = best.unwrap_or((0.0, 0, [1.0, 0.0, 0.0]));
        (self.pieces.triangles[t as usize], w)
    }
}

pub(super) fn corners(pieces: &Pieces, t: &[u32; 3]) -> [Vector2<f64>; 3] {
    t.map(|v| pieces.rest[v as usize])
}

fn barycentric(p: &Vector2<f64>, [a, b, c]: &[Vector2<f64>; 3]) -> [f64; 3] {
    let area = (b - a).perp(&(c - a));
    let (v, w) = ((p - a).perp(&(c - a)) / area, (b - a).perp(&(p - a)) / area);
    [1.0 - v - w, v, w]
}
