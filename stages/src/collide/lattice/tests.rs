#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::testing::{numbers, sphere};
use super::*;
use toile_core::Cancel;

/// The distance to a ball of radius 1/2, where it is within `bound`.
fn to_ball(p: &Point3, bound: f64) -> Option<f64> {
    Some(p.coords.norm() - 0.5).filter(|d| d.abs() <= bound)
}

#[test]
fn its_bounds_hold_and_are_not_loose() {
    let ball = sphere(0.5, 16, 16);
    let lattice = Lattice::build(&ball.positions, &Context::quiet(), to_ball).unwrap();
    assert!(lattice.distances.iter().all(|d| d.is_finite()));
    let mut next = numbers(1);
    for _ in 0..2000 {
        let p = Point3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 1.2;
        let (least, most) = lattice.bounds(&p).unwrap();
        let exact = p.coords.norm() - 0.5;
        assert!(least <= exact && exact <= most, "{p} {least} {exact} {most}");
        assert!(most == f64::INFINITY || most - least < 4.0 * lattice.cell);
    }
}

#[test]
fn a_flat_or_thin_body_does_not_ask_for_endless_cells() {
    let thin = [Point3::origin(), Point3::new(1000.0, 1e-9, 0.0)];
    let lattice = Lattice::build(&thin, &Context::quiet(), |_, _| Some(1.0)).unwrap();
    assert!(lattice.distances.len() <= MOST_ALONG_AXIS);
}

#[test]
fn points_that_are_no_number_have_no_bounds() {
    let lattice = Lattice::build(&sphere(0.5, 8, 8).positions, &Context::quiet(), to_ball).unwrap();
    assert_eq!(lattice.bounds(&Point3::new(f64::NAN, 0.0, 0.0)), None);
    assert_eq!(lattice.bounds(&Point3::new(0.0, f64::INFINITY, 0.0)), None);
}

#[test]
fn stops_when_asked() {
    let cancel = Cancel::new();
    cancel.cancel();
    let cx = Context::new("test", std::path::Path::new("."), cancel, std::sync::Arc::new(()));
    let error = Lattice::build(&sphere(0.5, 8, 8).positions, &cx, to_ball).unwrap_err();
    assert_eq!(error.message, "stopped on request");
}
