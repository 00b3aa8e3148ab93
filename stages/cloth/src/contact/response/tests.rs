#![allow(clippy::unwrap_used)]
use super::*;
use crate::contact::step_limit::limit_step;
use crate::mesh::Sheet;
use crate::scene::generate;
use proptest::prelude::*;
use toile_geometry::cloth_tree::ClothTree;

/// Two sheets of 25 nodes each, one so far over the other, and the pairs that may collide in
/// `moves`.
fn two(apart: f64, moves: impl Fn(usize, &Vec3) -> Vec3) -> (Vec<Vec3>, Vec<Vec3>, Vec<Pair>, ClothTree) {
    let one = generate::hang(4);
    let mut scene = one.clone();
    // Turned about a little, so that no node lies over a node.
    let level = |y: f64, turn: f64| -> Vec<Vec3> {
        let at = |p: &nalgebra::Vector2<f64>| {
            Vec3::new(p.x * turn.cos() - p.y * turn.sin(), y, -p.x * turn.sin() - p.y * turn.cos())
        };
        one.rest.iter().map(at).collect()
    };
    scene.positions = level(0.0, 0.0);
    scene.add_panel("sheet", &one.rest, &level(apart, 0.1), &one.triangles);
    let sheet = Sheet::flat(&scene.rest, &scene.triangles, 0.1).unwrap();
    let (x, tree) = (scene.positions.clone(), ClothTree::new(sheet.triangles(), &scene.positions));
    let moves: Vec<Vec3> = x.iter().enumerate().map(|(k, p)| moves(k, p)).collect();
    let pairs = tree.pairs(&x, &moves, 1e-3);
    (x, moves, pairs, tree)
}

/// The response where cloth would collide; `None` where none does.
fn given(x: &[Vec3], moves: &mut [Vec3], pairs: &[Pair], held: &[bool]) -> Option<Vec<bool>> {
    let meeting = colliding(x, moves, pairs);
    (!meeting.is_empty()).then(|| respond(x, moves, pairs, meeting, held))
}

fn sum(moves: &[Vec3]) -> Vec3 {
    moves.iter().sum()
}

fn end(x: &[Vec3], moves: &[Vec3]) -> Vec<Vec3> {
    x.iter().zip(moves).map(|(p, m)| p + m).collect()
}

#[test]
fn what_falls_onto_loose_cloth_takes_it_along() {
    let (x, mut moves, pairs, tree) = two(0.01, |k, _| Vec3::y() * if k < 25 { 0.0 } else { -0.03 });
    let before = sum(&moves);
    let pushed = given(&x, &mut moves, &pairs, &[false; 50]).unwrap();
    assert!((sum(&moves) - before).norm() < 1e-12);
    assert_eq!(tree.crossings(&end(&x, &moves)), vec![]);
    assert!(pushed.iter().filter(|p| **p).count() > 40);
    // As after a blow without a bounce: all of it half as fast.
    let lower = moves[..25].iter().map(|m| m.y).sum::<f64>() / 25.0;
    assert!((lower + 0.015).abs() < 0.005, "{lower}");
}

#[test]
fn what_is_held_stays_and_what_does_not_meet_is_not_touched() {
    let (x, mut moves, pairs, _) = two(0.01, |k, _| Vec3::y() * if k < 25 { 0.0 } else { -0.03 });
    let held: Vec<bool> = (0..50).map(|k| k < 25).collect();
    given(&x, &mut moves, &pairs, &held).unwrap();
    assert!(moves[..25].iter().all(|m| *m == Vec3::zeros()));
    let (x, mut moves, pairs, _) = two(0.01, |k, _| Vec3::y() * if k < 25 { 0.0 } else { -0.005 });
    let before = moves.clone();
    assert_eq!(given(&x, &mut moves, &pairs, &held), None);
    assert_eq!(moves, before);
}

#[test]
fn layers_a_micrometre_apart_go_on_together_where_all_cloth_goes() {
    // Turned by a tenth and moved by 5 cm, and the upper one pressed down by 10 micrometres.
    let turned = |k: usize, p: &Vec3| {
        let by = Vec3::new(-0.1 * p.y, 0.1 * p.x + 0.05, 0.0);
        if k < 25 { by } else { by - Vec3::y() * 1e-5 }
    };
    let (x, wanted, pairs, tree) = two(1e-6, turned);
    let (mut ended, mut pushed) = (wanted.clone(), wanted.clone());
    limit_step(&x, &mut ended, &pairs);
    given(&x, &mut pushed, &pairs, &[false; 50]).unwrap();
    limit_step(&x, &mut pushed, &pairs);
    assert_eq!(tree.crossings(&end(&x, &pushed)), vec![]);
    let left = |moves: &[Vec3]| sum(moves).norm() / sum(&wanted).norm();
    assert!(left(&pushed) > 0.9, "{} {}", left(&pushed), left(&ended));
    assert!(left(&ended) < 0.5);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn what_gives_way_is_pushed_as_hard_as_it_pushes(seed in 0u64..1000, size in 0.005..0.1f64) {
        let wild = |k: usize, c: u64| size * (((k as u64 * 3 + c) * 7919 + seed * 104_729) as f64).sin();
        let (x, mut moves, pairs, tree) = two(0.01, |k, _| Vec3::new(wild(k, 0), wild(k, 1), wild(k, 2)));
        let before = moves.clone();
        if let Some(pushed) = given(&x, &mut moves, &pairs, &[false; 50]) {
            prop_assert!((sum(&moves) - sum(&before)).norm() < 1e-9);
            prop_assert!((0..50).all(|k| pushed[k] || moves[k] == before[k]));
        }
        let pairs = tree.pairs(&x, &moves, 1e-3);
        limit_step(&x, &mut moves, &pairs);
        prop_assert_eq!(tree.crossings(&end(&x, &moves)), vec![]);
    }
}
