//! Cloth that passes through itself is taken out of itself.
#![allow(clippy::unwrap_used)]

use super::*;
use crate::scene::generate;
use crate::statics::levels::assemble::cloths;
use crate::statics::levels::pieces::Pieces;
use proptest::prelude::*;

const CELLS: usize = 12;

/// A flat square cloth of 1 m, and the tree of its places.
fn cloth() -> (Sheet, ClothTree, Vec<Vec3>) {
    let scene = generate::drape(CELLS as u32);
    let sheet = Pieces::new(&scene).sewn_sheet(&cloths(&scene)).unwrap();
    let tree = ClothTree::new(sheet.triangles(), &scene.positions);
    (sheet, tree, scene.positions.clone())
}

/// The cloth with one corner folded over, whose tip goes down through the cloth by `depth`, m.
fn folded_through(flat: &[Vec3], depth: f64) -> Vec<Vec3> {
    let along = Vec3::new(1.0, 0.0, 1.0).normalize();
    let [low, high] = flat
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], p| [l.min(along.dot(p)), h.max(along.dot(p))]);
    let (fold, length) = (0.6 * high + 0.4 * low, 0.4 * (high - low));
    let place = |p: &Vec3| {
        let over = (along.dot(p) - fold) / length;
        let down = 0.08 - over * (0.08 + depth);
        if over <= 0.0 { *p } else { p - along * (1.95 * over * length) + Vec3::y() * down }
    };
    flat.iter().map(place).collect()
}

#[test]
fn a_corner_that_came_through_cloth_is_drawn_out_again() {
    let (sheet, tree, flat) = cloth();
    for depth in [0.01, 0.03, 0.06] {
        let mut x = folded_through(&flat, depth);
        let before = tree.crossings(&x).len();
        assert!(before > 5, "{before} crossings");
        assert_eq!(uncross(&sheet, &tree, &vec![false; x.len()], &mut x), 0, "from {before}, {depth} m deep");
        assert!(tree.crossings(&x).is_empty());
        let longest = sheet.edges().iter().map(|e| {
            let [a, b] = e.vertices.map(|v| x[v as usize]);
            (b - a).norm() / e.rest_length
        });
        assert!(longest.fold(0.0, f64::max) < 1.6, "edges are drawn back to their lengths");
    }
}

#[test]
fn a_vertex_pulled_through_cloth_comes_back() {
    let (sheet, tree, flat) = cloth();
    let mut x = flat.clone();
    let knot = 6 * (CELLS + 1) + 6;
    x[knot] = (flat[knot + 2] + flat[knot + 3] + flat[knot + 15]) / 3.0 - Vec3::y() * 0.01;
    x[knot + 1] += Vec3::y() * 0.02;
    assert!(!tree.crossings(&x).is_empty());
    assert_eq!(uncross(&sheet, &tree, &vec![false; x.len()], &mut x), 0);
}

#[test]
fn what_is_clear_and_what_is_pinned_stay_where_they_are() {
    let (sheet, tree, flat) = cloth();
    let mut x = flat.clone();
    assert_eq!(uncross(&sheet, &tree, &vec![false; x.len()], &mut x), 0);
    assert_eq!(x, flat);
    let start = folded_through(&flat, 0.03);
    let mut held = start.clone();
    let left = uncross(&sheet, &tree, &vec![true; held.len()], &mut held);
    assert_eq!((left, &held), (tree.crossings(&start).len(), &start));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// For any crumpled start: crossings do not increase, positions are finite, pinned nodes stay
    /// in place, and the returned count is that of the result.
    #[test]
    fn it_never_makes_it_worse(
        noise in prop::collection::vec([-1.0..1.0f64, -1.0..1.0, -1.0..1.0], (CELLS + 1) * (CELLS + 1)),
        size in 0.0..0.3f64,
        held in prop::collection::vec(prop::bool::weighted(0.1), (CELLS + 1) * (CELLS + 1)),
    ) {
        let (sheet, tree, flat) = cloth();
        let start: Vec<Vec3> = flat.iter().zip(&noise).map(|(p, n)| p + Vec3::from(*n) * size).collect();
        let mut x = start.clone();
        let left = uncross(&sheet, &tree, &held, &mut x);
        prop_assert!(x.iter().all(|p| p.iter().all(|c| c.is_finite())));
        prop_assert_eq!(left, tree.crossings(&x).len());
        prop_assert!(left <= tree.crossings(&start).len());
        prop_assert!(x.iter().zip(&start).zip(&held).all(|((p, q), held)| !held || p == q));
    }
}
