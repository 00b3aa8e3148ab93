#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use crate::shapes::{ShapeMesh, both, cube, numbers, sphere};
use crate::volume::{BoundingSphere, KDop, Obb};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{TriMesh, TriMeshFlags};

fn index<V: BoundingVolume>(shape: &ShapeMesh) -> SignedDistance<V> {
    SignedDistance::new(shape.0.clone(), shape.1.clone())
}

/// Signed distance to the cube from -h to h.
fn to_cube(p: &Vec3, h: f64) -> f64 {
    let out = p.abs().add_scalar(-h);
    out.map(|x| x.max(0.0)).norm() + out.max().min(0.0)
}

#[test]
fn the_sign_is_right_about_edges_and_corners_of_a_cube() {
    let index = index::<Aabb>(&cube(0.5));
    let mut next = numbers(5);
    for _ in 0..5000 {
        // Around the corner (h, h, h), where faces, edges and vertex all may be closest.
        let p = Vec3::new(next(), next(), next()) * 0.2 + Vec3::repeat(0.4);
        let on = index.nearest(&p, f64::INFINITY).unwrap();
        assert!((on.distance - to_cube(&p, 0.5)).abs() < 1e-12, "{p} {on:?}");
        assert!((on.point + on.normal * on.distance - p).norm() < 1e-9, "the normal leads back: {p} {on:?}");
    }
}

#[test]
fn on_the_skin_the_normal_is_the_features() {
    let index = index::<Obb>(&cube(0.5));
    let normal = |x, y, z| index.nearest(&Vec3::new(x, y, z), 1.0).unwrap().normal;
    assert_eq!(normal(0.1, 0.2, 0.5), Vec3::z());
    assert!((normal(0.1, 0.5, 0.5) - Vec3::new(0.0, 1.0, 1.0).normalize()).norm() < 1e-12);
    assert!((normal(0.5, 0.5, 0.5) - Vec3::repeat(1.0).normalize()).norm() < 1e-12);
}

#[test]
fn agrees_with_parry_on_a_bumpy_body() {
    let mut bumpy = sphere(0.5, 24, 32);
    let mut next = numbers(9);
    bumpy.0.iter_mut().for_each(|p| *p *= 0.85 + 0.3 * next());
    let index = index::<KDop<9>>(&bumpy);
    let points = bumpy.0.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let mesh = TriMesh::with_flags(points, bumpy.1.clone(), TriMeshFlags::ORIENTED).unwrap();
    for _ in 0..1000 {
        let p = Vec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 1.3;
        let ours = index.distance(&p);
        let parry = mesh.project_local_point(Vector::new(p.x, p.y, p.z), false);
        let distance = (parry.point - Vector::new(p.x, p.y, p.z)).length();
        assert!((ours.abs() - distance).abs() < 1e-9, "{p}: {ours} {distance}");
        assert_eq!(ours < 0.0, parry.is_inside, "{p}: {ours}");
    }
}

#[test]
fn huge_and_tiny_bodies_keep_their_digits() {
    for scale in [1e-6, 1e6] {
        let index = index::<BoundingSphere>(&sphere(scale, 64, 64));
        let d = index.distance(&Vec3::new(0.0, 1.5 * scale, 0.0));
        assert!((d / scale - 0.5).abs() < 1e-9, "{d}");
    }
    let mut moved = cube(0.5);
    moved.0.iter_mut().for_each(|p| *p += Vec3::repeat(1e6));
    let d = index::<Aabb>(&moved).distance(&Vec3::new(1e6 + 0.25, 1e6, 1e6));
    assert!((d + 0.25).abs() < 1e-9, "{d}");
}

#[test]
fn pieces_are_searched_together() {
    let (one, mut two) = (cube(0.5), cube(0.5));
    two.0.iter_mut().for_each(|p| *p += Vec3::new(1.2, 0.0, 0.0));
    let index = index::<Aabb>(&both(one, two));
    let between = index.nearest(&Vec3::new(0.65, 0.0, 0.0), 1.0).unwrap();
    assert!((between.distance - 0.05).abs() < 1e-12 && between.normal == -Vec3::x());
}
