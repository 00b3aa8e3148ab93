#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use proptest::prelude::*;

fn point() -> impl Strategy<Value = Vec3> {
    let x = -1.0..1.0;
    (x.clone(), x.clone(), x).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

/// What the contact promises: weights in balance, a unit normal, and both giving the distance.
fn check(points: &[Vec3; 4], found: &Proximity) {
    let separation: Vec3 = points.iter().zip(&found.weights).map(|(p, w)| p * *w).sum();
    assert!(found.weights.iter().sum::<f64>().abs() < 1e-12, "{found:?}");
    assert!((found.normal.norm() - 1.0).abs() < 1e-12, "{found:?}");
    assert!((separation - found.normal * found.distance).norm() < 1e-12, "{found:?}");
}

proptest! {
    #[test]
    fn the_weights_give_the_separation(a in point(), b in point(), c in point(), d in point()) {
        check(&[a, b, c, d], &vertex_triangle(&a, &[b, c, d]).0);
        check(&[a, b, c, d], &edge_edge(&[a, b], &[c, d]).0);
    }

    #[test]
    fn pieces_that_touch_have_a_normal(a in point(), b in point(), c in point(), s in 0.0..1.0, k in -2.0..2.0) {
        let on = a + (b - a) * s;
        let (touching, _) = vertex_triangle(&on, &[a, b, c]);
        check(&[on, a, b, c], &touching);
        // Collinear edges that overlap, and a triangle of no area.
        let (parallel, _) = edge_edge(&[a, b], &[on, on + (b - a) * k]);
        check(&[a, b, on, on + (b - a) * k], &parallel);
        let (flat, _) = vertex_triangle(&on, &[a, b, a]);
        check(&[on, a, b, a], &flat);
    }
}

#[test]
fn a_vertex_in_the_plane_takes_the_triangles_normal() {
    let t = [Vec3::zeros(), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    let (found, feature) = vertex_triangle(&Vec3::new(0.25, 0.25, 0.0), &t);
    assert_eq!((found.distance, found.normal, feature), (0.0, Vec3::z(), Feature::Face));
    assert_eq!(found.weights, [1.0, -0.5, -0.25, -0.25]);
}

#[test]
fn edges_that_cross_take_their_cross_product() {
    let a = [Vec3::new(-1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0)];
    let b = [Vec3::new(0.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    let (found, inside) = edge_edge(&a, &b);
    assert_eq!((found.distance, found.normal, inside), (0.0, Vec3::z(), true));
    assert_eq!(found.weights, [0.5, 0.5, -0.5, -0.5]);
}

#[test]
fn four_points_at_one_place_are_no_division_by_zero() {
    let p = Vec3::new(0.3, 0.2, 0.1);
    check(&[p; 4], &vertex_triangle(&p, &[p; 3]).0);
    check(&[p; 4], &edge_edge(&[p; 2], &[p; 2]).0);
}
