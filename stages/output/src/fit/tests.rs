//! Fit on shapes whose figures are known exactly.
#![allow(clippy::unwrap_used)]

use super::load::ClothLoad;
use super::openings::{finished, openings};
use super::*;
use std::f64::consts::TAU;
use std::sync::Arc;
use toile_fixtures::cloth::{Capsules, ClothGrid, garment, plain};

const COLUMNS: usize = 240;
const STIFFNESS: f64 = 500.0;

/// Around a tube as its mesh has it.
fn polygon(radius: f64) -> f64 {
    2.0 * COLUMNS as f64 * radius * (TAU / 2.0 / COLUMNS as f64).sin()
}

/// A tube around the y axis, of that radius, sewn of cloth that is shorter by `strain`; 40 cm high,
/// without weight.
fn tube(radius: f64, strain: f64) -> Garment {
    let around = polygon(radius) / (1.0 + strain);
    let grid =
        ClothGrid { columns: COLUMNS, rows: 12, flat: Point2::new, lift: |p| Point3::new(p.x, p.y, 0.0) };
    let fabric = Arc::new(Fabric { area_density: 1e-9, ..(*plain(STIFFNESS, 50.0, 0.0)).clone() });
    let mut tube = garment(&[("tube", &grid)], &fabric);
    for (p, flat) in tube.positions.iter_mut().zip(&mut tube.rest) {
        let angle = TAU * flat.x;
        *flat = Point2::new(around * flat.x, 0.4 * flat.y);
        *p = Point3::new(radius * angle.cos(), flat.y + 0.8, radius * angle.sin());
    }
    (0..=12).for_each(|row| tube.weld[grid.at(COLUMNS, row) as usize] = grid.at(0, row));
    tube
}

fn cylinder(radius: f64) -> Collider {
    Capsules::new(&[([0.0, -5.0, 0.0], [0.0, 5.0, 0.0], radius - 5e-4)]).collider()
}

#[test]
fn a_tube_around_a_cylinder_presses_with_tension_over_radius() {
    for (radius, strain) in [(0.15, 0.02), (0.05, 0.1), (0.3, 0.004)] {
        let tube = tube(radius, strain);
        let load = ClothLoad::of(&tube, Some(&cylinder(radius)), &Context::quiet()).unwrap();
        let hoop = load.strain[COLUMNS][1];
        assert!((hoop / strain - 1.0).abs() < 0.01, "strain {hoop} of {strain}");
        let tension = load.tension[COLUMNS][1];
        assert!((tension / (STIFFNESS * strain) - 1.0).abs() < 0.01, "tension {tension}");
        let exact = STIFFNESS * strain / radius;
        for pressure in load.pressure.iter().map(|p| p.unwrap()) {
            assert!((pressure / exact - 1.0).abs() < 0.01, "pressure {pressure} of {exact}");
        }
    }
}

#[test]
fn cloth_off_the_body_has_no_pressure() {
    let load = ClothLoad::of(&tube(0.15, 0.02), Some(&cylinder(0.1)), &Context::quiet()).unwrap();
    assert!(load.pressure.iter().all(Option::is_none));
}

#[test]
fn a_tube_has_two_openings_and_its_height_is_its_length() {
    let tube = tube(0.15, 0.0);
    let open = openings(&tube);
    let lengths: Vec<f64> = open.iter().map(|o| o.length).collect();
    assert!(
        lengths.len() == 2 && lengths.iter().all(|l| (l / (polygon(0.15)) - 1.0).abs() < 1e-9),
        "{lengths:?}"
    );
    let measures = finished(&tube, None, &open);
    assert_eq!(measures.keys().collect::<Vec<_>>(), ["hem", "length", "opening"]);
    assert!((measures["length"] - 0.4).abs() < 1e-9, "{measures:?}");
}

#[test]
fn a_tight_garment_is_told_and_written_with_its_maps() {
    let tube = tube(0.15, 0.05);
    let cx = Context::quiet();
    let fit = Fit { comfort: 0.1, pictures: 64, ..Fit::default() };
    let files = fit.run(&tube, Some(&cylinder(0.15)), None, None, &cx).unwrap();
    let names: Vec<&str> = files.0.iter().map(|f| f.path.as_str()).collect();
    let wanted = [
        "fit.json",
        "fit_warp_strain.svg",
        "fit_weft_strain.svg",
        "fit_warp_tension.svg",
        "fit_weft_tension.svg",
        "fit_pressure.svg",
    ];
    assert_eq!(names, wanted);
    let json: Value = serde_json::from_slice(&files.0[0].bytes).unwrap();
    assert_eq!(json["pressure"]["too_tight"][0]["place"], "body");
    let told = cx.take_remarks().warnings;
    assert!(told[0].starts_with("it is tight at the body: up to 0.2 kPa on 3770 cm2"), "{told:?}");
}

#[test]
fn every_sentence_of_a_loose_garment_is_left_out() {
    let cx = Context::quiet();
    let files = Fit { pictures: 0, ..Fit::default() }
        .run(&tube(0.15, 0.05), Some(&cylinder(0.15)), None, None, &cx)
        .unwrap();
    assert_eq!((files.0.len(), cx.take_remarks().warnings.len()), (1, 0));
}
