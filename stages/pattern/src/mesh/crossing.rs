//! Finds two segments that cross or touch.
//!
//! Method: the segments are entered into a uniform grid of about as many cells as there are
//! segments, row by row, and only those that share a cell are tested, exactly.
//! Cost: about linear for outlines; n sqrt(n) cells for n segments as long as the panel.
//! Limits: none on the input; a touch counts as a crossing.

use super::predicates::{fold_back, segments_meet};
use toile_core::artifact::Point2;

/// The first pair of segments that cross, touch or run over each other. Segments that share a
/// vertex index may meet there.
pub(crate) fn first_crossing(points: &[Point2], segments: &[[u32; 2]]) -> Option<[usize; 2]> {
    let grid = Cells::new(points, segments);
    let mut filled: Vec<(u32, u32)> = Vec::new();
    for (i, s) in segments.iter().enumerate() {
        grid.visit(points[s[0] as usize], points[s[1] as usize], |cell| filled.push((cell as u32, i as u32)));
    }
    filled.sort_unstable();
    filled.chunk_by(|a, b| a.0 == b.0).filter_map(|cell| crossing_in_cell(points, segments, cell)).min()
}

fn crossing_in_cell(points: &[Point2], segments: &[[u32; 2]], cell: &[(u32, u32)]) -> Option<[usize; 2]> {
    let pairs = cell.iter().enumerate().flat_map(|(k, a)| cell[k + 1..].iter().map(move |b| (a.1, b.1)));
    pairs
        .filter(|&(i, j)| clash(points, segments[i as usize], segments[j as usize]))
        .map(|(i, j)| [i as usize, j as usize])
        .min()
}

fn clash(points: &[Point2], s: [u32; 2], t: [u32; 2]) -> bool {
    let at = |i: u32| points[i as usize];
    let shared = s.iter().find(|v| t.contains(v)).copied();
    let other = |s: [u32; 2], v: u32| at(if s[0] == v { s[1] } else { s[0] });
    match shared {
        Some(v) => fold_back(at(v), other(s, v), other(t, v)),
        None => segments_meet(at(s[0]), at(s[1]), at(t[0]), at(t[1])),
    }
}

/// A uniform grid over the points' box.
pub(crate) struct Cells {
    low: Point2,
    size: f64,
    columns: usize,
    rows: usize,
}

impl Cells {
    /// About one cell per segment, and no fewer than one.
    fn new(points: &[Point2], segments: &[[u32; 2]]) -> Self {
        let (mut low, mut high) =
            (Point2::new(f64::INFINITY, f64::INFINITY), Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY));
        for p in points {
            low = low.inf(p);
            high = high.sup(p);
        }
        let span = high - low;
        let size = (span.x.max(span.y) / (segments.len() as f64).sqrt().max(1.0)).max(f64::MIN_POSITIVE);
        let count = |length: f64| (length / size) as usize + 1;
        Cells { low, size, columns: count(span.x), rows: count(span.y) }
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.low.x) / self.size).max(0.0) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.low.y) / self.size).max(0.0) as usize).min(self.rows - 1)
    }

    /// Every cell that the segment ab may pass through, a little widened against rounding.
    fn visit(&self, a: Point2, b: Point2, mut enter: impl FnMut(usize)) {
        let slack = self.size * 1e-6;
        let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
        for row in self.row(a.y - slack)..=self.row(b.y + slack) {
            let (y0, y1) = (self.low.y + row as f64 * self.size, self.low.y + (row + 1) as f64 * self.size);
            let at = |y: f64| match b.y > a.y {
                true => a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0),
                false => a.x,
            };
            let (mut x0, mut x1) = (at(y0 - slack), at(y1 + slack));
            if b.y - a.y <= slack {
                (x0, x1) = (a.x, b.x);
            }
            for column in self.column(x0.min(x1) - slack)..=self.column(x0.max(x1) + slack) {
                enter(row * self.columns + column);
            }
        }
    }
}
