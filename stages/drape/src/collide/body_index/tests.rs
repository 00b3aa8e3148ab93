#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::testing::{cube, numbers, sphere};
use super::*;
use toile_core::artifact::Vector3;
use toile_geometry::signed_distance::SignedDistance;
use toile_geometry::volume::{Aabb, BoundingSphere, BoundingVolume, KDop, Obb};

type OwnIndex<V> = BodyIndex<SignedDistance<V>>;

fn index<V: BoundingVolume>(body: &Body) -> OwnIndex<V> {
    BodyIndex::new(body, Distances::Asked, &Context::quiet()).unwrap()
}

fn contacts<V: BoundingVolume>(index: &OwnIndex<V>, at: &[Point3], reach: f64) -> Vec<BodyContact> {
    let mut out = Vec::new();
    index.contacts(at, reach, &mut out);
    out
}

fn hits<V: BoundingVolume>(index: &OwnIndex<V>, from: &[Point3], to: &[Point3]) -> Vec<BodyContact> {
    let mut out = Vec::new();
    index.hits(from, to, &mut out);
    out
}

#[test]
fn contacts_are_those_of_brute_force_for_every_reach() {
    let ball = sphere(0.5, 24, 32);
    let index = index::<BoundingSphere>(&ball);
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
