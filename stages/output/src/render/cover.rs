//! Which samples a triangle covers.
//!
//! Edge functions (Pineda, 1988) on vertices snapped to 1/256 px, in whole numbers: exact, so two
//! triangles that share an edge leave no sample between them uncovered. Both faces are drawn.
//!
//! Cost: a few operations for every sample of the triangle's box. Limit: vertices farther than
//! [`REACH_PX`] from the picture are refused, which keeps the products within 64 bits.

use super::camera::Projected;

/// Sub-pixel steps a pixel.
pub(super) const STEPS: i64 = 256;
/// Vertices farther out than this (px) drop their triangle.
pub(super) const REACH_PX: f64 = 1e6;

/// A triangle ready to be scanned.
#[derive(Debug, Clone)]
pub(super) struct CoveredTriangle {
    /// Corners in sub-pixel steps, turned so that their area is positive.
    corners: [[i64; 2]; 3],
    /// Where each corner stood in the original order.
    pub(super) order: [usize; 3],
    /// Twice the area, square steps.
    area: i64,
    /// Nearness at each corner.
    near: [f64; 3],
}

impl CoveredTriangle {
    /// `None` for a triangle without area, not finite, or out of reach.
    pub(super) fn new(v: [Projected; 3]) -> Option<CoveredTriangle> {
        let ok = |p: &Projected| p.x.abs() < REACH_PX && p.y.abs() < REACH_PX && p.near.is_finite();
        if !v.iter().all(ok) {
            return None;
        }
        let snap = |p: &Projected| [p.x, p.y].map(|c| nearest(c * STEPS as f64));
        let corners = v.each_ref().map(snap);
        let area = edge(corners[0], corners[1], corners[2]);
        let order = if area < 0 { [0, 2, 1] } else { [0, 1, 2] };
        (area != 0).then(|| CoveredTriangle {
            corners: order.map(|k| corners[k]),
            order,
            area: area.abs(),
            near: order.map(|k| v[k].near),
        })
    }

    /// First and last pixel row that it may touch.
    pub(super) fn rows(&self) -> (i64, i64) {
        self.span(1)
    }

    fn span(&self, axis: usize) -> (i64, i64) {
        let c = self.corners.map(|c| c[axis]);
        let (lo, hi) = (c[0].min(c[1]).min(c[2]), c[0].max(c[1]).max(c[2]));
        (lo.div_euclid(STEPS), hi.div_euclid(STEPS))
    }

    /// Weights of the corners (in their turned order) at a place in sub-pixel steps.
    pub(super) fn weights(&self, at: [f64; 2]) -> [f64; 3] {
        let [a, b, c] = self.corners.map(|c| c.map(|v| v as f64));
        let part = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]);
        [part(b, c), part(c, a), part(a, b)].map(|e| e / self.area as f64)
    }

    /// Calls `hit(sample, x, y, nearness)` for every sample of every pixel in `columns` x `rows`
    /// that lies in the triangle; `samples` are their places in a pixel, sub-pixel steps.
    pub(super) fn scan<const N: usize>(
        &self,
        columns: i64,
        rows: std::ops::Range<i64>,
        samples: &[[i64; 2]; N],
        mut hit: impl FnMut(usize, usize, usize, f64),
    ) {
        let ((x0, x1), (y0, y1)) = (self.span(0), self.span(1));
        let (x0, x1) = (x0.max(0), x1.min(columns - 1));
        let [a, b, c] = self.corners;
        let sides = [(b, c), (c, a), (a, b)];
        let along = |[x, y]: [i64; 2]| sides.map(|(p, q)| (q[0] - p[0]) * y - (q[1] - p[1]) * x);
        let (step, offsets) = (along([STEPS, 0]), samples.map(along));
        // No sample of a pixel lies farther inside of a side than its corner does, and by this.
        let reach = [0, 1, 2].map(|k| offsets.iter().map(|o| o[k]).max().unwrap_or(0));
        let share = self.near.map(|n| n / self.area as f64);
        for y in y0.max(rows.start)..=y1.min(rows.end - 1) {
            let mut corner = sides.map(|(p, q)| edge(p, q, [x0 * STEPS, y * STEPS]));
            for x in x0..=x1 {
                let is_near = (corner[0] + reach[0]) | (corner[1] + reach[1]) | (corner[2] + reach[2]);
                let tested = if is_near >= 0 { offsets.as_slice() } else { &[] };
                for (s, o) in tested.iter().enumerate() {
                    let e = [corner[0] + o[0], corner[1] + o[1], corner[2] + o[2]];
                    if (e[0] | e[1] | e[2]) >= 0 {
                        let near = e[0] as f64 * share[0] + e[1] as f64 * share[1] + e[2] as f64 * share[2];
                        hit(s, x as usize, y as usize, near);
                    }
                }
                corner = [corner[0] + step[0], corner[1] + step[1], corner[2] + step[2]];
            }
        }
    }
}

/// Added before a number is cut off, so that it is positive: what lies within reach is smaller.
const OFFSET: i64 = 1 << 40;

/// The whole number below, to 1/4096: without the call of a library that `floor` is on old
/// processors.
pub(super) fn below(v: f64) -> i64 {
    ((v + OFFSET as f64) as i64).saturating_sub(OFFSET)
}

/// The nearest whole number, the upper of two.
fn nearest(v: f64) -> i64 {
    below(v + 0.5)
}

/// Twice the signed area of a, b, p.
fn edge(a: [i64; 2], b: [i64; 2], p: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}
