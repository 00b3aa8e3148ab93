//! Points at the crossings of a lattice that lie inside a divided outline.
//!
//! Method: for each row of the lattice the crossings with the outline are sorted and paired
//! even-odd into inside runs; the rule is half-open in y, so that a row through a vertex or along a
//! flat stretch counts each crossing once and no row is torn. Points crowded against a segment are
//! left out: the outline's vertex, which cannot move, stands for them.
//! Cost: linear in points and segments.

use super::predicates::{distance_to_segment, orient};
use toile_core::artifact::{Point2, Vector2};

/// A rectangular lattice, or a triangular one where odd rows are shifted.
#[derive(Debug, Clone)]
pub(crate) struct Lattice {
    /// The point of column 0, row 0.
    pub low: Point2,
    /// Distance of columns, metres.
    pub dx: f64,
    /// Distance of rows, metres.
    pub dy: f64,
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Share of `dx` by which odd rows are shifted to the right.
    pub shift: f64,
}

impl Lattice {
    /// The point of a column and row.
    pub(crate) fn point(&self, i: usize, j: usize) -> Point2 {
        Point2::new(self.x0(j) + i as f64 * self.dx, self.low.y + j as f64 * self.dy)
    }

    /// Columns of a row from the first at or right of `x0` to the last at or left of `x1`.
    fn span(&self, j: usize, x0: f64, x1: f64) -> std::ops::Range<usize> {
        let column = |x: f64| ((x - self.x0(j)) / self.dx).clamp(-1.0, self.columns as f64);
        let (from, to) = (column(x0).ceil().max(0.0) as usize, column(x1).floor() + 1.0);
        from..(to.max(0.0) as usize).min(self.columns)
    }

    fn row_span(&self, y0: f64, y1: f64) -> std::ops::Range<usize> {
        let row = |y: f64| ((y - self.low.y) / self.dy).clamp(-1.0, self.rows as f64);
        let (from, to) = (row(y0).ceil().max(0.0) as usize, row(y1).floor() + 1.0);
        from..(to.max(0.0) as usize).min(self.rows)
    }

    fn x0(&self, j: usize) -> f64 {
        self.low.x + if j % 2 == 1 { self.shift * self.dx } else { 0.0 }
    }

    /// For every point, row by row, whether it lies inside the loops.
    pub(crate) fn inside(&self, points: &[Point2], loops: &[[u32; 2]]) -> Vec<bool> {
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); self.rows];
        for s in loops {
            let (a, b) = (points[s[0] as usize], points[s[1] as usize]);
            for j in self.row_span(a.y.min(b.y) - self.dy, a.y.max(b.y) + self.dy) {
                let y = self.low.y + j as f64 * self.dy;
                if (a.y <= y) != (b.y <= y) {
                    crossings[j].push(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
                }
            }
        }
        let mut inside = vec![false; self.columns * self.rows];
        for (j, row) in crossings.iter_mut().enumerate() {
            row.sort_by(f64::total_cmp);
            for run in row.chunks_exact(2) {
                self.span(j, run[0], run[1]).for_each(|i| inside[j * self.columns + i] = true);
            }
        }
        inside
    }

    /// Calls `near` with every point at most `reach` from a segment.
    pub(crate) fn near(
        &self,
        points: &[Point2],
        segments: &[[u32; 2]],
        reach: f64,
        mut near: impl FnMut(usize),
    ) {
        for s in segments {
            let (a, b) = (points[s[0] as usize], points[s[1] as usize]);
            let (low, high) = (a.inf(&b), a.sup(&b));
            for j in self.row_span(low.y - reach, high.y + reach) {
                for i in self.span(j, low.x - reach, high.x + reach) {
                    if distance_to_segment(self.point(i, j), a, b).0 < reach {
                        near(j * self.columns + i);
                    }
                }
            }
        }
    }

    /// For every cell (named by its lower left point), whether a segment comes into it, or as near
    /// as `margin` to its sides.
    pub(crate) fn touched_cells(&self, points: &[Point2], segments: &[[u32; 2]], margin: f64) -> Vec<bool> {
        let mut touched = vec![false; self.columns * self.rows];
        for s in segments {
            let (a, b) = (points[s[0] as usize], points[s[1] as usize]);
            let (low, high) = (a.inf(&b), a.sup(&b));
            for j in self.row_span(low.y - self.dy - margin, high.y + margin) {
                for i in self.span(j, low.x - self.dx - margin, high.x + margin) {
                    let near = self.point(i, j) - Vector2::new(margin, margin);
                    let size = Vector2::new(self.dx, self.dy).add_scalar(2.0 * margin);
                    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
                        .map(|(u, v)| near + Vector2::new(u * size.x, v * size.y));
                    let sides = corners.map(|c| orient(a, b, c));
                    let apart = sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0);
                    touched[j * self.columns + i] |= !apart;
                }
            }
        }
        touched
    }
}
