//! Cloth on cloth holds and slides by Coulomb's law.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::tests::*;
use super::*;
use crate::fabric::Fabric;
use crate::scene::{SceneBody, generate};
use crate::solver::layout::{Layout, Rectangle};
use nalgebra::Vector3;
use nalgebra::{Rotation3, Vector2};
use std::ops::ControlFlow;
use toile_geometry::Vec3;

fn tilted(tangent: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), tangent.atan())
}

/// Sheets on each other on a slope of that tangent, each with its friction; the lowest is larger
/// and lies on a rough plate.
fn stacked(layout: Layout, tangent: f64, frictions: &[f64]) -> Scene {
    let mut scene = Scene::new("stack", generate::cloth());
    for (k, friction) in frictions.iter().enumerate() {
        let size = if k == 0 { 0.3 } else { 0.15 };
        let mesh = Rectangle::new(layout, size, size, if k == 0 { 12 } else { 7 });
        let rest: Vec<Vector2<f64>> = mesh.uv.iter().map(|p| p - 0.5 * mesh.size).collect();
        let lift = 0.99e-3 * (k + 1) as f64;
        let x: Vec<Vec3> = rest.iter().map(|p| Vec3::new(p.x + 0.007, lift, 0.004 - p.y)).collect();
        let x: Vec<Vec3> = x.iter().map(|p| tilted(tangent) * p).collect();
        scene.add_panel(format!("sheet {k}"), &rest, &x, &mesh.triangles);
        scene.panels[k].material = Some(Fabric { friction: *friction, ..generate::cloth() });
    }
    scene.body = Some(SceneBody { friction: 1.5, ..plate(tangent.atan(), 1.0) });
    scene.self_collision = true;
    scene
}

/// How far the sheet `k` ends from its start, at most, m; whether all came to rest.
fn slid(scene: &Scene, k: usize) -> (f64, bool) {
    // A sheet 2 % above its angle gains but 0.6 mm/s in the step that proves rest.
    let settings = StaticEquilibrium { speed: 1e-4, ..StaticEquilibrium::default() };
    let (state, rests) = match settings.solve(scene, &mut |_, _| ControlFlow::Continue(())) {
        Ok(state) => (state, true),
        Err(StaticsError::NotAtRest { state, .. }) => (*state, false),
        Err(StaticsError::FallsPast(_)) => return (f64::INFINITY, false),
        Err(error) => panic!("{error}"),
    };
    let range = scene.panels[k].vertices.clone();
    let way = |v: usize| (state.positions[v] - scene.positions[v]).norm();
    (range.map(way).fold(0.0, f64::max), rests)
}

#[test]
fn a_sheet_on_a_sheet_sticks_below_its_angle_and_slips_above() {
    for layout in [Layout::Irregular(3), Layout::OneDiagonal] {
        for share in [0.5, 0.9, 0.98] {
            let (way, rests) = slid(&stacked(layout, 0.3 * share, &[0.3, 0.3]), 1);
            assert!(rests && way < 2e-3, "{layout:?} {share}: {way} {rests}");
        }
        for share in [1.02, 1.2] {
            let (way, rests) = slid(&stacked(layout, 0.3 * share, &[0.3, 0.3]), 1);
            assert!(!rests && way > 0.04, "{layout:?} {share}: {way} {rests}");
        }
    }
}

#[test]
fn in_a_stack_the_smooth_sheet_slides_off_the_others() {
    // The mean of two frictions counts: 0.4 below, 0.25 on top.
    let scene = stacked(Layout::Irregular(3), 0.3, &[0.4, 0.4, 0.1]);
    let ((middle, _), (top, rests)) = (slid(&scene, 1), slid(&scene, 2));
    assert!(middle < 2e-3 && top > 0.04 && !rests, "{middle} {top} {rests}");
    let (top, rests) = slid(&stacked(Layout::Irregular(3), 0.24, &[0.4, 0.4, 0.1]), 2);
    assert!(top < 2e-3 && rests, "{top} {rests}");
}

#[test]
fn without_friction_a_sheet_slides_down_the_least_slope() {
    let (way, rests) = slid(&stacked(Layout::Irregular(3), 0.02, &[0.0, 0.0]), 1);
    assert!(way > 0.04, "{way} {rests}");
}

#[test]
fn a_stack_that_holds_has_the_same_bits_on_any_number_of_threads() {
    let scene = stacked(Layout::Irregular(3), 0.2, &[0.4, 0.4, 0.4]);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| roughly(&scene).positions)
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn a_garment_that_goes_on_remembers_what_holds_it() {
    use crate::statics::drive::live::Live;
    let scene = stacked(Layout::Irregular(3), 0.27, &[0.3, 0.3]);
    let b = scene.body.as_ref().unwrap();
    let body = Body::new(b.vertices.clone(), &b.triangles);
    let collider = Collider { surface: &body, friction: b.friction };
    let settings = StaticEquilibrium { speed: 1e-4, ..StaticEquilibrium::default() };
    let state = settings.solve(&scene, &mut |_, _| ControlFlow::Continue(())).unwrap();
    let moved = |state: &Equilibrium| {
        let mut live = Live::new(settings, scene.clone(), Some(collider), state).unwrap();
        let next = live.settle(&mut |_, _| ControlFlow::Continue(())).unwrap();
        let ways = next.positions.iter().zip(&state.positions).map(|(a, b)| (a - b).norm());
        ways.fold(0.0, f64::max)
    };
    let continuation_options = Equilibrium { friction_contacts: vec![], ..state.clone() };
    let (kept, lost) = (moved(&state), moved(&continuation_options));
    assert!(kept < 2e-5 && lost > 1e-4, "{kept} {lost}");
}

#[test]
fn edges_that_end_on_each_other_come_to_rest() {
    // Both sheets' rows run the same way and some corners lie exactly over others: with every
    // rounding edges meet there or do not.
    for k in 0..24 {
        let share = 0.5 + 0.02 * f64::from(k);
        let (way, rests) = slid(&stacked(Layout::OneDiagonal, 0.3 * share, &[0.3, 0.3]), 1);
        assert!(rests && way < 2e-3, "{share}: {way} {rests}");
    }
}
