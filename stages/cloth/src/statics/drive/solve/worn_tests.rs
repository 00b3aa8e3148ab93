//! Garments on bodies: what is sewn around a limb stays outside it everywhere.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::tests::*;
use super::*;
use crate::contact::body::Body;
use crate::scene::generate;
use toile_geometry::Vec3;

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

/// The least height of the outer layer over the inner one, where a vertex of one lies within 2 cm
/// of a triangle of the other, m.
fn least_height(scene: &Scene, x: &[Vec3]) -> f64 {
    let inner = scene.panels[2].triangles.start;
    let outer = scene.panels[2].vertices.start;
    let body = Body::new(x[..outer].to_vec(), &scene.triangles[..inner]);
    let height = |p: &Vec3| {
        let n = body.nearest(p, 0.02)?;
        // Beyond the border of the inner layer nothing is over or under it.
        let away = p - n.point;
        (away.norm() > 0.0 && away.normalize().dot(&face(scene, x, inner, &n.point)).abs() > 0.9)
            .then_some(n.distance)
    };
    x[outer..].iter().filter_map(height).fold(f64::INFINITY, f64::min)
}

/// Normal of the triangle of the first `count` that lies nearest to a point.
fn face(scene: &Scene, x: &[Vec3], count: usize, p: &Vec3) -> Vec3 {
    let on = |t: &[u32; 3]| {
        let c = t.map(|v| x[v as usize]);
        (
            (toile_geometry::closest::on_triangle(p, &c).point - p).norm(),
            (c[1] - c[0]).cross(&(c[2] - c[0])).normalize(),
        )
    };
    let all = scene.triangles[..count].iter().map(on);
    all.min_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(Vec3::zeros, |found| found.1)
}

#[test]
fn a_skirt_over_a_skirt_stays_over_it() {
    let scene = generate::layered(12, 14);
    let state = roughly(&scene);
    let x = &state.positions;
    picture(&scene, x, "layered");
    assert_eq!(crossings(&scene, x), 0);
    assert!(least_height(&scene, x) > 0.0, "{}", least_height(&scene, x));
    assert!(deepest_anywhere(&scene, x) < 1e-4, "{}", deepest_anywhere(&scene, x));
}

#[test]
fn layers_that_start_through_each_other_are_put_in_order() {
    let mut scene = generate::layered(12, 14);
    // The middle of the outer skirt's front begins 2 cm behind the inner one.
    let front = scene.panels[2].vertices.clone();
    for p in &mut scene.positions[front] {
        p.z -= 0.05 + 0.04 * (-(p.x * p.x + (p.y - 0.8) * (p.y - 0.8)) / 0.01).exp();
    }
    let mut one = scene.clone();
    one.panels.iter_mut().for_each(|p| p.layer = 0);
    assert!(matches!(settle(&one), Err(StaticsError::Start(StartError::Crossing { .. }))));
    let state = roughly(&scene);
    assert_eq!(crossings(&scene, &state.positions), 0);
    assert!(least_height(&scene, &state.positions) > 0.0, "{}", least_height(&scene, &state.positions));
}
