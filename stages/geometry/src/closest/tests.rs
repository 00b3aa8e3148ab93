#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::{PointQuery, details::closest_points_segment_segment_with_locations};
use parry3d_f64::shape::{Segment, Triangle};
use proptest::prelude::*;

fn to_parry(p: &Vec3) -> Vector {
    Vector::new(p.x, p.y, p.z)
}

fn point() -> impl Strategy<Value = Vec3> {
    let x = -1.0..1.0;
    (x.clone(), x.clone(), x).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn mix(t: &[Vec3], weights: &[f64]) -> Vec3 {
    t.iter().zip(weights).map(|(p, w)| p * *w).sum()
}

fn gap(a: &[Vec3; 2], b: &[Vec3; 2], (s, t): (f64, f64)) -> f64 {
    (mix(a, &[1.0 - s, s]) - mix(b, &[1.0 - t, t])).norm()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn agrees_with_parry_on_triangles(p in point(), a in point(), b in point(), c in point()) {
        let on = on_triangle(&p, &[a, b, c]);
        let parry = Triangle::new(to_parry(&a), to_parry(&b), to_parry(&c)).project_local_point(to_parry(&p), true);
        let distance = (parry.point - to_parry(&p)).length();
        prop_assert!(((p - on.point).norm() - distance).abs() < 1e-9);
        prop_assert!((mix(&[a, b, c], &on.weights) - on.point).norm() < 1e-12);
        prop_assert!(on.weights.iter().all(|w| *w >= 0.0) && (on.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn agrees_with_parry_on_segments(a in point(), b in point(), c in point(), d in point()) {
        let ours = gap(&[a, b], &[c, d], between_segments(&[a, b], &[c, d]));
        let (one, two) = (Segment::new(to_parry(&a), to_parry(&b)), Segment::new(to_parry(&c), to_parry(&d)));
        let (s, t) = closest_points_segment_segment_with_locations(&Pose::IDENTITY, &one, &two);
        let parry = (one.point_at(&s) - two.point_at(&t)).length();
        prop_assert!((ours - parry).abs() < 1e-9, "{ours} {parry}");
    }

    #[test]
    fn nothing_on_nearly_flat_triangles_is_nearer(p in point(), a in point(), b in point(), k in -1.5..2.5, thin in 0.0..1e-12) {
        let t = [a, b, a + (b - a) * k + Vec3::new(thin, 0.0, 0.0)];
        let on = on_triangle(&p, &t);
        for i in 0..=20 {
            let s = f64::from(i) / 20.0;
            for side in 0..3 {
                let q = mix(&[t[side], t[(side + 1) % 3]], &[1.0 - s, s]);
                prop_assert!((p - on.point).norm() <= (p - q).norm() + 1e-9);
            }
        }
    }

    #[test]
    fn nothing_on_nearly_parallel_segments_is_nearer(
        a in point(), b in point(), c in point(), scale in -2.0..2.0, tilt in -1e-6..1e-6,
    ) {
        let (one, two) = ([a, b], [c, c + (b - a) * scale + Vec3::new(0.0, tilt, 0.0)]);
        let best = gap(&one, &two, between_segments(&one, &two));
        for i in 0..=20 {
            for j in 0..=20 {
                let other = gap(&one, &two, (f64::from(i) / 20.0, f64::from(j) / 20.0));
                prop_assert!(best <= other + 1e-7, "{best} {other}");
            }
        }
    }
}

#[test]
fn names_the_feature() {
    let t = [Vec3::zeros(), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    let feature = |x, y| on_triangle(&Vec3::new(x, y, 0.5), &t).feature;
    assert_eq!(feature(0.2, 0.2), Feature::Face);
    assert_eq!([feature(0.5, -1.0), feature(1.0, 1.0), feature(-1.0, 0.5)], [0, 1, 2].map(Feature::Side));
    assert_eq!([feature(-1.0, -1.0), feature(2.0, -0.5), feature(-0.5, 2.0)], [0, 1, 2].map(Feature::Corner));
}

#[test]
fn a_triangle_shrunk_to_a_point_or_a_line_still_answers() {
    let p = Vec3::new(0.5, 1.0, 0.0);
    let q = Vec3::new(0.25, 0.0, 0.0);
    assert_eq!(on_triangle(&p, &[q, q, q]).point, q);
    let line = [Vec3::zeros(), Vec3::new(0.3, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0)];
    assert_eq!(on_triangle(&p, &line).point, Vec3::new(0.5, 0.0, 0.0));
}

#[test]
fn segments_without_length_are_points() {
    let (a, b) = (Vec3::new(0.0, 1.0, 0.0), Vec3::new(2.0, 0.0, 0.0));
    assert_eq!(between_segments(&[a, a], &[Vec3::zeros(), b]), (0.0, 0.0));
    assert_eq!(gap(&[a, a], &[b, b], between_segments(&[a, a], &[b, b])), 5.0_f64.sqrt());
}
