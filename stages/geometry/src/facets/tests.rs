#![allow(clippy::unwrap_used)]
use super::*;
use crate::shapes;

#[test]
fn a_triangle_that_a_corner_comes_through_crosses_around_it_and_one_outside_does_not() {
    let (vertices, triangles) = shapes::block([-1.0; 3], [1.0; 3]);
    let facets = Facets::of(&vertices, &triangles).unwrap();
    // The plane x + y + z = 2.9, wide enough for the corner at (1, 1, 1).
    let at = |sum: f64| [[sum - 0.2, 0.1, 0.1], [0.1, sum - 0.2, 0.1], [0.1, 0.1, sum - 0.2]].map(Vec3::from);
    let places = facets.crossings(&at(2.9));
    assert!(places.len() >= 3, "{places:?}");
    let is_on = |p: &Vec3| (p.sum() - 2.9).abs() < 1e-12 && (p.max() - 1.0).abs() < 1e-12;
    assert!(places.iter().all(is_on), "{places:?}");
    assert!(facets.crossings(&at(3.1)).is_empty());
    assert!(Facets::of(&vertices, &[]).is_none());
}
