#![allow(clippy::unwrap_used, clippy::expect_used)]
use super::body::Body;
use super::step_limit::{limit_step, limit_with_search};
use crate::mesh::Sheet;
use crate::scene::generate;
use nalgebra::Vector2;
use proptest::prelude::*;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::pair::{Kind, Pair};
use toile_geometry::{Vec3, ccd::impact};

fn point() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1.0..1.0f64).prop_map(Vec3::from)
}

fn kind() -> impl Strategy<Value = Kind> {
    prop_oneof![Just(Kind::VertexTriangle), Just(Kind::EdgeEdge)]
}

/// The least distance of a pair over a fine division of the step up to `until`.
fn least(kind: Kind, from: &[Vec3; 4], moves: &[Vec3; 4], until: f64) -> f64 {
    (0..=400)
        .map(|k| f64::from(k) / 400.0 * until)
        .map(|t| kind.closest(&std::array::from_fn(|i| from[i] + moves[i] * t)).distance)
        .fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn nothing_meets_before_the_impact(
        kind in kind(),
        from in prop::array::uniform4(point()),
        moves in prop::array::uniform4(point()),
    ) {
        let pair = Pair { kind, nodes: [0, 1, 2, 3] };
        let start = kind.closest(&from).distance;
        prop_assume!(start > 1e-3);
        let hit = impact(&pair, &from, &moves);
        let brute = least(kind, &from, &moves, 1.0);
        prop_assert!(least(kind, &from, &moves, hit.unwrap_or(1.0)) >= 0.09 * start);
        // A clear miss must not be called a hit, unless the pieces start so near each other that
        // the steps run out on the way. Fast pieces pass between two divisions, so the hit itself
        // is looked at, too.
        let there = hit.map(|t| kind.closest(&std::array::from_fn(|i| from[i] + moves[i] * t)).distance);
        let is_hit = there.is_none_or(|d| d.min(brute) < 0.2 * start);
        prop_assert!(start < 0.03 || is_hit, "{hit:?} {there:?} {brute} {start}");
    }

    #[test]
    fn closest_points_are_the_closest(
        kind in kind(),
        x in prop::array::uniform4(point()),
        s in 0.0..1.0f64,
        t in 0.0..1.0f64,
    ) {
        let c = kind.closest(&x);
        let between: Vec3 = (0..4).map(|i| x[i] * c.weights[i]).sum();
        prop_assert!((between.norm() - c.distance).abs() < 1e-9);
        let (s, t) = if s + t > 1.0 && kind == Kind::VertexTriangle { (1.0 - s, 1.0 - t) } else { (s, t) };
        let other = match kind {
            Kind::VertexTriangle => x[0] - (x[1] + (x[2] - x[1]) * s + (x[3] - x[1]) * t),
            Kind::EdgeEdge => x[0] + (x[1] - x[0]) * s - x[2] - (x[3] - x[2]) * t,
        };
        prop_assert!(c.distance <= other.norm() + 1e-12);
    }

    #[test]
    fn the_tree_finds_what_all_pairs_find(seed in 0u64..1000, reach in 0.01..0.2f64) {
        let (sheet, x, moves) = crumpled(4, seed, 0.05);
        let found = ClothTree::new(sheet.triangles(), &x).pairs(&x, &moves, reach);
        for pair in all_pairs(&sheet) {
            if least(pair.kind, &pair.at(&x), &pair.at(&moves), 1.0) < reach {
                let there = found.iter().any(|p| same(p, &pair));
                prop_assert!(there, "{pair:?}");
            }
        }
    }

    #[test]
    fn pairs_of_some_nodes_are_those_of_all_that_have_one(seed in 0u64..1000, reach in 0.01..0.2f64, every in 2usize..40) {
        let (sheet, x, moves) = crumpled(5, seed, 0.05);
        let tree = ClothTree::new(sheet.triangles(), &x);
        let some: Vec<bool> = (0..x.len()).map(|k| k % every == 0).collect();
        let mut all = tree.pairs(&x, &moves, reach);
        all.retain(|p| p.nodes.iter().any(|&i| some[i as usize]));
        prop_assert_eq!(tree.pairs_of(&some, &x, &moves, reach), all);
    }

    #[test]
    fn a_limited_step_crosses_nothing(seed in 0u64..1000, size in 0.01..0.5f64) {
        let (sheet, x, mut moves) = crumpled(6, seed, size);
        let tree = ClothTree::new(sheet.triangles(), &x);
        prop_assume!(tree.crossings(&x).is_empty());
        let pairs = tree.pairs(&x, &moves, 1e-3);
        limit_step(&x, &mut moves, &pairs);
        let end: Vec<Vec3> = x.iter().zip(&moves).map(|(p, m)| p + m).collect();
        prop_assert_eq!(tree.crossings(&end), vec![]);
    }

    #[test]
    fn distance_to_a_sphere(p in point()) {
        let scene = generate::drape(3).body.unwrap();
        let body = Body::new(scene.vertices, &scene.triangles);
        let near = body.nearest(&p, f64::INFINITY).unwrap();
        // The facets lie inside the sphere by less than this.
        let sag = 0.3 * (1.0 - (std::f64::consts::PI / 48.0).cos()) * 2.2;
        prop_assert!((near.distance - (p.norm() - 0.3)).abs() < sag + 1e-9);
        prop_assert!((near.normal.norm() - 1.0).abs() < 1e-9);
        prop_assert!((near.point + near.normal * near.distance - p).norm() < 1e-9);
    }

    #[test]
    fn no_guarded_move_enters_the_body(p in point(), by in point()) {
        let scene = generate::drape(3).body.unwrap();
        let body = Body::new(scene.vertices, &scene.triangles);
        prop_assume!(body.nearest(&p, f64::INFINITY).unwrap().distance > 0.0);
        let end = p + body.guard(&p, &(by * 3.0), 5e-4);
        prop_assert!(body.nearest(&end, f64::INFINITY).unwrap().distance > 0.0);
    }
}

fn same(a: &Pair, b: &Pair) -> bool {
    let parts = |p: &Pair| {
        let first = if p.kind == Kind::VertexTriangle { 1 } else { 2 };
        let mut sides = [p.nodes[..first].to_vec(), p.nodes[first..].to_vec()];
        sides.iter_mut().for_each(|s| s.sort_unstable());
        sides.sort_by_key(|s| (s.len(), s.clone()));
        sides
    };
    a.kind == b.kind && parts(a) == parts(b)
}

fn all_pairs(sheet: &Sheet) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for v in 0..sheet.vertex_count() as u32 {
        let away = sheet.triangles().iter().filter(|t| !t.contains(&v));
        pairs.extend(away.map(|t| Pair { kind: Kind::VertexTriangle, nodes: [v, t[0], t[1], t[2]] }));
    }
    for (k, e) in sheet.edges().iter().enumerate() {
        let others =
            sheet.edges()[k + 1..].iter().filter(|f| f.vertices.iter().all(|v| !e.vertices.contains(v)));
        pairs.extend(others.map(|f| Pair {
            kind: Kind::EdgeEdge,
            nodes: [e.vertices[0], e.vertices[1], f.vertices[0], f.vertices[1]],
        }));
    }
    pairs
}

/// A square sheet of `n` by `n` cells rolled up loosely, and wild moves of up to `size`.
fn crumpled(n: usize, seed: u64, size: f64) -> (Sheet, Vec<Vec3>, Vec<Vec3>) {
    let at = |i: usize, j: usize| (j * (n + 1) + i) as u32;
    let uv: Vec<Vector2<f64>> = (0..(n + 1) * (n + 1))
        .map(|k| Vector2::new((k % (n + 1)) as f64, (k / (n + 1)) as f64) / n as f64)
        .collect();
    let cell = |k: usize| (k % n, k / n);
    let triangles: Vec<[u32; 3]> = (0..n * n)
        .map(cell)
        .flat_map(|(i, j)| {
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
        .collect();
    let sheet = Sheet::flat(&uv, &triangles, 0.1).unwrap();
    let roll = |p: &Vector2<f64>| {
        let turn = 7.0 * p.x;
        Vec3::new((0.05 + 0.02 * turn) * turn.cos(), p.y, (0.05 + 0.02 * turn) * turn.sin())
    };
    let wild = |k: usize, c: u64| size * (((k as u64 * 3 + c) * 7919 + seed * 104_729) as f64).sin();
    let moves = (0..uv.len()).map(|k| Vec3::new(wild(k, 0), wild(k, 1), wild(k, 2))).collect();
    (sheet, uv.iter().map(roll).collect(), moves)
}

#[test]
fn what_falls_together_does_not_pass_what_is_held_back() {
    // Three sheets over each other: the upper two fall alike onto the lowest, which stays.
    let one = generate::hang(4);
    let n = one.rest.len();
    let mut scene = one.clone();
    let level = |y: f64| -> Vec<Vec3> { one.rest.iter().map(|p| Vec3::new(p.x, y, -p.y)).collect() };
    scene.positions = level(0.0);
    for y in [0.01, 0.014] {
        scene.add_panel("sheet", &one.rest, &level(y), &one.triangles);
    }
    let sheet = Sheet::flat(&scene.rest, &scene.triangles, 0.1).unwrap();
    let x = scene.positions.clone();
    let tree = ClothTree::new(sheet.triangles(), &x);
    let fall = |v: usize| if v < n { Vec3::zeros() } else { Vec3::new(0.0, -0.025, 0.0) };
    let mut moves: Vec<Vec3> = (0..x.len()).map(fall).collect();
    let seek = |moves: &[Vec3]| tree.pairs(&x, moves, 1e-3);
    let first = seek(&moves);
    // The upper two never near each other on their way: no pair of theirs is found at first.
    assert!(first.iter().all(|p| p.nodes.iter().any(|&v| (v as usize) < n)));
    limit_with_search(&x, &mut moves, first, |_| true, |moves| Some(seek(moves)));
    let height = |v: usize| x[v].y + moves[v].y;
    for v in 0..n {
        assert!(
            height(v + n) > 0.0 && height(v + 2 * n) > height(v + n),
            "{} {}",
            height(v + n),
            height(v + 2 * n)
        );
    }
    assert!(moves[n].y < -0.005);
}

/// Four wavy sheets over each other, a millimetre apart; the third is active.
fn wavy() -> (Sheet, Vec<Vec3>, Vec<bool>) {
    let scene = generate::stack(4, 5);
    let sheet = Sheet::flat(&scene.rest, &scene.triangles, 0.15).unwrap();
    let layer = |k: usize| k / 36;
    let at = |(k, p): (usize, &Vec3)| {
        Vec3::new(p.x, 1e-3 * layer(k) as f64 + 0.05 * (9.0 * p.x).sin() + 0.03 * (7.0 * p.z).cos(), p.z)
    };
    let x: Vec<Vec3> = scene.positions.iter().enumerate().map(at).collect();
    let active = (0..x.len()).map(|k| layer(k) == 2).collect();
    (sheet, x, active)
}

#[test]
fn only_active_triangles_seek_pairs() {
    let (sheet, x, active) = wavy();
    let still = vec![Vec3::zeros(); x.len()];
    let tree = ClothTree::new(sheet.triangles(), &x);
    let has_active = |p: &Pair| p.nodes.iter().any(|&i| active[i as usize]);
    let all: Vec<Pair> = tree.pairs(&x, &still, 5e-3).into_iter().filter(has_active).collect();
    let some = tree.with_active(&active).pairs(&x, &still, 5e-3);
    assert!(all.len() > 500 && some.iter().all(has_active));
    assert_eq!(all, some);
}

#[test]
fn a_part_of_the_tree_finds_what_the_whole_finds_about_it() {
    let (sheet, x, active) = wavy();
    let still = vec![Vec3::zeros(); x.len()];
    let tree = ClothTree::new(sheet.triangles(), &x).with_active(&active);
    let known = tree.about(&x, 5e-3);
    let nodes: Vec<u32> = (0..x.len() as u32).filter(|&i| known[i as usize]).collect();
    let mut index = vec![u32::MAX; x.len()];
    nodes.iter().enumerate().for_each(|(k, &i)| index[i as usize] = k as u32);
    let pick = |of: &[Vec3]| -> Vec<Vec3> { nodes.iter().map(|&i| of[i as usize]).collect() };
    let own: Vec<bool> = nodes.iter().map(|&i| active[i as usize]).collect();
    let part = tree.part(&nodes, &index, &pick(&x)).with_active(&own);
    let sides = |pairs: Vec<Pair>, name: &dyn Fn(u32) -> u32| {
        let side = |n: &[u32]| {
            let mut n: Vec<u32> = n.iter().map(|&i| name(i)).collect();
            n.sort_unstable();
            n
        };
        let one = |p: &Pair| {
            let (a, b) = p.nodes.split_at(if p.kind == Kind::EdgeEdge { 2 } else { 1 });
            let (a, b) = (side(a), side(b));
            if p.kind == Kind::EdgeEdge && b < a { (p.kind, b, a) } else { (p.kind, a, b) }
        };
        let mut all: Vec<_> = pairs.iter().map(one).collect();
        all.sort();
        all
    };
    let whole = sides(tree.pairs(&x, &still, 5e-3), &|i| i);
    assert_eq!(sides(part.pairs(&pick(&x), &pick(&still), 5e-3), &|k| nodes[k as usize]), whole);
}
