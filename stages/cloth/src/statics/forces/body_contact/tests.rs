#![allow(clippy::unwrap_used)]
use crate::contact::body::Body;
use crate::scene::{Scene, generate};
use crate::statics::factor::scalar::Precision;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::system::System;
use crate::statics::levels::testing::on_its_body;
use crate::statics::newton::to_rest::{NewtonOptions, Proof, relax};
use nalgebra::Vector3;
use std::ops::ControlFlow;

type Vec3 = Vector3<f64>;

/// A square on top of a ball, its middle pressed down as by the weight of much cloth, brought to
/// rest.
#[test]
fn contact_carries_whatever_presses_on_one_node() {
    let mut scene = generate::drape(10);
    scene.self_collision = false;
    on_its_body(&scene, |system, body, _| press_the_middle(&scene, system, body));
}

fn press_the_middle(scene: &Scene, mut system: System<'_>, body: &Body) {
    let mut x = scene.positions.clone();
    let middle = (0..x.len()).min_by(|&a, &b| x[a].xz().norm().total_cmp(&x[b].xz().norm())).unwrap();
    let (stiffness, offset) = {
        let s = system.get_mut::<BodyContact>().unwrap();
        // So that the layer is as thick everywhere.
        s.edges.clear();
        (s.stiffness[middle], s.offsets[middle])
    };
    // Ten times what the spring has at the guard.
    let load = 10.0 * stiffness * 0.5 * offset;
    system.loads.push = vec![Vec3::zeros(); x.len()];
    system.loads.push[middle] = Vec3::y() * -load;
    let options = NewtonOptions {
        first: 0.05,
        longest: 1.0,
        steps: 300,
        speed: 1e-3,
        non_static: 0.0,
        farthest: 0.05,
        proof: Proof::ProofStep,
        precision: Precision::Double,
        skip_line_search: false,
        holds_stopped: false,
        one_by_one: false,
        asleep: true,
    };
    let layout = scene.positions.clone();
    let outcome = relax(
        &mut system,
        &layout,
        None,
        &mut x,
        &options,
        &mut |_, _, _| ControlFlow::Continue(()),
        &|| false,
    )
    .unwrap();
    assert!(outcome.at_rest && outcome.residual < 1e-3 * load, "{outcome:?}");
    let touch =
        system.get::<BodyContact>().unwrap().touches.iter().find(|t| t.node as usize == middle).unwrap();
    assert!(touch.force > 0.9 * load, "{} of {load} N", touch.force);
    let height = body.nearest(&x[middle], 1.0).unwrap().distance;
    assert!(height > 0.5 * offset && height < offset, "{height}");
}

/// A node in the ball, pulled in harder than its contact carries, and one beside it that rests
/// outside.
#[test]
fn contact_that_is_hard_brings_a_node_out_of_the_body() {
    let scene = generate::drape(10);
    on_its_body(&scene, |mut system, body, _| {
        let mut x = scene.positions.clone();
        let top = (0..x.len()).min_by(|&a, &b| x[a].xz().norm().total_cmp(&x[b].xz().norm())).unwrap();
        let height = body.nearest(&x[top], 1.0).unwrap().distance;
        x[top] -= Vec3::y() * (height + 5e-3);
        let of = |system: &System<'_>, i: usize| system.get::<BodyContact>().unwrap().stiffness[i];
        let before = (of(&system, top), of(&system, top + 1));
        system.update_contacts(&x);
        system.update_contacts(&x);
        assert_eq!((of(&system, top), of(&system, top + 1)), before, "it is not hard yet");
        system.get_mut::<BodyContact>().unwrap().stiffens_inside = true;
        (0..3).for_each(|_| system.update_contacts(&x));
        assert_eq!((of(&system, top), of(&system, top + 1)), (16.0 * before.0, before.1));
        let force = system
            .get::<BodyContact>()
            .unwrap()
            .touches
            .iter()
            .find(|t| t.node as usize == top)
            .unwrap()
            .force;
        assert!(force > 15.0 * before.0 * 5e-3, "{force}");
    });
}
