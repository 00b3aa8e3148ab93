//! Cloth on tables, plates and blades comes to rest, and no edge of either passes through the
//! other.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::tests::*;
use super::*;
use crate::scene::{SceneBody, generate};
use toile_geometry::Vec3;

/// Whether the way from `p` to `q` passes through a triangle.
fn passes([p, q]: [Vec3; 2], [a, b, c]: [Vec3; 3]) -> bool {
    let volume = |a: Vec3, b: Vec3, c: Vec3, d: Vec3| (b - a).cross(&(c - a)).dot(&(d - a));
    let around = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    let is_inside = around.iter().all(|v| *v > 0.0) || around.iter().all(|v| *v < 0.0);
    is_inside && volume(a, b, c, p) * volume(a, b, c, q) < 0.0
}

/// How often edges of the cloth pass through triangles of the body, or the other way round.
fn body_crossings(scene: &Scene, x: &[Vec3]) -> usize {
    let b = scene.body.as_ref().unwrap();
    let corners = |x: &[Vec3], t: &[[u32; 3]]| -> Vec<[Vec3; 3]> {
        t.iter().map(|t| t.map(|v| x[v as usize])).collect()
    };
    let (cloth, body) = (corners(x, &scene.triangles), corners(&b.vertices, &b.triangles));
    let count = |of: &[[Vec3; 3]], others: &[[Vec3; 3]]| {
        let sides = of.iter().flat_map(|t| (0..3).map(|k| [t[k], t[(k + 1) % 3]]));
        sides.map(|s| others.iter().filter(|t| passes(s, **t)).count()).sum::<usize>()
    };
    count(&cloth, &body) + count(&body, &cloth)
}

fn rests_outside(name: &str, scene: &Scene) -> Equilibrium {
    let state = settle(scene).unwrap_or_else(|e| panic!("{name}: {e}"));
    picture(scene, &state.positions, name);
    assert_eq!(body_crossings(scene, &state.positions), 0, "{name}");
    assert!(deepest(scene, &state.positions) < 0.0, "{name}");
    state
}

/// A block that stands in the middle of another.
fn ledge() -> SceneBody {
    let mut low = generate::block([-0.3, -0.5, -0.3], [0.3, -0.2, 0.3]);
    let high = generate::block([-0.1, -0.1995, -0.1], [0.1, 0.0, 0.1]);
    low.triangles.extend(high.triangles.iter().map(|t| t.map(|v| v + 8)));
    low.vertices.extend(high.vertices);
    low
}

#[test]
fn cloth_comes_to_rest_on_sharp_edges_and_crosses_none() {
    let blade = || generate::block([-0.001, -0.3, -0.6], [0.001, 0.0, 0.6]);
    let plate = || generate::block([-0.25, -0.002, -0.4], [0.25, 0.0, 0.4]);
    let table = || generate::block([-0.3, -0.5, -0.3], [0.3, 0.0, 0.3]);
    for (name, body, cells, turn) in [
        ("blade", blade(), 11, 0.0),
        ("turned_blade", blade(), 20, 0.4),
        ("plate", plate(), 16, 0.3),
        ("table", table(), 12, 0.0),
        ("turned_table", table(), 20, 0.5),
        ("ledge", ledge(), 16, 0.0),
    ] {
        rests_outside(name, &generate::cover(body, cells, turn));
    }
}

#[test]
fn what_hangs_over_a_blade_hangs_on_both_sides() {
    let scene = generate::cover(generate::block([-0.001, -0.3, -0.6], [0.001, 0.0, 0.6]), 11, 0.0);
    let state = rests_outside("blade", &scene);
    let lowest = |side: f64| {
        let own = state.positions.iter().filter(|p| p.x * side > 0.0);
        own.map(|p| p.y).fold(f64::INFINITY, f64::min)
    };
    // Half a metre on each side, but for half of the cell that lies over the blade: cloth folds at
    // its vertices.
    assert!(
        [1.0, -1.0].iter().all(|s| (lowest(*s) + 0.5 * 10.0 / 11.0).abs() < 0.01),
        "{} {}",
        lowest(1.0),
        lowest(-1.0)
    );
}

#[test]
fn cloth_passes_through_no_facet_of_a_coarse_ball() {
    for (around, bend, cells) in [(12, 1e-5, 12), (16, 1e-2, 22), (24, 1e-5, 22), (48, 1e-3, 22)] {
        let mut scene = generate::drape(cells);
        scene.body = Some(generate::ball(around));
        (scene.material.bending_warp, scene.material.bending_weft) = (bend, bend);
        rests_outside(&format!("ball_{around}_{cells}"), &scene);
    }
}
