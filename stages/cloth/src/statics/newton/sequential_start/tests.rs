#![allow(clippy::unwrap_used, clippy::panic)]
use super::*;
use crate::contact::body::Body;
use crate::energy::Models;
use crate::scene::{Scene, generate};
use crate::statics::drive::solve::{StaticEquilibrium, StaticsError};
use crate::statics::factor::scalar::Precision;
use crate::statics::forces::seam_force::SeamForce;
use crate::statics::levels::assemble::{Collider, assemble, cloths as fabrics};
use crate::statics::levels::pieces::Pieces;
use crate::statics::newton::state::Proof;
use crate::statics::newton::to_rest::Outcome;

const CELLS: u32 = 4;

/// Vertices of a sheet.
const NODES: usize = 25;

/// What there is to a scene: the system, its tree and where its nodes are.
fn with_system(scene: &Scene, check: impl FnOnce(System<'_>, &ClothTree, Vec<Vec3>)) {
    let ball = scene.body.as_ref().unwrap();
    let body = Body::new(ball.vertices.clone(), &ball.triangles);
    let collider = Collider { surface: &body, friction: ball.friction };
    let pieces = Pieces::new(scene);
    let sheet = pieces.sewn_sheet(&fabrics(scene)).unwrap();
    let mut system = assemble(scene, Some(collider), &pieces, &sheet, false, Models::STATIC).unwrap();
    system.get_mut::<SelfContact>().into_iter().for_each(|c| c.stacked = true);
    check(system, &ClothTree::new(sheet.triangles(), &scene.positions), scene.positions.clone());
}

fn options() -> NewtonOptions {
    NewtonOptions {
        first: 0.05,
        longest: 1.0,
        steps: 200,
        speed: 1e-3,
        non_static: 0.0,
        farthest: 0.1,
        proof: Proof::AnyStep,
        skip_line_search: false,
        holds_stopped: false,
        one_by_one: true,
        asleep: true,
        precision: Precision::Mixed,
    }
}

/// A stack of which the sheets were made in the order of these heights.
fn shuffled(heights: &[usize]) -> Scene {
    let mut scene = generate::stack(heights.len(), CELLS);
    for (sheet, &height) in scene.positions.chunks_mut(NODES).zip(heights) {
        sheet.iter_mut().for_each(|p| p.y = 0.31 + 0.004 * height as f64);
    }
    scene
}

fn order(system: &System<'_>, x: &[Vec3]) -> Vec<u32> {
    let (of, count) = cloths(system);
    outwards(system, x, &of, count)
}

#[test]
fn cloths_come_from_the_innermost_outwards() {
    with_system(&shuffled(&[3, 0, 2, 1]), |mut system, _, x| {
        assert_eq!(order(&system, &x), [1, 3, 2, 0]);
        // Without a body, from the lowest up.
        system.body = None;
        assert_eq!(order(&system, &x), [1, 3, 2, 0]);
        // What is worn further in comes first, wherever it is.
        let layer = |sheet: usize| if sheet == 0 { 0 } else { 1 };
        system.get_mut::<SelfContact>().unwrap().order = (0..x.len()).map(|i| layer(i / NODES)).collect();
        assert_eq!(order(&system, &x), [0, 1, 3, 2]);
    });
}

#[test]
fn what_hangs_together_by_thread_is_one_cloth() {
    with_system(&shuffled(&[0, 1, 2]), |mut system, _, x| {
        let nodes = [0, 2 * NODES as u32];
        system.set_seam_forces(vec![SeamForce { nodes, force: 1.0, softening: 1e-3 }]);
        assert_eq!(cloths(&system).1, 2);
        // Sheet 1 lies lower than the middle of the other two, and comes first only where that is
        // so.
        assert_eq!(order(&system, &x).len(), 2);
    });
}

#[test]
fn a_cloth_comes_to_rest_on_pinned_cloth() {
    with_system(&generate::stack(2, CELLS), |mut system, tree, mut x| {
        let around = StackStart { layout: &x.clone(), tree, options: options(), stop: &|| false };
        let active = |sheet: usize| -> Vec<bool> { (0..2 * NODES).map(|i| i / NODES == sheet).collect() };
        let mut last = Outcome::default();
        let mut watch = |_: &System<'_>, _: &[Vec3], o: &Outcome| {
            last = *o;
            ControlFlow::Continue(())
        };
        assert!(around.settle(&mut system, &mut x, &active(0), 2, &mut watch).unwrap().is_continue());
        let below = x.clone();
        assert_eq!(below[NODES..], around.layout[NODES..]);
        assert!(around.settle(&mut system, &mut x, &active(1), 1, &mut watch).unwrap().is_continue());
        assert_eq!(x[..NODES], below[..NODES]);
        assert!(last.at_rest && last.steps > 5 && last.steps < STEPS, "{last:?}");
        assert!(tree.crossings(&x).is_empty());
        // It lies on the first sheet, whose middle may dip between the nodes around it.
        let middle = NODES / 2;
        let gap = x[NODES + middle].y - x[middle].y;
        assert!(gap > 0.4e-3 && gap < 1.5e-3, "{gap}");
    });
}

#[test]
fn a_caller_can_stop_between_two_steps() {
    with_system(&generate::stack(3, CELLS), |mut system, tree, mut x| {
        let around = StackStart { layout: &x.clone(), tree, options: options(), stop: &|| false };
        let mut left = 7;
        let mut watch = |_: &System<'_>, _: &[Vec3], _: &Outcome| {
            left -= 1;
            if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        assert!(start_one_by_one(&mut system, &around, &mut x, &mut watch).unwrap().is_break());
        assert_eq!(left, 0);
        // What the seven steps did is kept.
        assert!(x[0] != around.layout[0] && x[2 * NODES..] == around.layout[2 * NODES..]);
        let around = StackStart { stop: &|| true, ..around };
        let go_on = &mut |_: &System<'_>, _: &[Vec3], _: &Outcome| ControlFlow::Continue(());
        assert!(matches!(start_one_by_one(&mut system, &around, &mut x, go_on), Err(Halt::Stopped)));
    });
}

/// Heights of the middles of the sheets over the ball's top, m.
fn middles(x: &[Vec3]) -> Vec<f64> {
    x.chunks(NODES).map(|sheet| sheet[NODES / 2].y).collect()
}

#[test]
fn six_sheets_come_to_rest_in_order() {
    let heights = [4, 1, 0, 5, 2, 3];
    let scene = shuffled(&heights);
    let state = StaticEquilibrium::default().solve(&scene, &mut |_, _| ControlFlow::Continue(())).unwrap();
    assert!(state.outcome.at_rest && state.outcome.dt < 0.017 && state.outcome.speed < 1e-3);
    assert!(state.residual < 0.02, "{}", state.residual);
    let found = middles(&state.positions);
    let mut sorted = vec![0.0; heights.len()];
    heights.iter().zip(&found).for_each(|(h, y)| sorted[*h] = *y);
    for pair in sorted.windows(2) {
        assert!(pair[1] - pair[0] > 0.4e-3 && pair[1] - pair[0] < 1.5e-3, "{sorted:?}");
    }
}

#[test]
fn a_stack_that_is_stopped_returns_so() {
    let mut steps = 0;
    let stopped = StaticEquilibrium::default().solve(&generate::stack(6, CELLS), &mut |_, _| {
        steps += 1;
        if steps == 20 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(stopped, Err(StaticsError::Stopped)) && steps == 20);
}
