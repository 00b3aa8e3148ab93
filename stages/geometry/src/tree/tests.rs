#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::meet::Meeting;
use super::*;
use crate::shapes::{ShapeMesh, soup};
use crate::volume::{Aabb, BoundingSphere, KDop, Obb};
use std::collections::BTreeSet;

fn corners((positions, triangles): &ShapeMesh) -> Vec<Corners> {
    triangles.iter().map(|t| t.map(|i| positions[i as usize])).collect()
}

/// Pairs whose volumes are nearer than `reach`, the lower number first.
fn pairs<V: BoundingVolume>(corners: &[Corners], reach: f64) -> Vec<(u32, u32)> {
    let (tree, order) = VolumeTree::over(corners, 2);
    let things: Vec<V> = order.iter().map(|&i| V::fit(&corners[i as usize])).collect();
    let visit =
        |a: usize, b: usize, out: &mut Vec<_>| out.push((order[a].min(order[b]), order[a].max(order[b])));
    tree.meetings(&Meeting { parts: &tree.fit(&things), things: &things, reach, active: None, visit: &visit })
}

fn check_pairs<V: BoundingVolume>(corners: &[Corners], reach: f64) {
    let found = pairs::<V>(corners, reach);
    let set: BTreeSet<_> = found.iter().copied().collect();
    assert_eq!(set.len(), found.len(), "a pair came twice");
    assert!(set.iter().all(|(a, b)| a < b));
    for i in 0..corners.len() as u32 {
        for j in i + 1..corners.len() as u32 {
            let near = |p: &Vec3| corners[j as usize].iter().any(|q| (p - q).norm() <= reach);
            assert!(!corners[i as usize].iter().any(near) || set.contains(&(i, j)), "{i} {j}");
        }
    }
    assert!(set.len() < corners.len() * corners.len() / 4, "{} pairs: nothing is sorted out", set.len());
}

#[test]
fn finds_every_near_pair_once() {
    let corners = corners(&soup(1, 300, 0.1));
    check_pairs::<Aabb>(&corners, 0.05);
    check_pairs::<BoundingSphere>(&corners, 0.05);
    check_pairs::<Obb>(&corners, 0.05);
    check_pairs::<KDop<13>>(&corners, 0.05);
}

#[test]
fn finds_the_nearest_first_of_equals() {
    let corners = corners(&soup(2, 500, 0.05));
    let tree = Bvh::<BoundingSphere>::new(&corners, 4);
    let distance = |i: u32, p: &Vec3| (corners[i as usize][0] - p).norm_squared();
    for k in 0..50 {
        let p = Vec3::new(f64::from(k) / 50.0, 0.3, 0.7);
        let mut best = (f64::INFINITY, u32::MAX);
        tree.nearest(&p, f64::INFINITY, |i, bound| {
            best = if (distance(i, &p), i) < best { (distance(i, &p), i) } else { best };
            best.0.min(bound)
        });
        let brute = (0..500)
            .map(|i| (distance(i, &p), i))
            .fold((f64::INFINITY, u32::MAX), |a, b| if b < a { b } else { a });
        assert_eq!(best, brute);
    }
}

#[test]
fn serves_none_and_one() {
    assert!(pairs::<Aabb>(&[], 1.0).is_empty());
    Bvh::<Aabb>::new(&[], 2).nearest(&Vec3::zeros(), f64::INFINITY, |_, _| unreachable!());
    let corners = corners(&soup(3, 1, 0.1));
    assert!(pairs::<Obb>(&corners, 1.0).is_empty());
    let one = Bvh::<Obb>::new(&corners, 2);
    let mut seen = Vec::new();
    one.within(&Obb::fit(&[Vec3::new(0.5, 0.5, 0.5)]), 2.0, |i| seen.push(i));
    assert_eq!(seen, [0]);
}

#[test]
fn stays_shallow_where_all_triangles_lie_on_each_other() {
    let corners = vec![corners(&soup(4, 1, 0.1))[0]; 200];
    assert_eq!(pairs::<Aabb>(&corners, 0.0).len(), 200 * 199 / 2);
}

#[test]
fn stays_shallow_where_sizes_fall_by_powers() {
    let shrink = |i: i32| [1.0, 1.1, 1.2].map(|x| Vec3::new(x * 0.5_f64.powi(i), 0.0, 0.0));
    let corners: Vec<Corners> = (0..1000).map(shrink).collect();
    let mut seen = 0;
    Bvh::<Aabb>::new(&corners, 1).within(&Aabb::fit(&[Vec3::zeros()]), 2.0, |_| seen += 1);
    assert_eq!(seen, 1000);
}

#[test]
fn a_fit_follows_moved_triangles() {
    let (before, after) = (corners(&soup(5, 200, 0.1)), corners(&soup(6, 200, 0.1)));
    let (tree, order) = VolumeTree::over(&before, 2);
    let things: Vec<KDop<7>> = order.iter().map(|&i| KDop::fit(&after[i as usize])).collect();
    let mut seen = Vec::new();
    let probe = KDop::<7>::fit(&[Vec3::new(0.5, 0.5, 0.5)]);
    tree.within(&tree.fit(&things), &probe, 0.05, |i| seen.push(i));
    for (i, thing) in things.iter().enumerate() {
        assert!(!thing.near(&probe, 0.05) || seen.contains(&i));
    }
    assert!(!seen.is_empty() && seen.len() < 150);
}

#[test]
fn the_order_of_pairs_does_not_depend_on_threads() {
    let corners = corners(&soup(7, 2000, 0.05));
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| pairs::<Aabb>(&corners, 0.01))
    };
    assert_eq!(run(1), run(3));
}
