//! Where the map's border comes to lie.

use crate::kit::overlap;
use image::{GrayImage, Luma, Rgb, RgbImage};
use proptest::prelude::*;
use toile_core::artifact::{Mask, Photo};
use toile_core::testkit::shapes;
use toile_saliency::{Guide, Map, SIDE, mask};

/// A photo in halves that meet at column `edge`.
fn halves(edge: u32) -> Photo {
    let levels = |x| if x < edge { [210, 190, 40] } else { [60, 80, 160] };
    shapes::photo_from(RgbImage::from_fn(960, 640, |x, _| Rgb(levels(x))))
}

/// A map whose object ends at a share of the width, blurred over some pixels, as networks give it.
fn ramp(at: f64, blur: f64) -> Map {
    let value = |x: usize| (0.5 - ((x as f64 + 0.5) - at * SIDE as f64) / blur).clamp(0.0, 1.0) as f32;
    Map::of((0..SIDE * SIDE).map(|i| value(i % SIDE)).collect()).unwrap()
}

/// The first column off the mask, in a row.
fn end(found: &GrayImage, y: u32) -> u32 {
    (0..found.width()).find(|x| found.get_pixel(*x, y).0[0] == 0).unwrap()
}

#[test]
fn the_border_lies_on_the_photos_edge_to_the_pixel() {
    // The map's border lies six pixels of the photo beside the edge, to either side.
    for edge in [474, 486] {
        let photo = halves(edge);
        let found = mask(&ramp(0.5, 5.0), &Guide::of(&photo.pixels), &photo, 0.5);
        for y in [0, 100, 320, 639] {
            assert!(end(&found, y).abs_diff(edge) <= 1, "{} {edge}", end(&found, y));
        }
    }
}

#[test]
fn without_an_edge_the_border_stays_where_the_map_has_it() {
    let photo = shapes::photo_from(RgbImage::from_pixel(960, 640, Rgb([120; 3])));
    let found = mask(&ramp(0.25, 5.0), &Guide::of(&photo.pixels), &photo, 0.5);
    assert!(end(&found, 320).abs_diff(240) <= 1, "{}", end(&found, 320));
}

#[test]
fn a_grainy_photo_does_not_fray_the_border() {
    let grain = |x: u32, y: u32| (x * 7919 + y * 104_729) % 31;
    let level = |x, y| (if x < 480 { 170 } else { 60 } + grain(x, y)) as u8;
    let photo = shapes::photo_from(RgbImage::from_fn(960, 640, |x, y| Rgb([level(x, y); 3])));
    let found = Mask { pixels: mask(&ramp(0.5, 5.0), &Guide::of(&photo.pixels), &photo, 0.5).into() };
    let truth = GrayImage::from_fn(960, 640, |x, _| Luma([if x < 480 { 255 } else { 0 }]));
    let same = overlap(&found, &Mask { pixels: truth.into() });
    assert!(same > 0.999, "{same}");
}

#[test]
fn a_map_has_its_size_and_finite_values() {
    assert!(Map::of(vec![0.5; SIDE]).is_none());
    assert!(Map::of(vec![f32::INFINITY; SIDE * SIDE]).is_none());
}

#[test]
fn a_photo_without_pixels_has_a_mask_without_pixels() {
    let photo = shapes::photo_from(RgbImage::new(0, 5));
    assert!(mask(&ramp(0.5, 5.0), &Guide::of(&photo.pixels), &photo, 0.5).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_sure_map_keeps_its_answer_on_any_photo(w in 1u32..60, h in 1u32..60, seed in 0u32..1 << 20, on: bool) {
        let pixel = |x: u32, y: u32| [1, 3, 5].map(|k| (x.wrapping_mul(k * 7919) ^ y.wrapping_mul(seed + k)) as u8);
        let photo = shapes::photo_from(RgbImage::from_fn(w, h, |x, y| Rgb(pixel(x, y))));
        let map = Map::of(vec![f32::from(u8::from(on)); SIDE * SIDE]).unwrap();
        let found = mask(&map, &Guide::of(&photo.pixels), &photo, 0.5);
        prop_assert_eq!(found.dimensions(), (w, h));
        let level = u8::from(on) * 255;
        prop_assert!(found.as_raw().iter().all(|v| *v == level));
    }
}
