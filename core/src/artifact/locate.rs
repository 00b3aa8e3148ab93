//! Finds the triangle of a flat mesh in which a point lies.
//!
//! Method: triangles are entered into the cells of a uniform grid that their boxes touch; a point
//! looks into its own cell, then into wider and wider rings. Cost: linear in the triangles; a point
//! costs what its cell holds. Limits: a point beyond the mesh gets the triangle nearest to it, by
//! distance to its sides.

use super::{Point2, Point3, Vector3};
use std::collections::BTreeMap;

/// Where a point lies: a triangle, its weights (which sum to 1), and how far beyond the mesh it is,
/// metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located {
    /// Index of the triangle.
    pub triangle: usize,
    /// Weights of its corners; one is negative for a point beyond the mesh.
    pub weights: [f64; 3],
    /// Distance from the triangle, metres; 0 inside.
    pub beyond: f64,
}

impl Located {
    /// The same point of the cloth where the triangle's corners lie in space.
    pub fn in_space(&self, corners: [Point3; 3]) -> Point3 {
        Point3::from((0..3).map(|k| corners[k].coords * self.weights[k]).sum::<Vector3>())
    }
}

/// Cells to the farthest that a point may lie beyond the mesh, at most.
const CELLS_A_REACH: f64 = 8.0;

/// A triangle of less area than this share of its square extent is a needle.
const LEAST_SHAPE: f64 = 1e-3;

/// A flat mesh, ready to be asked.
#[derive(Debug, Clone)]
pub struct Locator {
    corners: Vec<[Point2; 3]>,
    cell: f64,
    cells: BTreeMap<(i64, i64), Vec<usize>>,
    reach: f64,
}

impl Locator {
    /// Of triangles with some area, for points at most `reach` (metres) beyond them; none where
    /// there are none.
    pub fn new(corners: Vec<[Point2; 3]>, reach: f64) -> Option<Self> {
        let area: f64 = corners.iter().map(|[a, b, c]| (b - a).perp(&(c - a)).abs() / 2.0).sum();
        // With the mean square of the boxes for a cell, all boxes together touch a number of cells
        // linear in theirs.
        let extent = |[a, b, c]: &[Point2; 3]| (a.sup(b).sup(c) - a.inf(b).inf(c)).max().powi(2);
        let mean = corners.iter().map(extent).sum::<f64>() / corners.len() as f64;
        let cell = mean.sqrt().max(reach / CELLS_A_REACH);
        if !(cell.is_finite() && area > 0.0) {
            return None;
        }
        let mut cells: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
        for (k, [a, b, c]) in corners.iter().enumerate() {
            // A point by a needle is located by the triangles beside it.
            if (b - a).perp(&(c - a)).abs() <= LEAST_SHAPE * extent(&corners[k]) {
                continue;
            }
            let (low, high) = (a.inf(b).inf(c) / cell, a.sup(b).sup(c) / cell);
            for i in low.x.floor() as i64..=high.x.floor() as i64 {
                for j in low.y.floor() as i64..=high.y.floor() as i64 {
                    cells.entry((i, j)).or_default().push(k);
                }
            }
        }
        Some(Locator { corners, cell, cells, reach })
    }

    /// The triangle that holds `p`, or the nearest one within reach.
    pub fn find(&self, p: Point2) -> Option<Located> {
        let (i, j) = ((p.x / self.cell).floor() as i64, (p.y / self.cell).floor() as i64);
        let most = (self.reach / self.cell).ceil() as i64 + 1;
        let mut best: Option<Located> = None;
        for ring in 0..=most {
            // What lies in farther rings is farther than this.
            if best.is_some_and(|b| b.beyond <= (ring - 1).max(0) as f64 * self.cell) {
                break;
            }
            let edge = |x: i64, y: i64| (x - i).abs().max((y - j).abs()) == ring;
            let cells = (i - ring..=i + ring).flat_map(|x| (j - ring..=j + ring).map(move |y| (x, y)));
            for &k in cells.filter(|c| edge(c.0, c.1)).filter_map(|c| self.cells.get(&c)).flatten() {
                let place = self.place(k, p);
                if best.is_none_or(|b| (place.beyond, place.triangle) < (b.beyond, b.triangle)) {
                    best = Some(place);
                }
            }
        }
        best.filter(|b| b.beyond <= self.reach)
    }

    fn place(&self, k: usize, p: Point2) -> Located {
        let [a, b, c] = self.corners[k];
        let area = (b - a).perp(&(c - a));
        let (v, w) = ((p - a).perp(&(c - a)) / area, (b - a).perp(&(p - a)) / area);
        let weights = [1.0 - v - w, v, w];
        let inside = weights.iter().all(|w| *w >= -1e-12);
        let to = |a: Point2, b: Point2| {
            let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (p - (a + (b - a) * t)).norm()
        };
        let beyond = if inside { 0.0 } else { to(a, b).min(to(b, c)).min(to(c, a)) };
        Located { triangle: k, weights, beyond }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn locator(reach: f64) -> Locator {
        let p = |x: f64, y: f64| Point2::new(x, y);
        let quad = |x: f64, y: f64| {
            let (a, b, c, d) = (p(x, y), p(x + 0.1, y), p(x + 0.1, y + 0.1), p(x, y + 0.1));
            [[a, b, c], [a, c, d]]
        };
        let all = (0..5).flat_map(|j| (0..8).flat_map(move |i| quad(0.1 * f64::from(i), 0.1 * f64::from(j))));
        Locator::new(all.collect(), reach).unwrap()
    }

    #[test]
    fn weights_give_the_point_back_inside_and_beyond() {
        let locator = locator(0.3);
        for (x, y, beyond) in
            [(0.31, 0.27, 0.0), (0.0, 0.0, 0.0), (0.8, 0.5, 0.0), (0.85, 0.2, 0.05), (0.4, -0.2, 0.2)]
        {
            let q = Point2::new(x, y);
            let found = locator.find(q).unwrap();
            let corners = locator.corners[found.triangle];
            let back: super::super::Vector2 = (0..3).map(|k| corners[k].coords * found.weights[k]).sum();
            assert!((back - q.coords).norm() < 1e-12 && (found.beyond - beyond).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn what_is_out_of_reach_is_not_found() {
        assert_eq!(locator(0.3).find(Point2::new(2.0, 0.2)), None);
        assert!(locator(1.3).find(Point2::new(2.0, 0.2)).is_some());
        assert!(Locator::new(vec![], 0.1).is_none());
        assert!(Locator::new(vec![[Point2::origin(); 3]], 0.1).is_none());
    }
}
