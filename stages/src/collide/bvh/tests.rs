#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::testing::{Cloth, soup};
use super::super::volume::{KDop, Obb, Sphere};
use super::*;
use std::collections::BTreeSet;

fn corners((positions, triangles): &Cloth) -> Vec<Corners> {
    triangles.iter().map(|t| t.map(|i| positions[i as usize])).collect()
}

fn tree<V: BoundingVolume>(corners: &[Corners], leaf: usize) -> Bvh<V> {
    Bvh::fitted((0..corners.len() as u32).collect(), leaf, |i| corners[i as usize])
}

/// Pairs of the tree's leaves that hold boxes nearer than `reach`.
fn pairs<V: BoundingVolume>(tree: &Bvh<V>, reach: f64) -> Vec<(u32, u32)> {
    tree.self_pairs(reach, |a, b, out| out.push((a, b))).0
}

fn check_pairs<V: BoundingVolume>(corners: &[Corners], reach: f64) {
    let found = pairs(&tree::<V>(corners, 2), reach);
    let set: BTreeSet<_> = found.iter().copied().collect();
    assert_eq!(set.len(), found.len(), "a pair came twice");
    assert!(set.iter().all(|(a, b)| a < b));
    for i in 0..corners.len() as u32 {
        for j in i + 1..corners.len() as u32 {
            let near = |p: &Point3| corners[j as usize].iter().any(|q| (p - q).norm() <= reach);
            assert!(!corners[i as usize].iter().any(near) || set.contains(&(i, j)), "{i} {j}");
        }
    }
    assert!(set.len() < corners.len() * corners.len() / 4, "{} pairs: nothing is sorted out", set.len());
}

#[test]
fn finds_every_near_pair_once() {
    let corners = corners(&soup(1, 300, 0.1));
    check_pairs::<Aabb>(&corners, 0.05);
    check_pairs::<Sphere>(&corners, 0.05);
    check_pairs::<Obb>(&corners, 0.05);
    check_pairs::<KDop<13>>(&corners, 0.05);
}

#[test]
fn finds_the_nearest_first_of_equals() {
    let corners = corners(&soup(2, 500, 0.05));
    let tree = tree::<Sphere>(&corners, 4);
    let distance = |i: u32, p: &Point3| (corners[i as usize][0] - p).norm_squared();
    for k in 0..50 {
        let p = Point3::new(f64::from(k) / 50.0, 0.3, 0.7);
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
    let none = tree::<Aabb>(&[], 2);
    assert!(pairs(&none, 1.0).is_empty() && none.root().is_none());
    none.nearest(&Point3::origin(), f64::INFINITY, |_, _| unreachable!());
    let one = tree::<Obb>(&corners(&soup(3, 1, 0.1)), 2);
    assert!(pairs(&one, 1.0).is_empty());
    let mut seen = Vec::new();
    one.within(&Obb::fit(&[Point3::new(0.5, 0.5, 0.5)]), 2.0, |i| seen.push(i));
    assert_eq!(seen, [0]);
}

#[test]
fn stays_shallow_where_all_triangles_lie_on_each_other() {
    let corners = vec![corners(&soup(4, 1, 0.1))[0]; 200];
    assert_eq!(pairs(&tree::<Aabb>(&corners, 2), 0.0).len(), 200 * 199 / 2);
}

#[test]
fn stays_shallow_where_sizes_fall_by_powers() {
    let shrink = |i: i32| [1.0, 1.1, 1.2].map(|x| Point3::new(x * 0.5_f64.powi(i), 0.0, 0.0));
    let corners: Vec<Corners> = (0..1000).map(shrink).collect();
    let mut seen = 0;
    tree::<Aabb>(&corners, 1).within(&Aabb::fit(&[Point3::origin()]), 2.0, |_| seen += 1);
    assert_eq!(seen, 1000);
}

#[test]
fn a_refit_follows_moved_triangles() {
    let (before, after) = (corners(&soup(5, 200, 0.1)), corners(&soup(6, 200, 0.1)));
    let mut moved = Bvh::<KDop<7>>::merged((0..200).collect(), 2, |i| before[i as usize]);
    moved.refit(|i| after[i as usize]);
    let mut seen = Vec::new();
    let probe = KDop::<7>::fit(&[Point3::new(0.5, 0.5, 0.5)]);
    moved.within(&probe, 0.05, |i| seen.push(i));
    for i in (0..200u32).filter(|&i| KDop::<7>::fit(&after[i as usize]).near(&probe, 0.05)) {
        assert!(seen.contains(&i));
    }
    assert!(!seen.is_empty() && seen.len() < 150);
}

#[test]
fn the_order_of_pairs_does_not_depend_on_threads() {
    let corners = corners(&soup(7, 2000, 0.05));
    let tree = tree::<Aabb>(&corners, 2);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| pairs(&tree, 0.01))
    };
    assert_eq!(run(1), run(3));
}
