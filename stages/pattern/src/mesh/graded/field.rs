//! How long edges should be at each place of a panel.
//!
//! Method: sizes stand on a raster over the panel's box. Places that ask for short edges lower it;
//! then growth away from them is limited to a share of the way (Persson 2006), by two passes of a 5
//! by 5 chamfer (Borgefors 1986), whose distances are too long by 2.8 % at most. Cost: linear in
//! the raster's nodes, which stand half of the shortest edge apart. Limits: at most a million
//! nodes; on panels of more the raster is coarser, and what lies between two nodes is averaged.

use toile_core::artifact::Point2;

/// Nodes of the finest raster.
const MOST_NODES: f64 = 1e6;

/// Nodes to an edge of the shortest length.
const NODES_AN_EDGE: f64 = 2.0;

/// Neighbours that stand before a node, row by row.
const BEFORE: [(isize, isize); 8] =
    [(-1, 0), (-1, -1), (0, -1), (1, -1), (-2, -1), (2, -1), (-1, -2), (1, -2)];

/// The lengths that a mesh may have, metres, and how fast they may change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    /// The shortest.
    pub fine: f64,
    /// The longest.
    pub edge: f64,
    /// Growth of the length, metres per metre.
    pub grading: f64,
}

/// Edge lengths over a panel's box.
#[derive(Debug, Clone)]
pub(crate) struct SizeField {
    low: Point2,
    cell: f64,
    columns: usize,
    rows: usize,
    sizes: Vec<f64>,
    range: Range,
}

impl SizeField {
    /// The longest edges everywhere in a box.
    pub(crate) fn new((low, high): (Point2, Point2), range: Range) -> Self {
        let span = high - low;
        let cell = (range.fine / NODES_AN_EDGE).max((span.x * span.y / MOST_NODES).sqrt());
        let count = |length: f64| (length / cell).ceil() as usize + 2;
        let (columns, rows) = (count(span.x), count(span.y));
        SizeField { low, cell, columns, rows, sizes: vec![range.edge; columns * rows], range }
    }

    /// What bounds it.
    pub(crate) fn range(&self) -> Range {
        self.range
    }

    /// Asks for edges no longer than `size` at `p`; takes effect elsewhere with
    /// [`spread`](Self::spread).
    pub(crate) fn lower(&mut self, p: Point2, size: f64) {
        let (i, j, _, _) = self.place(p);
        for k in [0, 1, self.columns, self.columns + 1].map(|step| j * self.columns + i + step) {
            let far = (self.node(k) - p).norm();
            self.sizes[k] = self.sizes[k].min(size.max(self.range.fine) + self.range.grading * far);
        }
    }

    /// Lets sizes grow from where they are short by no more than the grading.
    pub(crate) fn spread(&mut self) {
        for k in 0..self.sizes.len() {
            self.lower_from(k, 1);
        }
        for k in (0..self.sizes.len()).rev() {
            self.lower_from(k, -1);
        }
    }

    /// Limits node `k` by its neighbours on the side that the pass comes from.
    fn lower_from(&mut self, k: usize, side: isize) {
        let (i, j) = ((k % self.columns) as isize, (k / self.columns) as isize);
        for (dx, dy) in BEFORE {
            let (x, y) = (i + side * dx, j + side * dy);
            if x < 0 || y < 0 || x >= self.columns as isize || y >= self.rows as isize {
                continue;
            }
            let way = ((dx * dx + dy * dy) as f64).sqrt() * self.cell;
            let most = self.sizes[y as usize * self.columns + x as usize] + self.range.grading * way;
            self.sizes[k] = self.sizes[k].min(most);
        }
    }

    /// The length at a point, metres: between four nodes, bilinear.
    pub(crate) fn at(&self, p: Point2) -> f64 {
        let (i, j, u, v) = self.place(p);
        let at = |di: usize, dj: usize| self.sizes[(j + dj) * self.columns + i + di];
        let row = |dj: usize| at(0, dj) * (1.0 - u) + at(1, dj) * u;
        row(0) * (1.0 - v) + row(1) * v
    }

    /// The cell of a point (the nearest for one beyond the box) and its place in it, 0 to 1.
    fn place(&self, p: Point2) -> (usize, usize, f64, f64) {
        let along = |x: f64, count: usize| {
            let x = (x / self.cell).clamp(0.0, (count - 1) as f64);
            let i = (x as usize).min(count - 2);
            (i, x - i as f64)
        };
        let (i, u) = along(p.x - self.low.x, self.columns);
        let (j, v) = along(p.y - self.low.y, self.rows);
        (i, j, u, v)
    }

    fn node(&self, k: usize) -> Point2 {
        let (i, j) = (k % self.columns, k / self.columns);
        Point2::new(self.low.x + i as f64 * self.cell, self.low.y + j as f64 * self.cell)
    }

    /// The raster, for callers that find which of its nodes lie inside an outline: origin, distance
    /// and counts of nodes.
    pub(crate) fn raster(&self) -> (Point2, f64, usize, usize) {
        (self.low, self.cell, self.columns, self.rows)
    }

    /// About how many triangles of these sizes fill the nodes for which `inside` is true:
    /// equilateral ones.
    pub(crate) fn triangles(&self, inside: &[bool]) -> f64 {
        let of = |h: &f64| 4.0 / 3f64.sqrt() * (self.cell / h).powi(2);
        self.sizes.iter().zip(inside).filter(|(_, inside)| **inside).map(|(h, _)| of(h)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGE: Range = Range { fine: 0.004, edge: 0.02, grading: 0.25 };

    fn field() -> SizeField {
        SizeField::new((Point2::new(0.0, 0.0), Point2::new(0.3, 0.2)), RANGE)
    }

    #[test]
    fn sizes_grow_from_a_short_place_by_the_grading() {
        let mut field = field();
        let short = Point2::new(0.1, 0.1);
        field.lower(short, 0.004);
        field.spread();
        for (x, y) in [(0.1, 0.1), (0.12, 0.1), (0.1, 0.07), (0.13, 0.14), (0.127, 0.11), (0.3, 0.2)] {
            let p = Point2::new(x, y);
            let wanted = (0.004 + 0.25 * (p - short).norm()).min(0.02);
            let found = field.at(p);
            assert!((found / wanted - 1.0).abs() < 0.04, "at ({x}, {y}): {found} for {wanted}");
        }
    }

    #[test]
    fn neighbours_never_differ_by_more_than_the_grading() {
        let mut field = field();
        for k in 0..30 {
            let p = Point2::new(0.01 * f64::from(k * 7 % 30), 0.01 * f64::from(k * 11 % 20));
            field.lower(p, 0.003 + 0.0005 * f64::from(k));
        }
        field.spread();
        let n = field.columns;
        let steep = |a: f64, b: f64| (a - b).abs() > RANGE.grading * field.cell * (1.0 + 1e-9);
        for k in 0..field.sizes.len() - n {
            assert!(!steep(field.sizes[k], field.sizes[k + n]), "node {k} and the one above");
            assert!((k + 1) % n == 0 || !steep(field.sizes[k], field.sizes[k + 1]), "node {k} and the next");
        }
        assert!(field.sizes.iter().all(|h| (RANGE.fine..=RANGE.edge).contains(h)));
    }

    #[test]
    fn beyond_the_box_the_nearest_place_counts_and_a_huge_box_has_a_coarser_raster() {
        let mut field = field();
        field.lower(Point2::new(0.0, 0.0), 0.004);
        field.spread();
        assert_eq!(field.at(Point2::new(-1.0, -5.0)), field.at(Point2::new(0.0, 0.0)));
        let huge = SizeField::new((Point2::new(0.0, 0.0), Point2::new(100.0, 100.0)), RANGE);
        assert!(huge.sizes.len() < 1_100_000);
    }

    #[test]
    fn triangles_are_counted_by_area_over_size() {
        let (low, cell, columns, rows) = field().raster();
        assert_eq!((low, cell), (Point2::new(0.0, 0.0), 0.002));
        let count = field().triangles(&vec![true; columns * rows]);
        let wanted = (columns * rows) as f64 * 4e-6 * 4.0 / 3f64.sqrt() / 4e-4;
        assert!((count / wanted - 1.0).abs() < 1e-9);
    }
}
