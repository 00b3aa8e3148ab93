//! Horizontal slices of a closed mesh as loops, and the tape measure around them.
//!
//! A tape spans hollows, so a girth is the length of the convex hull of the slice (as ISO 8559
//! prescribes for the bust). Cost: one pass over the triangles a slice.

use std::collections::BTreeMap;
use toile_core::artifact::{Point2, Point3};

/// A closed curve of a slice, as (x, z) points.
#[derive(Debug, Clone)]
pub struct SliceLoop {
    /// Its points in order.
    pub points: Vec<Point2>,
    /// Length of its convex hull, metres.
    pub girth: f64,
    /// Least and greatest x and z.
    pub bounds: [f64; 4],
}

impl SliceLoop {
    fn new(points: Vec<Point2>) -> Self {
        let hull = convex_hull(points.clone());
        let girth = (0..hull.len()).map(|i| (hull[(i + 1) % hull.len()] - hull[i]).norm()).sum();
        let mut bounds = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
        for p in &points {
            bounds[0] = bounds[0].min(p.x);
            bounds[1] = bounds[1].max(p.x);
            bounds[2] = bounds[2].min(p.y);
            bounds[3] = bounds[3].max(p.y);
        }
        SliceLoop { points, girth, bounds }
    }

    /// The middle of its box, (x, z).
    pub fn centre(&self) -> Point2 {
        let [x0, x1, z0, z1] = self.bounds;
        Point2::new((x0 + x1) / 2.0, (z0 + z1) / 2.0)
    }

    /// Whether it goes around a place (x, z).
    pub fn holds(&self, at: Point2) -> bool {
        let n = self.points.len();
        let turn = |k: usize| {
            let (a, b) = (self.points[k] - at, self.points[(k + 1) % n] - at);
            a.perp(&b).atan2(a.dot(&b))
        };
        (0..n).map(turn).sum::<f64>().abs() > std::f64::consts::PI
    }

    /// Extent along x.
    pub fn width(&self) -> f64 {
        self.bounds[1] - self.bounds[0]
    }

    /// Greatest (front) and least (back) z where the loop crosses a given x; `None` beside it.
    pub fn depths_at(&self, x: f64) -> Option<(f64, f64)> {
        let n = self.points.len();
        let crossing = |i: usize| {
            let (a, b) = (self.points[i], self.points[(i + 1) % n]);
            let between = (a.x <= x) != (b.x <= x);
            between.then(|| a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x))
        };
        let zs: Vec<f64> = (0..n).filter_map(crossing).collect();
        let front = zs.iter().copied().reduce(f64::max)?;
        Some((front, zs.iter().copied().fold(front, f64::min)))
    }
}

/// The loops of the slice at height `y`, ordered by the x of their middle.
pub fn slice(positions: &[Point3], triangles: &[[u32; 3]], y: f64) -> Vec<SliceLoop> {
    let above = |i: u32| positions[i as usize].y >= y;
    let crosses = |a: u32, b: u32| above(a) != above(b);
    let cut = |(a, b): (u32, u32)| {
        let (p, q) = (positions[a as usize], positions[b as usize]);
        let t = (y - p.y) / (q.y - p.y);
        Point2::new(p.x + (q.x - p.x) * t, p.z + (q.z - p.z) * t)
    };
    let mut next = BTreeMap::new();
    for t in triangles {
        let sides = [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
        // A closed, consistently turned mesh leaves each slice edge once downwards and once
        // upwards.
        let down = sides.iter().find(|&&(a, b)| above(a) && crosses(a, b));
        let up = sides.iter().find(|&&(a, b)| !above(a) && crosses(a, b));
        if let (Some(&(a, b)), Some(&(c, d))) = (down, up) {
            next.insert((a.min(b), a.max(b)), (c.min(d), c.max(d)));
        }
    }
    let mut loops = Vec::new();
    while let Some((&first, _)) = next.iter().next() {
        let (mut points, mut at) = (Vec::new(), first);
        while let Some(to) = next.remove(&at) {
            points.push(cut(at));
            at = to;
        }
        if points.len() > 2 {
            loops.push(SliceLoop::new(points));
        }
    }
    loops.sort_by(|a, b| a.centre().x.total_cmp(&b.centre().x));
    loops
}

/// The loop around the trunk: the one with the greatest girth among those that the middle plane
/// cuts.
pub fn trunk(loops: &[SliceLoop], middle: f64) -> Option<&SliceLoop> {
    let cut = |l: &&SliceLoop| l.bounds[0] < middle && l.bounds[1] > middle;
    loops.iter().filter(cut).max_by(|a, b| a.girth.total_cmp(&b.girth))
}

/// The convex hull, counter-clockwise (monotone chain, Andrew 1979).
pub fn convex_hull(mut points: Vec<Point2>) -> Vec<Point2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut hull = half_hull(points.iter().copied());
    hull.pop();
    hull.extend(half_hull(points.iter().rev().copied()));
    hull.pop();
    hull
}

fn half_hull(points: impl Iterator<Item = Point2>) -> Vec<Point2> {
    let mut chain: Vec<Point2> = Vec::new();
    for p in points {
        while let [.., a, b] = chain[..] {
            if (b - a).perp(&(p - a)) > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(p);
    }
    chain
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    /// A box of two squares of side 2, one metre high.
    fn cube() -> (Vec<Point3>, Vec<[u32; 3]>) {
        let p = (0..8).map(|i| {
            let s = |b: u32| if i >> b & 1 == 1 { 1.0 } else { -1.0 };
            Point3::new(s(0), s(1), s(2))
        });
        let t = [
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        (p.collect(), t.to_vec())
    }

    #[test]
    fn a_cube_has_one_square_slice() {
        let (p, t) = cube();
        let loops = slice(&p, &t, 0.25);
        assert_eq!(loops.len(), 1);
        assert!((loops[0].girth - 8.0).abs() < 1e-12);
        assert_eq!(loops[0].depths_at(0.3), Some((1.0, -1.0)));
        assert_eq!(loops[0].depths_at(1.3), None);
        assert!(slice(&p, &t, 1.5).is_empty());
    }

    #[test]
    fn the_trunk_is_the_loop_astride_the_middle() {
        let (p, t) = cube();
        let apart = |dx: f64| p.iter().map(|q| Point3::new(q.x + dx, q.y, q.z)).collect::<Vec<_>>();
        let loops = slice(&apart(5.0), &t, 0.0);
        assert!(trunk(&loops, 0.0).is_none());
        assert!(trunk(&loops, 5.2).is_some());
    }

    proptest! {
        #[test]
        fn the_hull_holds_every_point(raw in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 3..40)) {
            let points: Vec<Point2> = raw.iter().map(|&(x, y)| Point2::new(x, y)).collect();
            let hull = convex_hull(points.clone());
            for p in points {
                for i in 0..hull.len() {
                    let (a, b) = (hull[i], hull[(i + 1) % hull.len()]);
                    prop_assert!((b - a).perp(&(p - a)) >= -1e-12);
                }
            }
        }
    }
}
