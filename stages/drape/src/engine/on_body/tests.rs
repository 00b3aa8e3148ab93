#![allow(clippy::unwrap_used)]
use super::*;
use toile_core::artifact::Vector3;
use toile_fixtures::cloth::{Capsules, hanging, plain, vest};

const GRAVITY: Vector3 = Vector3::new(0.0, -9.81, 0.0);

/// The shares of a garment whose vertices all end so much lower, m.
fn sunk(garment: &Garment, body: &Capsules, by: f64) -> Vec<f64> {
    let end: Vec<Point3> = garment.positions.iter().map(|p| p - Vector3::y() * by).collect();
    on_body(garment, &end, body, &GRAVITY)
}

#[test]
fn a_vest_that_slides_some_centimetres_is_in_its_place_and_one_about_the_feet_is_not() {
    let (vest, body) = (vest(&plain(500.0, 50.0, 1e-5)), Capsules::torso());
    assert_eq!(sunk(&vest, &body, 0.0), [1.0, 1.0]);
    let area: f64 = vest.panels.iter().map(|p| vest.panel_areas(p).0).sum();
    let some = sunk(&vest, &body, 0.05);
    assert!((some[0] - (1.0 - 0.05 / area.sqrt())).abs() < 1e-9 && some[0] > 0.9, "{some:?}");
    assert_eq!(sunk(&vest, &body, 1.5), [0.0, 0.0]);
}

#[test]
fn a_vest_that_slides_down_on_one_side_alone_has_sunk_by_the_mean() {
    let (vest, body) = (vest(&plain(500.0, 50.0, 1e-5)), Capsules::torso());
    let widest = vest.positions.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
    // One side stays where it was, the other ends 0.4 m lower.
    let tilted = |p: &Point3| p - Vector3::y() * 0.2 * (1.0 + p.x / widest);
    let end: Vec<Point3> = vest.positions.iter().map(tilted).collect();
    let area: f64 = vest.panels.iter().map(|p| vest.panel_areas(p).0).sum();
    let sunk = (1.0 - on_body(&vest, &end, &body, &GRAVITY)[0]) * area.sqrt();
    assert!((sunk - 0.2).abs() < 0.03, "{sunk}");
}

#[test]
fn cloth_that_falls_onto_a_ball_has_not_sunk() {
    // 0.2 m square, 0.3 m above a ball of 0.1 m.
    let (mut sheet, _) = hanging(0.2, 0.2, 0.02, &plain(500.0, 50.0, 1e-5));
    sheet.positions.iter_mut().for_each(|p| *p = Point3::new(p.x - 0.1, 0.4, -p.y - 0.1));
    let ball = Capsules::new(&[([0.0; 3], [0.0; 3], 0.1)]);
    let on = |top: f64| -> Vec<f64> {
        let end: Vec<Point3> =
            sheet.positions.iter().map(|p| Point3::new(p.x, top - p.x.abs() - p.z.abs(), p.z)).collect();
        on_body(&sheet, &end, &ball, &GRAVITY)
    };
    assert_eq!(on(0.1), [1.0]);
    // Beside the ball it has lost its place: the ball was under it.
    assert!(on(-0.1)[0] < 0.1, "{:?}", on(-0.1));
}

#[test]
fn what_pins_hold_stays_in_its_place_and_without_weight_nothing_is_told() {
    let (mut sheet, _) = hanging(0.2, 0.2, 0.02, &plain(500.0, 50.0, 1e-5));
    sheet.pinned = vec![0];
    let ball = Capsules::new(&[([0.0; 3], [0.0; 3], 0.1)]);
    assert_eq!(sunk(&sheet, &ball, 5.0), [1.0]);
    assert_eq!(on_body(&sheet, &sheet.positions, &ball, &Vector3::zeros()), [0.0; 0]);
}

#[test]
fn one_solver_after_the_other_loses_both_ways() {
    assert_eq!(both(&[0.5, 1.0], vec![0.5, 0.75]), [0.25, 0.75]);
    assert_eq!(both(&[], vec![0.5]), [0.5]);
}
