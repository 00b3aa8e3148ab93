//! Cloth with bending hysteresis keeps a part of its folds.
#![allow(clippy::unwrap_used)]
use super::*;
use crate::fabric::Fabric;
use crate::solver::layout::{Layout, Rectangle};
use std::ops::ControlFlow;
use toile_geometry::Vec3;

/// Curvature that the strip is bent to, 1/m.
const BENT: f64 = 60.0;

/// Rigidity, N m.
const RIGIDITY: f64 = 1e-5;

/// A strip without weight, bent to an arc and clamped at one end, of a cloth with that couple over
/// its rigidity (1/m).
fn bent(layout: Layout, along: usize, ratio: f64) -> Scene {
    let strip = Rectangle::new(layout, 0.01, 0.04, along);
    let couple = ratio * RIGIDITY;
    let cloth = Fabric {
        bending_friction_warp: couple,
        bending_friction_weft: couple,
        ..Fabric::isotropic(0.1, 2000.0, 0.0, RIGIDITY)
    };
    let mut scene = Scene::new("bent", cloth);
    let around = |p: &nalgebra::Vector2<f64>| {
        let angle = BENT * p.y;
        Vec3::new(p.x, angle.sin() / BENT, (1.0 - angle.cos()) / BENT)
    };
    let positions: Vec<Vec3> = strip.uv.iter().map(around).collect();
    scene.add_panel("strip", &strip.uv, &positions, &strip.triangles);
    scene.pinned = (0..strip.uv.len()).filter(|&v| strip.uv[v].y < 0.006).map(|v| v as u32).collect();
    scene.phases.iter_mut().for_each(|p| p.gravity = Vec3::zeros());
    scene.self_collision = false;
    scene
}

/// The curvature that is left when the strip is released, by the turn between its ends' edges, 1/m.
fn left(layout: Layout, along: usize, ratio: f64) -> f64 {
    let scene = bent(layout, along, ratio);
    let settings = StaticEquilibrium { speed: 1e-5, ..StaticEquilibrium::default() };
    let state = settings.solve(&scene, &mut |_, _| ControlFlow::Continue(())).unwrap();
    let of_row = |low: f64, high: f64| {
        let row: Vec<usize> =
            (0..scene.rest.len()).filter(|&v| (low..=high).contains(&scene.rest[v].y)).collect();
        let mean = |x: &dyn Fn(usize) -> Vec3| row.iter().map(|&v| x(v)).sum::<Vec3>() / row.len() as f64;
        (mean(&|v| state.positions[v]), mean(&|v| Vec3::y() * scene.rest[v].y).y)
    };
    let turn = |a: (f64, f64), b: (f64, f64)| {
        let ((p, s), (q, t)) = (of_row(a.0, a.1), of_row(b.0, b.1));
        let way = q - p;
        (way.z.atan2(way.y), 0.5 * (s + t))
    };
    let (first, at) = turn((0.0099, 0.0141), (0.0139, 0.0181));
    let (last, to) = turn((0.0299, 0.0341), (0.0339, 0.0381));
    (last - first) / (to - at)
}

#[test]
fn a_bent_strip_springs_back_to_a_curvature_that_its_friction_holds() {
    for (layout, along) in [(Layout::Equilateral, 20), (Layout::Equilateral, 40), (Layout::Irregular(1), 40)]
    {
        let flat = left(layout, along, 0.0);
        assert!(flat.abs() < 0.5, "{layout:?} {along} {flat}");
        for ratio in [10.0, 20.0] {
            let kept = left(layout, along, ratio) / ratio;
            // Friction holds anything up to its couple; what turned last was dragged at half of it.
            assert!((0.35..=1.0).contains(&kept), "{layout:?} {along} {ratio} {kept}");
        }
    }
}

/// What friction holds stays when the garment is followed, for it goes on from the same angles.
#[test]
fn a_followed_strip_keeps_its_folds() {
    let scene = bent(Layout::Equilateral, 20, 20.0);
    let settings = StaticEquilibrium { speed: 1e-5, ..StaticEquilibrium::default() };
    let state = settings.solve(&scene, &mut |_, _| ControlFlow::Continue(())).unwrap();
    assert!(!state.folds.is_empty());
    let mut live = crate::statics::drive::live::Live::new(settings, scene.clone(), None, &state).unwrap();
    let again = live.settle(&mut |_, _| ControlFlow::Continue(())).unwrap();
    let moved = state.positions.iter().zip(&again.positions).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(moved < 1e-4, "{moved}");
}

/// What friction held when a garment came to rest holds it in another run, on a body and against
/// itself.
#[test]
fn what_friction_held_holds_again() {
    let mut scene = crate::scene::generate::tube(34, 12);
    scene.material.bending_friction_warp = 3e-4;
    scene.material.bending_friction_weft = 3e-4;
    let solve = |settings: StaticEquilibrium, scene: &Scene| {
        settings.solve(scene, &mut |_, _| ControlFlow::Continue(())).unwrap()
    };
    let first = solve(StaticEquilibrium::default(), &scene);
    scene.positions.clone_from(&first.positions);
    scene.held = first.held();
    let written = crate::scene::to_json(&scene, "body.obj");
    let obj = crate::scene::body_to_obj(&scene);
    let load = |_: &str| Ok(obj.clone().into_bytes());
    let read =
        crate::scene::parse(written.as_bytes(), &load, &crate::scene::Options::default()).unwrap().scene;
    assert_eq!(read.held, scene.held);
    let again = solve(StaticEquilibrium { from_here: true, ..StaticEquilibrium::default() }, &read);
    let apart = first.positions.iter().zip(&again.positions).map(|(a, b)| (a - b).norm());
    let farthest = apart.fold(0.0, f64::max);
    assert!(farthest < 5e-4, "{farthest}");
}

/// A garment that came to rest goes on from there: a skirt's folds are where they were, in a few
/// steps.
#[test]
fn from_here_a_garment_at_rest_stays_where_it_is() {
    let mut scene = crate::scene::generate::tube(34, 12);
    scene.material.bending_friction_warp = 3e-4;
    scene.material.bending_friction_weft = 3e-4;
    let mut steps = 0;
    let mut solve = |settings: StaticEquilibrium, scene: &Scene| {
        steps = 0;
        let state = settings.solve(scene, &mut |_, _| {
            steps += 1;
            ControlFlow::Continue(())
        });
        (state.unwrap(), steps)
    };
    let (first, many) = solve(StaticEquilibrium::default(), &scene);
    scene.positions.clone_from(&first.positions);
    let (again, few) = solve(StaticEquilibrium { from_here: true, ..StaticEquilibrium::default() }, &scene);
    assert_eq!(again.levels.len(), 1);
    let apart = first.positions.iter().zip(&again.positions).map(|(a, b)| (a - b).norm());
    let mean = apart.sum::<f64>() / first.positions.len() as f64;
    assert!(mean < 4e-3 && 2 * few < many, "{mean} {few} {many}");
}
