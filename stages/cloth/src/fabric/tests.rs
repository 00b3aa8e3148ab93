#![allow(clippy::unwrap_used)]
use proptest::prelude::*;

use super::*;

#[test]
fn curve_follows_its_points_and_both_ends() {
    let c = Curve::through(&[[0.05, 1.5], [0.10, 5.0], [0.20, 40.0]]).unwrap();
    assert!((c.force(0.075) - 3.25).abs() < 1e-12);
    assert!((c.force(0.3) - 75.0).abs() < 1e-12);
    assert!((c.force(-0.05) + 1.5).abs() < 1e-12);
    assert!((c.energy(0.10) - (0.0375 + 0.1625)).abs() < 1e-12);
    assert!((c.steepest() - 350.0).abs() < 1e-9);
}

#[test]
fn bad_curves_are_named() {
    let e = |p: &[[f64; 2]]| Curve::through(p).unwrap_err().to_string();
    assert_eq!(e(&[[0.0, 1.0]]), "curve strain = 0 is out of range: strains that rise from above 0");
    assert_eq!(e(&[[0.1, -1.0]]), "curve force = -1 is out of range: forces that rise from above 0");
    assert_eq!(
        e(&[[0.1, 1.0], [0.2, 1.0]]),
        "curve force = 1 is out of range: forces that rise from above 0",
        "a level piece has no stiffness"
    );
    assert_eq!(e(&[[f64::NAN, 1.0]]), "curve[0] is not a finite number");
}

proptest! {
    #[test]
    fn force_is_the_slope_of_energy(strain in -0.2..0.4f64) {
        let c = Curve::through(&[[0.05, 1.5], [0.10, 5.0], [0.20, 40.0]]).unwrap();
        let h = 1e-6;
        let slope = (c.energy(strain + h) - c.energy(strain - h)) / (2.0 * h);
        prop_assert!((slope - c.force(strain)).abs() < 1e-3);
    }
}
