//! Boundary edges that cross each other in the plane, by exact predicates (Shewchuk 1997).
//!
//! Edges sorted by their least x; each is compared with those that begin before it ends. Cost about
//! n^1.5 for n edges of even length.

use nalgebra::Point2;
use robust::{Coord, orient2d};

/// Pairs of edges, each edge by its two vertices, that cross at an inner point of both.
#[must_use]
pub(super) fn boundary_crossings(loops: &[Vec<u32>], flat: &[Point2<f64>]) -> Vec<[[u32; 2]; 2]> {
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for vertices in loops {
        let next = vertices.iter().cycle().skip(1);
        edges.extend(vertices.iter().zip(next).map(|(&a, &b)| [a, b]));
    }
    let place = |v: u32| flat[v as usize];
    let low = |e: &[u32; 2]| place(e[0]).x.min(place(e[1]).x);
    let high = |e: &[u32; 2]| place(e[0]).x.max(place(e[1]).x);
    edges.sort_by(|a, b| low(a).total_cmp(&low(b)).then(a.cmp(b)));
    let mut found = Vec::new();
    for (i, e) in edges.iter().enumerate() {
        let end = high(e);
        for f in edges[i + 1..].iter().take_while(|f| low(f) <= end) {
            if cross(e.map(place), f.map(place)) {
                found.push([*e, *f]);
            }
        }
    }
    found
}

fn cross([a, b]: [Point2<f64>; 2], [c, d]: [Point2<f64>; 2]) -> bool {
    if a.y.max(b.y) < c.y.min(d.y) || c.y.max(d.y) < a.y.min(b.y) {
        return false;
    }
    let side = |p: Point2<f64>, q: Point2<f64>, r: Point2<f64>| {
        let of = |p: Point2<f64>| Coord { x: p.x, y: p.y };
        orient2d(of(p), of(q), of(r))
    };
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}
