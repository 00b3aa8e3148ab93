//! Bending continuation: what it improves, and what it must not change.
#![allow(clippy::unwrap_used)]
use super::tests::{crossings, deepest, strains};
use super::*;
use crate::scene::generate;
use std::ops::ControlFlow;
use std::time::Duration;
use toile_geometry::Vec3;

fn graded(scene: &Scene) -> Equilibrium {
    let settings = StaticEquilibrium { bending_continuation: true, ..StaticEquilibrium::default() };
    match settings.solve(scene, &mut |_, _| ControlFlow::Continue(())) {
        Err(StaticsError::NotAtRest { state, .. }) => *state,
        other => other.unwrap(),
    }
}

/// How far, in the mean, four starts with every vertex moved by 1 mm end from where the scene's own
/// does, m.
fn spread(scene: &Scene, solve: impl Fn(&Scene) -> Equilibrium) -> Vec<f64> {
    let own = solve(scene).positions;
    let apart = |seed: u64| {
        let mut moved = scene.clone();
        generate::jitter(&mut moved, 1e-3, seed);
        let end = solve(&moved).positions;
        own.iter().zip(&end).map(|(a, b)| (a - b).norm()).sum::<f64>() / own.len() as f64
    };
    (1..=4).map(apart).collect()
}

#[test]
#[ignore = "slow: .ci/wide"]
fn a_skirt_from_moved_starts_ends_where_the_unmoved_one_does() {
    let scene = generate::tube(22, 25);
    let (straight, graded) = (spread(&scene, super::tests::roughly), spread(&scene, graded));
    assert!(graded.iter().all(|d| *d < 2e-3), "{graded:?}");
    assert!(straight.iter().all(|d| *d > 2e-3), "{straight:?}");
}

#[test]
fn of_two_mirror_images_a_skirt_takes_the_same_from_every_start() {
    let apart = spread(&generate::tube(16, 16), graded);
    assert!(apart.iter().all(|d| *d < 1e-3), "{apart:?}");
}

#[test]
fn a_square_on_a_ball_keeps_its_friction_and_stays() {
    // A plate falls off the ball, with friction or without: the cloth does not.
    for cells in [12, 20] {
        let state = graded(&generate::drape(cells));
        assert!(state.outcome.at_rest);
        assert!(state.positions.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max) > 0.0);
    }
}

#[test]
fn a_skirt_that_slides_without_friction_keeps_it() {
    // Without friction on the way it would rest 3 cm lower, strained by 3 %.
    let scene = generate::tube(22, 25);
    let state = graded(&scene);
    let strain = strains(&scene, &state.positions);
    assert!(state.outcome.at_rest);
    let (p99, most) = (strain[strain.len() * 99 / 100], strain[strain.len() - 1]);
    assert!(p99 < 0.015 && most < 0.025, "{p99} {most}");
    assert!(deepest(&scene, &state.positions) < 1e-4);
    assert_eq!(crossings(&scene, &state.positions), 0);
}

#[test]
fn cloth_without_bending_or_weight_is_solved_straight_away() {
    let mut scene = generate::hang(8);
    (scene.material.bending_warp, scene.material.bending_weft) = (0.0, 0.0);
    let straight = super::tests::roughly(&scene);
    assert_eq!(graded(&scene).positions, straight.positions);
}

#[test]
fn out_of_time_tells_the_mesh_whatever_the_state_of_stiffness() {
    let scene = generate::hang(24);
    let settings = StaticEquilibrium {
        bending_continuation: true,
        budget: Duration::from_secs(1),
        ..StaticEquilibrium::default()
    };
    let mut progress = |level: &LevelReport, _: &dyn Fn() -> Vec<Vec3>| {
        if level.nodes == scene.rest.len() {
            std::thread::sleep(settings.budget);
        }
        ControlFlow::Continue(())
    };
    let error = settings.solve(&scene, &mut progress).unwrap_err();
    let told = |level: usize, levels: usize| (1..=levels).contains(&level);
    assert!(
        matches!(&error, StaticsError::Timeout { level, levels, positions, .. }
            if told(*level, *levels) && positions.len() == scene.rest.len()),
        "{error}"
    );
}
