#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::closest::{between_segments, on_triangle};
use super::*;
use proptest::prelude::*;

fn points() -> impl Strategy<Value = [Point3; 4]> {
    let x = -1.0..1.0;
    let p = (x.clone(), x.clone(), x).prop_map(|(x, y, z)| Point3::new(x, y, z));
    prop::array::uniform4(p)
}

fn between(from: &[Point3; 4], to: &[Point3; 4], t: f64) -> [Point3; 4] {
    std::array::from_fn(|i| from[i] + (to[i] - from[i]) * t)
}

fn vertex_gap([p, a, b, c]: &[Point3; 4]) -> f64 {
    (p - on_triangle(p, &[*a, *b, *c]).point).norm()
}

fn edge_gap([a, b, c, d]: &[Point3; 4]) -> f64 {
    let (s, t) = between_segments(&[*a, *b], &[*c, *d]);
    ((a + (b - a) * s) - (c + (d - c) * t)).norm()
}

/// Up to the answer the gap stays open; where there is one, it is nearly closed then.
fn check(
    impact: Option<f64>,
    from: &[Point3; 4],
    to: &[Point3; 4],
    gap: f64,
    distance: fn(&[Point3; 4]) -> f64,
) {
    let until = impact.unwrap_or(1.0);
    assert!((0.0..=1.0).contains(&until));
    if distance(from) <= gap {
        assert_eq!(impact, Some(0.0));
        return;
    }
    for i in 0..=200 {
        assert!(distance(&between(from, to, until * f64::from(i) / 200.0)) > gap);
    }
    if impact.is_some() {
        let left = distance(&between(from, to, until)) - gap;
        assert!(left <= NEARNESS * (distance(from) - gap) + 1e-12, "stopped at {left}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn nothing_is_passed_through(from in points(), to in points(), gap in 0.0..0.05) {
        check(vertex_triangle_impact(&from, &to, gap), &from, &to, gap, vertex_gap);
        check(edge_edge_impact(&from, &to, gap), &from, &to, gap, edge_gap);
    }
}

fn falling(height: f64, to: f64) -> ([Point3; 4], [Point3; 4]) {
    let floor = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 0.0, 2.0]].map(Point3::from);
    let at = |y| [Point3::new(0.0, y, 0.0), floor[0], floor[1], floor[2]];
    (at(height), at(to))
}

#[test]
fn a_falling_vertex_lands_where_it_should() {
    let (from, to) = falling(1.0, -1.0);
    let t = vertex_triangle_impact(&from, &to, 0.0).unwrap();
    assert!((0.45..0.5).contains(&t), "{t}");
    let (from, to) = falling(1.0, 0.2);
    assert_eq!(vertex_triangle_impact(&from, &to, 0.0), None);
    let t = vertex_triangle_impact(&from, &to, 0.5).unwrap();
    assert!((0.5..0.625).contains(&t), "{t}");
}

#[test]
fn a_very_fast_vertex_does_not_tunnel() {
    let (from, to) = falling(1e-3, -1e6);
    assert!(vertex_triangle_impact(&from, &to, 0.0).is_some());
}

#[test]
fn crossing_edges_meet() {
    let at = |y| [[-1.0, y, 0.0], [1.0, y, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]].map(Point3::from);
    let t = edge_edge_impact(&at(1.0), &at(-1.0), 0.0).unwrap();
    assert!((0.45..0.5).contains(&t), "{t}");
    assert_eq!(edge_edge_impact(&at(1.0), &at(0.1), 0.0), None);
}

#[test]
fn what_moves_together_or_rests_never_meets() {
    let (from, _) = falling(0.01, 0.0);
    assert_eq!(vertex_triangle_impact(&from, &from, 0.0), None);
    let carried = from.map(|p| p + Vector3::new(5.0, -3.0, 1.0));
    assert_eq!(vertex_triangle_impact(&from, &carried, 0.0), None);
}

#[test]
fn what_starts_in_contact_or_is_no_number_may_not_move() {
    let (from, to) = falling(0.01, -1.0);
    assert_eq!(vertex_triangle_impact(&from, &to, 0.02), Some(0.0));
    let (nowhere, _) = falling(f64::NAN, 0.0);
    assert_eq!(vertex_triangle_impact(&from, &nowhere, 0.0), Some(0.0));
    assert_eq!(vertex_triangle_impact(&nowhere, &to, 0.0), Some(0.0));
}
