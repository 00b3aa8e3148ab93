#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::proximity::{edge_edge, vertex_triangle};
use super::super::testing::{ClothMesh, both, sheet, soup};
use super::*;
use proptest::prelude::*;
use std::collections::BTreeSet;
use toile_core::artifact::Vector3;
use toile_geometry::closest::Feature;
use toile_geometry::volume::{Aabb, BoundingSphere, BoundingVolume, KDop, Obb};

const CARD: ColliderCard =
    ColliderCard { thickness: 1e-3, friction: 0.3, restitution: 0.0, self_collision: true, penalty: None };

fn scheme<V: BoundingVolume>() -> BvhScheme<V> {
    BvhScheme::new(CARD, None, Distances::Asked, &Context::quiet()).unwrap()
}

fn contacts(scheme: &dyn Collide, (positions, triangles): &ClothMesh, reach: f64) -> Vec<SelfContact> {
    let mut out = Vec::new();
    scheme.self_contacts(positions, triangles, reach, &mut out);
    out
}

fn edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let of = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|[i, j]| [i.min(j), i.max(j)]);
    triangles.iter().flat_map(of).collect::<BTreeSet<_>>().into_iter().collect()
}

/// Every pair nearer than `reach`, straight from the definition: nodes, distance, closest features.
type BrutePair = ([u32; 4], f64, Option<BTreeSet<u32>>);

fn brute_pairs((positions, triangles): &ClothMesh, reach: f64) -> Vec<BrutePair> {
    let at = |i: u32| positions[i as usize].coords;
    let used: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let mut pairs = Vec::new();
    for &v in &used {
        for t in triangles.iter().filter(|t| !t.contains(&v)) {
            let (found, feature) = vertex_triangle(&at(v), &t.map(at));
            let nodes = |ks: &[usize]| Some(ks.iter().map(|&k| t[k % 3]).chain([v]).collect());
            let features = match feature {
                Feature::Face => nodes(&[0, 1, 2]),
                Feature::Side(k) => nodes(&[k as usize, k as usize + 1]),
                Feature::Corner(k) => nodes(&[k as usize]),
            };
            pairs.push(([v, t[0], t[1], t[2]], found.distance, features));
        }
    }
    let edges = edges(triangles);
    for (i, e) in edges.iter().enumerate() {
        for f in edges[i + 1..].iter().filter(|f| !f.contains(&e[0]) && !f.contains(&e[1])) {
            let (found, inside) = edge_edge(&e.map(at), &f.map(at));
            let features = inside.then(|| e.iter().chain(f).copied().collect());
            pairs.push(([e[0], e[1], f[0], f[1]], found.distance, features));
        }
    }
    pairs.retain(|p| p.1 < reach);
    pairs
}

/// The closest features of a contact: the nodes that carry weight.
fn features(c: &SelfContact) -> BTreeSet<u32> {
    c.vertices.iter().zip(c.weights).filter(|(_, w)| *w != 0.0).map(|(v, _)| *v).collect()
}

fn check_against_brute_force(cloth: &ClothMesh, reach: f64) {
    let brute = brute_pairs(cloth, reach);
    let found = contacts(&scheme::<Aabb>(), cloth, reach);
    let is_vertex = |c: &&SelfContact| c.weights[0] == 1.0 && c.weights[1] <= 0.0;
    let (vertices, edges): (Vec<&SelfContact>, Vec<&SelfContact>) = found.iter().partition(is_vertex);
    assert!(vertices.is_sorted_by_key(|c| c.vertices) && edges.is_sorted_by_key(|c| c.vertices));
    let expected: BTreeSet<_> = brute.iter().filter_map(|p| p.2.clone()).collect();
    assert_eq!(found.iter().map(features).collect::<BTreeSet<_>>(), expected);
    // Three nodes are a vertex and a side in three ways, two nodes are one pair.
    let vertex = |c: &SelfContact, f: &BTreeSet<u32>| (f.len() == 3).then_some(c.vertices[0]);
    let named = found.iter().map(|c| (c, features(c))).filter(|(_, f)| f.len() < 4);
    let small: Vec<_> = named.map(|(c, f)| (vertex(c, &f), f)).collect();
    assert_eq!(small.len(), small.iter().collect::<BTreeSet<_>>().len(), "a pair came twice");
    let wide: BTreeSet<([u32; 4], u64)> = brute.iter().map(|p| (p.0, p.1.to_bits())).collect();
    assert!(found.iter().all(|c| wide.contains(&(c.vertices, c.distance.to_bits()))));
    // The bounds are the least over all pairs, deduplicated or not.
    let mut bounds = vec![reach; cloth.0.len()];
    for (nodes, d, _) in &brute {
        nodes.iter().for_each(|&n| bounds[n as usize] = bounds[n as usize].min(*d));
    }
    assert_eq!(scheme::<Aabb>().conservative_bounds(&cloth.0, &cloth.1, reach), bounds);
}

fn check_same(cloth: &ClothMesh, reach: f64, other: &dyn Collide) {
    let boxes = scheme::<Aabb>();
    assert_eq!(contacts(other, cloth, reach), contacts(&boxes, cloth, reach));
    let bounds = |s: &dyn Collide| s.conservative_bounds(&cloth.0, &cloth.1, reach);
    assert_eq!(bounds(other), bounds(&boxes));
    assert_eq!(other.self_crossings(&cloth.0, &cloth.1), boxes.self_crossings(&cloth.0, &cloth.1));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn contacts_are_those_of_brute_force(seed in 0u64..1 << 32, count in 1u32..60, size in 0.05..0.5, reach in 0.0..0.3) {
        check_against_brute_force(&soup(seed, count, size), reach);
    }

    #[test]
    fn all_volumes_agree(seed in 0u64..1 << 32, count in 1u32..120, size in 0.02..0.5, reach in 0.0..0.2) {
        let cloth = soup(seed, count, size);
        check_same(&cloth, reach, &scheme::<BoundingSphere>());
        check_same(&cloth, reach, &scheme::<Obb>());
        check_same(&cloth, reach, &scheme::<KDop<3>>());
        check_same(&cloth, reach, &scheme::<KDop<7>>());
        check_same(&cloth, reach, &scheme::<KDop<9>>());
        check_same(&cloth, reach, &scheme::<KDop<13>>());
    }

    #[test]
    fn moves_within_the_bounds_make_no_crossing(seed in 0u64..1 << 32, lift in 0.001..0.02) {
        let wave = |lift: f64| sheet(6, move |x, y| 0.05 * (9.0 * x).sin() * (7.0 * y).cos() + lift);
        let (mut positions, triangles) = both(wave(0.0), wave(lift));
        let scheme = scheme::<Aabb>();
        prop_assert_eq!(scheme.self_crossings(&positions, &triangles), Vec::<[u32; 2]>::new());
        let mut next = super::super::testing::numbers(seed);
        for _ in 0..5 {
            let bounds = scheme.conservative_bounds(&positions, &triangles, 0.1);
            for (p, bound) in positions.iter_mut().zip(&bounds) {
                let way = Vector3::new(next() - 0.5, next() - 0.5, 8.0 * (next() - 0.5)).normalize();
                *p += way * (0.499 * bound);
            }
            prop_assert_eq!(scheme.self_crossings(&positions, &triangles), Vec::<[u32; 2]>::new());
        }
    }
}

#[test]
fn contacts_of_smooth_cloth_are_those_of_brute_force() {
    let wave = |lift: f64| sheet(6, move |x, y| 0.05 * (9.0 * x).sin() * (7.0 * y).cos() + lift);
    check_against_brute_force(&both(wave(0.0), wave(0.01)), 0.05);
}

#[test]
fn two_parallel_sheets_push_each_other_straight_apart() {
    let cloth = both(sheet(4, |_, _| 0.0), sheet(4, |_, _| 0.002));
    let found = contacts(&scheme::<Aabb>(), &cloth, 0.003);
    // Every vertex lies over one of the other sheet: one contact per pair, whatever the triangles.
    assert_eq!(found.len(), 25);
    for c in &found {
        assert!((c.distance - 0.002).abs() < 1e-15 && c.normal.z.abs() == 1.0);
        assert_eq!(c.vertices[0] + 25, *features(c).last().unwrap());
    }
}

#[test]
fn cloth_with_nothing_near_has_no_contacts() {
    let cloth = sheet(8, |_, _| 0.0);
    assert!(contacts(&scheme::<Aabb>(), &cloth, 0.05).is_empty());
    assert!(contacts(&scheme::<Aabb>(), &(vec![], vec![]), 0.05).is_empty());
    let one: ClothMesh = (cloth.0.clone(), vec![cloth.1[0]]);
    assert!(contacts(&scheme::<Obb>(), &one, 0.05).is_empty());
    assert_eq!(scheme::<Aabb>().conservative_bounds(&one.0, &one.1, 0.05), vec![0.05; one.0.len()]);
}

#[test]
fn bad_triangles_and_numbers_are_left_out() {
    let (mut positions, mut triangles) = both(sheet(3, |_, _| 0.0), sheet(3, |_, _| 0.002));
    let clean = contacts(&scheme::<Aabb>(), &(positions.clone(), triangles.clone()), 0.003);
    triangles.extend([[0, 0, 20], [1, 2, 99], [u32::MAX; 3]]);
    assert_eq!(contacts(&scheme::<Aabb>(), &(positions.clone(), triangles.clone()), 0.003), clean);
    positions[20] = Point3::new(f64::NAN, f64::INFINITY, 0.0);
    for scheme in [&scheme::<BoundingSphere>() as &dyn Collide, &scheme::<Obb>(), &scheme::<KDop<13>>()] {
        let found = contacts(scheme, &(positions.clone(), triangles.clone()), 0.003);
        assert!(
            !found.is_empty() && found.iter().all(|c| c.distance.is_finite() && c.normal.norm().is_finite())
        );
        assert!(found.iter().all(|c| !c.vertices.contains(&20)));
        let bounds = scheme.conservative_bounds(&positions, &triangles, 0.003);
        assert!(bounds.iter().all(|b| b.is_finite()));
        assert!(scheme.self_crossings(&positions, &triangles).is_empty());
    }
}

#[test]
fn a_triangle_without_area_still_makes_contacts_with_normals() {
    let (mut positions, triangles) = both(sheet(3, |_, _| 0.0), sheet(3, |_, _| 0.002));
    positions[5] = positions[6];
    positions[9] = nalgebra::center(&positions[8], &positions[10]);
    let found = contacts(&scheme::<Aabb>(), &(positions, triangles), 0.003);
    assert!(found.iter().all(|c| (c.normal.norm() - 1.0).abs() < 1e-12));
    assert!(found.iter().all(|c| c.weights.iter().sum::<f64>().abs() < 1e-12));
}

#[test]
fn what_was_asked_before_changes_nothing() {
    let wave = |lift: f64| sheet(10, move |x, y| 0.05 * (9.0 * x).sin() * (7.0 * y).cos() + lift);
    let (near, far) = (both(wave(0.0), wave(0.01)), both(wave(0.0), wave(0.5)));
    let used = scheme::<Aabb>();
    let fresh = contacts(&scheme::<Aabb>(), &near, 0.02);
    for other in [&far, &soup(1, 20, 0.1), &near] {
        contacts(&used, other, 0.02);
    }
    assert_eq!(contacts(&used, &near, 0.02), fresh);
}

#[test]
fn threads_change_nothing() {
    let wave = |lift: f64| sheet(30, move |x, y| 0.05 * (9.0 * x).sin() * (7.0 * y).cos() + lift);
    let cloth = both(wave(0.0), wave(0.01));
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let scheme = scheme::<Aabb>();
        pool.install(|| {
            (contacts(&scheme, &cloth, 0.02), scheme.conservative_bounds(&cloth.0, &cloth.1, 0.02))
        })
    };
    let one = run(1);
    assert!(one.0.len() > 1000);
    assert_eq!(one, run(2));
    assert_eq!(one, run(3));
}

#[test]
fn queries_from_inside_a_pool_do_not_wait_for_each_other() {
    use rayon::prelude::*;
    let cloth = soup(3, 200, 0.1);
    let shared = scheme::<Aabb>();
    let expected = contacts(&shared, &cloth, 0.05);
    assert!((0..32).into_par_iter().all(|_| contacts(&shared, &cloth, 0.05) == expected));
}

#[test]
fn a_tree_is_kept_for_the_same_cloth_and_made_for_another() {
    let (cloth, other) = (soup(7, 60, 0.5), soup(8, 30, 0.5));
    let scheme = scheme::<Aabb>();
    let first = scheme.self_crossings(&cloth.0, &cloth.1);
    assert!(!first.is_empty());
    let own = contacts(&scheme, &other, 0.1);
    assert_eq!(scheme.lock().len(), 1);
    assert_eq!(scheme.self_crossings(&cloth.0, &cloth.1), first);
    assert_eq!(contacts(&scheme, &other, 0.1), own);
}
