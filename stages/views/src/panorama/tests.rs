//! Panoramas of a scene that is known.
#![allow(clippy::unwrap_used)]

use super::camera::CylinderCamera;
use super::*;
use crate::picture::psnr;
use image::{Rgb, RgbImage};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use toile_core::prelude::*;
use toile_core::testkit;

toile_core::contracts!(Cylinder);

/// A number in 0 to 1 of a lattice point.
fn hash(x: i64, y: i64, z: i64) -> f64 {
    let mut h = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)
        ^ (y as u64).wrapping_mul(0xD1B5_4A32_D192_ED03)
        ^ (z as u64).wrapping_mul(0xABC9_8388_FB8F_AC03);
    h = (h ^ (h >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((h ^ (h >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Smooth noise in space, 0 to 1.
fn smooth(p: [f64; 3]) -> f64 {
    let cell = p.map(f64::floor);
    let t = [0, 1, 2].map(|c| {
        let t = p[c] - cell[c];
        t * t * (3.0 - 2.0 * t)
    });
    let corner = |k: usize| {
        let at = |c: usize| cell[c] as i64 + (k >> c & 1) as i64;
        let weight = |c: usize| if k >> c & 1 == 1 { t[c] } else { 1.0 - t[c] };
        weight(0) * weight(1) * weight(2) * hash(at(0), at(1), at(2))
    };
    (0..8).map(corner).sum()
}

/// Smooth detail of a plane, some pixels wide, grey levels 0 to 200.
pub(in crate::panorama) fn noise(x: f64, y: f64) -> f32 {
    (120.0 * smooth([x / 9.0, y / 9.0, 0.5]) + 80.0 * smooth([x / 4.0, y / 4.0, 7.5])) as f32
}

/// What is seen in a direction around the camera.
fn scene(d: [f64; 3]) -> [u8; 3] {
    let n = d.iter().map(|v| v * v).sum::<f64>().sqrt();
    let at = |s: f64, k: f64| smooth(d.map(|v| s * v / n + k));
    let level = 40.0 + 110.0 * at(9.0, 3.3) + 60.0 * at(26.0, 9.1);
    [level, level * (0.6 + 0.4 * at(5.0, 21.0)), level * (0.6 + 0.4 * at(7.0, 33.0))].map(|v| v.round() as u8)
}

/// A photo by a camera that looks in a direction around the axis.
fn photo(camera: CylinderCamera, angle: f64) -> RgbImage {
    let [w, h] = camera.size.map(|n| n as u32);
    RgbImage::from_fn(w, h, |x, y| {
        let (x, y) = (f64::from(x) - camera.centre[0], f64::from(y) - camera.centre[1]);
        let (sin, cos) = angle.sin_cos();
        let [u, v] = [x / camera.focal, y / camera.focal];
        Rgb(scene([cos * u + sin, -v, cos - sin * u]))
    })
}

/// What the panorama of a whole turn should be: its middle is the direction 0.
fn truth(focal: f64, width: u32, rows: std::ops::Range<f64>) -> RgbImage {
    let height = (rows.end - rows.start).round() as u32;
    RgbImage::from_fn(width, height, |x, y| {
        let angle = TAU * f64::from(x) / f64::from(width) - PI;
        Rgb(scene([angle.sin(), -(rows.start + f64::from(y)) / focal, angle.cos()]))
    })
}

fn set(photos: impl IntoIterator<Item = RgbImage>) -> Set<Photo> {
    photos
        .into_iter()
        .enumerate()
        .map(|(k, p)| ((k + 1).to_string(), testkit::shapes::photo_from(p)))
        .collect()
}

/// The panorama and the stage's figures.
fn made(stage: &Cylinder, photos: Set<Photo>) -> Result<(Photo, BTreeMap<String, f64>), StageError> {
    let cx = Context::quiet();
    let set = stage.run(photos, &cx)?;
    let figures = cx.take_figures().into_iter().map(|m| (m.name, m.value)).collect();
    Ok((set.get("panorama").unwrap().clone(), figures))
}

fn stage(text: &str) -> Cylinder {
    toile_core::param::ron_options().from_str(text).unwrap()
}

fn refused(photos: Set<Photo>) -> (String, String) {
    let error = made(&stage("()"), photos).unwrap_err();
    (error.message, error.hint.unwrap_or_default())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn turns_are_found_within_half_a_pixel(angles in prop::collection::vec(8.0f64..26.0, 3), view in 40.0f64..75.0) {
        let focal = 100.0 / (view.to_radians() / 2.0).tan();
        let camera = CylinderCamera::new(focal, [200, 150]);
        let mut at = 0.0;
        let photos: Vec<RgbImage> = std::iter::once(0.0).chain(angles.iter().map(|a| { at += a.to_radians(); at }))
            .map(|a| photo(camera, a)).collect();
        let stage = stage(&format!("(lens: Pixels({focal}), turn: Part)"));
        let (_, figures) = made(&stage, set(photos)).unwrap();
        for (k, angle) in angles.iter().enumerate() {
            let off = figures[&format!("shift_x.{}", k + 2)] - focal * angle.to_radians();
            prop_assert!(off.abs() < 0.15, "photo {}: off by {off} px", k + 2);
            let down = figures[&format!("shift_y.{}", k + 2)];
            prop_assert!(down.abs() < 0.15, "photo {}: {down} px down", k + 2);
        }
    }
}

/// Ten photos all around, some turned farther than others.
fn around(camera: CylinderCamera) -> Vec<RgbImage> {
    (0..10).map(|k| photo(camera, TAU * (f64::from(k) + 0.2 * f64::from(k % 3)) / 10.0)).collect()
}

#[test]
fn a_whole_turn_closes_and_tells_the_focal_length() {
    let focal = 210.0;
    let camera = CylinderCamera::new(focal, [240, 180]);
    for (blend, lens) in [("Feather", "Estimate"), ("Multiband", "Pixels(210)")] {
        let (panorama, figures) =
            made(&stage(&format!("(blend: {blend}, lens: {lens})")), set(around(camera))).unwrap();
        assert!((figures["focal_px"] / focal - 1.0).abs() < 0.003, "{figures:?}");
        assert!(figures["gap_x"].abs() < 0.5 && figures["gap_y"].abs() < 0.5, "{figures:?}");
        let (w, h) = panorama.pixels.dimensions();
        assert!((f64::from(w) - TAU * focal).abs() < 4.0, "{w}");
        let half = f64::from(h - 1) / 2.0;
        let truth = truth(figures["focal_px"], w, -half..half + 1.0);
        let psnr = psnr(&panorama.pixels, &truth, |_, _| true).unwrap();
        assert!(psnr > 36.0, "{blend}: {psnr} dB");
    }
}

#[test]
fn photos_of_other_exposure_become_equally_bright() {
    let camera = CylinderCamera::new(210.0, [240, 180]);
    let photos: Vec<RgbImage> = (0..3)
        .map(|k| {
            let mut p = photo(camera, 0.35 * f64::from(k));
            let gain = [1.0, 0.8, 1.0][k as usize];
            p.iter_mut().for_each(|v| *v = (f64::from(*v) * gain).round() as u8);
            p
        })
        .collect();
    let text = |exposure: bool| format!("(lens: Pixels(210), blend: Feather, exposure: {exposure})");
    let overlap = |exposure| made(&stage(&text(exposure)), set(photos.clone())).unwrap().1["overlap_psnr"];
    assert!(overlap(true) > overlap(false) + 6.0, "{} {}", overlap(true), overlap(false));
}

#[test]
fn photos_from_right_to_left_and_mirrored_ones_are_the_same_panorama() {
    let camera = CylinderCamera::new(210.0, [240, 180]);
    let photos: Vec<RgbImage> = (0..3).map(|k| photo(camera, 0.4 * f64::from(k))).collect();
    let stage = stage("(lens: Pixels(210))");
    let forwards = made(&stage, set(photos.clone())).unwrap().0.pixels;
    let backwards = made(&stage, set(photos.iter().rev().cloned())).unwrap().0.pixels;
    assert_eq!(forwards.dimensions(), backwards.dimensions());
    assert!(psnr(&forwards, &backwards, |_, _| true).unwrap() > 40.0);
    let mirrors: Set<Photo> = photos
        .iter()
        .enumerate()
        .map(|(k, p)| {
            let mirror = testkit::shapes::photo_from(image::imageops::flip_horizontal(p));
            (k.to_string(), Photo { mirrored: true, ..mirror })
        })
        .collect();
    assert_eq!(made(&stage, mirrors).unwrap().0.pixels.as_raw(), forwards.as_raw());
}

#[test]
fn rows_that_are_not_filled_are_cut_or_transparent() {
    let camera = CylinderCamera::new(210.0, [240, 180]);
    let photos = || set((0..2).map(|k| photo(camera, 0.4 * f64::from(k))));
    let (cut, _) = made(&stage("(lens: Pixels(210))"), photos()).unwrap();
    assert!(
        cut.alpha.is_none() && (150..160).contains(&cut.pixels.height()),
        "{:?}",
        cut.pixels.dimensions()
    );
    let (whole, _) = made(&stage("(lens: Pixels(210), crop: false)"), photos()).unwrap();
    assert_eq!(whole.pixels.height(), 180);
    let alpha = whole.alpha.unwrap();
    assert_eq!((alpha.get_pixel(0, 0).0, alpha.get_pixel(100, 90).0), ([0], [255]));
}

#[test]
fn photos_that_make_no_panorama_are_refused_with_what_to_do() {
    let camera = CylinderCamera::new(210.0, [240, 180]);
    let order = "add the other photos of the turn to `photos`, named in their order: \"01\", \"02\"";
    let (message, hint) = refused(set([]));
    assert_eq!(
        (message.as_str(), hint.as_str()),
        ("a panorama needs two photos or more, and there are none", order)
    );
    let (message, hint) = refused(set([photo(camera, 0.0)]));
    assert_eq!(
        (message.as_str(), hint.as_str()),
        ("a panorama needs two photos or more, and there is 1", order)
    );

    let (message, hint) = refused(set([photo(camera, 0.0), photo(camera, 2.0)]));
    assert_eq!(message, "photo \"2\" shows nothing that photo \"1\" shows");
    assert_eq!(
        hint,
        "photos follow each other in the order of their names: turn the camera by at most two thirds of what a photo shows, \
         and leave out photos without detail"
    );
    let blank = || RgbImage::from_pixel(240, 180, Rgb([120; 3]));
    assert_eq!(refused(set([blank(), blank()])).0, "photo \"2\" shows nothing that photo \"1\" shows");

    let (message, hint) = refused(set([photo(camera, 0.0), RgbImage::new(180, 240)]));
    assert_eq!(message, "photo \"2\" is 180 x 240 px, and photo \"1\" 240 x 180 px");
    assert_eq!(
        hint,
        "a panorama is made of uncut photos of one camera, all upright or all across; give photos of one size"
    );
    let (message, hint) = refused(set([RgbImage::new(90, 20), RgbImage::new(90, 20)]));
    assert_eq!(message, "the photos are 90 x 20 px, too small to be registered");
    assert_eq!(hint, "give photos of at least 48 px a side");

    let (message, hint) = refused(set((0..101).map(|_| RgbImage::new(60, 60))));
    assert_eq!(message, "a panorama takes at most 100 photos, and there are 101");
    assert_eq!(hint, "leave out every second one: a third of overlap is enough");
}

#[test]
fn a_turn_that_does_not_close_is_refused_where_a_whole_one_is_asked_for() {
    let camera = CylinderCamera::new(210.0, [240, 180]);
    let photos = set((0..3).map(|k| photo(camera, 0.4 * f64::from(k))));
    let error = made(&stage("(lens: Pixels(210), turn: Whole)"), photos).unwrap_err();
    assert_eq!(error.message, "the photos turn by 46 degrees, and the last does not fit onto the first");
    assert_eq!(
        error.hint.as_deref(),
        Some(
            "photograph on until the first view comes back, or set `turn: Part`; a wrong `lens` gives a wrong turn"
        )
    );
    assert_eq!(error.param, Some("turn"));
}

#[test]
fn a_focal_length_of_less_than_a_turn_is_found_within_some_per_cent() {
    let camera = CylinderCamera::new(210.0, [240, 180]);
    let photos = set((0..4).map(|k| photo(camera, 0.4 * f64::from(k))));
    let (_, figures) = made(&stage("()"), photos).unwrap();
    assert!((figures["focal_px"] / 210.0 - 1.0).abs() < 0.05, "{}", figures["focal_px"]);
}
