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

#[test]
fn kes_sheet_keeps_extension_work_and_units() {
    let kes = Kes {
        emt: [4.0, 10.0],
        lt: [0.7, 0.8],
        g: 1.0,
        b: [0.1, 0.05],
        hb: [0.08, 0.04],
        weight: 20.0,
        thickness: 0.5,
        miu: 0.2,
    };
    let f = kes.fabric().unwrap();
    assert!((f.warp.force(0.04) - kes::TENSILE_LOAD).abs() < 1e-9);
    assert!((f.weft.energy(0.10) - 0.8 * 0.5 * 0.10 * kes::TENSILE_LOAD).abs() < 1e-9);
    assert!(
        (f.bending_friction_warp - 3.92e-4).abs() < 1e-6 && (f.bending_friction_weft - 1.96e-4).abs() < 1e-6
    );
    assert!((f.shear.slope(0.0) - 56.19).abs() < 0.01);
    assert!((f.bending_warp - 9.80665e-6).abs() < 1e-15);
    assert!((f.density - 0.2).abs() < 1e-15);
    let bad = Kes { emt: [0.0, 1.0], ..kes }.fabric().unwrap_err();
    assert_eq!(bad.to_string(), "EMT = 0 is out of range: above 0 percent");
}

#[test]
fn presets_are_valid() {
    for preset in PRESETS {
        preset.fabric().check().unwrap();
    }
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
