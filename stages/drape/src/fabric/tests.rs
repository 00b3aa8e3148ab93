//! Presets lie in the ranges of their kind; measured figures come out in SI units.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::curve::{KES_FORCE, shear_curve};
use super::*;
use toile_core::prelude::*;

fn preset(text: &str) -> Result<Fabric, StageError> {
    let preset: Preset = ron_from(text);
    preset.run(&Context::quiet())
}

fn ron_from<T: serde::de::DeserializeOwned>(text: &str) -> T {
    toile_core::param::ron_options().from_str(text).unwrap()
}

#[test]
fn a_curve_ends_at_its_point_with_its_work() {
    for (strain, linearity) in [(0.03, 0.6), (0.2, 0.75), (0.05, 1.0)] {
        let curve = tensile_curve(strain, KES_FORCE, linearity);
        assert!((curve.at(strain).0 - KES_FORCE).abs() < 1e-9);
        let straight = strain * KES_FORCE / 2.0;
        assert!((curve.energy(strain) / straight - linearity).abs() < 1e-9, "{strain} {linearity}");
    }
}

#[test]
fn cloth_starts_soft() {
    let curve = tensile_curve(0.03, KES_FORCE, 0.75);
    assert!(curve.at(0.001).1 < curve.at(0.029).1);
}

#[test]
fn threads_that_jam_stiffen() {
    let curve = shear_curve(50.0);
    assert_eq!(curve.at(0.1).1, 50.0);
    assert!((curve.at(0.7).1 - 500.0).abs() < 1e-9);
}

/// (name, g/m2, secant N/m, shear N/m/rad, bending N m): handbook ranges.
type Range = [f64; 2];
#[rustfmt::skip]
const RANGES: [(&str, Range, Range, Range, Range); 12] = [
    ("cotton poplin", [100.0, 130.0], [4903.0, 24520.0], [44.95, 168.6], [4.903e-6, 1.471e-5]),
    ("denim", [370.0, 480.0], [6129.0, 24520.0], [112.4, 337.1], [4.903e-5, 1.961e-4]),
    ("wool suiting", [180.0, 280.0], [4903.0, 16340.0], [28.09, 50.57], [6.865e-6, 1.765e-5]),
    ("wool coating", [400.0, 600.0], [4086.0, 12260.0], [39.33, 84.28], [2.942e-5, 9.807e-5]),
    ("silk charmeuse", [60.0, 90.0], [8172.0, 24520.0], [11.24, 22.48], [1.471e-6, 4.903e-6]),
    ("linen", [140.0, 200.0], [8172.0, 24520.0], [33.71, 112.4], [9.807e-6, 4.903e-5]),
    ("polyester satin", [80.0, 130.0], [8172.0, 24520.0], [14.05, 33.71], [2.942e-6, 9.807e-6]),
    ("cotton jersey", [130.0, 180.0], [817.2, 4903.0], [22.48, 50.57], [9.807e-7, 3.923e-6]),
    ("interlock knit", [180.0, 260.0], [612.9, 3269.0], [22.48, 56.19], [1.961e-6, 7.845e-6]),
    ("polyester chiffon", [40.0, 80.0], [4903.0, 16340.0], [11.24, 22.48], [7.845e-7, 2.942e-6]),
    ("cotton twill", [230.0, 280.0], [6129.0, 24520.0], [84.28, 224.8], [1.471e-5, 4.903e-5]),
    ("ripstop nylon", [40.0, 70.0], [12260.0, 49030.0], [56.19, 224.8], [1.961e-6, 7.845e-6]),
];

#[test]
fn every_preset_lies_in_the_range_of_its_kind() {
    for (name, mass, secant, shear, bending) in RANGES {
        let f = preset(&format!("(name: \"{name}\")")).unwrap();
        let within = |what: &str, x: f64, [lo, hi]: [f64; 2]| {
            assert!(x >= lo && x <= hi, "{name}: {what} {x} is not in {lo}..{hi}");
        };
        within("mass", f.area_density * 1e3, mass);
        for curve in [&f.warp, &f.weft] {
            let end = curve.0[curve.0.len() - 1];
            within("secant", end.1 / end.0, secant);
        }
        within("shear", f.shear.at(0.01).1, shear);
        within("warp bending", f.bending_warp, bending);
        within("weft bending", f.bending_weft, bending);
    }
}

#[test]
fn a_preset_has_the_hysteresis_of_its_kind_where_it_is_asked_for() {
    for (name, ..) in RANGES {
        let plain = preset(&format!("(name: \"{name}\")")).unwrap();
        assert_eq!((plain.bending_friction_warp, plain.bending_friction_weft), (0.0, 0.0));
        let held = preset(&format!("(name: \"{name}\", hysteresis: true)")).unwrap();
        // 2HB / B as a KES sheet has it, 1/cm.
        let sheet = 0.02 * held.bending_friction_warp / held.bending_warp;
        assert!((0.3..=1.2).contains(&sheet), "{name} {sheet}");
        assert_eq!(held.bending_warp, plain.bending_warp);
    }
}

#[test]
fn a_preset_is_found_by_its_other_names_and_in_capitals() {
    assert_eq!(preset("(name: \"Jersey\")").unwrap().name, "cotton jersey");
}

#[test]
fn an_unknown_preset_names_the_nearest_and_all() {
    let e = preset("(name: \"coton popelin\")").unwrap_err();
    assert_eq!(e.code, ErrorCode::InvalidInput);
    assert_eq!(e.message, "there is no fabric preset \"coton popelin\"");
    assert_eq!(
        e.hint.unwrap(),
        "did you mean \"cotton poplin\"? there are: cotton poplin, cotton twill, denim, linen, wool suiting, \
         wool coating, silk charmeuse, polyester satin, polyester chiffon, ripstop nylon, cotton jersey, \
         interlock knit"
    );
}

#[test]
fn a_kes_sheet_comes_out_in_si_units() {
    let kes: Kes =
        ron_from("(weight: 20.0, emt: (5.0, 10.0), lt: 1.0, g: 1.0, b: (0.1, 0.05), hb: (0.08, 0.0))");
    let f = kes.run(&Context::quiet()).unwrap();
    assert!((f.area_density - 0.2).abs() < 1e-12);
    assert!((f.warp.at(0.01).1 - 9806.65).abs() < 1e-6);
    assert!((f.shear.at(0.01).1 - 56.188).abs() < 1e-6);
    assert!((f.bending_weft - 4.903_325e-6).abs() < 1e-12);
    // Half of 2HB, 1 gf cm/cm being 9.80665e-3 N m/m.
    assert!((f.bending_friction_warp - 3.922_66e-4).abs() < 1e-10 && f.bending_friction_weft == 0.0);
}

#[test]
fn a_cloth_keeps_its_points() {
    let cloth: Cloth = ron_from("(warp: [(0.01, 60), (0.03, 490)])");
    assert_eq!(cloth.run(&Context::quiet()).unwrap().warp, Curve(vec![(0.01, 60.0), (0.03, 490.0)]));
}

#[test]
fn a_curve_that_falls_is_refused() {
    let cloth: Cloth = ron_from("(weft: [(0.02, 60), (0.03, 50)])");
    let e = cloth.run(&Context::quiet()).unwrap_err();
    assert_eq!(e.message, "point 2 of the weft curve, (0.03, 50), does not rise above (0.02, 60)");
    assert_eq!(e.hint.as_deref(), Some("give points (strain, N/m) that rise in both, without the origin"));
    assert_eq!(e.param, Some("weft"));
}

#[test]
fn a_curve_without_points_is_refused() {
    let cloth: Cloth = ron_from("(warp: [])");
    assert_eq!(cloth.run(&Context::quiet()).unwrap_err().message, "the warp curve has no points");
}
