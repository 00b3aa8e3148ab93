#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::*;
use crate::contact::body::Body;
use crate::energy::Air;
use crate::fabric::{Curve, Fabric};
use crate::scene::{Phase, generate};
use std::ops::ControlFlow;

const GO_ON: fn(&LevelReport, &dyn Fn() -> Vec<Vec3>) -> ControlFlow<()> = |_, _| ControlFlow::Continue(());

fn fresh(scene: &Scene) -> Equilibrium {
    StaticEquilibrium::default().solve(scene, &mut GO_ON.clone()).unwrap()
}

fn farthest(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// A cloth stiff enough to hang in one way only.
fn stiff() -> Scene {
    let mut scene = generate::hang(10);
    (scene.material.bending_warp, scene.material.bending_weft) = (2e-3, 2e-3);
    scene
}

/// The fabric after `share` of a slide of all its values.
fn slide(fabric: &Fabric, share: f64) -> Fabric {
    let times = |k: f64| 1.0 + share * (k - 1.0);
    let stretch = fabric.stretch() * times(0.6);
    Fabric {
        density: fabric.density * times(1.5),
        warp: Curve::linear(stretch),
        weft: Curve::linear(stretch),
        shear: Curve::linear(50.0 * times(0.5)),
        bending_warp: fabric.bending_warp * times(2.0),
        bending_weft: fabric.bending_weft * times(2.0),
        ..fabric.clone()
    }
}

#[test]
fn a_changed_fabric_hangs_as_a_fresh_one_does() {
    let scene = stiff();
    let cloth = scene.material.clone();
    let mut live = Live::new(StaticEquilibrium::default(), scene.clone(), None, &fresh(&scene)).unwrap();
    for k in 1..=10 {
        live.change(|s| s.material = slide(&cloth, 0.1 * f64::from(k))).unwrap();
        live.follow(2).unwrap();
    }
    let state = live.settle(&mut GO_ON.clone()).unwrap();
    assert!(state.outcome.at_rest);
    let want = fresh(&Scene { material: slide(&cloth, 1.0), ..scene });
    let off = farthest(&state.positions, &want.positions);
    assert!(off < 2e-3, "{off}");
}

#[test]
fn a_skirt_follows_its_fabric_and_comes_to_rest() {
    let scene = generate::tube(12, 14);
    let b = scene.body.as_ref().unwrap();
    let body = Body::new(b.vertices.clone(), &b.triangles);
    let collider = Collider { surface: &body, friction: b.friction };
    let cloth = scene.material.clone();
    let mut live =
        Live::new(StaticEquilibrium::default(), scene.clone(), Some(collider), &fresh(&scene)).unwrap();
    let mut residuals = Vec::new();
    // A second of a slider's way, a state every thirtieth.
    for k in 1..=30 {
        let share = f64::from(k) / 30.0;
        live.change(|s| {
            s.material = slide(&cloth, share);
            s.body.as_mut().unwrap().friction = 0.4 - 0.1 * share;
        })
        .unwrap();
        let outcome = live.follow(3).unwrap();
        residuals.push(outcome.residual);
    }
    // Nine states of ten leave a tenth of the garment's weight, some 0.6 N, on no vertex; a vertex
    // that lands on the body may show more for one state.
    residuals.sort_by(f64::total_cmp);
    assert!(residuals[26] < 0.06, "{residuals:?}");
    let state = live.settle(&mut GO_ON.clone()).unwrap();
    assert!(state.outcome.at_rest && state.outcome.speed < 1e-3);
    let deepest = state.positions.iter().filter_map(|p| body.nearest(p, 1.0)).map(|n| -n.distance);
    assert!(deepest.fold(f64::NEG_INFINITY, f64::max) < 1e-4);
}

#[test]
fn a_pin_that_is_pulled_takes_the_cloth_along() {
    let scene = stiff();
    let corner = scene.pinned[0];
    let mut live = Live::new(StaticEquilibrium::default(), scene.clone(), None, &fresh(&scene)).unwrap();
    let to = scene.positions[corner as usize] + Vec3::new(0.1, 0.0, 0.05);
    assert!(live.pull(corner, to));
    assert!(!live.pull(corner + 1, to));
    let state = live.settle(&mut GO_ON.clone()).unwrap();
    assert!((state.positions[corner as usize] - to).norm() < 1e-8);
}

#[test]
fn what_is_at_rest_takes_no_steps() {
    let scene = stiff();
    let state = fresh(&scene);
    let mut live = Live::new(StaticEquilibrium::default(), scene, None, &state).unwrap();
    let settled = live.settle(&mut GO_ON.clone()).unwrap();
    assert!(farthest(&settled.positions, &state.positions) < 1e-4);
    let before = live.positions();
    assert!(live.follow(5).unwrap().at_rest);
    assert_eq!(live.positions(), before);
}

#[test]
fn another_mesh_is_refused() {
    let scene = stiff();
    let mut live = Live::new(StaticEquilibrium::default(), scene.clone(), None, &fresh(&scene)).unwrap();
    let error = live.change(|s| s.triangles.swap(0, 1)).unwrap_err();
    assert_eq!(error.to_string(), "the mesh or its seams have changed; solve the scene from its start");
    let error = live.change(|s| s.material.density = -1.0).unwrap_err();
    assert_eq!(error.to_string(), "density = -1 is out of range: above 0 kg/m^2");
}

#[test]
fn wind_is_refused_and_changes_nothing() {
    let scene = stiff();
    let mut live = Live::new(StaticEquilibrium::default(), scene.clone(), None, &fresh(&scene)).unwrap();
    let before = live.scene().clone();
    let gravity = Vec3::new(0.0, -9.81, 0.0);
    let air = Some(Air { wind: Vec3::new(3.0, 0.0, 0.0), ..Air::still(1.2) });
    let blow = |s: &mut Scene| s.phases = vec![Phase { name: "storm".into(), seconds: 1.0, gravity, air }];
    let said = "wind of 3 m/s has no potential, so this solver finds no state of rest in it; take ImplicitEuler, \
                CentralDifferences, Xpbd or Projective, which move the cloth until it rests";
    assert_eq!(live.change(blow).unwrap_err().to_string(), said);
    assert!(*live.scene() == before);
    let mut windy = scene.clone();
    blow(&mut windy);
    let refused = Live::new(StaticEquilibrium::default(), windy, None, &fresh(&scene)).err();
    assert_eq!(refused.map(|e| e.to_string()).as_deref(), Some(said));
}
