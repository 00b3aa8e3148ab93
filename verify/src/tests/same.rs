//! What must not change a figure: a rigid motion, the number of threads.

use super::*;
use crate::{Certificate, InputFile};
use nalgebra::{Isometry3, Vector3};
use proptest::prelude::*;

/// The skirt with a vertex in the body and one seam open, so that figures are not all zero.
fn damaged() -> Skirt {
    let mut skirt = Skirt::new(24, 12);
    let (inside, open) = (skirt.at(0, 12, 6), skirt.at(0, 24, 3));
    skirt.meshes.positions[inside].z *= 0.5;
    skirt.meshes.positions[open].x += 1e-3;
    skirt
}

/// The figures with a body that is moved along.
fn figures(skirt: &Skirt, to: &Isometry3<f64>) -> Vec<(&'static str, Option<f64>)> {
    let mut moved = skirt.clone();
    moved.meshes.positions.iter_mut().for_each(|p| *p = to * *p);
    let body = post().body;
    let places: Vec<Point3> = body.positions.iter().map(|p| to * p).collect();
    let body = wearer(&places, &body.triangles);
    let pattern = pattern(24);
    let found = judge(&moved.subject(Some(&pattern), Ok(body)), &CheckLimits::default());
    found.checks.iter().map(|c| (c.name, c.value)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn a_garment_that_is_moved_rigidly_has_the_same_figures(
        turn in prop::array::uniform3(-3.0..3.0f64), way in prop::array::uniform3(-5.0..5.0f64),
    ) {
        let to = Isometry3::new(Vector3::from(way), Vector3::from(turn));
        let skirt = damaged();
        for (one, other) in figures(&skirt, &Isometry3::identity()).iter().zip(figures(&skirt, &to)) {
            prop_assert_eq!(one.0, other.0);
            let (a, b) = (one.1.unwrap_or(-1.0), other.1.unwrap_or(-1.0));
            prop_assert!((a - b).abs() <= 1e-9, "{}: {} and {}", one.0, a, b);
        }
    }
}

#[test]
fn the_certificate_does_not_depend_on_the_number_of_threads() {
    let skirt = damaged();
    let text = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let certificate = || {
            let inputs = vec![InputFile::of("garment", "skirt.glb", b"skirt")];
            Certificate::new(inputs, skirt.judged(), None, Vec::new())
        };
        pool.install(|| serde_json::to_string(&certificate()).unwrap())
    };
    let one = text(1);
    assert!(one.contains("\"verdict\":\"fails\""), "{one}");
    assert_eq!(text(3), one);
}
