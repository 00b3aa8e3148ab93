#![allow(clippy::unwrap_used)]
use nalgebra::Vector2;

use super::*;
use crate::mesh::Sheet;
use toile_geometry::Vec3;

#[test]
fn friction_sticks_below_and_slides_above_the_cone() {
    let plane = Plane::new(Vec3::zeros(), Vec3::y(), 0.5).unwrap();
    let at = Vec3::zeros();
    assert_eq!(plane.stop(&at, &Vec3::new(0.49, -1.0, 0.0), 0.1), Vec3::zeros());
    assert!((plane.stop(&at, &Vec3::new(0.9, -1.0, 0.0), 0.1) - Vec3::new(0.4, 0.0, 0.0)).norm() < 1e-15);
    assert_eq!(plane.stop(&at, &Vec3::new(0.9, 1.0, 0.0), 0.1), Vec3::new(0.9, 1.0, 0.0));
    let bad = Plane::new(at, Vec3::y(), -0.1).unwrap_err();
    assert_eq!(bad.to_string(), "friction = -0.1 is out of range: 0 or more");
}

#[test]
fn the_centre_of_a_sphere_has_a_direction() {
    let (gap, up) = Sphere::new(Vec3::zeros(), 1.0, 0.0).unwrap().distance(&Vec3::zeros());
    assert_eq!((gap, up), (-1.0, Vec3::y()));
}

fn stretched() -> (Sheet, Vec<Vec3>) {
    let uv: Vec<_> = (0..12).map(|k| Vector2::new((k % 2) as f64 * 0.1, (k / 2) as f64 * 0.1)).collect();
    let t: Vec<[u32; 3]> =
        (0..5).flat_map(|r| [[2 * r, 2 * r + 1, 2 * r + 3], [2 * r, 2 * r + 3, 2 * r + 2]]).collect();
    let x = uv.iter().map(|p| Vec3::new(p.x, -1.3 * p.y, 0.0)).collect();
    (Sheet::flat(&uv, &t, 0.1).unwrap(), x)
}

#[test]
fn both_limits_shorten_and_hold_what_is_held() {
    let (sheet, x) = stretched();
    let fixed: Vec<bool> = (0..12).map(|v| v < 2).collect();
    let (mut a, mut b) = (x.clone(), x.clone());
    assert!(Provot::new(0.1, 200).unwrap().apply(&sheet, &fixed, &mut a) < 0.11);
    assert!(StrainLimit::new(0.1, 200).unwrap().apply(&sheet, &fixed, &mut b) < 0.11);
    assert!(a[..2] == x[..2] && b[..2] == x[..2]);
}

#[test]
fn the_triangle_limit_keeps_the_centre_of_mass() {
    let (sheet, x) = stretched();
    let mut moved = x.clone();
    StrainLimit::new(0.1, 20).unwrap().apply(&sheet, &[false; 12], &mut moved);
    let centre = |x: &[Vec3]| -> Vec3 { x.iter().zip(sheet.masses()).map(|(x, m)| x * *m).sum() };
    assert!((centre(&moved) - centre(&x)).norm() < 1e-15);
}
