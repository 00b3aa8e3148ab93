//! The stage by itself.
#![allow(clippy::unwrap_used)]

use image::{Rgb, RgbImage};
use toile_core::artifact::Photo;
use toile_core::testkit;
use toile_tutorial::{Dust, Specks};

toile_core::contracts!(Dust);

/// A grey photo with a step in its middle.
fn photo(speck: Option<(u32, u32)>) -> Photo {
    let mut pixels = RgbImage::from_fn(16, 8, |x, _| Rgb([if x < 8 { 60 } else { 200 }; 3]));
    speck.into_iter().for_each(|(x, y)| pixels.put_pixel(x, y, Rgb([255, 255, 255])));
    testkit::photo().with_pixels(pixels)
}

#[test]
fn a_speck_goes_and_the_edge_stays() {
    let cleaned: Photo = testkit::run_one(&Dust::default(), &photo(Some((3, 4)))).unwrap();
    assert_eq!(cleaned.pixels, photo(None).pixels);
}

#[test]
fn a_light_speck_stays_where_dark_ones_are_asked_for() {
    let dark = Dust { specks: Specks::Dark, ..Dust::default() };
    let cleaned: Photo = testkit::run_one(&dark, &photo(Some((3, 4)))).unwrap();
    assert_eq!(cleaned.pixels, photo(Some((3, 4))).pixels);
}
