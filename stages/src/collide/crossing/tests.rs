#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::testing::{sheet, soup};
use super::super::volume::{KDop, Obb, Sphere};
use super::*;

fn found<V: BoundingVolume>(positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    crossings(&ClothTree::<V>::build(positions, triangles), positions)
}

/// Three points and a triangle of the plane z = 0 with corners at 0, x and y.
fn against_unit(points: [[f64; 3]; 3]) -> bool {
    let mut positions = vec![Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)];
    positions.extend(points.map(Point3::from));
    cross(&positions, &[0, 1, 2], &[3, 4, 5])
}

#[test]
fn piercing_crosses_and_touching_does_not() {
    assert!(against_unit([[0.2, 0.2, -1.0], [0.2, 0.2, 1.0], [5.0, 5.0, 1.0]]), "an edge pierces");
    assert!(against_unit([[0.2, 0.2, 1.0], [0.2, 0.2, -1e-300], [5.0, 5.0, 1.0]]), "by a hair");
    assert!(!against_unit([[0.2, 0.2, 1.0], [0.2, 0.2, 0.0], [5.0, 5.0, 1.0]]), "a vertex in the plane");
    assert!(!against_unit([[0.1, 0.1, 0.0], [0.5, 0.1, 0.0], [0.1, 0.5, 0.0]]), "coplanar");
    assert!(!against_unit([[0.2, 0.2, 1.0], [0.3, 0.2, 1.0], [0.2, 0.3, 1.0]]), "parallel");
    assert!(!against_unit([[f64::NAN, 0.2, -1.0], [0.2, 0.2, 1.0], [5.0, 5.0, 1.0]]), "no number");
}

#[test]
fn a_fold_about_one_shared_vertex_can_cross() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.3, -0.2], [0.3, 0.3, 0.2]]
        .map(Point3::from);
    assert!(cross(&positions, &[0, 1, 2], &[0, 3, 4]), "the far edge pierces the neighbour");
    assert!(!cross(&positions, &[0, 1, 2], &[0, 1, 4]), "a shared edge never does");
}

#[test]
fn agrees_with_brute_force_for_all_volumes() {
    let (positions, triangles) = soup(11, 400, 0.25);
    let mut brute = Vec::new();
    for i in 0..triangles.len() {
        for j in i + 1..triangles.len() {
            if cross(&positions, &triangles[i], &triangles[j]) {
                brute.push([i as u32, j as u32]);
            }
        }
    }
    assert!(brute.len() > 200, "{} crossings are too few to tell", brute.len());
    assert_eq!(found::<Aabb>(&positions, &triangles), brute);
    assert_eq!(found::<Sphere>(&positions, &triangles), brute);
    assert_eq!(found::<Obb>(&positions, &triangles), brute);
    assert_eq!(found::<KDop<9>>(&positions, &triangles), brute);
}

#[test]
fn a_smooth_sheet_does_not_cross_itself() {
    let (positions, triangles) = sheet(20, |x, y| 0.1 * (9.0 * x).sin() * (7.0 * y).cos());
    assert!(found::<Aabb>(&positions, &triangles).is_empty());
}

#[test]
fn the_inner_side_has_positive_volume() {
    let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
    assert!(volume(&a, &b, &c, &Point3::new(0.0, 0.0, -1.0)) > 0.0);
}
