use super::*;
use crate::shapes::{bump, surface};
use proptest::prelude::*;

/// Gradient and exact Hessian against differences of the value; the projected one has no negative
/// eigenvalues.
fn check_derivatives(energy: &dyn EnergyDensity, j: Matrix2<f64>) {
    let d = energy.derivatives(0, &j, Hessian::Projected);
    let exact = energy.derivatives(0, &j, Hessian::Exact);
    assert_eq!((d.value, d.gradient), (exact.value, exact.gradient));
    let at = |v: &Vector4<f64>| Matrix2::new(v[0], v[1], v[2], v[3]);
    let h = 1e-5;
    assert!((d.value - energy.value(0, &j)).abs() <= 1e-12 * (1.0 + d.value.abs()));
    for k in 0..4 {
        let mut step = Vector4::zeros();
        step[k] = h;
        let (up, down) = (j + at(&step), j - at(&step));
        let slope = (energy.value(0, &up) - energy.value(0, &down)) / (2.0 * h);
        assert!((slope - d.gradient[k]).abs() < 1e-6 * (1.0 + slope.abs()), "{slope} {}", d.gradient[k]);
        let slopes = |j: &Matrix2<f64>| energy.derivatives(0, j, Hessian::Exact).gradient;
        let bend = (slopes(&up) - slopes(&down)) / (2.0 * h);
        let off = (bend - exact.hessian.column(k)).amax();
        assert!(off < 1e-5 * (1.0 + bend.amax()), "{off}");
    }
    assert!(d.hessian.symmetric_eigenvalues().min() > -1e-9 * (1.0 + d.hessian.amax()));
}

/// A map with positive determinant from angles and stretches.
fn map(a: f64, b: f64, s: f64, t: f64) -> Matrix2<f64> {
    let turn = |a: f64| nalgebra::Rotation2::new(a).into_inner();
    turn(a) * Matrix2::new(s, 0.0, 0.0, t) * turn(b)
}

#[test]
fn isometries_cost_nothing_and_flips_everything() {
    let woven = WovenEnergy::new(WovenStiffness::COTTON);
    let woven: &dyn EnergyDensity = woven.as_ref().map_or(&ArapEnergy, |w| w);
    for energy in [&SymmetricDirichletEnergy as &dyn EnergyDensity, &ArapEnergy, woven] {
        assert!(energy.value(0, &map(0.4, -1.0, 1.0, 1.0)).abs() < 1e-28);
        assert_eq!(energy.value(0, &map(0.4, -1.0, 1.0, -1.0)), f64::INFINITY);
    }
}

#[test]
fn woven_stiffness_is_the_second_derivative() {
    // 1 % of strain along the warp alone, as an energy: k/2 0.01^2, the stiffest scaled to 4.
    let woven = WovenEnergy::new(WovenStiffness { warp: 500.0, weft: 1000.0, shear: 10.0 });
    let value = woven.map(|w| w.value(0, &Matrix2::new(1.0, 0.0, 0.0, 1.0 / 1.01)));
    assert!(value.is_ok_and(|v| (v / (2.0 / 2.0 * 0.0001) - 1.0).abs() < 0.02));
}

#[test]
fn stiffnesses_out_of_range_are_refused() {
    let error = |warp, shear| {
        WovenEnergy::new(WovenStiffness { warp, weft: 1.0, shear })
            .map_or_else(|e| e.to_string(), |_| String::new())
    };
    let range = "stiffnesses are above zero and within a factor of 1000000 of each other";
    assert_eq!(error(0.0, 1.0), format!("warp = 0 is out of range: {range}"));
    assert_eq!(error(f64::NAN, 1.0), format!("warp = NaN is out of range: {range}"));
    assert_eq!(error(1.0, 1e-7), format!("shear = 0.0000001 is out of range: {range}"));
}

proptest! {
    #[test]
    fn derivatives_are_those_of_the_value(a in -3.0..3.0f64, b in -3.0..3.0f64, s in 0.6..1.7f64, t in 0.6..1.7f64) {
        let j = map(a, b, s, t);
        check_derivatives(&SymmetricDirichletEnergy, j);
        check_derivatives(&ArapEnergy, j);
        let springs = SpringEnergy::new(&surface(bump(1, 1, 0.3)));
        check_derivatives(&springs, j);
        if let Ok(woven) = WovenEnergy::new(WovenStiffness { warp: 3.0, weft: 2.0, shear: 0.5 }) {
            check_derivatives(&woven, j);
        }
    }

    #[test]
    fn singular_values_are_those_of_the_map(a in -3.0..3.0f64, b in -3.0..3.0f64, s in 0.1..3.0f64, t in -3.0..3.0f64) {
        let found = singular_values(&map(a, b, s, t));
        let (most, least) = (s.max(t.abs()), s.min(t.abs()) * t.signum());
        prop_assert!((found.x - most).abs() < 1e-12 && (found.y - least).abs() < 1e-12);
    }
}
