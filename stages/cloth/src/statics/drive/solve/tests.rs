#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::*;
use crate::fabric::Fabric;
use crate::scene::Seam;
use crate::scene::{Phase, SceneBody, generate};
use crate::statics::levels::assemble::cloths;
use crate::statics::levels::pieces::Pieces;
use nalgebra::Vector3;
use std::ops::ControlFlow;
use std::time::Duration;
use toile_geometry::Vec3;
use toile_geometry::cloth_tree::ClothTree;

pub(super) fn settle(scene: &Scene) -> Result<Equilibrium, StaticsError> {
    StaticEquilibrium::default().solve(scene, &mut |_, _| ControlFlow::Continue(()))
}

/// The same, where a state that still moves a little is good enough.
pub(super) fn roughly(scene: &Scene) -> Equilibrium {
    match settle(scene) {
        Ok(state) => state,
        Err(StaticsError::NotAtRest { state, .. }) => *state,
        Err(error) => panic!("{error}"),
    }
}

/// Strain of every edge, sorted by size.
pub(super) fn strains(scene: &Scene, x: &[Vec3]) -> Vec<f64> {
    let sides = scene.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let strain = |[a, b]: [u32; 2]| {
        let (a, b) = (a as usize, b as usize);
        ((x[a] - x[b]).norm() / (scene.rest[a] - scene.rest[b]).norm() - 1.0).abs()
    };
    let mut all: Vec<f64> = sides.map(strain).collect();
    all.sort_by(f64::total_cmp);
    all
}

pub(super) fn deepest(scene: &Scene, x: &[Vec3]) -> f64 {
    let b = scene.body.as_ref().unwrap();
    let body = Body::new(b.vertices.clone(), &b.triangles);
    x.iter().filter_map(|p| body.nearest(p, 1.0)).map(|n| -n.distance).fold(f64::NEG_INFINITY, f64::max)
}

pub(super) fn crossings(scene: &Scene, x: &[Vec3]) -> usize {
    let pieces = Pieces::new(scene);
    let sheet = pieces.sewn_sheet(&cloths(scene)).unwrap();
    let nodes = pieces.sew(x, &vec![1.0; x.len()]);
    ClothTree::new(sheet.triangles(), &nodes).crossings(&nodes).len()
}

/// Writes the state to `TOILE_PICTURES`/name.obj where that is set, to be looked at.
pub(super) fn picture(scene: &Scene, x: &[Vec3], name: &str) {
    let Ok(folder) = std::env::var("TOILE_PICTURES") else { return };
    let mut all = x.to_vec();
    let mut triangles = scene.triangles.clone();
    if let Some(b) = &scene.body {
        triangles.extend(b.triangles.iter().map(|t| t.map(|v| v + x.len() as u32)));
        all.extend(&b.vertices);
    }
    toile_geometry::obj::write(&std::path::Path::new(&folder).join(format!("{name}.obj")), &all, &triangles)
        .unwrap();
}

#[test]
fn a_skirt_is_sewn_and_comes_to_rest_from_ten_starts() {
    for seed in 0..10 {
        let mut scene = generate::tube(22, 25);
        if seed > 0 {
            generate::jitter(&mut scene, 1e-3, seed);
        }
        let state = settle(&scene).unwrap();
        let x = &state.positions;
        let gap =
            scene.seams.iter().flat_map(|s| &s.pairs).map(|p| (x[p[0] as usize] - x[p[1] as usize]).norm());
        assert_eq!(gap.fold(0.0, f64::max), 0.0);
        assert!(state.joined_at.unwrap() < 5e-4);
        let strain = strains(&scene, x);
        let (p99, most) = (strain[strain.len() * 99 / 100], strain[strain.len() - 1]);
        assert!(p99 < 0.015 && most < 0.02, "{seed}: {p99} {most}");
        assert!(deepest(&scene, x) < 1e-4, "{seed}: {}", deepest(&scene, x));
        assert_eq!(crossings(&scene, x), 0, "{seed}");
        assert!(state.outcome.speed < 1e-3);
    }
}

#[test]
fn a_fall_onto_a_sphere_and_itself_crosses_nothing() {
    let scene = generate::drape(20);
    let state = roughly(&scene);
    assert_eq!(crossings(&scene, &state.positions), 0);
    assert!(deepest(&scene, &state.positions) < 1e-4);
    assert!(state.positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min) < -0.1);
}

#[test]
#[ignore = "slow: .ci/wide"]
fn cloth_falls_onto_cloth_and_stays_above_it() {
    // A sheet held at one edge folds down over a box edge onto itself: three layers in the end.
    let mut scene = generate::drape(16);
    scene.body = Some(plate(0.0, 0.3));
    scene.positions.iter_mut().for_each(|p| {
        // Rolled up before it drops.
        let (turn, r) = ((p.x + 0.5) * 9.0, 0.1 - 0.06 * (p.x + 0.5));
        *p = Vector3::new(r * turn.sin(), 0.25 - r * turn.cos(), p.z);
    });
    let state = roughly(&scene);
    assert_eq!(crossings(&scene, &state.positions), 0);
    assert!(deepest(&scene, &state.positions) < 1e-4);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let scene = generate::tube(8, 9);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| roughly(&scene).positions)
    };
    assert_eq!(with(1), with(3));
}

/// A plate in the x-z plane whose top passes through the origin, turned by `slope` about z, half as
/// wide as `half`.
pub(super) fn plate(slope: f64, half: f64) -> SceneBody {
    let corner = |k: usize| {
        let sign = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let p = Vector3::new(sign(0) * half, sign(1).min(0.0) * 0.1, sign(2) * half);
        nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), slope) * p
    };
    let triangles = vec![
        [0, 4, 6],
        [0, 6, 2],
        [1, 3, 7],
        [1, 7, 5],
        [0, 1, 5],
        [0, 5, 4],
        [2, 6, 7],
        [2, 7, 3],
        [0, 2, 3],
        [0, 3, 1],
        [4, 5, 7],
        [4, 7, 6],
    ];
    SceneBody { vertices: (0..8).map(corner).collect(), triangles, friction: 0.4 }
}

/// A patch of cloth on a slope of the given tangent.
fn on_slope(tangent: f64) -> Scene {
    let slope = tangent.atan();
    let mut scene = generate::drape(6);
    scene.self_collision = false;
    scene.rest.iter_mut().for_each(|p| *p *= 0.2);
    let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), slope);
    let place = |p: &nalgebra::Vector2<f64>| turn * Vector3::new(p.x, 1e-3, -p.y);
    scene.positions = scene.rest.iter().map(place).collect();
    scene.body = Some(plate(slope, 1.0));
    scene
}

#[test]
fn friction_sticks_below_its_angle_and_slips_above() {
    let slid = |state: &Equilibrium, scene: &Scene| {
        state.positions.iter().zip(&scene.positions).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
    };
    for share in [0.5, 0.9, 0.97] {
        let scene = on_slope(0.4 * share);
        let state = settle(&scene).unwrap();
        assert!(slid(&state, &scene) < 1e-3, "{share}: {}", slid(&state, &scene));
    }
    for share in [1.03, 1.2] {
        let scene = on_slope(0.4 * share);
        match settle(&scene) {
            Err(StaticsError::NotAtRest { state, .. }) => assert!(slid(&state, &scene) > 1e-3),
            Err(StaticsError::FallsPast(_)) => {}
            other => panic!("{share}: {other:?}"),
        }
    }
}

#[test]
fn what_has_no_rest_is_named() {
    let falls = settle(&Scene { body: None, ..generate::drape(5) }).unwrap_err();
    let text =
        "nothing holds the cloth: it has weight, but no pin and no body under it; it has no state of rest";
    assert_eq!(falls.to_string(), text);
    let mut beside = generate::drape(5);
    beside.positions.iter_mut().for_each(|p| p.x += 3.0);
    assert_eq!(
        settle(&beside).unwrap_err().to_string(),
        "the cloth of 'square' falls past the body: its middle starts 3.000 m beside the body's; move it by (-3.00, 0.00, 0.00) m, \
         around or above the body, which is 0.60 m tall, and see that both are in the same unit of length"
    );
}

#[test]
fn without_weight_nothing_moves() {
    let mut scene = generate::hang(9);
    scene.phases = vec![Phase { name: "none".into(), seconds: 1.0, gravity: Vec3::zeros(), air: None }];
    let state = settle(&scene).unwrap();
    let moved = state.positions.iter().zip(&scene.positions).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(moved < 1e-9, "{moved}");
}

#[test]
fn panels_inside_the_body_are_refused_or_moved_out() {
    let mut scene = generate::tube(8, 9);
    scene.positions.iter_mut().for_each(|p| p.z *= 0.2);
    let error = settle(&scene).unwrap_err();
    assert!(
        matches!(&error, StaticsError::Start(StartError::InBody { vertices, depth, panel, .. }) if *vertices > 20 && *depth > 0.05 && panel == "panel 'back'"),
        "{error}"
    );
    let mut scene = generate::drape(12);
    scene.positions.iter_mut().for_each(|p| p.y = 0.29);
    let state = roughly(&scene);
    assert!(deepest(&scene, &state.positions) < 1e-4);
}

#[test]
fn a_seam_that_cannot_close_is_named() {
    let mut scene = generate::tube(8, 9);
    // Panels too narrow to meet around the body.
    scene.rest.iter_mut().for_each(|p| p.x *= 0.3);
    scene.positions.iter_mut().for_each(|p| p.x *= 0.3);
    match settle(&scene).unwrap_err() {
        StaticsError::SeamNotClosed { seam, gap, .. } => assert!(seam.starts_with("side") && gap > 5e-4),
        error => panic!("{error}"),
    }
}

#[test]
fn where_the_caller_has_another_way_a_seam_that_stays_open_is_not_tried_on_ever_finer_meshes() {
    let mut scene = generate::tube(16, 17);
    scene.rest.iter_mut().for_each(|p| p.x *= 0.7);
    scene.positions.iter_mut().for_each(|p| p.x *= 0.7);
    let meshes = |gives_way: bool| {
        let mut sewn_on: Vec<usize> = Vec::new();
        let solver = StaticEquilibrium { gives_way, sew_through: true, coarsest: 60, ..Default::default() };
        let result = solver.solve(&scene, &mut |level, _| {
            if level.sewing && sewn_on.last() != Some(&level.nodes) {
                sewn_on.push(level.nodes);
            }
            ControlFlow::Continue(())
        });
        assert!(matches!(result, Err(StaticsError::SeamNotClosed { .. })));
        sewn_on.len()
    };
    assert_eq!((meshes(false), meshes(true)), (3, 2));
}

#[test]
fn crossing_panels_are_refused() {
    let mut scene = generate::tube(8, 9);
    let half = scene.positions.len() / 2;
    let front: Vec<Vec3> = scene.positions[..half].to_vec();
    for (p, q) in scene.positions[half..].iter_mut().zip(front) {
        *p = Vec3::new(q.x + 0.011, q.y + 0.007, q.z + 0.3 * (q.x + 0.011));
    }
    let error = settle(&scene).unwrap_err();
    let StaticsError::Start(StartError::Crossing { panels, pairs, more, .. }) = &error else {
        panic!("{error}")
    };
    assert_eq!((&panels[..], *more), (&["panel 'front'".to_owned(), "panel 'back'".to_owned()][..], 0));
    assert!(*pairs > 0);
}

#[test]
fn a_caller_can_stop_and_time_can_run_out() {
    let scene = generate::hang(9);
    let stopped = StaticEquilibrium::default().solve(&scene, &mut |_, _| ControlFlow::Break(()));
    assert_eq!(stopped.unwrap_err(), StaticsError::Stopped);
    let hurried = StaticEquilibrium { budget: Duration::ZERO, ..StaticEquilibrium::default() }
        .solve(&scene, &mut |_, _| ControlFlow::Continue(()));
    match hurried.unwrap_err() {
        StaticsError::Timeout { positions, .. } => assert_eq!(positions.len(), scene.rest.len()),
        error => panic!("{error}"),
    }
}

/// A strip of two panels that hangs from its upper edge: 0.2 m wide, each panel 0.4 m long.
fn two_panel_strip(lower: Option<Fabric>, joined: bool) -> (Scene, f64) {
    let part = generate::hang(8);
    let rest: Vec<_> = part.rest.iter().map(|p| nalgebra::Vector2::new(0.2 * p.x, 0.4 * p.y)).collect();
    let place = |y: f64| rest.iter().map(|p| Vec3::new(p.x, p.y + y, 0.0)).collect::<Vec<_>>();
    let mut scene = Scene::new("strip", generate::cloth());
    let top = scene.add_panel("top", &rest, &place(0.0), &part.triangles);
    let bottom = scene.add_panel("bottom", &rest, &place(-0.401), &part.triangles);
    scene.panels[1].material = lower;
    let pairs = (0..9).map(|k| [top.start + k, bottom.start + 72 + k]).collect();
    scene.seams = vec![Seam { joined, ..Seam::new("waist", pairs) }];
    scene.pinned = (72..81).collect();
    scene.self_collision = false;
    let state = settle(&scene).unwrap();
    (scene, state.positions[bottom.start as usize + 4].y)
}

#[test]
fn each_panel_stretches_as_its_own_fabric_does() {
    let heavy = Fabric { density: 0.6, warp: crate::fabric::Curve::linear(100.0), ..generate::cloth() };
    let ends = [None, Some(heavy)].map(|m| two_panel_strip(m, true).1);
    // Weight a metre of width over stiffness: the upper panel carries both, the lower one on
    // average half of itself.
    let long = |lower: f64, k: f64| {
        let (g, l) = (9.81, 0.4);
        let top = l * (0.5 * 0.15 * l + lower * l) * g / 500.0;
        let bottom = l * 0.5 * lower * l * g / k;
        -0.2 - l - top - bottom
    };
    for (end, want) in ends.iter().zip([long(0.15, 500.0), long(0.6, 100.0)]) {
        assert!((end - want).abs() < 3e-4, "{end} {want}");
    }
}

#[test]
fn a_seam_that_is_not_joined_stays_two_rows_without_a_gap() {
    let (scene, end) = two_panel_strip(None, false);
    let state = settle(&scene).unwrap();
    let x = &state.positions;
    let gaps: Vec<f64> =
        scene.seams[0].pairs.iter().map(|p| (x[p[0] as usize] - x[p[1] as usize]).norm()).collect();
    assert!(gaps.iter().all(|g| (1e-6..5e-4).contains(g)), "{gaps:?}");
    assert!((end - two_panel_strip(None, true).1).abs() < 6e-4);
}

#[test]
fn sheets_too_coarse_for_the_ball_to_catch_are_tried_finer() {
    // Fifty sheets share the coarsest mesh: four vertices each fall past the ball on all sides.
    let mut scene = generate::drape(8);
    scene.rest.iter_mut().for_each(|p| *p *= 0.5);
    let (rest, triangles) = (scene.rest.clone(), scene.triangles.clone());
    let level = |k: usize| -> Vec<Vec3> {
        rest.iter().map(|p| Vec3::new(p.x, 0.31 + 0.004 * k as f64, -p.y)).collect()
    };
    scene.positions = level(0);
    for k in 1..50 {
        scene.add_panel(format!("layer {k}"), &rest, &level(k), &triangles);
    }
    let finer =
        |l: &LevelReport| if l.nodes > 200 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let error = StaticEquilibrium::default().solve(&scene, &mut |l, _| finer(l)).unwrap_err();
    assert_eq!(error, StaticsError::Stopped);
}
