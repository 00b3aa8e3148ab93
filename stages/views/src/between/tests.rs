//! Views between views of a scene that is known.
#![allow(clippy::unwrap_used)]

use super::*;
use crate::picture::psnr;
use image::{Rgb, RgbImage};
use std::collections::BTreeMap;
use toile_core::prelude::*;
use toile_core::testkit;

mod contracts_of_flow {
    use crate::between::FlowView;
    toile_core::contracts!(FlowView);
}
mod contracts_of_depth {
    use crate::between::DepthView;
    toile_core::contracts!(DepthView);
}
mod contracts_of_rays {
    use crate::between::LightField;
    toile_core::contracts!(LightField);
}

/// Detail of a surface at a place, some units wide.
fn print(x: f64, y: f64, seed: f64) -> [u8; 3] {
    let wave = |a: f64, b: f64, c: f64| (a * x + b * y + c * seed).sin();
    let level = 128.0 + 40.0 * wave(31.0, 7.0, 1.0) * wave(-5.0, 23.0, 2.0) + 45.0 * wave(11.0, -13.0, 3.0);
    [level, 0.8 * level + 20.0 * wave(3.0, 17.0, 4.0), 200.0 - 0.5 * level].map(|v| v.clamp(0.0, 255.0) as u8)
}

const FOCAL: f64 = 260.0;
const SIZE: [u32; 2] = [180, 160];

/// A ball on the axis before a wall, seen from an angle around the axis at distance 1.
fn around(angle: f64) -> RgbImage {
    let (sin, cos) = angle.sin_cos();
    RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let rx = (f64::from(x) - f64::from(SIZE[0] - 1) / 2.0) / FOCAL;
        let ry = (f64::from(y) - f64::from(SIZE[1] - 1) / 2.0) / FOCAL;
        let from = [sin, 0.0, -cos];
        let d = [rx * cos - sin, ry, rx * sin + cos];
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (a, b, c) = (dot(d, d), dot(from, d), dot(from, from) - 0.18 * 0.18);
        let disc = b * b - a * c;
        if disc > 0.0 {
            let t = (-b - disc.sqrt()) / a;
            let p = [0, 1, 2].map(|k| from[k] + t * d[k]);
            return Rgb(print(p[0].atan2(-p[2]), p[1] * 5.0, 1.0));
        }
        let t = (0.5 - from[2]) / d[2];
        Rgb(print(2.0 * (from[0] + t * d[0]), 2.0 * t * d[1], 5.0))
    })
}

fn set<'a>(photos: impl IntoIterator<Item = (&'a str, RgbImage)>) -> Set<Photo> {
    photos.into_iter().map(|(n, p)| (n.to_owned(), testkit::shapes::photo_from(p))).collect()
}

fn params<T: serde::de::DeserializeOwned>(text: &str) -> T {
    toile_core::param::ron_options().from_str(text).unwrap()
}

fn pixels(made: &Set<Photo>) -> &RgbImage {
    made.get("view").unwrap().pixels.as_ref()
}

const TURN: f64 = 8.0;

fn two() -> Set<Photo> {
    set([("1", around(0.0)), ("2", around(TURN.to_radians()))])
}

fn score(made: &Set<Photo>, truth: &RgbImage) -> f64 {
    // What leaves the frame is seen by one photo alone; the middle is judged.
    psnr(pixels(made), truth, |x, _| (20..SIZE[0] - 20).contains(&x)).unwrap()
}

/// The two photos blended, nothing moved.
fn faded() -> f64 {
    let (a, b) = (around(0.0), around(TURN.to_radians()));
    let mean = |x: u32, y: u32| {
        let (a, b) = (a.get_pixel(x, y).0, b.get_pixel(x, y).0);
        Rgb([0, 1, 2].map(|c| a[c].midpoint(b[c])))
    };
    let truth = around(TURN.to_radians() / 2.0);
    psnr(&RgbImage::from_fn(SIZE[0], SIZE[1], mean), &truth, |x, _| (20..SIZE[0] - 20).contains(&x)).unwrap()
}

#[test]
fn the_view_between_two_photos_is_nearer_to_the_truth_than_their_blend() {
    let cx = Context::quiet();
    let truth = around(TURN.to_radians() / 2.0);
    let by_flow = score(&FlowView::default().run(two(), &cx).unwrap(), &truth);
    let by_depth: DepthView = params(&format!("(turn: {TURN}, lens: Pixels({FOCAL}))"));
    let by_depth = score(&by_depth.run(two(), &cx).unwrap(), &truth);
    assert!(by_flow > faded() + 6.0, "{by_flow} dB, {} dB faded", faded());
    assert!(by_depth > faded() + 8.0, "{by_depth} dB, {} dB faded", faded());
}

#[test]
fn at_the_ends_the_view_is_the_photo() {
    for (at, angle) in [(0.0, 0.0), (1.0, TURN.to_radians())] {
        let flow: FlowView = params(&format!("(at: {at:?})"));
        let made = flow.run(two(), &Context::quiet()).unwrap();
        assert!(score(&made, &around(angle)) > 40.0, "{at}: {}", score(&made, &around(angle)));
        let depth: DepthView = params(&format!("(turn: {TURN}, lens: Pixels({FOCAL}), at: {at:?})"));
        let made = depth.run(two(), &Context::quiet()).unwrap();
        assert!(score(&made, &around(angle)) > 32.0, "{at}: {}", score(&made, &around(angle)));
    }
}

/// A plane at a distance of 2 seen by a camera moved so far across and down.
fn parallel(s: f64, t: f64) -> RgbImage {
    RgbImage::from_fn(90, 70, |x, y| {
        Rgb(print((f64::from(x) + 2.5 * s) / 40.0, (f64::from(y) + 2.5 * t) / 40.0, 2.0))
    })
}

fn grid(columns: u32, rows: u32) -> BTreeMap<String, RgbImage> {
    let names = (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c)));
    names.map(|(r, c)| (format!("r{}c{}", r + 1, c + 1), parallel(f64::from(c), f64::from(r)))).collect()
}

fn rays(text: &str, photos: BTreeMap<String, RgbImage>) -> Result<Set<Photo>, StageError> {
    let stage: LightField = params(text);
    let photos = photos.into_iter().map(|(n, p)| (n, testkit::shapes::photo_from(p))).collect();
    stage.run(photos, &Context::quiet())
}

#[test]
fn a_plane_in_focus_is_sharp_from_between_the_photos_and_more_photos_are_better() {
    let inner = |made: &Set<Photo>, truth: &RgbImage| {
        psnr(pixels(made), truth, |x, y| (12..78).contains(&x) && (12..58).contains(&y)).unwrap()
    };
    let truth = parallel(4.0 * 0.3, 4.0 * 0.6);
    let sharp = rays("(across: 0.3, down: 0.6, focus: 2.5)", grid(5, 5)).unwrap();
    assert!(inner(&sharp, &truth) > 38.0, "{}", inner(&sharp, &truth));
    let dull = |every: usize| {
        let text = format!("(across: 0.3, down: 0.6, every: {every})");
        inner(&rays(&text, grid(5, 5)).unwrap(), &truth)
    };
    assert!(dull(1) > dull(2) + 2.0 && dull(2) > dull(4), "{} {} {}", dull(1), dull(2), dull(4));
    // At a photo's own place it is that photo.
    let own = rays("(across: 0.25, down: 0.5)", grid(5, 5)).unwrap();
    assert_eq!(pixels(&own), &parallel(1.0, 2.0));
    // With a sharp plane, the grid's steps do not matter.
    let few = rays("(across: 0.3, down: 0.6, focus: 2.5, every: 2)", grid(5, 5)).unwrap();
    assert!(inner(&few, &truth) > 38.0, "{}", inner(&few, &truth));
}

#[test]
fn photos_that_make_no_view_are_refused_with_what_to_do() {
    let cx = Context::quiet();
    let flow = |photos: Set<Photo>| FlowView::default().run(photos, &cx).unwrap_err();
    let small = || RgbImage::new(40, 40);
    let error = flow(set([("1", small())]));
    assert_eq!(error.message, "a view between two photos needs two, and there is 1");
    assert_eq!(
        error.hint.as_deref(),
        Some("give two entries of `photos`, the left one first in the order of their names")
    );
    let error = flow(set([("1", small()), ("2", RgbImage::new(40, 41))]));
    assert_eq!(error.message, "photo \"2\" is 40 x 41 px, and photo \"1\" 40 x 40 px");
    let error = flow(set([("1", RgbImage::new(9, 40)), ("2", RgbImage::new(9, 40))]));
    assert_eq!(error.message, "the photos are 9 x 40 px, too small for a view between them");

    let stage: DepthView = params("(turn: 5, lens: Estimate)");
    let error = stage.run(set([("1", small()), ("2", small())]), &cx).unwrap_err();
    assert_eq!(error.message, "two photos around an object do not tell the focal length");
    assert_eq!(error.param, Some("lens"));

    let named = |names: &[&str]| names.iter().map(|n| ((*n).to_owned(), small())).collect();
    let error = rays("()", named(&["r1c1", "back"])).unwrap_err();
    assert_eq!(error.message, "photo \"back\" does not tell its row and column");
    let error = rays("()", named(&["r1c1", "r1c2", "r2c1"])).unwrap_err();
    assert_eq!(error.message, "the grid of 2 x 2 photos has none, or more than one, in row 2 and column 2");
    let error = rays("()", named(&["r1c1"])).unwrap_err();
    assert_eq!(error.message, "a light field needs two photos or more, and there is 1");
}

#[test]
fn photos_without_detail_make_a_view_and_no_panic() {
    let blank = |c: u8| RgbImage::from_pixel(50, 40, Rgb([c; 3]));
    let photos = || set([("1", blank(10)), ("2", blank(200))]);
    let made = FlowView::default().run(photos(), &Context::quiet()).unwrap();
    assert_eq!(pixels(&made).dimensions(), (50, 40));
    let depth: DepthView = params("(turn: -60)");
    assert_eq!(pixels(&depth.run(photos(), &Context::quiet()).unwrap()).dimensions(), (50, 40));
}
