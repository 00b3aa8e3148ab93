//! Garments on bodies: what is sewn around a limb stays outside it everywhere.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::tests::*;
use super::*;
use crate::contact::body::Body;
use crate::scene::generate;

/// Depth of the deepest of many points of each triangle, m; negative where all are outside.
fn deepest_anywhere(scene: &Scene, x: &[Vec3]) -> f64 {
    let b = scene.body.as_ref().unwrap();
    let body = Body::new(b.vertices.clone(), &b.triangles);
    let mut deepest = f64::NEG_INFINITY;
    for t in &scene.triangles {
        let [a, b, c] = t.map(|v| x[v as usize]);
        for i in 0..=12 {
            for j in 0..=12 - i {
                let (s, t) = (f64::from(i) / 12.0, f64::from(j) / 12.0);
                let near = body.nearest(&(a * (1.0 - s - t) + b * s + c * t), 0.05);
                deepest = deepest.max(near.map_or(f64::NEG_INFINITY, |n| -n.distance));
            }
        }
    }
    deepest
}

#[test]
fn a_sleeve_is_sewn_around_an_arm_and_dips_into_it_nowhere() {
    for (nx, ny) in [(8, 16), (14, 30)] {
        let scene = generate::sleeve(nx, ny);
        let state = settle(&scene).unwrap();
        let x = &state.positions;
        assert!(deepest_anywhere(&scene, x) < 0.0, "{}", deepest_anywhere(&scene, x));
        assert_eq!(state.dip, 0.0);
        assert!(strains(&scene, x).iter().all(|s| *s < 0.02));
        assert_eq!(crossings(&scene, x), 0);
        picture(&scene, x, &format!("sleeve_{nx}"));
    }
}
