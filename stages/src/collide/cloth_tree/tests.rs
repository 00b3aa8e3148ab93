#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::testing::sheet;
use super::super::volume::Aabb;
use super::*;

#[test]
fn every_vertex_and_edge_has_one_owner() {
    let (positions, triangles) = sheet(5, |_, _| 0.0);
    let tree = ClothTree::<Aabb>::build(&positions, &triangles);
    let corners: usize = tree.owned.iter().map(|o| o.corners().count()).sum();
    let edges: usize = tree.owned.iter().map(|o| o.edges().count()).sum();
    assert_eq!(corners, positions.len());
    // Euler: vertices - edges + faces = 1 for a disc.
    assert_eq!(edges, positions.len() + triangles.len() - 1);
}

#[test]
fn triangles_that_make_no_sense_are_left_out() {
    let (positions, mut triangles) = sheet(1, |_, _| 0.0);
    triangles.extend([[0, 0, 1], [0, 1, 4], [7, 8, 9], [u32::MAX; 3]]);
    let tree = ClothTree::<Aabb>::build(&positions, &triangles);
    assert_eq!(tree.owned[2..], [Owned::default(); 4]);
}

#[test]
fn is_built_anew_only_for_another_cloth_or_a_far_move() {
    let flat = |lift: f64| sheet(10, move |x, _| lift * (40.0 * x).sin());
    let (positions, triangles) = flat(0.0);
    let tree = ClothTree::<Aabb>::build(&positions, &triangles);
    let before = tree.looseness;
    let tree = tree.updated(&flat(0.001).0, &triangles);
    assert_eq!(tree.looseness, before, "a small move keeps the topology");
    let tree = tree.updated(&flat(2.0).0, &triangles);
    assert!(tree.looseness > before, "a far move makes a new one");
    let other = sheet(3, |_, _| 0.0);
    assert_eq!(tree.updated(&other.0, &other.1).triangles, other.1);
}
