//! All pieces on one sheet, in true scale, millimetres, y up from the sheet's lower left corner.

use super::canvas::Canvas;
use crate::allowance::CutLines;
use crate::drawing::{LaidPiece, laid};
use crate::inside::{crosses, upright_parts};
use crate::options::DrawingOptions;
use crate::shelf::pack;
use toile_core::artifact::{Pattern, Point2, Vector2};

/// Between pieces, mm.
const GAP: f64 = 12.0;

/// All pieces at their places.
pub(super) struct PatternSheet<'a> {
    pub pieces: Vec<LaidPiece<'a>>,
    /// Width and height, mm.
    pub size: [f64; 2],
}

impl<'a> PatternSheet<'a> {
    /// The pieces of a pattern, not yet at their places.
    pub(super) fn new(pattern: &'a Pattern, cut: &CutLines, options: &DrawingOptions) -> Self {
        PatternSheet { pieces: laid(pattern, cut, options), size: [0.0; 2] }
    }

    /// The sizes of the pieces, mm.
    pub(super) fn sizes(&self) -> Vec<[f64; 2]> {
        self.pieces.iter().map(|p| p.size).collect()
    }

    /// Puts the pieces on a sheet of that width or more, with so much around them, mm.
    pub(super) fn lay(&mut self, width: f64, around: f64) {
        let (places, [w, h]) = pack(&self.sizes(), width - 2.0 * around, GAP);
        self.size = [w + 2.0 * around, h + 2.0 * around];
        for (p, [x, y]) in self.pieces.iter_mut().zip(places) {
            p.corner = [x + around, h + y + around];
        }
    }

    pub(super) fn draw(&self, canvas: &mut Canvas) {
        self.pieces.iter().for_each(|p| p.draw(canvas));
    }

    /// Which boxes of a grid the pieces reach, `columns` in each row, mm: those that a line of
    /// theirs crosses, and those within a piece. The first box of the first row has its lower left
    /// corner at `low`.
    pub(super) fn reached(&self, low: [f64; 2], step: [f64; 2], columns: usize, rows: usize) -> Vec<bool> {
        let mut out = vec![false; columns * rows];
        let number = |x: f64, k: usize, most: usize| {
            (((x - low[k]) / step[k]).floor().max(0.0) as usize).min(most.saturating_sub(1))
        };
        let range =
            |a: f64, b: f64, k: usize, most: usize| number(a.min(b), k, most)..=number(a.max(b), k, most);
        let corner =
            |c: usize, r: usize| Point2::new(low[0] + c as f64 * step[0], low[1] + r as f64 * step[1]);
        let across = Vector2::new(step[0], step[1]);
        for p in &self.pieces {
            let at: Vec<Point2> = p.cut.iter().map(|q| Point2::from(p.at(*q))).collect();
            for k in 0..at.len() {
                let (a, b) = (at[k], at[(k + 1) % at.len()]);
                for r in range(a.y, b.y, 1, rows) {
                    for c in range(a.x, b.x, 0, columns) {
                        out[r * columns + c] |= crosses(a, b, (corner(c, r), corner(c, r) + across));
                    }
                }
            }
            for c in range(p.corner[0], p.corner[0] + p.size[0], 0, columns) {
                let inside = upright_parts(&at, corner(c, 0).x + step[0] / 2.0);
                for r in range(p.corner[1], p.corner[1] + p.size[1], 1, rows) {
                    let y = corner(c, r).y + step[1] / 2.0;
                    out[r * columns + c] |= inside.iter().any(|[a, b]| (*a..*b).contains(&y));
                }
            }
        }
        out
    }
}
