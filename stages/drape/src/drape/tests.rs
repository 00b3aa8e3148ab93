//! A sewn vest hangs; cloth comes to rest where it should.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::{SpringDraper, StaticEquilibrium};
use crate::stitch::SpringStitcher;
use toile_core::prelude::*;
use toile_fixtures::cloth::{Capsules, hanging, plain, vest};

#[test]
fn a_vest_hangs_from_the_shoulders() {
    let body = Capsules::torso().collider();
    let cx = Context::quiet();
    let sewn = SpringStitcher::default().run(&vest(&plain(6000.0, 80.0, 1e-5)), Some(&body), &cx).unwrap();
    let draped = SpringDraper::default().run(&sewn, Some(&body), &cx).unwrap();
    assert!(draped.status.converged && draped.status.max_speed < 0.02, "{:?}", draped.status);
    assert!(draped.status.steps > sewn.status.steps);
    assert_eq!(draped.seam_gap_max(), 0.0);
    let strains = draped.edge_strains();
    assert!(strains[strains.len() * 99 / 100] < 0.02, "{}", strains[strains.len() * 99 / 100]);
    for p in &draped.panels {
        let ((flat, now), (outline, length)) = (draped.panel_areas(p), draped.panel_boundaries(p));
        assert!((now / flat - 1.0).abs() < 0.01 && (length / outline - 1.0).abs() < 0.01);
    }
    let solid = Capsules::torso();
    let nearest = draped.positions.iter().map(|p| solid.distance(p).0).fold(f64::INFINITY, f64::min);
    assert!(nearest > 1.4e-3, "{nearest}");
    let top = draped.positions.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
    assert!(top > 1.42, "it slid off: {top}");
}

#[test]
fn cloth_in_the_air_falls_until_the_time_is_over_and_says_so() {
    let (g, _) = hanging(0.1, 0.1, 0.02, &plain(500.0, 50.0, 1e-5));
    // Steps so short that no vertex gets inertia.
    let stage = SpringDraper { time_limit: 0.1, damping: 0.0, least_step: 1e-6, ..SpringDraper::default() };
    let cx = Context::quiet();
    let fallen = stage.run(&g, None, &cx).unwrap();
    assert!(!fallen.status.converged);
    let warnings = cx.take_remarks().warnings;
    assert_eq!(warnings.len(), 1);
    assert_eq!(
        warnings[0],
        "the cloth still moves by 905.9 mm/s after 0.1 s, at rest it has less than 20.0 mm/s: allow a longer motion"
    );
}

#[test]
fn a_sheet_on_a_ball_comes_to_rest_on_it() {
    let (mut g, _) = hanging(0.2, 0.2, 0.02, &plain(500.0, 30.0, 1e-5));
    for p in &mut g.positions {
        *p = Point3::new(p.x - 0.1, 0.105, -p.y - 0.1);
    }
    let body = Capsules::new(&[([0.0; 3], [0.0; 3], 0.1)]);
    let draped = SpringDraper::default().run(&g, Some(&body.clone().collider()), &Context::quiet()).unwrap();
    assert!(draped.status.converged, "{:?}", draped.status);
    let nearest = draped.positions.iter().map(|p| body.distance(p).0).fold(f64::INFINITY, f64::min);
    assert!((nearest - 1.5e-3).abs() < 2e-4, "{nearest}");
    let lowest = draped.positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    assert!(lowest < 0.06 && lowest > -0.1, "its corners hang: {lowest}");
}

#[test]
fn rest_tells_what_force_is_left_and_how_often_it_began_again() {
    let cx = Context::quiet();
    let body = Capsules::torso().collider();
    let strict = StaticEquilibrium { speed: 1e-3, non_static: 0.0, ..StaticEquilibrium::default() };
    let draped = strict.run(&vest(&plain(6000.0, 80.0, 1e-5)), Some(&body), None, &cx).unwrap();
    assert!(draped.status.converged);
    let figures = cx.take_figures();
    let told: Vec<(&str, &str)> = figures.iter().map(|f| (f.name.as_str(), f.unit)).collect();
    assert_eq!(told, [("residual", "N"), ("non_static", ""), ("restarts", "")]);
    assert!(figures[0].value > 0.0 && figures[0].value < 0.1, "{figures:?}");
    assert_eq!(figures[1].value, 0.0, "no vertex may still move");
    assert!(figures[2].value.fract() == 0.0, "{figures:?}");
}

#[test]
fn a_bad_garment_is_refused() {
    let (mut g, _) = hanging(0.1, 0.1, 0.02, &plain(500.0, 50.0, 1e-5));
    g.triangles.clear();
    let e = SpringDraper::default().run(&g, None, &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "the garment is empty: it has no triangles");
}
