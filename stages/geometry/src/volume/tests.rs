#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use proptest::prelude::*;

fn points(scale: f64) -> impl Strategy<Value = Vec<Vec3>> {
    let x = -1.0..1.0;
    prop::collection::vec((x.clone(), x.clone(), x), 1..9)
        .prop_map(move |v| v.into_iter().map(|(x, y, z)| Vec3::new(x, y, z) * scale).collect())
}

/// The least distance between two sets of points.
fn gap(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().flat_map(|p| b.iter().map(move |q| (p - q).norm())).fold(f64::INFINITY, f64::min)
}

/// The promises of every volume, for two sets of points and an offset between them.
fn check<V: BoundingVolume>(a: &[Vec3], b: &[Vec3], c: &[Vec3]) {
    let (va, vb, vc) = (V::fit(a), V::fit(b), V::fit(c));
    let both = va.merge(&vb);
    for p in a.iter().chain(b) {
        assert_eq!(both.distance_squared(p), 0.0, "{both:?} leaves {p} out");
    }
    for (volume, held) in [(va, a.to_vec()), (both, [a, b].concat())] {
        let least = gap(&held, c);
        assert!(volume.near(&vc, least) && vc.near(&volume, least), "{volume:?} {vc:?} {least}");
        for p in c {
            assert!(volume.distance_squared(p).sqrt() <= gap(&held, &[*p]));
        }
    }
}

fn check_all(a: &[Vec3], b: &[Vec3], c: &[Vec3]) {
    check::<Aabb>(a, b, c);
    check::<BoundingSphere>(a, b, c);
    check::<Obb>(a, b, c);
    check::<KDop<3>>(a, b, c);
    check::<KDop<7>>(a, b, c);
    check::<KDop<9>>(a, b, c);
    check::<KDop<13>>(a, b, c);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn never_leave_anything_out(a in points(0.1), b in points(1.0), c in points(0.3), x in -2.0..2.0) {
        let c: Vec<Vec3> = c.iter().map(|p| p + Vec3::new(x, 0.3, 0.0)).collect();
        check_all(&a, &b, &c);
    }

    #[test]
    fn hold_far_from_the_origin(a in points(1.0), b in points(1.0), c in points(1.0)) {
        let far = |v: Vec<Vec3>| v.iter().map(|p| p + Vec3::new(3e7, -5e7, 1e8)).collect::<Vec<_>>();
        check_all(&far(a), &far(b), &far(c));
    }
}

#[test]
fn hold_a_single_point_and_points_on_a_line() {
    let p = Vec3::new(0.1, 0.7, -0.3);
    let line: Vec<Vec3> = (0..5).map(|i| p + Vec3::new(0.1, 0.2, 0.3) * f64::from(i)).collect();
    check_all(&[p], &[p, p, p], &line);
    check_all(&line, &[p], &[p, p]);
}

/// A thin slanted strip about `along`, moved by `offset`.
fn strip(along: Vec3, offset: Vec3) -> Vec<Vec3> {
    (0..8).map(|i| Vec3::from(along * f64::from(i) / 8.0 + offset)).collect()
}

#[test]
fn see_the_gap_between_slanted_strips_according_to_how_tight_they_are() {
    let along = Vec3::new(1.0, 1.0, 0.0);
    let apart = Vec3::new(0.1, -0.1, 0.0);
    fn sees<V: BoundingVolume>(a: &[Vec3], b: &[Vec3]) -> bool {
        !V::fit(a).near(&V::fit(b), 0.0)
    }
    let (a, b) = (strip(along, Vec3::zeros()), strip(along, apart));
    assert!(!sees::<BoundingSphere>(&a, &b) && !sees::<Aabb>(&a, &b) && !sees::<KDop<3>>(&a, &b));
    assert!(
        sees::<KDop<7>>(&a, &b) && sees::<KDop<9>>(&a, &b) && sees::<KDop<13>>(&a, &b) && sees::<Obb>(&a, &b)
    );
}

#[test]
fn oriented_boxes_are_separated_across_two_edges() {
    // Two crossed bars whose faces' normals separate nothing: only the cross product of their axes.
    let bar = |d: Vec3, at: Vec3| -> Vec<Vec3> {
        let ends = [-d, d].map(|e| Vec3::from(e + at));
        let thin = [Vec3::x(), Vec3::y(), Vec3::z()].map(|t| t * 1e-3);
        ends.iter().flat_map(|e| thin.iter().flat_map(move |t| [e + t, e - t])).collect()
    };
    let a = Obb::fit(&bar(Vec3::new(1.0, 1.0, 0.3), Vec3::zeros()));
    let b = Obb::fit(&bar(Vec3::new(1.0, -1.0, 0.2), Vec3::new(0.0, 0.0, 0.1)));
    assert!(!a.near(&b, 0.05));
    assert!(a.near(&b, 0.11));
}

#[test]
fn a_volume_is_not_needlessly_large() {
    let unit: Vec<Vec3> =
        (0..8).map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
    assert_eq!(Aabb::fit(&unit).size(), 3.0);
    assert!(BoundingSphere::fit(&unit).radius < 1.1 * 0.75_f64.sqrt());
    assert!(Obb::fit(&unit).size() < 1.5 + 1e-9);
    assert!((KDop::<13>::fit(&unit).size() - 3.0).abs() < 1e-9);
}
