//! The shape of a garment against the light, from the front and from the side.
//!
//! Parallel projection on a grid of [`PIXEL`]; a pixel is covered where its middle lies in a
//! triangle. Agreement is the intersection over the union: 1 for equal shapes. Cost: pixels and
//! triangles.

use toile_core::artifact::{Garment, Point2};

/// Side of a pixel, metres: a millimetre's difference along the whole edge of a vest shows in the
/// third digit.
const PIXEL: f64 = 1e-3;
/// Pixels along a side at most; a larger scene gets larger pixels.
const MOST_PIXELS: f64 = 2000.0;

/// From where a garment is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ViewSide {
    /// Along the depth.
    Front,
    /// Along the width.
    Left,
}

impl ViewSide {
    fn project(self, garment: &Garment) -> Vec<Point2> {
        let place = |p: &toile_core::artifact::Point3| match self {
            ViewSide::Front => Point2::new(p.x, p.y),
            ViewSide::Left => Point2::new(p.z, p.y),
        };
        garment.positions.iter().map(place).collect()
    }
}

/// Intersection over union of the two shapes.
pub(crate) fn agreement(a: &Garment, b: &Garment, side: ViewSide) -> f64 {
    let (p, q) = (side.project(a), side.project(b));
    let first = p.first().copied().unwrap_or_else(Point2::origin);
    let (lo, hi) = p.iter().chain(&q).fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
    let extent = hi - lo;
    let pixel = PIXEL.max(extent.x.max(extent.y) / MOST_PIXELS);
    let grid = PixelGrid { lo, pixel, size: [extent.x, extent.y].map(|e| (e / pixel).ceil() as usize + 1) };
    let (a, b) = (grid.cover(&p, &a.triangles), grid.cover(&q, &b.triangles));
    let count = |test: fn(bool, bool) -> bool| a.iter().zip(&b).filter(|(a, b)| test(**a, **b)).count();
    let (both, any) = (count(|a, b| a && b), count(|a, b| a || b));
    both as f64 / any.max(1) as f64
}

struct PixelGrid {
    lo: Point2,
    pixel: f64,
    size: [usize; 2],
}

impl PixelGrid {
    fn cover(&self, points: &[Point2], triangles: &[[u32; 3]]) -> Vec<bool> {
        let mut covered = vec![false; self.size[0] * self.size[1]];
        for t in triangles {
            self.fill(t.map(|i| points[i as usize]), &mut covered);
        }
        covered
    }

    fn fill(&self, [a, b, c]: [Point2; 3], covered: &mut [bool]) {
        let area = (b - a).perp(&(c - a));
        if area == 0.0 {
            return;
        }
        let (lo, hi) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        let span = |lo: f64, hi: f64, from: f64, n: usize| {
            let at = |x: f64| ((x - from) / self.pixel).floor().max(0.0) as usize;
            at(lo)..(at(hi) + 1).min(n)
        };
        for y in span(lo.y, hi.y, self.lo.y, self.size[1]) {
            for x in span(lo.x, hi.x, self.lo.x, self.size[0]) {
                let p = Point2::new(
                    self.lo.x + (x as f64 + 0.5) * self.pixel,
                    self.lo.y + (y as f64 + 0.5) * self.pixel,
                );
                let is_left = |u: Point2, v: Point2| (v - u).perp(&(p - u)) * area >= 0.0;
                if is_left(a, b) && is_left(b, c) && is_left(c, a) {
                    covered[y * self.size[0] + x] = true;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::testing::{sheet, shifted};

    #[test]
    fn a_sheet_agrees_with_itself_and_half_with_itself_moved_by_a_third() {
        let a = sheet(4, 0.3);
        assert_eq!(agreement(&a, &a, ViewSide::Front), 1.0);
        let b = shifted(&a, [0.1, 0.0, 0.0]);
        assert!(
            (agreement(&a, &b, ViewSide::Front) - 0.5).abs() < 0.01,
            "{}",
            agreement(&a, &b, ViewSide::Front)
        );
    }
}
