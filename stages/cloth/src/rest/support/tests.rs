#![allow(clippy::unwrap_used)]
use crate::contact::body::Body;
use crate::rest::assemble::{Wearer, assemble, cloths};
use crate::rest::newton::{Pace, relax};
use crate::rest::pieces::Pieces;
use crate::rest::real::Precision;
use crate::scene::generate;
use nalgebra::Vector3;
use std::ops::ControlFlow;

type Vec3 = Vector3<f64>;

/// A square on top of a ball, its middle pressed down as by the weight of much cloth, brought to rest.
#[test]
fn contact_carries_whatever_presses_on_one_node() {
    let mut scene = generate::drape(10);
    scene.self_collision = false;
    let ball = scene.body.as_ref().unwrap();
    let body = Body::new(ball.vertices.clone(), &ball.triangles);
    let wearer = Wearer { skin: &body, friction: ball.friction };
    let pieces = Pieces::new(&scene);
    let sheet = pieces.sewn_sheet(&cloths(&scene)).unwrap();
    let mut system = assemble(&scene, Some(wearer), &pieces, &sheet, false).unwrap();
    let mut x = scene.positions.clone();
    let middle = (0..x.len()).min_by(|&a, &b| x[a].xz().norm().total_cmp(&x[b].xz().norm())).unwrap();
    let (stiffness, offset) = {
        let s = system.support.as_mut().unwrap();
        // So that the layer is as thick everywhere.
        s.edges.clear();
        (s.stiffness[middle], s.offsets[middle])
    };
    // Ten times what the spring has at the guard.
    let load = 10.0 * stiffness * 0.5 * offset;
    system.push = vec![Vec3::zeros(); x.len()];
    system.push[middle] = Vec3::y() * -load;
    let pace = Pace {
        first: 0.05,
        longest: 1.0,
        steps: 300,
        speed: 1e-3,
        farthest: 0.05,
        prove: true,
        precision: Precision::Double,
        one_by_one: false,
    };
    let layout = scene.positions.clone();
    let outcome =
        relax(&mut system, &layout, None, &mut x, &pace, &mut |_, _, _| ControlFlow::Continue(()), &|| false)
            .unwrap();
    assert!(outcome.at_rest && outcome.residual < 1e-3 * load, "{outcome:?}");
    let touch = system.touches.iter().find(|t| t.node as usize == middle).unwrap();
    assert!(touch.force > 0.9 * load, "{} of {load} N", touch.force);
    let height = body.nearest(&x[middle], 1.0).unwrap().distance;
    assert!(height > 0.5 * offset && height < offset, "{height}");
}
