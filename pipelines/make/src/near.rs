//! Where a point lies with respect to an outline: signed distance, nearest edge, place along it.
//!
//! A grid of cells keeps, for each cell, only the segments that can be nearest to one of its
//! points.

use crate::garment::{NamedOutline, PlanePoint, distance};

/// Cell size, mm: smaller cells hold fewer segments but there are more of them.
const CELL: f64 = 10.0;
/// How far beyond the outline's box distances are asked for, mm.
const MARGIN: f64 = 120.0;

/// The answer to a query.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NearestEdge {
    /// Distance to the outline, mm, positive inside.
    pub(crate) depth: f64,
    /// Index of the nearest edge.
    pub(crate) edge: usize,
    /// Length along the whole outline up to the nearest point, mm.
    pub(crate) along: f64,
}

/// The outline prepared for queries.
#[derive(Debug)]
pub(crate) struct NearField<'a> {
    outline: &'a NamedOutline,
    low: PlanePoint,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<u32>>,
    along: Vec<f64>,
    edge_of: Vec<usize>,
}

impl<'a> NearField<'a> {
    pub(crate) fn new(outline: &'a NamedOutline) -> Self {
        let fold =
            |f: fn(f64, f64) -> f64, k: usize, from: f64| outline.points.iter().map(|p| p[k]).fold(from, f);
        let low = [0, 1].map(|k| fold(f64::min, k, f64::INFINITY) - MARGIN);
        let high = [0, 1].map(|k| fold(f64::max, k, f64::NEG_INFINITY) + MARGIN);
        let [columns, rows] = [0, 1].map(|k| ((high[k] - low[k]) / CELL).ceil() as usize);
        let mut field = NearField {
            outline,
            low,
            columns,
            rows,
            cells: Vec::new(),
            along: arc_lengths(outline),
            edge_of: edge_indices(outline),
        };
        field.cells = (0..columns * rows).map(|c| field.candidates(c)).collect();
        field
    }

    fn segment(&self, i: usize) -> (PlanePoint, PlanePoint) {
        let p = &self.outline.points;
        (p[i], p[(i + 1) % p.len()])
    }

    fn candidates(&self, cell: usize) -> Vec<u32> {
        let centre = [
            self.low[0] + ((cell % self.columns) as f64 + 0.5) * CELL,
            self.low[1] + ((cell / self.columns) as f64 + 0.5) * CELL,
        ];
        let reach: Vec<f64> =
            (0..self.outline.points.len()).map(|i| to_segment(centre, self.segment(i)).0).collect();
        // The nearest segment of any point of the cell is at most one diagonal farther from the
        // centre.
        let limit = reach.iter().copied().fold(f64::INFINITY, f64::min) + CELL * 2f64.sqrt();
        (0..reach.len()).filter(|&i| reach[i] <= limit).map(|i| i as u32).collect()
    }

    /// A horizontal line at height `y`, along which points are asked for.
    pub(crate) fn row(&self, y: f64) -> OutlineRow<'_> {
        let points = &self.outline.points;
        let mut crossings: Vec<f64> = points
            .iter()
            .zip(points.iter().cycle().skip(1))
            .filter(|(a, b)| (a[1] > y) != (b[1] > y))
            .map(|(a, b)| a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            .collect();
        crossings.sort_by(f64::total_cmp);
        OutlineRow { field: self, y, crossings }
    }
}

/// One horizontal line over the outline, with its crossings.
#[derive(Debug)]
pub(crate) struct OutlineRow<'a> {
    field: &'a NearField<'a>,
    y: f64,
    crossings: Vec<f64>,
}

impl OutlineRow<'_> {
    /// The nearest place of the outline; points beyond the margin count as at its border.
    pub(crate) fn at(&self, x: f64) -> NearestEdge {
        let (f, p) = (self.field, [x, self.y]);
        let index = |k: usize, count: usize| (((p[k] - f.low[k]) / CELL).max(0.0) as usize).min(count - 1);
        let mut best = (f64::INFINITY, 0.0, 0);
        for &i in &f.cells[index(1, f.rows) * f.columns + index(0, f.columns)] {
            let (d, t) = to_segment(p, f.segment(i as usize));
            if d < best.0 {
                best = (d, t, i as usize);
            }
        }
        let (d, t, i) = best;
        let (a, b) = f.segment(i);
        // Even-odd rule.
        let inside = self.crossings.iter().filter(|&&c| c < x).count() % 2 == 1;
        NearestEdge {
            depth: if inside { d } else { -d },
            edge: f.edge_of[i],
            along: f.along[i] + t * distance(a, b),
        }
    }
}

fn arc_lengths(outline: &NamedOutline) -> Vec<f64> {
    let mut sum = 0.0;
    let next = outline.points.iter().cycle().skip(1);
    outline
        .points
        .iter()
        .zip(next)
        .map(|(a, b)| {
            let here = sum;
            sum += distance(*a, *b);
            here
        })
        .collect()
}

fn edge_indices(outline: &NamedOutline) -> Vec<usize> {
    let last = |i: usize| outline.edges.iter().rposition(|e| e.start <= i).unwrap_or(0);
    (0..outline.points.len()).map(last).collect()
}

/// Distance of a point to a segment and the share of the segment up to its nearest point.
fn to_segment(p: PlanePoint, (a, b): (PlanePoint, PlanePoint)) -> (f64, f64) {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = u[0] * u[0] + u[1] * u[1];
    let t = if square > 0.0 { ((u[0] * v[0] + u[1] * v[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (distance(p, [a[0] + u[0] * t, a[1] + u[1] * t]), t)
}
