//! A garment that misses its body, or slides off it, is reported as soon as it is certain; one that
//! slides a little is not.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::tests::*;
use super::*;
use crate::contact::past::Start;
use crate::fabric::Fabric;
use crate::scene::generate;
use std::ops::ControlFlow;
use toile_geometry::Vec3;

/// The skirt of 2,200 triangles after a change.
fn skirt(change: impl Fn(&mut Scene)) -> Scene {
    let mut scene = generate::tube(22, 25);
    change(&mut scene);
    scene
}

fn wider(scene: &mut Scene, factor: f64) {
    scene.rest.iter_mut().for_each(|p| p.x *= factor);
    scene.positions.iter_mut().for_each(|p| p.x *= factor);
}

fn scaled_body(scene: &mut Scene, factor: f64) {
    scene.body.iter_mut().flat_map(|b| &mut b.vertices).for_each(|p| *p *= factor);
}

/// How it fell, and how many nodes the finest mesh had that it was followed on.
fn fall(scene: &Scene, graded: bool) -> (crate::contact::past::Fallen, usize) {
    let mut finest = 0;
    let solved = StaticEquilibrium { bending_continuation: graded, ..StaticEquilibrium::default() }.solve(
        scene,
        &mut |level, _| {
            finest = finest.max(if level.sewing { 0 } else { level.nodes });
            ControlFlow::Continue(())
        },
    );
    match solved {
        Err(StaticsError::FallsPast(fallen)) => (*fallen, finest),
        other => panic!("{:?}", other.map(|s| s.outcome)),
    }
}

#[test]
fn a_skirt_beside_the_body_is_told_on_the_coarsest_mesh() {
    for graded in [false, true] {
        for way in [[0.0, 0.3], [0.0, -0.3], [0.5, 0.0], [-0.5, 0.0]] {
            let aside =
                |s: &mut Scene| s.positions.iter_mut().for_each(|p| *p += Vec3::new(way[0], 0.0, way[1]));
            let (fallen, finest) = fall(&skirt(aside), graded);
            assert_eq!(fallen.cloth, "'front' and 'back'");
            assert!(finest < 1000, "{way:?}: {finest} nodes");
        }
    }
}

#[test]
fn a_skirt_too_wide_slides_off_and_is_told() {
    for graded in [false, true] {
        let (fallen, _) = fall(&skirt(|s| wider(s, 1.4)), graded);
        assert_eq!(fallen.start, Start::Around);
        assert_eq!(
            fallen.to_string(),
            "the cloth of 'front' and 'back' finds no hold on the body and falls past it; place it around the body, cut it narrower \
             where the body is to hold it (a skirt at its waist) or raise the friction, and see that it is not too heavy and that the \
             body, 1.05 m tall, is in metres"
        );
    }
}

#[test]
fn a_body_in_centimetres_or_millimetres_is_told_by_its_size() {
    for (factor, below, tall) in [(100.0, "33.95", "105.00"), (1000.0, "348.95", "1050.00")] {
        let (fallen, _) = fall(&skirt(|s| scaled_body(s, factor)), false);
        assert_eq!(
            fallen.to_string(),
            format!(
                "the cloth of 'front' and 'back' falls away from the body: it starts {below} m below it, and the body is {tall} m tall; \
                 place it around or above the body, and see that both are in the same unit of length"
            )
        );
    }
    // A body far too small falls through the skirt.
    fall(&skirt(|s| scaled_body(s, 0.01)), false);
}

#[test]
fn of_two_garments_the_one_that_falls_is_named() {
    let scene = skirt(|s| {
        let patch = generate::drape(4);
        let rest: Vec<_> = patch.rest.iter().map(|p| 0.2 * p).collect();
        let beside: Vec<Vec3> = rest.iter().map(|p| Vec3::new(1.0 + p.x, 1.0, p.y)).collect();
        s.add_panel("pocket", &rest, &beside, &patch.triangles);
    });
    assert_eq!(fall(&scene, false).0.cloth, "'pocket'");
}

#[test]
fn a_loose_piece_of_a_panel_that_falls_is_told_by_its_vertices() {
    // A square over the ball, and a small one beside it that no seam holds, in one panel.
    let mut scene = generate::drape(12);
    let patch = generate::drape(2);
    let rest: Vec<_> = patch.rest.iter().map(|p| 0.1 * p + nalgebra::Vector2::new(2.0, 0.0)).collect();
    let at: Vec<Vec3> = rest.iter().map(|p| Vec3::new(p.x - 1.0, 0.32, -p.y)).collect();
    scene.add_panel("rest", &rest, &at, &patch.triangles);
    let all = scene.panels.pop().unwrap();
    (scene.panels[0].vertices.end, scene.panels[0].triangles.end) = (all.vertices.end, all.triangles.end);
    assert_eq!(fall(&scene, false).0.cloth, "'square' (a part of it)");
}

#[test]
fn a_pin_on_one_piece_does_not_hold_another() {
    let mut scene = generate::drape(8);
    let pinned = generate::hang(4);
    let aside: Vec<Vec3> = pinned.positions.iter().map(|p| p + Vec3::new(3.0, 0.0, 0.0)).collect();
    let first = scene.add_panel("curtain", &pinned.rest, &aside, &pinned.triangles).start;
    scene.pinned = pinned.pinned.iter().map(|v| v + first).collect();
    scene.positions[..81].iter_mut().for_each(|p| p.x -= 2.0);
    assert_eq!(fall(&scene, false).0.cloth, "'square'");
}

#[test]
fn a_skirt_that_slides_some_centimetres_onto_the_hips_is_not_called_fallen() {
    for (lift, width, friction) in [(0.08, 1.0, 0.4), (0.0, 1.0, 0.0), (0.0, 1.06, 0.4), (-0.05, 1.0, 0.1)] {
        let scene = skirt(|s| {
            wider(s, width);
            s.positions.iter_mut().for_each(|p| p.y += lift);
            s.body.iter_mut().for_each(|b| b.friction = friction);
        });
        let state = roughly(&scene);
        let top = state.positions.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        assert!((0.85..1.1).contains(&top), "{lift} {width} {friction}: {top}");
    }
}

#[test]
fn cloth_dropped_on_a_ball_from_high_above_lands_on_it() {
    let mut scene = generate::drape(10);
    scene.positions.iter_mut().for_each(|p| p.y += 0.8);
    let state = roughly(&scene);
    let top = state.positions.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
    assert!((0.29..0.32).contains(&top), "{top}");
}

#[test]
fn a_skirt_too_heavy_for_its_friction_slides_off() {
    let scene = skirt(|s| {
        s.material = Fabric { density: 60.0, ..generate::cloth() };
        s.body.iter_mut().for_each(|b| b.friction = 0.05);
    });
    fall(&scene, false);
}
