//! Colliders across the plugin ABI, both ways, and a solver of a plugin.

use crate::plugins::kit::{make, registry_with, run};
use std::sync::Arc;
use toile_core::artifact::{
    Artifact, Body, Curve, Fabric, Garment, GarmentPanel, Penalty, Point2, Point3, SolveStatus, Vector3,
};
use toile_core::{PortValue, Registry};

fn linked() -> Registry {
    let mut registry = toile::registry();
    toile_faulty::register(&mut registry);
    registry
}

fn body() -> Body {
    let at = |x, y, z| Point3::new(x, y, z);
    Body {
        positions: vec![at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(0.0, 0.0, 1.0)],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        landmarks: Default::default(),
        measurements: Default::default(),
    }
}

pub(crate) fn garment() -> Garment {
    let positions =
        vec![Point3::new(0.05, 0.0, 0.0), Point3::new(0.0, 0.3, 0.0), Point3::new(0.02, 0.02, 0.01)];
    let rest = vec![Point2::new(0.0, 0.0), Point2::new(0.1, 0.0), Point2::new(0.0, 0.1)];
    let fabric = Fabric {
        name: "t".into(),
        area_density: 0.1,
        warp: Curve::linear(1e3),
        weft: Curve::linear(1e3),
        shear: Curve::linear(50.0),
        bending_warp: 1e-5,
        bending_weft: 1e-5,
        bending_friction_warp: 0.0,
        bending_friction_weft: 0.0,
        thickness: 3e-4,
        friction: 0.3,
        damping: 0.1,
        source: String::new(),
    };
    Garment {
        velocities: vec![Vector3::zeros(); 3],
        panels: vec![GarmentPanel {
            name: "front".into(),
            vertices: 0..3,
            triangles: 0..1,
            boundary: vec![0, 1, 2],
            photo_px: vec![],
            fabric: Arc::new(fabric),
            layer: 0,
        }],
        positions,
        rest,
        triangles: vec![[0, 1, 2]],
        seams: vec![],
        weld: vec![0, 1, 2],
        pinned: vec![],
        status: SolveStatus::default(),
        starts: Vec::new(),
        motion: None,
    }
}

fn collider(registry: &Registry, name: &str) -> Arc<dyn Artifact> {
    collider_with(registry, name, "()")
}

fn collider_with(registry: &Registry, name: &str, params: &str) -> Arc<dyn Artifact> {
    let stage = make(registry, name, params);
    match run(stage.as_ref(), vec![Arc::new(body())]).unwrap().remove(0) {
        PortValue::One(collider) => collider,
        PortValue::Set(..) => unreachable!("a collider is one"),
    }
}

/// Collider and solver each linked in or loaded: four ways, one result.
#[test]
fn a_collider_and_a_solver_work_on_either_side() {
    let (linked, loaded) = (linked(), registry_with(&["toile_faulty"]));
    let mut results = Vec::new();
    for made_by in [&linked, &loaded] {
        for solved_by in [&linked, &loaded] {
            let collider = collider(made_by, "Sphere");
            let solver = make(solved_by, "PushesOut", "()");
            let made = run(solver.as_ref(), vec![Arc::new(garment()), collider]).unwrap();
            results.push(crate::plugins::kit::only(&made));
        }
    }
    assert!(results[0].contains("steps: 2"), "{}", results[0]);
    assert!(results.windows(2).all(|w| w[0] == w[1]), "{results:#?}");
}

#[test]
fn a_collider_tells_settings_and_signature() {
    let collider = collider(&registry_with(&["toile_faulty"]), "Sphere");
    let any: &dyn std::any::Any = collider.as_ref();
    let collider = any.downcast_ref::<toile_core::artifact::Collider>().unwrap();
    assert_eq!(collider.signature, "sphere 0.1");
    assert_eq!(
        format!("{:?}", collider.scheme.card()),
        "ColliderCard { thickness: 0.001, friction: 0.3, restitution: 0.0, self_collision: false, penalty: None }"
    );
}

#[test]
fn a_penalty_crosses_with_its_law() {
    let loaded = registry_with(&["toile_sdf"]);
    let laws = [
        ("None", None),
        ("Linear(50)", Some(Penalty::Linear(50.0))),
        ("Exponential(0.5)", Some(Penalty::Exponential(0.5))),
    ];
    for (written, penalty) in laws {
        let params = format!("(cell: \"50 mm\", penalty: {written})");
        let collider = collider_with(&loaded, "SdfCollider", &params);
        let any: &dyn std::any::Any = collider.as_ref();
        let collider = any.downcast_ref::<toile_core::artifact::Collider>().unwrap();
        assert_eq!(collider.scheme.card().penalty, penalty);
    }
}

#[test]
fn a_collider_that_panics_ends_the_solve_with_its_message() {
    let loaded = registry_with(&["toile_faulty"]);
    let trap = collider(&loaded, "TrapCollider");
    // A solver of a plugin that meets it hands the error on; the program's own ends by the runner's
    // guard.
    let solver = make(&loaded, "PushesOut", "()");
    let e = run(solver.as_ref(), vec![Arc::new(garment()), trap.clone()]).unwrap_err();
    assert!(e.message.contains("its collider panicked in body_contacts: snap"), "{}", e.message);
    let any: &dyn std::any::Any = trap.as_ref();
    let trap = any.downcast_ref::<toile_core::artifact::Collider>().unwrap().scheme.clone();
    let asked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        trap.body_contacts(&garment().positions, 0.0, &mut Vec::new());
    }));
    let error = asked.unwrap_err().downcast::<toile_core::StageError>().unwrap();
    assert_eq!(error.message, "plugin \"toile-faulty\" 0.1.0: its collider panicked in body_contacts: snap");
}
