#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use crate::shapes::{numbers, sphere};

/// The distance to a ball of radius 1/2, where it is within `bound`.
fn to_ball(p: &Vec3, bound: f64) -> Option<f64> {
    Some(p.norm() - 0.5).filter(|d| d.abs() <= bound)
}

fn filled(points: &[Vec3], distance: impl Fn(&Vec3, f64) -> Option<f64> + Sync) -> DistanceLattice {
    let lattice = DistanceLattice::around(points);
    lattice.fill(|| Ok::<(), ()>(()), distance).unwrap();
    lattice
}

/// Cells that have a distance.
fn known(lattice: &DistanceLattice) -> usize {
    let distance = |d: &AtomicU64| f64::from_bits(d.load(Ordering::Relaxed));
    lattice.distances.iter().filter(|d| distance(d).is_finite()).count()
}

#[test]
fn cells_are_filled_where_they_are_asked_for_and_bound_alike() {
    let ball = sphere(0.5, 16, 16);
    let (ahead, asked) = (filled(&ball.0, to_ball), DistanceLattice::around(&ball.0));
    let mut next = numbers(2);
    for count in 1..=50 {
        let p = Vec3::new(next(), 0.1 * next(), 0.1 * next()) - Vec3::new(0.5, 0.0, 0.0);
        assert_eq!(asked.bounds(&p, to_ball), ahead.bounds(&p, to_ball));
        assert!(known(&asked) <= count);
    }
    assert!(known(&asked) > 0);
}

#[test]
fn its_bounds_hold_and_are_not_loose() {
    let ball = sphere(0.5, 16, 16);
    let lattice = filled(&ball.0, to_ball);
    assert_eq!(known(&lattice), lattice.distances.len());
    let mut next = numbers(1);
    for _ in 0..2000 {
        let p = Vec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 1.2;
        let (least, most) = lattice.bounds(&p, |_, _| None).unwrap();
        let exact = p.norm() - 0.5;
        assert!(least <= exact && exact <= most, "{p} {least} {exact} {most}");
        assert!(most == f64::INFINITY || most - least < 4.0 * lattice.cell);
    }
}

#[test]
fn a_flat_or_thin_body_does_not_ask_for_endless_cells() {
    let thin = [Vec3::zeros(), Vec3::new(1000.0, 1e-9, 0.0)];
    let lattice = DistanceLattice::around(&thin);
    assert!(lattice.distances.len() <= MOST_ALONG_AXIS);
}

#[test]
fn points_that_are_no_number_have_no_bounds() {
    let lattice = DistanceLattice::around(&sphere(0.5, 8, 8).0);
    assert_eq!(lattice.bounds(&Vec3::new(f64::NAN, 0.0, 0.0), to_ball), None);
    assert_eq!(lattice.bounds(&Vec3::new(0.0, f64::INFINITY, 0.0), to_ball), None);
}

#[test]
fn stops_when_asked() {
    let stop = || Err("stopped on request");
    let lattice = DistanceLattice::around(&sphere(0.5, 8, 8).0);
    assert_eq!(lattice.fill(stop, to_ball), Err("stopped on request"));
}
