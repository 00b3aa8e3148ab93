#![allow(clippy::unwrap_used)]
use super::*;
use crate::contact::body::Body;
use crate::scene::generate;

/// The box of the ball of 0.3 m about the origin.
fn ball() -> BodyBox {
    let body = generate::drape(2).body.unwrap();
    BodyBox::of(&Body::new(body.vertices, &body.triangles), &Vec3::new(0.0, -9.81, 0.0)).unwrap()
}

fn at(heights: &[f64]) -> Vec<Vec3> {
    heights.iter().map(|y| Vec3::new(1.0, *y, 2.0)).collect()
}

#[test]
fn a_piece_is_past_the_body_once_all_of_it_is_below() {
    let (body, free) = (ball(), [false; 4]);
    assert!((body.height() - 0.6).abs() < 1e-9);
    assert_eq!(body.past(&at(&[-0.29, -0.35]), &[0, 0], &free), [false; 0]);
    assert_eq!(body.past(&at(&[-0.31, -0.35]), &[0, 0], &free), [true]);
    // The first of two pieces still lies on the body.
    assert_eq!(body.past(&at(&[0.0, -0.29, -0.31, -0.4]), &[0, 0, 1, 1], &free), [false, true]);
}

#[test]
fn cloth_that_something_holds_may_still_catch_a_piece() {
    let (body, free) = (ball(), [false; 4]);
    // The first piece hangs down to -0.5 m: the second may lie in a fold of it.
    assert_eq!(body.past(&at(&[0.0, -0.5, -0.4, -0.45]), &[0, 0, 1, 1], &free), [false; 0]);
    assert_eq!(body.past(&at(&[0.0, -0.5, -0.51, -0.6]), &[0, 0, 1, 1], &free), [false, true]);
    // And so it may in a piece that a pin holds below the body.
    let held = [true, false, false, false];
    assert_eq!(body.past(&at(&[-0.5, -0.7, -0.6, -0.65]), &[0, 0, 1, 1], &held), [false; 0]);
    assert_eq!(body.past(&at(&[-0.5, -0.7, -0.8, -0.9]), &[0, 0, 1, 1], &held), [false, true]);
}

#[test]
fn what_is_no_cloth_does_not_fall() {
    assert_eq!(ball().past(&at(&[0.0, -5.0]), &[0, NO_PIECE], &[false; 2]), [false; 0]);
}

#[test]
fn a_start_is_around_the_body_or_beside_or_below_it() {
    let body = ball();
    let patch = |x: f64, y: f64| [Vec3::new(x, y, 0.0), Vec3::new(x + 0.1, y + 0.1, 0.1)];
    assert_eq!(body.start(&patch(0.0, 0.5)), Start::Around);
    let Start::Beside(way) = body.start(&patch(0.5, -9.0)) else { unreachable!() };
    assert!((way - Vec3::new(0.55, 0.0, 0.05)).norm() < 1e-9, "from middle to middle: {way}");
    let Start::Below(gap) = body.start(&patch(0.0, -0.6)) else { unreachable!() };
    assert!((gap - 0.2).abs() < 1e-9);
}

#[test]
fn without_body_or_weight_there_is_no_box() {
    let body = generate::drape(2).body.unwrap();
    let body = Body::new(body.vertices, &body.triangles);
    assert_eq!(BodyBox::of(&body, &Vec3::zeros()), None);
    assert_eq!(BodyBox::of(&Body::new(vec![], &[]), &Vec3::y()), None);
}

#[test]
fn panels_are_listed_for_people() {
    assert_eq!(list(&[("front", 5, 5)]), "'front'");
    assert_eq!(list(&[("front", 5, 5), ("back", 3, 5)]), "'front' and 'back' (a part of it)");
    let five: Vec<(&str, usize, usize)> = ["a", "b", "c", "d", "e"].map(|n| (n, 1, 1)).to_vec();
    assert_eq!(list(&five), "'a', 'b', 'c' and 2 more");
    assert_eq!(list(&[]), "no panel");
}
