//! What is refused, word for word.
#![allow(clippy::unwrap_used)]

use image::{Rgb, RgbImage};
use toile_scale::{KnownObject, RectifyOptions, ScaleError, ScaleOptions, find, find_with, rectify};

fn plain() -> RgbImage {
    RgbImage::from_pixel(200, 150, Rgb([120, 110, 100]))
}

fn sheet() -> RgbImage {
    let mut photo = RgbImage::from_pixel(800, 600, Rgb([70, 60, 50]));
    for (x, y) in (200..497).flat_map(|x| (150..360).map(move |y| (x, y))) {
        photo.put_pixel(x, y, Rgb([235, 235, 230]));
    }
    photo
}

#[test]
fn an_empty_ground_holds_no_card() {
    let text = "no bank card was found; lay it flat beside the garment, whole in the frame, on a ground of another \
                colour, and photograph from above";
    assert_eq!(find(&plain(), KnownObject::BankCard).unwrap_err().to_string(), text);
}

#[test]
fn a_photo_of_few_pixels_is_refused() {
    let error = find(&RgbImage::new(31, 200), KnownObject::A4).unwrap_err();
    let text = "the photo is 31 x 200 px; give one of 32 to 30000 px a side and at most 200 megapixels";
    assert_eq!(error.to_string(), text);
}

#[test]
fn chessboards_are_checked() {
    let square = KnownObject::Chessboard { square_um: 10, corners: None };
    let text = "a chessboard's square of 10 um is out of range; give 1000 to 1000000 um";
    assert_eq!(find(&plain(), square).unwrap_err().to_string(), text);
    let counts = KnownObject::Chessboard { square_um: 25_000, corners: Some((2, 9)) };
    let text = "a chessboard of 2 x 9 inner corners is out of range; give 3 to 60 each";
    assert_eq!(find(&plain(), counts).unwrap_err().to_string(), text);
}

#[test]
fn focal_lengths_and_resolutions_are_checked() {
    for focal in [0.0, f64::NAN, 1000.0] {
        let options = ScaleOptions { focal_35mm: Some(focal) };
        let error = find_with(&plain(), KnownObject::A4, &options).unwrap_err();
        let text =
            format!("a focal length of {focal} mm (35 mm film) is out of range; give 8 to 400 mm, or none");
        assert_eq!(error.to_string(), text);
    }
    let photo = sheet();
    let found = find(&photo, KnownObject::A4).unwrap();
    let options = RectifyOptions { px_per_metre: Some(1.0), ..RectifyOptions::default() };
    let text = "a resolution of 1 px per metre is out of range; give 10 to 100000, or none";
    assert_eq!(rectify(&photo, &found, &options).unwrap_err().to_string(), text);
}

#[test]
fn a_homography_that_is_not_finite_is_refused() {
    let photo = sheet();
    let mut found = find(&photo, KnownObject::A4).unwrap();
    found.homography[(0, 1)] = f64::NAN;
    let error = rectify(&photo, &found, &RectifyOptions::default()).unwrap_err();
    assert_eq!(error.to_string(), "the homography has no finite inverse; take the one that `find` gave");
}

#[test]
fn two_sheets_are_one_too_many() {
    let mut photo = RgbImage::from_pixel(900, 600, Rgb([70, 60, 50]));
    for (x, y) in (60..357).flat_map(|x| (150..360).map(move |y| (x, y))) {
        photo.put_pixel(x, y, Rgb([235, 235, 230]));
        photo.put_pixel(x + 450, y, Rgb([235, 235, 230]));
    }
    let error = find(&photo, KnownObject::A4).unwrap_err();
    assert!(matches!(&error, ScaleError::Several { places, .. } if places.len() == 2), "{error}");
}

#[test]
fn a_small_card_is_told() {
    let text = "the bank card at (10, 20) is 21 px on its shorter side, 25 are needed; use a photo of more pixels or \
                a larger object";
    let error = ScaleError::TooSmall { object: "bank card", place: [10.0, 20.0], short: 21.2, least: 25.0 };
    assert_eq!(error.to_string(), text);
}

#[test]
fn the_other_refusals_read_well() {
    let place = [10.0, 20.0];
    let cut = ScaleError::Cut { object: "A4 sheet", place };
    assert_eq!(
        cut.to_string(),
        "the A4 sheet at (10, 20) is cut by the photo's frame; lay it whole into the frame"
    );
    let tilted = ScaleError::Tilted { object: "A4 sheet", place, degrees: 63.4 };
    let text = "the A4 sheet at (10, 20) is seen at 63 degrees from straight above, at most 60 are allowed, \
                and 35 without the lens's focal length; photograph from above";
    assert_eq!(tilted.to_string(), text);
    let ruler = ScaleError::RulerTilted { place, percent: 4.2 };
    let text = "the marks of the ruler at (10, 20) widen by 4.2 % along it, so the camera was tilted and a ruler \
                gives no tilt; photograph from straight above or use a sheet";
    assert_eq!(ruler.to_string(), text);
    let fine = ScaleError::RulerFine { place, apart: 3.04, least: 4.0 };
    let text = "the marks of the ruler at (10, 20) are 3.0 px apart, 4 are needed; go nearer or use a photo of more \
                pixels";
    assert_eq!(fine.to_string(), text);
    let several = ScaleError::Several { object: "A4 sheet", places: vec![[1.0, 2.0], [3.0, 4.0]] };
    assert_eq!(several.to_string(), "2 places look like a A4 sheet ((1, 2), (3, 4)); leave one in the frame");
}
