//! Welding: points at the same place get the same number.
//!
//! File formats repeat vertices along seams and UV points at every corner. A grid as fine as the
//! tolerance holds the points; each looks in the cells around its own and joins the lowest-numbered
//! point within the tolerance. Cost O(n log n).

use nalgebra::{Point2, Point3};
use std::collections::BTreeMap;

/// For each point the number of the first point within `tolerance` of it (0: exactly there); points
/// that are not finite stay alone.
#[must_use]
pub fn weld_places(points: &[Point3<f64>], tolerance: f64) -> Vec<u32> {
    if tolerance > 0.0 { weld_near(points, tolerance) } else { weld_equal(points) }
}

fn weld_equal(points: &[Point3<f64>]) -> Vec<u32> {
    let compare = |a: &u32, b: &u32| {
        // Adding zero makes -0 and 0 one number.
        let [p, q] = [*a, *b].map(|k| points[k as usize].map(|x| x + 0.0));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(p.z.total_cmp(&q.z)).then(a.cmp(b))
    };
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_unstable_by(compare);
    let mut first: Vec<u32> = (0..points.len() as u32).collect();
    // NaN equals nothing, so it starts a group of its own each time.
    for group in order.chunk_by(|a, b| points[*a as usize] == points[*b as usize]) {
        group.iter().for_each(|&k| first[k as usize] = group[0]);
    }
    first
}

fn weld_near(points: &[Point3<f64>], tolerance: f64) -> Vec<u32> {
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    let mut first = Vec::with_capacity(points.len());
    for (i, p) in points.iter().enumerate() {
        let cell = [p.x, p.y, p.z].map(|x| (x / tolerance).floor() as i64);
        let found = near(&cells, cell).filter(|&j| (points[j as usize] - p).norm() <= tolerance).min();
        first.push(found.unwrap_or(i as u32));
        if found.is_none() {
            cells.entry(cell).or_default().push(i as u32);
        }
    }
    first
}

/// The same for UV points.
#[must_use]
pub fn weld_uv(points: &[Point2<f64>], tolerance: f64) -> Vec<u32> {
    let flat: Vec<_> = points.iter().map(|p| Point3::new(p.x, p.y, 0.0)).collect();
    weld_places(&flat, tolerance)
}

/// Points in a cell and in those around it.
fn near(cells: &BTreeMap<[i64; 3], Vec<u32>>, [x, y, z]: [i64; 3]) -> impl Iterator<Item = u32> {
    let around = (0..27).map(move |k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]);
    around
        .filter_map(move |[i, j, k]| {
            cells.get(&[x.saturating_add(i), y.saturating_add(j), z.saturating_add(k)])
        })
        .flatten()
        .copied()
}
