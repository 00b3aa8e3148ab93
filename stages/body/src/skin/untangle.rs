//! Skin that crosses itself, as between the ends of fingers that lie side by side, and its repair.
//!
//! Crossings are edges that pierce a triangle near them, looked up in a grid of boxes. Where there
//! are some, the vertices around them go to the middle of their neighbours, until there are none.
//! Cost: one look at every triangle of the fine parts; a few rounds over those that cross. Limit: a
//! crossing that so many rounds do not undo stays.

use std::collections::BTreeMap;
use toile_core::artifact::{Point3, Vector3};
use toile_geometry::crossing::pierces;

/// A cell of the grid in which triangles are looked up, metres.
const CELL: f64 = 0.012;
/// Rounds of smoothing at most.
const ROUNDS: usize = 12;

/// Smooths the skin where it crosses itself. `fine` says whether parts thinner than a cell may lie
/// at a place.
pub(crate) fn untangle(
    positions: &mut [Point3],
    triangles: &[[u32; 3]],
    neighbours: &[Vec<u32>],
    fine: impl Fn(Point3) -> bool,
) {
    let near = |t: &[u32; 3]| fine(positions[t[0] as usize]);
    let some: Vec<[u32; 3]> = triangles.iter().filter(|t| near(t)).copied().collect();
    for _ in 0..ROUNDS {
        let crossing = crossing(positions, &some);
        if crossing.is_empty() {
            return;
        }
        let mut moved: Vec<u32> = crossing.into_iter().flatten().collect();
        moved.extend(moved.clone().iter().flat_map(|v| &neighbours[*v as usize]));
        moved.sort_unstable();
        moved.dedup();
        let middle = |v: u32| {
            let around = &neighbours[v as usize];
            let sum: Vector3 = around.iter().map(|&m| positions[m as usize].coords).sum();
            let to = Point3::from(sum / around.len().max(1) as f64);
            let at = positions[v as usize];
            let to = nalgebra::center(&at, &to);
            // What lies in the plane of symmetry stays there.
            if at.x == 0.0 { Point3::new(0.0, to.y, to.z) } else { to }
        };
        let places: Vec<Point3> = moved.iter().map(|v| middle(*v)).collect();
        moved.into_iter().zip(places).for_each(|(v, p)| positions[v as usize] = p);
    }
}

/// The corners of every edge and of each triangle that it passes through without sharing a vertex.
pub(crate) fn crossing(positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<[u32; 5]> {
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
    let at = |v: u32| positions[v as usize].coords;
    let edges = triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let pierced = |e: [u32; 2]| {
        let near = cells(&e).filter_map(|c| grid.get(&c)).flatten();
        let [p, q] = e.map(at);
        near.map(|&t| triangles[t])
            .find(|v| !v.contains(&e[0]) && !v.contains(&e[1]) && pierces(&p, &q, &v.map(at)))
            .map(|v| [e[0], e[1], v[0], v[1], v[2]])
    };
    edges.filter(|e| e[0] < e[1]).filter_map(pierced).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64, z: f64) -> Point3 {
        Point3::new(x * 0.02, y * 0.02, z * 0.02)
    }

    #[test]
    fn a_triangle_that_an_edge_goes_through_is_found() {
        let points = [
            at(0.0, 0.0, 0.0),
            at(1.0, 0.0, 0.0),
            at(0.0, 1.0, 0.0),
            at(0.2, 0.2, -1.0),
            at(0.2, 0.3, 1.0),
            at(0.25, 0.25, 1.0),
        ];
        assert_eq!(crossing(&points, &[[0, 1, 2], [3, 4, 5]]).len(), 1);
        assert!(crossing(&points, &[[0, 1, 2], [2, 4, 5]]).is_empty());
    }

    #[test]
    fn a_peak_that_reaches_through_the_skin_beside_it_is_smoothed_back() {
        // A grid of triangles; one vertex has run past its neighbours' neighbours.
        let n = 9;
        let mut points: Vec<Point3> = (0..n * n)
            .map(|i| at(0.2 * (i % n) as f64, 0.2 * (i / n) as f64, 0.01 * (i % 3) as f64))
            .collect();
        points[4 * n + 4].x += 0.011;
        points[4 * n + 4].z -= 0.0004;
        points[4 * n + 6].z += 0.0003;
        let v = |x: usize, y: usize| (y * n + x) as u32;
        let cells = (0..n - 1).flat_map(|y| (0..n - 1).map(move |x| (x, y)));
        let triangles: Vec<[u32; 3]> = cells
            .flat_map(|(x, y)| {
                [[v(x, y), v(x + 1, y), v(x + 1, y + 1)], [v(x, y), v(x + 1, y + 1), v(x, y + 1)]]
            })
            .collect();
        let mut neighbours = vec![Vec::new(); n * n];
        for t in &triangles {
            (0..3).for_each(|k| neighbours[t[k] as usize].extend([t[(k + 1) % 3], t[(k + 2) % 3]]));
        }
        assert!(!crossing(&points, &triangles).is_empty());
        untangle(&mut points, &triangles, &neighbours, |_| true);
        assert!(crossing(&points, &triangles).is_empty());
    }
}
