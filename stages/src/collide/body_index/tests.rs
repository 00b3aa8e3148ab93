#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::testing::{body, both, cube, numbers, sphere};
use super::super::volume::{Aabb, KDop, Obb, Sphere};
use super::*;
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{TriMesh, TriMeshFlags};

fn index<V: BoundingVolume>(body: &Body) -> BodyIndex<V> {
    BodyIndex::new(body, Distances::Asked, &Context::quiet()).unwrap()
}

/// Signed distance to the cube from -h to h.
fn to_cube(p: &Point3, h: f64) -> f64 {
    let out = p.coords.abs().add_scalar(-h);
    out.map(|x| x.max(0.0)).norm() + out.max().min(0.0)
}

fn contacts<V: BoundingVolume>(index: &BodyIndex<V>, at: &[Point3], reach: f64) -> Vec<BodyContact> {
    let mut out = Vec::new();
    index.contacts(at, reach, &mut out);
    out
}

fn hits<V: BoundingVolume>(index: &BodyIndex<V>, from: &[Point3], to: &[Point3]) -> Vec<BodyContact> {
    let mut out = Vec::new();
    index.hits(from, to, &mut out);
    out
}

#[test]
fn the_sign_is_right_about_edges_and_corners_of_a_cube() {
    let index = index::<Aabb>(&cube(0.5));
    let mut next = numbers(5);
    for _ in 0..5000 {
        // Around the corner (h, h, h), where faces, edges and vertex all may be closest.
        let p = Point3::new(next(), next(), next()) * 0.2 + Vector3::repeat(0.4);
        let on = index.closest(&p, f64::INFINITY).unwrap();
        assert!((on.distance - to_cube(&p, 0.5)).abs() < 1e-12, "{p} {on:?}");
        assert!((on.point + on.normal * on.distance - p).norm() < 1e-9, "the normal leads back: {p} {on:?}");
    }
}

#[test]
fn on_the_skin_the_normal_is_the_features() {
    let index = index::<Obb>(&cube(0.5));
    let normal = |x, y, z| index.closest(&Point3::new(x, y, z), 1.0).unwrap().normal;
    assert_eq!(normal(0.1, 0.2, 0.5), Vector3::z());
    assert!((normal(0.1, 0.5, 0.5) - Vector3::new(0.0, 1.0, 1.0).normalize()).norm() < 1e-12);
    assert!((normal(0.5, 0.5, 0.5) - Vector3::repeat(1.0).normalize()).norm() < 1e-12);
}

#[test]
fn agrees_with_parry_on_a_bumpy_body() {
    let mut bumpy = sphere(0.5, 24, 32);
    let mut next = numbers(9);
    bumpy.positions.iter_mut().for_each(|p| *p *= 0.85 + 0.3 * next());
    let index = index::<KDop<9>>(&bumpy);
    let points = bumpy.positions.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let mesh = TriMesh::with_flags(points, bumpy.triangles.clone(), TriMeshFlags::ORIENTED).unwrap();
    for _ in 0..1000 {
        let p = Point3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 1.3;
        let ours = index.signed_distance(&p);
        let parry = mesh.project_local_point(Vector::new(p.x, p.y, p.z), false);
        let distance = (parry.point - Vector::new(p.x, p.y, p.z)).length();
        assert!((ours.abs() - distance).abs() < 1e-9, "{p}: {ours} {distance}");
        assert_eq!(ours < 0.0, parry.is_inside, "{p}: {ours}");
    }
}

#[test]
fn contacts_are_those_of_brute_force_for_every_reach() {
    let ball = sphere(0.5, 24, 32);
    let index = index::<Sphere>(&ball);
    let mut next = numbers(3);
    let at: Vec<Point3> =
        (0..3000).map(|_| Point3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 1.4).collect();
    for reach in [0.0, 0.001, 0.05, 10.0] {
        let expected: Vec<(u32, f64)> = (0..at.len() as u32)
            .map(|i| (i, index.signed_distance(&at[i as usize])))
            .filter(|(_, d)| *d <= reach)
            .collect();
        let found: Vec<(u32, f64)> =
            contacts(&index, &at, reach).iter().map(|c| (c.vertex, c.distance)).collect();
        assert_eq!(found, expected, "reach {reach}");
    }
}

#[test]
fn a_path_hits_where_it_enters() {
    let index = index::<Aabb>(&cube(0.5));
    let from = [[0.0, 0.1, 2.0], [0.0, 0.1, 0.0], [0.0, 0.0, 2.0], [0.3, 0.1, 0.5], [0.0, 0.0, 2.0]]
        .map(Point3::from);
    let to = [[0.0, 0.1, -2.0], [0.0, 0.1, 2.0], [0.0, 0.0, 0.6], [0.3, 0.1, 0.4], [0.0, 0.0, 0.25]]
        .map(Point3::from);
    let found = hits(&index, &from, &to);
    assert_eq!(
        found.iter().map(|h| h.vertex).collect::<Vec<_>>(),
        [0, 3, 4],
        "not one that leaves or stays out"
    );
    assert_eq!(found[0].point, Point3::new(0.0, 0.1, 0.5), "the first of two walls");
    assert!((found[0].distance - 1.5).abs() < 1e-12, "the end is outside again");
    assert_eq!(found[1].point, from[3], "a start on the skin");
    assert_eq!((found[2].normal, found[2].distance), (Vector3::z(), -0.25));
}

#[test]
fn no_path_slips_between_triangles() {
    let ball = sphere(0.5, 12, 16);
    let index = index::<Obb>(&ball);
    // Straight at the vertices and at the middles of edges, from far out.
    let corner = |i: u32| ball.positions[i as usize];
    let targets: Vec<Point3> = ball
        .triangles
        .iter()
        .flat_map(|t| [corner(t[0]), nalgebra::center(&corner(t[1]), &corner(t[2]))])
        .collect();
    let from: Vec<Point3> = targets.iter().map(|p| p * 3.0 + Vector3::new(0.01, 0.02, 0.0)).collect();
    let to: Vec<Point3> = from.iter().zip(&targets).map(|(f, p)| p + (p - f) * 0.01).collect();
    let inside: Vec<u32> =
        (0..to.len() as u32).filter(|&i| index.signed_distance(&to[i as usize]) < 0.0).collect();
    let hit: Vec<u32> = hits(&index, &from, &to).iter().map(|h| h.vertex).collect();
    assert!(inside.len() > targets.len() / 2);
    assert!(inside.iter().all(|i| hit.binary_search(i).is_ok()));
}

#[test]
fn vertices_that_are_no_number_are_left_out() {
    let index = index::<KDop<7>>(&cube(0.5));
    let (good, bad) = (Point3::new(0.0, 0.0, 0.4), Point3::new(0.0, f64::NAN, 0.0));
    let far = Point3::new(f64::INFINITY, 0.0, 0.0);
    assert_eq!(contacts(&index, &[bad, good, far], 0.1).len(), 1);
    assert!(hits(&index, &[bad, good, good], &[good, bad, far]).is_empty());
    assert_eq!(index.signed_distance(&bad), f64::INFINITY);
}

#[test]
fn huge_and_tiny_bodies_keep_their_digits() {
    for scale in [1e-6, 1e6] {
        let index = index::<Sphere>(&sphere(scale, 64, 64));
        let d = index.signed_distance(&Point3::new(0.0, 1.5 * scale, 0.0));
        assert!((d / scale - 0.5).abs() < 1e-9, "{d}");
    }
    let mut moved = cube(0.5);
    moved.positions.iter_mut().for_each(|p| *p += Vector3::repeat(1e6));
    let d = index::<Aabb>(&moved).signed_distance(&Point3::new(1e6 + 0.25, 1e6, 1e6));
    assert!((d + 0.25).abs() < 1e-9, "{d}");
}

#[test]
fn pieces_are_searched_together() {
    let (one, mut two) = (cube(0.5), cube(0.5));
    two.positions.iter_mut().for_each(|p| *p += Vector3::new(1.2, 0.0, 0.0));
    let index = index::<Aabb>(&body(both((one.positions, one.triangles), (two.positions, two.triangles))));
    let between = index.closest(&Point3::new(0.65, 0.0, 0.0), 1.0).unwrap();
    assert!((between.distance - 0.05).abs() < 1e-12 && between.normal == -Vector3::x());
}

#[test]
fn threads_change_nothing() {
    let index = index::<Aabb>(&sphere(0.5, 24, 32));
    let mut next = numbers(4);
    let mut cloud = || (0..2000).map(|_| Point3::new(next(), next(), next()) * 0.6).collect::<Vec<_>>();
    let (from, to) = (cloud(), cloud());
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (contacts(&index, &from, 0.03), hits(&index, &from, &to)))
    };
    assert_eq!(run(1), run(2));
}
