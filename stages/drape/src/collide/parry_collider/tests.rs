#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::bvh_collider::BvhCollider;
use super::super::testing::{ClothMesh, both, cube, numbers, sheet, soup, sphere};
use super::*;
use proptest::prelude::*;
use std::sync::Arc;

/// The service of the stage and that of `BvhCollider`.
fn two(body: Option<&Body>) -> [Arc<dyn Collide>; 2] {
    let cx = Context::quiet();
    [ParryCollider::default().run(body, &cx), BvhCollider::default().run(body, &cx)]
        .map(|c| c.unwrap().scheme)
}

fn contacts(scheme: &Arc<dyn Collide>, at: &[Point3], reach: f64) -> Vec<BodyContact> {
    let mut out = Vec::new();
    scheme.body_contacts(at, reach, &mut out);
    out
}

fn hits(scheme: &Arc<dyn Collide>, from: &[Point3], to: &[Point3]) -> Vec<BodyContact> {
    let mut out = Vec::new();
    scheme.body_hits(from, to, &mut out);
    out
}

fn cloud(seed: u64, count: usize, size: f64) -> Vec<Point3> {
    let mut next = numbers(seed);
    (0..count).map(|_| Point3::new(next() - 0.5, next() - 0.5, next() - 0.5) * size).collect()
}

/// A ball with dents and spikes, whose edges and corners are closest to many points.
fn bumpy(seed: u64) -> Body {
    let (mut ball, mut next) = (sphere(0.5, 12, 16), numbers(seed));
    ball.positions.iter_mut().for_each(|p| *p *= 0.8 + 0.4 * next());
    ball
}

#[test]
fn tells_the_distance_to_a_sphere_inside_and_outside() {
    let [parry, _] = two(Some(&sphere(0.5, 64, 128)));
    let at = [0.3, 0.499, 0.501, 0.51, 0.6].map(|r| Point3::new(0.0, 0.0, r));
    let found = contacts(&parry, &at, 0.02);
    assert_eq!(found.iter().map(|c| c.vertex).collect::<Vec<_>>(), [0, 1, 2, 3]);
    for (contact, expected) in found.iter().zip([-0.2, -0.001, 0.001, 0.01]) {
        // The facets lie up to 0.6 mm under the sphere.
        assert!((contact.distance - expected).abs() < 7e-4, "{contact:?}");
        assert!(contact.normal.z > 0.999, "{contact:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn distances_are_those_of_the_other_collider(seed in 0u64..1 << 32, reach in 0.0..1.0f64) {
        let [parry, own] = two(Some(&bumpy(seed)));
        let at = cloud(seed, 400, 1.4);
        let (a, b) = (contacts(&parry, &at, reach), contacts(&own, &at, reach));
        prop_assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(&b) {
            prop_assert_eq!(a.vertex, b.vertex);
            prop_assert!((a.distance - b.distance).abs() < 1e-9, "{a:?} {b:?}");
            // Where two places are as near, either may be the closest.
            let gap = |c: &BodyContact| (at[c.vertex as usize] - c.point).norm();
            prop_assert!((gap(a) - gap(b)).abs() < 1e-9, "{a:?} {b:?}");
            prop_assert!((a.normal.norm() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn paths_enter_where_they_do_for_the_other_collider(seed in 0u64..1 << 32) {
        let [parry, own] = two(Some(&bumpy(seed)));
        let (from, to) = (cloud(seed, 300, 1.6), cloud(seed + 1, 300, 1.6));
        let (a, b) = (hits(&parry, &from, &to), hits(&own, &from, &to));
        prop_assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(&b) {
            prop_assert_eq!(a.vertex, b.vertex);
            prop_assert!((a.point - b.point).norm() < 1e-9 && (a.normal - b.normal).norm() < 1e-9);
            prop_assert!((a.distance - b.distance).abs() < 1e-9);
        }
    }

    #[test]
    fn cloth_meets_itself_where_it_does_for_the_other_collider(
        seed in 0u64..1 << 32, count in 1u32..120, size in 0.02..0.5, reach in 0.0..0.2,
    ) {
        let [parry, own] = two(None);
        let cloth = soup(seed, count, size);
        // The second time the tree is one that was kept, and the cloth lies elsewhere.
        let mut moved: ClothMesh = cloth.clone();
        moved.0.iter_mut().zip(cloud(seed, cloth.0.len(), 0.2)).for_each(|(p, by)| *p += by.coords);
        for (x, triangles) in [&cloth, &moved] {
            let found = |s: &Arc<dyn Collide>| {
                let mut out = Vec::new();
                s.self_contacts(x, triangles, reach, &mut out);
                (out, s.conservative_bounds(x, triangles, reach), s.self_crossings(x, triangles))
            };
            prop_assert_eq!(found(&parry), found(&own));
        }
    }
}

#[test]
fn a_point_on_a_corner_of_the_body_is_at_no_distance() {
    let schemes = two(Some(&cube(0.5)));
    let at = [Point3::new(0.5, 0.5, 0.5), Point3::new(0.5, 0.5, 0.1), Point3::new(0.5, 0.2, 0.1)];
    let [parry, own] = schemes.map(|s| contacts(&s, &at, 1e-12));
    assert_eq!((parry.len(), own.len()), (3, 3));
    assert!(parry.iter().all(|c| c.distance.abs() < 1e-12), "{parry:?}");
    let apart = |k: usize| (parry[k].normal - own[k].normal).norm();
    assert!(apart(0) < 1e-12 && apart(2) < 1e-12, "{parry:?} {own:?}");
    // On an edge, parry3d takes the inside of one of its triangles for the closest feature.
    assert!([Vector3::x(), Vector3::y()].contains(&parry[1].normal), "{parry:?}");
}

#[test]
fn small_cloths_bad_triangles_and_numbers_are_taken() {
    let [parry, own] = two(None);
    let (mut positions, mut triangles) = both(sheet(3, |_, _| 0.0), sheet(3, |_, _| 0.002));
    triangles.extend([[0, 0, 20], [1, 2, 99], [u32::MAX; 3]]);
    positions[20] = Point3::new(f64::NAN, f64::INFINITY, 0.0);
    for part in [&triangles[..0], &triangles[..1], &triangles[..2], &triangles[..3], &triangles[..]] {
        let found = |s: &Arc<dyn Collide>| {
            let mut out = Vec::new();
            s.self_contacts(&positions, part, 0.003, &mut out);
            (out, s.conservative_bounds(&positions, part, 0.003), s.self_crossings(&positions, part))
        };
        assert_eq!(found(&parry), found(&own));
    }
    let [parry, _] = two(Some(&cube(0.5)));
    let (good, bad) = (Point3::new(0.0, 0.0, 0.4), Point3::new(0.0, f64::NAN, 0.0));
    let far = Point3::new(f64::INFINITY, 0.0, 0.0);
    assert_eq!(contacts(&parry, &[bad, good, far], 0.1).len(), 1);
    assert!(hits(&parry, &[bad, good, good], &[good, bad, far]).is_empty());
}

#[test]
fn refuses_an_open_body_in_the_words_of_the_other_collider() {
    let mut open = cube(0.5);
    open.triangles.pop();
    let told = |e: StageError| (e.message, e.hint);
    let error = told(ParryCollider::default().run(Some(&open), &Context::quiet()).unwrap_err());
    assert_eq!(
        error.0,
        "the body is not closed: it has 3 boundary edges, the first from (0.500, -0.500, -0.500) to (0.500, -0.500, 0.500) m"
    );
    assert_eq!(error, told(BvhCollider::default().run(Some(&open), &Context::quiet()).unwrap_err()));
}

#[test]
fn warns_where_nothing_is_left_to_collide() {
    let cx = Context::quiet();
    let contact = ContactSettings { self_collision: false, ..Default::default() };
    ParryCollider { contact }.run(None, &cx).unwrap();
    assert_eq!(
        cx.take_remarks().warnings,
        ["there is no body and self-collision is off: nothing is kept apart"]
    );
}

#[test]
fn its_signature_and_card_tell_settings_and_bodies_apart() {
    let contact = ContactSettings {
        thickness: Length::mm(2.0),
        penalty: Some(Penalty::Linear(50.0)),
        ..Default::default()
    };
    let other = ParryCollider { contact };
    let made = |c: &ParryCollider, b: Option<&Body>| c.run(b, &Context::quiet()).unwrap();
    let plain = ParryCollider::default();
    let signs = [
        made(&plain, None).signature,
        made(&plain, Some(&cube(0.5))).signature,
        made(&plain, Some(&cube(0.6))).signature,
        made(&other, Some(&cube(0.5))).signature,
        BvhCollider::default().run(None, &Context::quiet()).unwrap().signature,
    ];
    assert_eq!(signs.iter().collect::<std::collections::BTreeSet<_>>().len(), 5);
    let card = made(&other, None).scheme.card();
    assert_eq!((card.thickness, card.penalty), (0.002, Some(Penalty::Linear(50.0))));
}

#[test]
fn threads_change_nothing() {
    let wave = |lift: f64| sheet(30, move |x, y| 0.05 * (9.0 * x).sin() * (7.0 * y).cos() + lift);
    let (cloth, at) = (both(wave(0.0), wave(0.01)), cloud(4, 2000, 1.2));
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let [scheme, _] = two(Some(&sphere(0.5, 24, 32)));
        pool.install(|| {
            let mut on_self = Vec::new();
            scheme.self_contacts(&cloth.0, &cloth.1, 0.02, &mut on_self);
            (on_self, contacts(&scheme, &at, 0.03))
        })
    };
    let one = run(1);
    assert!(one.0.len() > 1000 && !one.1.is_empty());
    assert_eq!(one, run(2));
}
