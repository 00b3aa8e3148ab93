//! Photos through the tiny network.

use crate::kit::{given, mask_of, overlap, run, tiny};
use image::{GrayImage, Luma, Rgb, RgbImage};
use toile_core::artifact::{Photo, Shared};
use toile_core::testkit::{self, shapes};
use toile_saliency::Saliency;

/// A light square on dark ground, from 20 to 60 of 80 px.
fn square(inside: impl Fn(u32, u32) -> [u8; 3]) -> Photo {
    let on = |x: u32, y: u32| (20..60).contains(&x) && (20..60).contains(&y);
    shapes::photo_from(RgbImage::from_fn(80, 80, |x, y| Rgb(if on(x, y) { inside(x, y) } else { [20; 3] })))
}

fn is_on(mask: &toile_core::artifact::Mask, x: u32, y: u32) -> bool {
    mask.pixels.get_pixel(x, y).0[0] != 0
}

#[test]
fn a_light_garment_on_dark_ground_is_found() {
    let mask = mask_of(&testkit::photo());
    let found = overlap(&mask, &testkit::mask());
    assert!(found > 0.97, "{found}");
}

#[test]
fn the_network_takes_levels_relative_to_the_lightest() {
    let dim = square(|_, _| [90; 3]);
    assert!(is_on(&mask_of(&dim), 40, 40) && !is_on(&mask_of(&dim), 10, 10));
}

#[test]
fn channels_are_red_green_blue() {
    let mut net = tiny();
    net.constants[0].2 = vec![0.229 * 20.0, 0.0, 0.0];
    net.constants[1].2 = vec![(0.485 - 0.5) * 20.0];
    let (dir, stage) = given(&net.file());
    let on = |pixel| is_on(&run(&stage, &square(move |_, _| pixel), dir.path()).0.unwrap(), 40, 40);
    assert_eq!([[250, 20, 20], [20, 250, 20], [20, 20, 250]].map(on), [true, false, false]);
}

#[test]
fn a_print_is_no_hole() {
    let print = |x, y| if (35..45).contains(&x) && (35..45).contains(&y) { [20; 3] } else { [230; 3] };
    assert!(is_on(&mask_of(&square(print)), 40, 40));
}

#[test]
fn transparent_pixels_are_ground() {
    let photo = square(|_, _| [230; 3]);
    let alpha = GrayImage::from_fn(80, 80, |x, _| Luma([if x < 40 { 0 } else { 255 }]));
    let mask = mask_of(&Photo { alpha: Some(Shared::new(alpha)), ..photo });
    assert_eq!([30, 50].map(|x| is_on(&mask, x, 40)), [false, true]);
}

#[test]
fn a_higher_threshold_wants_more() {
    let (dir, stage) = given(&tiny().file());
    // The right half is as sure as 0.73: 20 (0.55 3 - 1.5) = 3 before the division by the lightest
    // level.
    let photo = square(|x, _| if x < 40 { [255; 3] } else { [133; 3] });
    let on = |threshold| {
        let mask = run(&Saliency { threshold, ..stage.clone() }, &photo, dir.path()).0.unwrap();
        [30, 50, 10].map(|x| is_on(&mask, x, 40))
    };
    assert_eq!(on(0.5), [true, true, false]);
    assert_eq!(on(0.95), [true, false, false]);
}

#[test]
fn where_nothing_is_seen_the_mask_is_empty_and_the_run_says_so() {
    let mut net = tiny();
    net.constants[1].2 = vec![-1000.0];
    let (dir, stage) = given(&net.file());
    let (mask, said) = run(&stage, &square(|_, _| [230; 3]), dir.path());
    assert_eq!(mask.unwrap().area_px(), 0);
    assert_eq!(said, ["the network sees nothing in \"suite.png\": its mask is empty"]);
}
