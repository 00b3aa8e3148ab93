//! Bending that is let go by steps: what it is for, and what it must leave alone.
#![allow(clippy::unwrap_used)]
use super::tests::{crossings, deepest, strains};
use super::*;
use crate::scene::generate;

fn graded(scene: &Scene) -> Rested {
    let rest = Rest { graded: true, ..Rest::default() };
    match rest.solve(scene, &mut |_| ControlFlow::Continue(())) {
        Err(RestError::NotAtRest { state, .. }) => *state,
        other => other.unwrap(),
    }
}

/// Mean distance, in mm, of where the same vertices are, from the scene's own start and from one with every vertex moved by 1 mm.
fn spread(scene: &Scene, solve: impl Fn(&Scene) -> Rested) -> f64 {
    let mut moved = scene.clone();
    generate::jitter(&mut moved, 1e-3, 1);
    let (a, b) = (solve(scene).positions, solve(&moved).positions);
    a.iter().zip(&b).map(|(a, b)| (a - b).norm()).sum::<f64>() / a.len() as f64 * 1e3
}

#[test]
fn a_drape_from_a_moved_start_ends_where_the_other_does() {
    let scene = generate::drape(33);
    let straight = spread(&scene, super::tests::roughly);
    let graded = spread(&scene, graded);
    assert!(graded < 2.0 && graded < 0.2 * straight, "{graded} mm, straight away {straight} mm");
}

#[test]
fn a_skirt_slides_on_where_only_friction_held_it_and_is_sound_there() {
    // Straight away, friction holds it higher up, where it is strained by 1.5 % at most.
    let scene = generate::tube(22, 25);
    let state = graded(&scene);
    let strain = strains(&scene, &state.positions);
    assert!(state.outcome.at_rest);
    let (p99, most) = (strain[strain.len() * 99 / 100], strain[strain.len() - 1]);
    assert!(p99 < 0.03 && most < 0.04, "{p99} {most}");
    assert!(deepest(&scene, &state.positions) < 1e-4);
    assert_eq!(crossings(&scene, &state.positions), 0);
}

#[test]
fn friction_that_holds_a_cloth_up_is_kept() {
    // Without friction a square slides off a ball.
    let state = graded(&generate::drape(12));
    assert!(state.outcome.at_rest);
    assert!(state.positions.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max) > 0.0);
}

#[test]
fn cloth_without_bending_or_weight_is_solved_straight_away() {
    let mut scene = generate::hang(8);
    (scene.material.bending_warp, scene.material.bending_weft) = (0.0, 0.0);
    let straight = super::tests::roughly(&scene);
    assert_eq!(graded(&scene).positions, straight.positions);
}
