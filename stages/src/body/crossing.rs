//! Whether a mesh crosses itself: every edge against every triangle near it (Möller and Trumbore, 1997). For tests.

use std::collections::BTreeMap;
use toile_core::artifact::Point3;

/// A cell of the grid in which triangles are looked up, metres.
const CELL: f64 = 0.03;

/// How many edges pass through triangles that do not share a vertex with them.
pub(crate) fn crossings(positions: &[Point3], triangles: &[[u32; 3]]) -> usize {
    let cells = |points: &[u32]| {
        let of = |p: &Point3| [p.x, p.y, p.z].map(|c| (c / CELL).floor() as i32);
        let all: Vec<[i32; 3]> = points.iter().map(|&v| of(&positions[v as usize])).collect();
        let end = |k: usize, best: fn(i32, i32) -> i32| all.iter().map(|c| c[k]).reduce(best).unwrap_or(0);
        let [lo, hi] = [i32::min as fn(i32, i32) -> i32, i32::max].map(|f| [0, 1, 2].map(|k| end(k, f)));
        (lo[0]..=hi[0])
            .flat_map(move |x| (lo[1]..=hi[1]).flat_map(move |y| (lo[2]..=hi[2]).map(move |z| [x, y, z])))
    };
    let mut grid: BTreeMap<[i32; 3], Vec<usize>> = BTreeMap::new();
    for (t, v) in triangles.iter().enumerate() {
        cells(v).for_each(|c| grid.entry(c).or_default().push(t));
    }
    let edges = triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let crossed = |e: &[u32; 2]| {
        let near = cells(e).filter_map(|c| grid.get(&c)).flatten();
        near.into_iter().any(|&t| {
            let v = triangles[t];
            !v.contains(&e[0])
                && !v.contains(&e[1])
                && passes(e.map(|i| positions[i as usize]), v.map(|i| positions[i as usize]))
        })
    };
    edges.filter(|e| e[0] < e[1] && crossed(e)).count()
}

fn passes([from, to]: [Point3; 2], [a, b, c]: [Point3; 3]) -> bool {
    let (way, u, v) = (to - from, b - a, c - a);
    let h = way.cross(&v);
    let det = u.dot(&h);
    if det.abs() < 1e-18 {
        return false;
    }
    let s = from - a;
    let q = s.cross(&u);
    let (x, y, t) = (s.dot(&h) / det, way.dot(&q) / det, v.dot(&q) / det);
    x > 0.0 && y > 0.0 && x + y < 1.0 && t > 0.0 && t < 1.0
}

#[test]
fn a_triangle_that_an_edge_goes_through_is_found() {
    let p = |x: f64, y: f64, z: f64| Point3::new(x * 0.02, y * 0.02, z * 0.02);
    let points = [
        p(0.0, 0.0, 0.0),
        p(1.0, 0.0, 0.0),
        p(0.0, 1.0, 0.0),
        p(0.2, 0.2, -1.0),
        p(0.2, 0.3, 1.0),
        p(0.25, 0.25, 1.0),
    ];
    assert_eq!(crossings(&points, &[[0, 1, 2], [3, 4, 5]]), 1);
    assert_eq!(crossings(&points, &[[0, 1, 2], [2, 4, 5]]), 0);
}
