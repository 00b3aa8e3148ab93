#![allow(clippy::unwrap_used)]
use super::*;
use crate::energy::Models;
use crate::scene::generate;
use crate::statics::levels::assemble::{assemble, cloths};
use crate::statics::levels::pieces::Pieces;
use proptest::prelude::*;

/// Three sheets over each other, three millimetres apart, wavy.
fn with_sheets(check: impl FnOnce(System<'_>, ClothTree, Vec<Vec3>)) {
    let scene = generate::stack(3, 8);
    let pieces = Pieces::new(&scene);
    let sheet = pieces.sewn_sheet(&cloths(&scene)).unwrap();
    let mut system = assemble(&scene, None, &pieces, &sheet, false, Models::STATIC).unwrap();
    let self_contact = system.get_mut::<SelfContact>().unwrap();
    self_contact.thickness = 2e-3;
    let each = scene.positions.len() / 3;
    let at = |(k, p): (usize, &Vec3)| {
        Vec3::new(p.x, 3e-3 * (k / each) as f64 + 0.01 * (20.0 * p.x).sin() * (15.0 * p.z).cos(), p.z)
    };
    let x: Vec<Vec3> = scene.positions.iter().enumerate().map(at).collect();
    let tree = ClothTree::new(sheet.triangles(), &scene.positions);
    check(system, tree, x);
}

/// Numbers from -1 to 1.
fn wild(seed: u64, k: usize) -> f64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (k as u64).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 31)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Moves of which a `share` are long, the others a part of the slack.
fn moves(seed: u64, nodes: usize, slack: f64, share: f64) -> Vec<Vec3> {
    let size = |k: usize| if wild(seed, 7 * k).abs() < share { 4.0 * slack } else { 0.3 * slack };
    let one = |k: usize| {
        Vec3::new(wild(seed, 3 * k + 1), wild(seed, 3 * k + 2), wild(seed, 3 * k + 3)) * size(k) / 2.0
    };
    (0..nodes).map(one).collect()
}

/// The pairs that a look at all of the cloth would want on the way.
fn wanted(tree: &ClothTree, x: &[Vec3], moves: &[Vec3], thickness: f64) -> Vec<Pair> {
    let still = vec![Vec3::zeros(); x.len()];
    let on_the_way = |t: f64| {
        let at: Vec<Vec3> = x.iter().zip(moves).map(|(p, m)| p + m * t).collect();
        tree.pairs(&at, &still, thickness)
    };
    [0.0, 0.5, 1.0].into_iter().flat_map(on_the_way).collect()
}

/// Self-contact has these pairs, each once.
fn known(system: &System<'_>, wanted: &[Pair]) {
    let pairs = &system.get::<SelfContact>().unwrap().pairs;
    assert!(pairs.windows(2).all(|w| w[0] < w[1]));
    assert!(wanted.iter().all(|p| pairs.binary_search(p).is_ok()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_step_knows_what_may_meet_on_its_way(seed in 0u64..1000, share in 0.0..0.5f64) {
        with_sheets(|mut system, tree, mut x| {
            let (slack, thickness) = system.get::<SelfContact>().map(|c| (c.slack(), c.thickness)).unwrap();
            let mut nearby = Nearby::new(Some(tree.clone()));
            for round in 0..6 {
                // Still rounds between see what is left of the long ones.
                let share = if round % 3 == 2 { 0.0 } else { share };
                let mut moves = moves(6 * seed + round, x.len(), slack, share);
                nearby.seek(&mut system, &x, &moves);
                known(&system, &wanted(&tree, &x, &moves, thickness));
                nearby.limit(&mut system, &x, &mut moves);
                known(&system, &wanted(&tree, &x, &moves, thickness));
                x.iter_mut().zip(&moves).for_each(|(p, m)| *p += m);
                assert_eq!(tree.crossings(&x), vec![]);
            }
        });
    }
}

#[test]
fn what_hardly_moves_is_not_sought_again() {
    with_sheets(|mut system, tree, x| {
        let slack = system.get::<SelfContact>().map(|c| c.slack()).unwrap();
        let mut nearby = Nearby::new(Some(tree));
        nearby.seek(&mut system, &x, &moves(1, x.len(), slack, 0.0));
        // One that is not there any more would be found again by a search.
        let known = std::mem::take(&mut system.get_mut::<SelfContact>().unwrap().pairs);
        assert!(known.len() > 100);
        let mut moves = vec![Vec3::zeros(); x.len()];
        nearby.seek(&mut system, &x, &moves);
        assert!(system.get::<SelfContact>().unwrap().pairs.is_empty());
        moves[7] = Vec3::y() * 1.01 * slack;
        nearby.seek(&mut system, &x, &moves);
        let found = &system.get::<SelfContact>().unwrap().pairs;
        assert!(!found.is_empty() && found.iter().all(|p| p.nodes.contains(&7)));
    });
}

#[test]
fn a_part_keeps_its_distance_from_where_pairs_end() {
    with_sheets(|mut system, tree, mut x| {
        let slack = system.get::<SelfContact>().map(|c| c.slack()).unwrap();
        let mut nearby = Nearby::new(Some(tree));
        nearby.seek(&mut system, &x, &vec![Vec3::zeros(); x.len()]);
        let was = x.clone();
        x.iter_mut().for_each(|p| p.y += 0.5 * slack);
        let active: Vec<bool> = (0..x.len()).map(|k| k < 20).collect();
        nearby.seek_about(&mut system, &x, &active);
        for (k, at) in nearby.at().iter().enumerate() {
            assert_eq!(at.unwrap(), if active[k] { x[k] } else { was[k] });
        }
    });
}

#[test]
fn layers_that_lie_in_each_other_and_meet_are_taken_apart_as_crossings_are() {
    with_sheets(|mut system, tree, mut x| {
        let each = x.len() / 3;
        // The middle one comes down to a micrometre over the lowest.
        (each..2 * each).for_each(|k| x[k] = x[k - each] + Vec3::y() * 1e-6);
        let mut nearby = Nearby::new(Some(tree));
        let mut moves: Vec<Vec3> =
            (0..x.len()).map(|k| Vec3::y() * if k < each { 1e-4 } else { 0.0 }).collect();
        nearby.seek(&mut system, &x, &moves);
        assert!(!nearby.is_intersecting(&system));
        nearby.limit(&mut system, &x, &mut moves);
        assert!(nearby.is_intersecting(&system) && !system.is_intersecting());
        nearby.resolve_intersections(&mut system, &x);
        let intersecting = &system.get::<SelfContact>().unwrap().intersecting;
        assert!(intersecting[..2 * each].iter().all(|t| *t) && !intersecting[2 * each..].contains(&true));
        // The layers of a stack come near each other under great loads and are held apart.
        system.get_mut::<SelfContact>().unwrap().stacked = true;
        system.get_mut::<SelfContact>().unwrap().intersecting.clear();
        let mut moves: Vec<Vec3> =
            (0..x.len()).map(|k| Vec3::y() * if k < each { 1e-4 } else { 0.0 }).collect();
        nearby.limit(&mut system, &x, &mut moves);
        assert!(!nearby.is_intersecting(&system));
    });
}
