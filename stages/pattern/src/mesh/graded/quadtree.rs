//! Inner vertices at the corners of squares that are as small as the sizes ask.
//!
//! Method: a grid along warp and weft with cells of about the longest edge; a cell that is too
//! large for the size in it is cut into four, and neighbours differ by one such cut at most (Yerry,
//! Shephard 1983). Grain counts: a woven cloth hardly stretches along its threads and shears with
//! ease, and triangles whose sides run along the threads can do so, while slanted ones of the same
//! size are too stiff. Cost: linear in the cells. Limits: sizes come in halves of the longest; one
//! in between gets the nearer by ratio.

use super::super::divide::Division;
use super::super::predicates::distance_to_segment;
use super::field::SizeField;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::artifact::{Point2, Vector2};
use toile_core::{Context, StageError};

/// A cell is cut where the size in it is below this share of its side: half-way, by ratio, to its
/// half.
const CUT: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// A corner nearer to the outline than this share of the size is left out: the outline's own
/// vertices stand for it.
const LEAST_DISTANCE: f64 = 0.5;
/// Most cuts of a cell, one in the other.
const MOST_CUTS: usize = 12;

/// Cells of all levels: level 0 the largest.
pub(crate) struct Quadtree {
    low: Point2,
    /// Sides of the largest cells, metres.
    side: Vector2,
    /// Their columns and rows.
    counts: (i64, i64),
    /// Cells that there are at each level, those that are cut as well, by row and column.
    levels: Vec<BTreeSet<(i64, i64)>>,
}

impl Quadtree {
    /// A quadtree over a box, with cells as small as the field requires.
    pub(crate) fn new((low, high): (Point2, Point2), field: &SizeField) -> Self {
        let (span, edge) = (high - low, field.range().edge);
        let count = |length: f64| ((length / edge - 1e-9).ceil() as i64).max(1);
        let counts = (count(span.x), count(span.y));
        let side = Vector2::new(span.x / counts.0 as f64, span.y / counts.1 as f64);
        let mut tree = Quadtree { low, side, counts, levels: vec![] };
        let all = (0..counts.1).flat_map(|j| (0..counts.0).map(move |i| (j, i)));
        tree.levels.push(all.collect());
        while tree.levels.len() <= MOST_CUTS {
            let level = tree.levels.len() - 1;
            let cut = |c: &&(i64, i64)| tree.is_too_large(level, **c, field);
            let next: BTreeSet<_> =
                tree.levels[level].iter().filter(cut).flat_map(|c| children(*c)).collect();
            if next.is_empty() {
                break;
            }
            tree.levels.push(next);
        }
        tree.balance();
        tree
    }

    fn is_too_large(&self, level: usize, cell: (i64, i64), field: &SizeField) -> bool {
        let side = self.side.max() / (1u64 << level) as f64;
        let probes = [(0.5, 0.5), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let at = |(u, v): (f64, f64)| field.at(self.point(level, cell.1 as f64 + u, cell.0 as f64 + v));
        // The middle counts twice: a corner alone lies in four cells.
        let mean = (at(probes[0]) + probes.map(at).iter().sum::<f64>()) / 6.0;
        side > field.range().fine && mean < CUT * side
    }

    /// Adds cells until the neighbours of each, at corners too, are cut at most once less.
    fn balance(&mut self) {
        for level in (1..self.levels.len()).rev() {
            let parents: BTreeSet<(i64, i64)> =
                self.levels[level].iter().map(|c| (c.0 >> 1, c.1 >> 1)).collect();
            let limit = (self.counts.0 << (level - 1), self.counts.1 << (level - 1));
            let near = |&(j, i): &(i64, i64)| {
                (j - 1..=j + 1).flat_map(move |y| (i - 1..=i + 1).map(move |x| (y, x)))
            };
            let there = |c: &(i64, i64)| c.0 >= 0 && c.1 >= 0 && c.0 < limit.1 && c.1 < limit.0;
            let wanted: Vec<(i64, i64)> = parents.iter().flat_map(near).filter(there).collect();
            // A cell is there with the three others that its parent was cut into.
            let whole =
                |c: (i64, i64)| if level > 1 { children((c.0 >> 1, c.1 >> 1)).to_vec() } else { vec![c] };
            self.levels[level - 1].extend(wanted.into_iter().flat_map(whole));
            self.levels[level].extend(parents.into_iter().flat_map(children));
        }
    }

    /// The point of a place among the cells of a level.
    fn point(&self, level: usize, i: f64, j: f64) -> Point2 {
        let scale = (1u64 << level) as f64;
        self.low + Vector2::new(i / scale * self.side.x, j / scale * self.side.y)
    }

    /// The level of the smallest cells.
    fn deepest(&self) -> usize {
        self.levels.len() - 1
    }

    /// All corners of cells, each once, by row and column of the smallest cells.
    fn corners(&self) -> BTreeSet<(i64, i64)> {
        let mut corners = BTreeSet::new();
        for (level, cells) in self.levels.iter().enumerate() {
            let up = self.deepest() - level;
            let of = |&(j, i): &(i64, i64)| [(j, i), (j, i + 1), (j + 1, i), (j + 1, i + 1)];
            corners.extend(cells.iter().flat_map(of).map(|(j, i)| (j << up, i << up)));
        }
        corners
    }

    /// The corners inside a divided outline and clear of its segments, row by row.
    pub(crate) fn seeds(
        &self,
        division: &Division,
        field: &SizeField,
        cx: &Context,
    ) -> Result<Vec<Point2>, StageError> {
        let mut rows: BTreeMap<i64, Vec<i64>> = BTreeMap::new();
        self.corners().into_iter().for_each(|(j, i)| rows.entry(j).or_default().push(i));
        let at = |j: i64, i: i64| self.point(self.deepest(), i as f64, j as f64);
        let mut seeds: BTreeMap<(i64, i64), Point2> = BTreeMap::new();
        let loops = division.loop_segments();
        for (&j, row) in &rows {
            cx.check()?;
            let crossings = crossings(division, &loops, at(j, 0).y);
            let inside = |p: &Point2| crossings.partition_point(|x| *x <= p.x) % 2 == 1;
            seeds.extend(row.iter().map(|&i| ((j, i), at(j, i))).filter(|(_, p)| inside(p)));
        }
        for s in division.segments() {
            let [a, b] = s.map(|v| division.points[v as usize]);
            self.drop_near(&mut seeds, &rows, (a, b), field);
        }
        cx.check()?;
        Ok(seeds.into_values().collect())
    }

    /// Takes out the corners near a segment.
    fn drop_near(
        &self,
        seeds: &mut BTreeMap<(i64, i64), Point2>,
        rows: &BTreeMap<i64, Vec<i64>>,
        (a, b): (Point2, Point2),
        field: &SizeField,
    ) {
        let reach = LEAST_DISTANCE * field.range().edge;
        let (low, high) = (a.inf(&b) - self.low, a.sup(&b) - self.low);
        let cell = self.side / (1u64 << self.deepest()) as f64;
        let span = |low: f64, high: f64, cell: f64| {
            (((low - reach) / cell).floor() as i64, ((high + reach) / cell).ceil() as i64)
        };
        let ((left, right), (from, to)) = (span(low.x, high.x, cell.x), span(low.y, high.y, cell.y));
        for (&j, row) in rows.range(from..=to) {
            let first = row.partition_point(|i| *i < left);
            for &i in row[first..].iter().take_while(|i| **i <= right) {
                let near = |p: &Point2| distance_to_segment(*p, a, b).0 < LEAST_DISTANCE * field.at(*p);
                if seeds.get(&(j, i)).is_some_and(near) {
                    seeds.remove(&(j, i));
                }
            }
        }
    }

    /// The direction of the diagonal of the square with this lowest corner and side, so that
    /// diagonals alternate like a chequer board: true from the lowest corner to the highest; none
    /// where there is no such cell.
    pub(crate) fn rises(&self, corner: Point2, side: f64) -> Option<bool> {
        let level = (self.side.x / side).log2().round();
        if !(0.0..=MOST_CUTS as f64).contains(&level) {
            return None;
        }
        let scale = (1u64 << level as u64) as f64;
        let (u, v) =
            ((corner.x - self.low.x) * scale / self.side.x, (corner.y - self.low.y) * scale / self.side.y);
        let whole = |x: f64| (x - x.round()).abs() < 1e-6;
        (whole(u) && whole(v)).then(|| (u.round() as i64 + v.round() as i64) % 2 == 0)
    }
}

fn children((j, i): (i64, i64)) -> [(i64, i64); 4] {
    [(2 * j, 2 * i), (2 * j, 2 * i + 1), (2 * j + 1, 2 * i), (2 * j + 1, 2 * i + 1)]
}

/// Where a row crosses the outline, ascending; half-open in y, so that a row through a vertex
/// counts once.
fn crossings(division: &Division, loops: &[[u32; 2]], y: f64) -> Vec<f64> {
    let cross = |s: &[u32; 2]| {
        let [a, b] = s.map(|v| division.points[v as usize]);
        ((a.y <= y) != (b.y <= y)).then(|| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)))
    };
    let mut all: Vec<f64> = loops.iter().filter_map(cross).collect();
    all.sort_by(f64::total_cmp);
    all
}

#[cfg(test)]
mod tests {
    use super::super::field::Range;
    use super::*;

    fn tree(grading: f64) -> Quadtree {
        let range = Range { fine: 0.004, edge: 0.032, grading };
        let bounds = (Point2::new(0.0, 0.0), Point2::new(0.64, 0.32));
        let mut field = SizeField::new(bounds, range);
        field.lower(Point2::new(0.2, 0.1), 0.004);
        field.spread();
        Quadtree::new(bounds, &field)
    }

    #[test]
    fn cells_are_as_small_as_the_sizes_ask() {
        let tree = tree(0.2);
        assert_eq!(tree.levels.len(), 4);
        let has = |level: usize, x: f64, y: f64| {
            let scale = (1u64 << level) as f64 / 0.032;
            tree.levels[level].contains(&((y * scale) as i64, (x * scale) as i64))
        };
        assert!(has(3, 0.2, 0.1) && has(2, 0.23, 0.1) && !has(3, 0.25, 0.1) && !has(1, 0.5, 0.25));
    }

    #[test]
    fn neighbours_differ_by_one_cut_however_steep_the_sizes() {
        let tree = tree(1.0);
        let is_leaf = |level: usize, c: (i64, i64)| {
            tree.levels[level].contains(&c)
                && tree.levels.get(level + 1).is_none_or(|n| children(c).iter().all(|k| !n.contains(k)))
        };
        for level in 2..tree.levels.len() {
            for &(j, i) in &tree.levels[level] {
                for (y, x) in [(j - 1, i), (j + 1, i), (j, i - 1), (j, i + 1), (j - 1, i - 1), (j + 1, i + 1)]
                {
                    for up in 2..=level {
                        assert!(!is_leaf(level - up, (y >> up, x >> up)), "({i}, {j}) of level {level}");
                    }
                }
            }
        }
    }

    #[test]
    fn all_cells_of_a_level_come_in_fours() {
        let tree = tree(1.0);
        for level in 1..tree.levels.len() {
            let whole = |c: &(i64, i64)| {
                children((c.0 >> 1, c.1 >> 1)).iter().all(|k| tree.levels[level].contains(k))
            };
            assert!(tree.levels[level].iter().all(whole));
        }
    }

    #[test]
    fn diagonals_alternate() {
        let tree = tree(0.3);
        assert_eq!(tree.rises(Point2::new(0.0, 0.0), 0.032), Some(true));
        assert_eq!(tree.rises(Point2::new(0.032, 0.0), 0.032), Some(false));
        assert_eq!(tree.rises(Point2::new(0.032, 0.0), 0.016), Some(true));
        assert_eq!(tree.rises(Point2::new(0.04, 0.0), 0.032), None);
    }
}
