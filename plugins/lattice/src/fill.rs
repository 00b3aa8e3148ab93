//! Points of an equilateral lattice inside the outline.
//!
//! Method: for each row the crossings with the loops are sorted and paired into inside runs,
//! half-open in y so that no row is torn; points nearer to a segment than [`CLEAR`] are left out.
//! Linear in points and segments.

use crate::divide::MeshSegments;
use toile_core::prelude::*;

/// Lattice points keep this distance from every segment, in edge lengths: less makes needles at the
/// border, more leaves room for a second, irregular row.
const CLEAR: f64 = 0.62;

/// Points within this distance of a segment (edge lengths) may be moved; farther in they are
/// equilateral already.
const BORDER: f64 = 2.6;

/// A point of the lattice, and whether it is near enough to the border to be moved.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seed {
    pub(crate) at: Point2,
    pub(crate) near: bool,
}

struct LatticeRows {
    low: Point2,
    h: f64,
    dy: f64,
    columns: usize,
    rows: usize,
}

impl LatticeRows {
    /// Rows over the outline's box, centred on it.
    fn over(outline: &Outline, h: f64) -> Self {
        let (low, high) = outline.bounds();
        let (span, dy) = (high - low, h * 0.75f64.sqrt());
        let (columns, rows) = ((span.x / h) as usize + 2, (span.y / dy) as usize + 1);
        let size = Vector2::new((columns - 1) as f64 * h, (rows - 1) as f64 * dy);
        LatticeRows { low: low + (span - size) / 2.0, h, dy, columns, rows }
    }

    fn y(&self, row: usize) -> f64 {
        self.low.y + row as f64 * self.dy
    }

    /// Odd rows are shifted by half an edge.
    fn x(&self, row: usize, column: usize) -> f64 {
        self.low.x + (column as f64 + 0.5 * (row % 2) as f64) * self.h
    }

    fn between(&self, y0: f64, y1: f64) -> std::ops::Range<usize> {
        let row = |y: f64| ((y - self.low.y) / self.dy).clamp(-1.0, self.rows as f64);
        (row(y0).ceil().max(0.0) as usize)..((row(y1).floor() + 1.0).max(0.0) as usize).min(self.rows)
    }

    fn columns_between(&self, row: usize, x0: f64, x1: f64) -> std::ops::Range<usize> {
        let column = |x: f64| ((x - self.x(row, 0)) / self.h).clamp(-1.0, self.columns as f64);
        (column(x0).ceil().max(0.0) as usize)
            ..((column(x1).floor() + 1.0).max(0.0) as usize).min(self.columns)
    }

    /// Which points lie inside the loops, row by row.
    fn inside(&self, division: &MeshSegments) -> Vec<bool> {
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); self.rows];
        for [a, b] in division.loop_segments().iter().map(|s| s.map(|v| division.points[v as usize])) {
            for row in self.between(a.y.min(b.y), a.y.max(b.y)) {
                let y = self.y(row);
                if (a.y <= y) != (b.y <= y) {
                    crossings[row].push(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
                }
            }
        }
        let mut inside = vec![false; self.rows * self.columns];
        for (row, xs) in crossings.iter_mut().enumerate() {
            xs.sort_by(f64::total_cmp);
            for run in xs.chunks_exact(2) {
                let columns = self.columns_between(row, run[0], run[1]);
                columns.for_each(|c| inside[row * self.columns + c] = true);
            }
        }
        inside
    }

    /// Distance of every point to the nearest segment, as far as `reach`.
    fn distances(&self, division: &MeshSegments, reach: f64) -> Vec<f64> {
        let mut distance = vec![f64::INFINITY; self.rows * self.columns];
        for [a, b] in division.segments().iter().map(|s| s.map(|v| division.points[v as usize])) {
            for row in self.between(a.y.min(b.y) - reach, a.y.max(b.y) + reach) {
                for c in self.columns_between(row, a.x.min(b.x) - reach, a.x.max(b.x) + reach) {
                    let slot = &mut distance[row * self.columns + c];
                    *slot = slot.min(to_segment(Point2::new(self.x(row, c), self.y(row)), a, b));
                }
            }
        }
        distance
    }
}

/// Distance of a point from a segment.
fn to_segment(p: Point2, a: Point2, b: Point2) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (p - (a + d * t)).norm()
}

/// The lattice's points that become vertices, row by row.
pub(crate) fn fill(outline: &Outline, division: &MeshSegments, h: f64) -> Vec<Seed> {
    let rows = LatticeRows::over(outline, h);
    let (inside, distance) = (rows.inside(division), rows.distances(division, BORDER * h));
    let kept = (0..inside.len()).filter(|&k| inside[k] && distance[k] > CLEAR * h);
    let seed = |k: usize| {
        let (row, column) = (k / rows.columns, k % rows.columns);
        Seed { at: Point2::new(rows.x(row, column), rows.y(row)), near: distance[k] < BORDER * h }
    };
    kept.map(seed).collect()
}
