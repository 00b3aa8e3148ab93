//! Exact cases: planes, spheres, other meshes of the same cloth.
#![allow(clippy::unwrap_used)]

use super::testing::{ball, sheet, shifted};
use super::*;

fn between(a: &Garment, b: &Garment) -> (Spread, Spread) {
    let (a, b) = (DrapedSurface::new(a).unwrap(), DrapedSurface::new(b).unwrap());
    (distance(&a, &b), displacement(&a, &b))
}

fn near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() < tolerance, "{found} is not {exact}");
}

#[test]
fn a_plane_moved_along_its_normal_is_that_far_everywhere() {
    let a = sheet(5, 1.0);
    let (apart, moved) = between(&a, &shifted(&a, [0.0, 0.0, 0.02]));
    for found in [apart.mean, apart.p95, apart.max, moved.mean, moved.p95, moved.max] {
        near(found, 0.02, 1e-12);
    }
}

#[test]
fn a_plane_that_slides_in_itself_is_displaced_but_near() {
    let a = sheet(5, 1.0);
    let (apart, moved) = between(&a, &shifted(&a, [0.02, 0.0, 0.0]));
    near(moved.mean, 0.02, 1e-12);
    // Only a strip of 2 % of the area sticks out, by 1 cm in the mean, on one side of each.
    near(apart.mean, 0.02 * 0.01, 3e-5);
    near(apart.p95, 0.0, 1e-12);
}

#[test]
fn spheres_of_two_radii_are_their_difference_apart() {
    let (apart, _) = between(&ball(60, 1.0), &ball(60, 1.1));
    near(apart.mean, 0.1, 2e-3);
    near(apart.max, 0.1, 3e-3);
}

#[test]
fn another_mesh_of_the_same_flat_cloth_is_no_difference() {
    let (apart, moved) = between(&sheet(4, 1.0), &sheet(7, 1.0));
    assert!(apart.max < 1e-12 && moved.max < 1e-12, "{apart:?} {moved:?}");
}

#[test]
fn spots_cover_every_part_by_its_area() {
    let a = sheet(3, 1.0);
    let surface = DrapedSurface::new(&a).unwrap();
    let left = surface.spots(POINTS).iter().filter(|s| surface.place(s).x < 0.25).count();
    near(left as f64 / POINTS as f64, 0.25, 0.01);
}

#[test]
fn a_garment_without_triangles_is_refused() {
    let mut a = sheet(1, 1.0);
    a.triangles.clear();
    a.panels[0].triangles = 0..0;
    let e = DrapedSurface::new(&a).err().unwrap();
    assert_eq!(e.message, "there is a garment or panel without triangles");
}
