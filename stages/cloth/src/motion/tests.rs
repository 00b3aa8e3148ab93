#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::{Method, Motion, MotionError, Moved, PenaltyForce, Response, SeamClosing, Through, Until};
use crate::contact::body::Body;
use crate::energy::Air;
use crate::scene::{Phase, Scene, generate};
use crate::statics::drive::solve::{Collider, StaticEquilibrium};
use crate::stopper::Stopper;
use nalgebra::Vector3;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const METHODS: [Method; 4] = [
    Method::CentralDifferences { least: 0.0 },
    Method::ImplicitEuler { tolerance: 1e-6, relative: None },
    Method::Xpbd { substeps: 4 },
    Method::Projective { iterations: 5 },
];

fn run(motion: &Motion, scene: &Scene) -> Result<Moved, MotionError> {
    let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
    let collider = body.as_ref().map(|(surface, friction)| Collider { surface, friction: *friction });
    motion.run(scene, collider, &mut |_, _| ControlFlow::Continue(()))
}

fn falling(cells: u32) -> Scene {
    let gravity = Vector3::new(0.0, -9.81, 0.0);
    let phases = vec![Phase { name: "fall".into(), seconds: 0.5, gravity, air: None }];
    Scene { pinned: vec![], phases, ..generate::hang(cells) }
}

#[test]
fn in_every_solver_a_curtain_hangs_from_pins_that_belong_to_no_triangle() {
    let scene = generate::curtain(4);
    let still =
        Scene { phases: scene.phases.iter().map(|p| Phase { seconds: 0.3, ..p.clone() }).collect(), ..scene };
    for method in METHODS {
        let moved = run(&Motion { method, ..Motion::default() }, &still).unwrap();
        for &[corner, pin] in &still.seams[0].pairs {
            let place = still.positions[pin as usize];
            assert_eq!(moved.positions[pin as usize], place, "{method:?}");
            assert_eq!(moved.positions[corner as usize], place, "{method:?}");
        }
    }
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
    let rest = StaticEquilibrium::default().solve(&scene, &mut |_, _| ControlFlow::Continue(())).unwrap();
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
    let tree = toile_geometry::cloth_tree::ClothTree::new(sheet.triangles(), &scene.positions);
    assert_eq!(tree.crossings(&moved.positions).len(), 0);
}

#[test]
fn a_seam_that_cannot_close_is_named() {
    let mut scene = generate::tube(4, 5);
    scene.phases.truncate(1);
    let error =
        run(&Motion { until: Until::Phases { longest: 0.05 }, ..Motion::default() }, &scene).unwrap_err();
    assert!(matches!(error, MotionError::SeamNotClosed { .. }), "{error}");
    let name = &scene.seams[0].name;
    let text = error.to_string();
    assert!(text.contains("stays open by") && text.contains("after 0.05 s"), "{text} {name}");
}

/// Two fabrics, the second twice as heavy.
fn two_fabrics() -> Scene {
    let mut scene = generate::tube(4, 5);
    let mut other = scene.material.clone();
    other.density *= 2.0;
    scene.panels[1].material = Some(other);
    scene
}

#[test]
fn two_fabrics_are_refused_by_the_panel_where_the_solver_takes_one() {
    let scene = two_fabrics();
    let method = Method::Xpbd { substeps: 4 };
    let error = run(&Motion { method, ..Motion::default() }, &scene).unwrap_err();
    assert_eq!(
        error.to_string(),
        format!(
            "panel '{}' is of another fabric than the first; Xpbd and Projective take one, all others any number",
            scene.panels[1].name
        )
    );
}

#[test]
fn panels_of_two_fabrics_are_sewn_and_come_to_rest() {
    let until = Until::Rest { speed: 0.02, energy: 1e-3, longest: 6.0 };
    let method = Method::ImplicitEuler { tolerance: 1e-3, relative: None };
    let moved = run(&Motion { method, until, drag: 4.0, ..Motion::default() }, &two_fabrics()).unwrap();
    assert!(moved.converged, "{:?}", moved.progress);
}

#[test]
fn a_sewn_motion_ends_when_the_seams_are_joined() {
    let motion = Motion { until: Until::Sewn { longest: 3.0 }, ..Motion::default() };
    let moved = run(&motion, &generate::tube(4, 5)).unwrap();
    assert!(moved.converged && moved.joined_at.unwrap() < 5e-4);
}

/// The height of a small sheet released 0.2 m above a floor of a great box, at its highest after it
/// has met it.
fn bounce(response: Response) -> f64 {
    let mut scene = falling(2);
    // Flat, so that all of it meets the floor at once.
    scene.positions = scene.rest.iter().map(|p| Vector3::new(p.x, 0.2, p.y)).collect();
    scene.phases[0].seconds = 0.2 + 0.15;
    let (floor, sides) = floor();
    let surface = Body::new(floor, &sides);
    let motion = Motion { response, dt: 1e-3, ..Motion::default() };
    let moved = motion
        .run(&scene, Some(Collider { surface: &surface, friction: 0.0 }), &mut |_, _| {
            ControlFlow::Continue(())
        })
        .unwrap();
    moved.positions.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max)
}

/// A box of 8 m whose top is the plane y = 0.
fn floor() -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let corner = |i: u32| {
        let side = |bit: u32| if i & bit == 0 { -4.0 } else { 4.0 };
        Vector3::new(side(1), side(2) - 4.0, side(4))
    };
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let sides = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
    ((0..8).map(corner).collect(), sides.collect())
}

#[test]
fn restitution_gives_back_its_share_of_the_speed() {
    let offset = falling(2).material.thickness;
    let meets = (2.0 * (0.2 - offset) / 9.81f64).sqrt();
    let speed = 9.81 * meets;
    let left = 0.35 - meets;
    for e in [0.5, 1.0] {
        let height = bounce(Response { restitution: e, penalty: None });
        let exact = offset + e * speed * left - 0.5 * 9.81 * left * left;
        assert!((height - exact).abs() < 0.01, "{e}: {height} m, by the formula {exact} m");
    }
    assert!((bounce(Response::default()) - offset).abs() < 1e-4);
}

#[test]
fn a_penalty_lets_cloth_sink_by_its_weight_over_the_stiffness() {
    // With the greatest stiffness that the steps allow, the floor yields by no more than the
    // cloth's thickness.
    let offset = falling(2).material.thickness;
    let soft = bounce(Response { restitution: 0.0, penalty: Some(PenaltyForce::Linear(1e9)) });
    assert!(soft > -0.5 * offset && soft < 0.2, "{soft}");
    assert_ne!(soft, bounce(Response::default()));
}

#[test]
fn an_exponential_penalty_carries_the_weight_of_the_cloth() {
    let mut scene = falling(2);
    let offset = scene.material.thickness;
    scene.positions = scene.rest.iter().map(|p| Vector3::new(p.x, 2.0 * offset, p.y)).collect();
    scene.phases[0].seconds = 2.0;
    let (floor, sides) = floor();
    let surface = Body::new(floor, &sides);
    let weight = 9.81 * scene.material.density;
    // So strong that no node comes to half of the contact distance, where it is held.
    for share in [10.0f64, 40.0] {
        let at_the_body = share * weight / scene.positions.len() as f64;
        let response = Response { restitution: 0.0, penalty: Some(PenaltyForce::Exponential(at_the_body)) };
        let motion = Motion { response, dt: 1e-3, drag: 10.0, ..Motion::default() };
        let moved = motion
            .run(&scene, Some(Collider { surface: &surface, friction: 0.0 }), &mut |_, _| {
                ControlFlow::Continue(())
            })
            .unwrap();
        let carried: f64 = moved.positions.iter().map(|p| at_the_body * (-p.y / offset).exp()).sum();
        assert!((carried - weight).abs() < 0.02 * weight, "{share}: {carried} N of {weight} N");
    }
}

/// A square metre of 0.1 kg/m2 hung by its upper edge, in this air.
fn flag(cells: u32, air: Option<Air>) -> Scene {
    let mut scene = generate::hang(cells);
    scene.positions = scene.rest.iter().map(|p| Vector3::new(p.x, p.y, 0.0)).collect();
    let top = scene.positions.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
    scene.pinned =
        (0..scene.positions.len() as u32).filter(|&v| scene.positions[v as usize].y > top - 1e-9).collect();
    scene.phases.iter_mut().for_each(|p| p.air = air);
    scene.self_collision = false;
    scene
}

#[test]
fn wind_blows_in_the_phases_that_have_it() {
    let wind = Vector3::new(0.0, 0.0, 5.0);
    let mut scene = Scene { pinned: vec![], ..flag(3, None) };
    let phase = |seconds, air| Phase { name: "p".into(), seconds, gravity: Vector3::zeros(), air };
    let air = Air { wind, ..Air::still(1.2) };
    scene.phases = vec![phase(0.1, None), phase(0.2, Some(air)), phase(0.1, None)];
    let k = 0.5 * air.density * air.normal / scene.material.density;
    let exact = 5.0 - 5.0 / (1.0 + k * 5.0 * 0.2);
    for method in METHODS {
        let moved = run(&Motion { method, ..Motion::default() }, &scene).unwrap();
        let off = moved.velocities.iter().map(|v| (v.z - exact).abs()).fold(0.0, f64::max);
        // Central differences start half a step late.
        assert!(
            off < if matches!(method, Method::CentralDifferences { .. }) { 0.01 } else { 1e-6 },
            "{method:?}: {off}"
        );
    }
}

#[test]
fn a_flag_in_the_wind_comes_to_rest_where_weight_and_wind_balance_and_rest_names_who_can() {
    let air = Air { wind: Vector3::new(0.0, 0.0, 2.0), ..Air::still(1.2) };
    let scene = flag(5, Some(air));
    let until = Until::Rest { speed: 0.005, energy: 1e-3, longest: 12.0 };
    let method = Method::ImplicitEuler { tolerance: 1e-7, relative: None };
    let moved = run(&Motion { method, until, drag: 4.0, ..Motion::default() }, &scene).unwrap();
    assert!(moved.converged, "{:?}", moved.progress);
    let q = air.density * air.normal * 4.0 / (2.0 * scene.material.density * 9.81);
    let sine = ((1.0 + 4.0 * q * q).sqrt() - 1.0) / (2.0 * q);
    for (p, s) in moved.positions.iter().zip(&scene.positions).filter(|(p, s)| (*p - *s).norm() > 1e-9) {
        let (out, down) = (p.z - s.z, scene.positions[scene.pinned[0] as usize].y - p.y);
        assert!((out / out.hypot(down) - sine).abs() < 5e-3, "{} against {sine}", out / out.hypot(down));
    }
    let error =
        StaticEquilibrium::default().solve(&scene, &mut |_, _| ControlFlow::Continue(())).unwrap_err();
    assert_eq!(
        error.to_string(),
        "wind of 2 m/s has no potential, so this solver finds no state of rest in it; take ImplicitEuler, \
         CentralDifferences, Xpbd or Projective, which move the cloth until it rests"
    );
    let calm = |air: Option<Air>| {
        let rested =
            StaticEquilibrium::default().solve(&flag(5, air), &mut |_, _| ControlFlow::Continue(())).unwrap();
        rested.positions
    };
    assert_eq!(calm(Some(air.calmed())), calm(None));
}

#[test]
fn seams_are_sewn_without_wind() {
    let storm = Air { wind: Vector3::new(0.0, 0.0, 20.0), ..Air::still(1.2) };
    let until = Until::Rest { speed: 0.02, energy: 1e-3, longest: 3.0 };
    let start = generate::tube(4, 5);
    let sewn_with = |air: Air| {
        let mut scene = start.clone();
        scene.phases.iter_mut().for_each(|p| p.air = Some(air));
        let (mut last, mut seen) = (0.0, vec![]);
        let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
        let collider = body.as_ref().map(|(surface, friction)| Collider { surface, friction: *friction });
        let motion = Motion { until, ..Motion::default() };
        let ended = motion.run(&scene, collider, &mut |p, _| {
            let sewn = last > 0.0 && p.gap == 0.0;
            last = p.gap;
            seen.push((p.time, p.gap, p.speed));
            if sewn { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!(ended.unwrap_err(), MotionError::Stopped);
        seen.pop();
        seen
    };
    assert_eq!(sewn_with(storm), sewn_with(storm.calmed()));
}

#[test]
fn cloth_that_contacts_hold_in_the_air_is_not_at_rest() {
    let until = Until::Rest { speed: 0.02, energy: 1e-3, longest: 0.3 };
    let method = Method::ImplicitEuler { tolerance: 1e-4, relative: None };
    let motion = Motion { method, until, drag: 4.0, ..Motion::default() };
    let moved = run(&motion, &generate::stack(24, 4)).unwrap();
    assert!(!moved.converged, "at rest after {} s", moved.progress.time);
}

#[test]
fn gravity_waits_for_the_seams() {
    // 0.5 s do not close the sides of a skirt at half a metre a second; it keeps its place all the
    // same.
    let scene = generate::tube(8, 10);
    let method = Method::Xpbd { substeps: 4 };
    let (mut sewn, mut time) = (0.0, 0.0);
    let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
    let collider = body.as_ref().map(|(surface, friction)| Collider { surface, friction: *friction });
    let moved = Motion { method, drag: 4.0, ..Motion::default() }
        .run(&scene, collider, &mut |p, _| {
            sewn = if p.gap > 0.0 { p.time } else { sewn };
            time = p.time;
            ControlFlow::Continue(())
        })
        .unwrap();
    assert!(sewn > 0.5, "{sewn}");
    // The drape has its 1.5 s whatever sewing took.
    assert!((time - sewn - 1.5).abs() < 0.01, "{time} {sewn}");
    let top = moved.positions.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
    assert!(top > 0.9, "{top}");
}

#[test]
fn seams_that_close_early_leave_the_phases_their_time() {
    let mut scene = generate::tube(4, 5);
    scene.phases[0].seconds = 3.0;
    scene.phases.truncate(1);
    let moved = run(&Motion { method: Method::Xpbd { substeps: 1 }, ..Motion::default() }, &scene).unwrap();
    assert!((moved.progress.time - 3.0).abs() < 1e-6, "{}", moved.progress.time);
}

#[test]
fn a_seam_that_is_stuck_is_told_before_the_time_is_over() {
    let mut scene = generate::tube(4, 5);
    scene.rest.iter_mut().for_each(|p| p.x *= 0.3);
    scene.positions.iter_mut().for_each(|p| p.x *= 0.3);
    let error =
        run(&Motion { method: Method::Xpbd { substeps: 4 }, ..Motion::default() }, &scene).unwrap_err();
    assert!(matches!(error, MotionError::SeamNotClosed { time, .. } if time < 4.0), "{error}");
}

#[test]
fn a_fall_past_the_body_ends_the_motion_and_one_without_a_body_does_not() {
    let mut scene = Scene { phases: falling(4).phases, ..generate::drape(4) };
    scene.phases[0].seconds = 3.0;
    scene.positions.iter_mut().for_each(|p| p.x += 1.0);
    for method in METHODS {
        let mut end = 0.0;
        let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
        let collider = body.as_ref().map(|(surface, friction)| Collider { surface, friction: *friction });
        let motion = Motion { method, ..Motion::default() };
        let error = motion.run(&scene, collider, &mut |p, _| {
            end = p.time;
            ControlFlow::Continue(())
        });
        assert_eq!(
            error.unwrap_err().to_string(),
            "the cloth of 'square' falls past the body: its middle starts 1.000 m beside the body's; move it by (-1.00, 0.00, 0.00) m, \
             around or above the body, which is 0.60 m tall, and see that both are in the same unit of length"
        );
        // 0.62 m of free fall.
        assert!((end - (2.0_f64 * 0.62 / 9.81).sqrt()).abs() < 0.01, "{method:?}: {end}");
    }
    let free = run(&Motion::default(), &Scene { body: None, ..scene }).unwrap();
    assert!(free.positions[0].y < -10.0);
}

/// A step of stiff cloth is many steps of the solver: each asks whether to stop.
#[test]
fn a_motion_stops_inside_of_a_step() {
    let mut scene = falling(6);
    scene.material = crate::fabric::Fabric::isotropic(0.1, 1e5, 0.0, 1e-5);
    for method in METHODS {
        let asked = Arc::new(AtomicUsize::new(0));
        let count = asked.clone();
        let stopper = Stopper::when(move || count.fetch_add(1, Ordering::Relaxed) >= 2);
        let mut steps = 0;
        let ended =
            Motion { method, ..Motion::default() }.run_until_stopped(&scene, None, &stopper, &mut |_, _| {
                steps += 1;
                ControlFlow::Continue(())
            });
        assert_eq!(ended.unwrap_err(), MotionError::Stopped, "{method:?}");
        assert!(steps < 3, "{method:?}: it stopped after {steps} steps");
        assert!(asked.load(Ordering::Relaxed) >= 3, "{method:?}");
    }
}

#[test]
fn cloth_too_stiff_for_steps_that_end_is_told() {
    let mut scene = falling(6);
    scene.material = crate::fabric::Fabric::isotropic(1e-6, 1e9, 0.0, 1e-5);
    let error =
        run(&Motion { method: Method::CentralDifferences { least: 0.0 }, ..Motion::default() }, &scene)
            .unwrap_err();
    let MotionError::TooStiff { step, least, time, gap } = error else { panic!("{error}") };
    assert!(step < least && time < 1e-3 && gap == 0.0, "{step} {least} {time} {gap}");
}

/// A tube whose front is moved into the body and turned, so that it starts in the body and in the
/// back.
fn tangled() -> Scene {
    let mut scene = generate::tube(16, 20);
    let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::y_axis(), 1.0);
    let front = scene.panels[0].vertices.clone();
    scene.positions[front].iter_mut().for_each(|p| *p = turn * (*p - 0.13 * Vector3::z()));
    scene
}

#[test]
fn panels_that_start_in_each_other_and_in_the_body_are_sewn_through() {
    let scene = tangled();
    let until = Until::Sewn { longest: 4.0 };
    let method = Method::CentralDifferences { least: 2e-4 };
    let models = crate::energy::Models {
        membrane: crate::energy::Membrane::Springs,
        bending: crate::energy::Bending::SkipOne,
    };
    let plain = Motion { method, models, until, drag: 20.0, ..Motion::default() };
    let refused = run(&plain, &scene).err();
    assert!(refused.is_some(), "without it they are refused or stay open");
    for seam_force in [SeamClosing::Speed, SeamClosing::Linear(30.0)] {
        let motion = Motion { through: Some(Through { coarsest: 100 }), seam_force, ..plain };
        let moved = run(&motion, &scene).unwrap();
        for [a, b] in scene.seams.iter().flat_map(|s| &s.pairs) {
            assert_eq!(moved.positions[*a as usize], moved.positions[*b as usize]);
        }
        let body = scene.body.as_ref().unwrap();
        let body = Body::new(body.vertices.clone(), &body.triangles);
        let near = moved.positions.iter().filter_map(|p| body.nearest(p, 1.0));
        assert_eq!(near.filter(|n| n.distance < 0.0).count(), 0, "{seam_force:?}");
        let sheet = crate::mesh::Sheet::flat(&scene.rest, &scene.triangles, 0.15).unwrap();
        let tree = toile_geometry::cloth_tree::ClothTree::new(sheet.triangles(), &moved.positions);
        assert_eq!(tree.crossings(&moved.positions).len(), 0, "{seam_force:?}");
    }
}
