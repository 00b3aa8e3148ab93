//! The tape measure around a garment or a body at some height.
//!
//! The surface is cut by a level plane; connected pieces of the cut form one curve each; the
//! trunk's is the longest of those that go around the middle. A tape spans hollows, so a girth is
//! the length of the convex hull (ISO 8559). Cost: one pass over the triangles. Limit: where the
//! garment is open at that height (a neckline), the tape still closes.

use std::collections::BTreeMap;
use toile_core::artifact::{Body, Garment, Point2, Point3};

/// The girth of the part of a surface that goes around the vertical line x = `middle`, metres; none
/// where the plane meets no such part.
pub(crate) fn girth(positions: &[Point3], triangles: &[[u32; 3]], height: f64, middle: f64) -> Option<f64> {
    let pieces = pieces(positions, triangles, height);
    let astride =
        |points: &&Vec<Point2>| points.iter().any(|p| p.x < middle) && points.iter().any(|p| p.x > middle);
    pieces.iter().filter(astride).map(|points| tape(points.clone())).reduce(f64::max)
}

/// The girth of a garment, seams closed.
pub(crate) fn of_garment(garment: &Garment, height: f64, middle: f64) -> Option<f64> {
    let joined: Vec<[u32; 3]> =
        garment.triangles.iter().map(|t| t.map(|i| garment.weld[i as usize])).collect();
    girth(&garment.positions, &joined, height, middle)
}

/// The heights at which ease is measured, by name, with the x of the body's middle there.
pub(crate) fn levels(body: &Body) -> Vec<(&'static str, f64, f64)> {
    let level =
        |(name, landmark): (&'static str, &str)| body.landmarks.get(landmark).map(|p| (name, p.y, p.x));
    [("bust", "bust_front"), ("waist", "waist_front"), ("hip", "hip_front")]
        .into_iter()
        .filter_map(level)
        .collect()
}

/// Points of the cut, by the piece that they belong to.
fn pieces(positions: &[Point3], triangles: &[[u32; 3]], height: f64) -> Vec<Vec<Point2>> {
    let is_above = |i: u32| positions[i as usize].y >= height;
    let mut ids: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    let (mut points, mut parent) = (Vec::new(), Vec::new());
    for t in triangles {
        let sides = [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
        let mut cut = sides.iter().filter(|(a, b)| is_above(*a) != is_above(*b)).map(|&(a, b)| {
            *ids.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push(crossing(&positions[a as usize], &positions[b as usize], height));
                parent.push(parent.len());
                parent.len() - 1
            })
        });
        if let (Some(a), Some(b)) = (cut.next(), cut.next()) {
            drop(cut);
            let (a, b) = (root(&parent, a), root(&parent, b));
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut pieces: BTreeMap<usize, Vec<Point2>> = BTreeMap::new();
    for (i, p) in points.iter().enumerate() {
        pieces.entry(root(&parent, i)).or_default().push(*p);
    }
    pieces.into_values().collect()
}

fn root(parent: &[usize], mut i: usize) -> usize {
    while parent[i] != i {
        i = parent[i];
    }
    i
}

fn crossing(a: &Point3, b: &Point3, height: f64) -> Point2 {
    let t = (height - a.y) / (b.y - a.y);
    Point2::new(a.x + (b.x - a.x) * t, a.z + (b.z - a.z) * t)
}

/// Length of the convex hull (monotone chain, Andrew 1979).
fn tape(mut points: Vec<Point2>) -> f64 {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |order: &mut dyn Iterator<Item = &Point2>| {
        let mut chain: Vec<Point2> = Vec::new();
        for p in order {
            while let [.., a, b] = chain[..] {
                if (b - a).perp(&(p - a)) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(*p);
        }
        chain.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>()
    };
    half(&mut points.iter()) + half(&mut points.iter().rev())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A tube of radius 1 around x = `at`, one metre high, of `n` sides.
    fn tube(n: u32, at: f64) -> (Vec<Point3>, Vec<[u32; 3]>) {
        let ring = |y: f64| {
            (0..n).map(move |i| {
                let a = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
                Point3::new(at + a.cos(), y, a.sin())
            })
        };
        let side = |i: u32| {
            let j = (i + 1) % n;
            [[i, j, n + i], [j, n + j, n + i]]
        };
        (ring(0.0).chain(ring(1.0)).collect(), (0..n).flat_map(side).collect())
    }

    #[test]
    fn a_tube_has_the_girth_of_its_circle() {
        let (p, t) = tube(400, 0.0);
        let found = girth(&p, &t, 0.4, 0.0).unwrap();
        assert!((found - std::f64::consts::TAU).abs() < 1e-3, "{found}");
        assert_eq!(girth(&p, &t, 1.5, 0.0), None);
    }

    #[test]
    fn sleeves_beside_the_trunk_do_not_count() {
        let ((mut p, mut t), (q, u)) = (tube(100, 0.0), tube(100, 5.0));
        let first = p.len() as u32;
        p.extend(q);
        t.extend(u.iter().map(|t| t.map(|i| i + first)));
        assert!((girth(&p, &t, 0.5, 0.1).unwrap() - std::f64::consts::TAU).abs() < 1e-2);
        assert_eq!(girth(&p, &t, 0.5, 2.5), None);
    }
}
