#![allow(clippy::unwrap_used, clippy::expect_used)]
use super::{Method, Motion, MotionError, Moved, Until};
use crate::contact::body::Body;
use crate::rest::solve::{Rest, Wearer};
use crate::scene::{Phase, Scene, generate};
use nalgebra::Vector3;
use std::ops::ControlFlow;

const METHODS: [Method; 4] = [
    Method::CentralDifferences,
    Method::ImplicitEuler { tolerance: 1e-6, relative: None },
    Method::Xpbd { substeps: 4 },
    Method::Projective { iterations: 5 },
];

fn run(motion: &Motion, scene: &Scene) -> Result<Moved, MotionError> {
    let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
    let wearer = body.as_ref().map(|(skin, friction)| Wearer { skin, friction: *friction });
    motion.run(scene, wearer, &mut |_| ControlFlow::Continue(()))
}

fn falling(cells: u32) -> Scene {
    let gravity = Vector3::new(0.0, -9.81, 0.0);
    let phases = vec![Phase { name: "fall".into(), seconds: 0.5, gravity, air: None }];
    Scene { pinned: vec![], phases, ..generate::hang(cells) }
}

#[test]
fn every_solver_falls_as_galileo_says() {
    let scene = falling(3);
    for method in METHODS {
        let moved = run(&Motion { method, ..Motion::default() }, &scene).unwrap();
        let way = 0.5 * 9.81 * 0.25;
        for (p, s) in moved.positions.iter().zip(&scene.positions) {
            assert!((s.y - p.y - way).abs() < 1e-6, "{method:?}: {} m", s.y - p.y);
        }
    }
}

#[test]
fn a_skirt_is_sewn_and_comes_to_rest_near_where_rest_puts_it() {
    let scene = generate::tube(8, 10);
    let until = Until::Rest { speed: 0.02, energy: 1e-3, longest: 6.0 };
    let method = Method::ImplicitEuler { tolerance: 1e-3, relative: None };
    let moved = run(&Motion { method, until, drag: 4.0, ..Motion::default() }, &scene).unwrap();
    assert!(moved.converged, "{:?}", moved.progress);
    assert!(moved.joined_at.unwrap() < 5e-4);
    for [a, b] in scene.seams.iter().flat_map(|s| &s.pairs) {
        assert_eq!(moved.positions[*a as usize], moved.positions[*b as usize]);
    }
    let body = scene.body.as_ref().unwrap();
    let body = Body::new(body.vertices.clone(), &body.triangles);
    let inside = moved.positions.iter().filter_map(|p| body.nearest(p, 1.0)).filter(|n| n.distance < 0.0);
    assert_eq!(inside.count(), 0);
    let rest = Rest::default().solve(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
    let mean = |p: &[Vector3<f64>]| p.iter().map(|p| p.y).sum::<f64>() / p.len() as f64;
    let apart = mean(&moved.positions) - mean(&rest.positions);
    // It arrives with speed and slides further down than friction would let it from standstill.
    assert!((-0.06..0.01).contains(&apart), "{apart}");
}

#[test]
fn the_same_motion_has_the_same_bits_on_one_thread_and_on_four() {
    let scene = Scene { phases: falling(4).phases, ..generate::drape(8) };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&Motion::default(), &scene)).unwrap()
    };
    assert_eq!(on(1), on(4));
}

#[test]
fn cloth_thrown_at_a_ball_stays_outside_and_does_not_cross_itself() {
    let mut scene = generate::drape(12);
    let gravity = Vector3::new(0.0, -40.0, 0.0);
    scene.phases = vec![Phase { name: "fall".into(), seconds: 0.6, gravity, air: None }];
    let moved = run(&Motion { drag: 1.0, ..Motion::default() }, &scene).unwrap();
    let b = scene.body.as_ref().unwrap();
    let body = Body::new(b.vertices.clone(), &b.triangles);
    let deepest = moved.positions.iter().filter_map(|p| body.nearest(p, 1.0)).map(|n| n.distance);
    assert!(deepest.fold(f64::INFINITY, f64::min) > 0.0);
    let sheet = crate::mesh::Sheet::flat(&scene.rest, &scene.triangles, 0.15).unwrap();
    let tree = crate::contact::tree::ClothTree::new(&sheet, &scene.positions);
    assert_eq!(tree.crossings(&moved.positions).len(), 0);
}

#[test]
fn a_seam_that_cannot_close_is_named() {
    let mut scene = generate::tube(4, 5);
    scene.phases.truncate(1);
    scene.phases[0].seconds = 0.05;
    let error = run(&Motion::default(), &scene).unwrap_err();
    assert!(matches!(error, MotionError::SeamNotClosed { .. }), "{error}");
    let name = &scene.seams[0].name;
    let text = error.to_string();
    assert!(text.contains("stays open by") && text.contains("after 0.05 s"), "{text} {name}");
}

#[test]
fn two_fabrics_are_refused_by_the_panel() {
    let mut scene = generate::tube(4, 5);
    let mut other = scene.material.clone();
    other.density *= 2.0;
    scene.panels[1].material = Some(other);
    let error = run(&Motion::default(), &scene).unwrap_err();
    assert_eq!(
        error.to_string(),
        format!(
            "panel '{}' is of another fabric than the first; solvers in time take one, Rest takes any number",
            scene.panels[1].name
        )
    );
}
