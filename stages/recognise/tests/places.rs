//! Places: from the photo to cells and back.

use crate::kit::seen;
use image::{Rgb, RgbImage};
use toile_recognise::{Landmark, Part};

/// A dark photo with a red disc.
fn disc(width: u32, height: u32, (x, y): (f64, f64), radius: f64) -> RgbImage {
    RgbImage::from_fn(width, height, |px, py| {
        let is_red = (f64::from(px) - x).hypot(f64::from(py) - y) < radius;
        Rgb(if is_red { [255, 0, 0] } else { [20; 3] })
    })
}

#[test]
fn a_landmark_is_where_the_photo_shows_it() {
    for (width, height) in [(1000, 1000), (1600, 900), (700, 1500), (400, 401)] {
        let side = f64::from(width.max(height));
        for (a, b) in [(0.3, 0.6), (0.52, 0.5), (0.71, 0.2)] {
            let at = (a * f64::from(width), b * f64::from(height));
            let mark = seen(&disc(width, height, at, side / 40.0)).landmark(Landmark::NeckLeft).unwrap();
            let off = (mark.place.x - at.0).hypot(mark.place.y - at.1);
            // A third of a cell: the disc fills some cells in part, and they hardly count.
            assert!(off < side / 144.0, "{width} x {height}: {off} px off at {at:?}");
            assert!(mark.share > 0.5);
        }
    }
}

#[test]
fn a_landmark_at_the_border_stays_on_the_photo() {
    for at in [(0.0, 20.0), (399.0, 99.0), (200.0, 0.0)] {
        let mark = seen(&disc(400, 100, at, 12.0)).landmark(Landmark::NeckLeft).unwrap();
        let off = (mark.place.x - at.0).hypot(mark.place.y - at.1);
        assert!(off < 9.0 && mark.place.y >= -0.5 && mark.place.y <= 99.5, "{mark:?}");
    }
}

#[test]
fn a_landmark_that_is_likelier_absent_is_none() {
    let seen = seen(&disc(50, 50, (20.0, 20.0), 5.0));
    assert_eq!(seen.landmark(Landmark::Fork), None);
    let all = seen.landmarks();
    assert_eq!(all.len(), 20);
    assert!(all.iter().zip(Landmark::ALL).all(|(mark, landmark)| mark.landmark == landmark));
    assert!((all[13].presence - 1.0 / (1.0 + 3f64.exp())).abs() < 1e-6);
    // Heat that is alike everywhere gathers nowhere.
    assert!(all[13].share < 0.05);
}

#[test]
fn places_are_centres_of_pixels() {
    // Light from pixel 48 on: the border lies at 47.5, where as much is light as dark.
    let photo = RgbImage::from_fn(96, 96, |x, _| Rgb([if x < 48 { 0 } else { 255 }; 3]));
    let seen = seen(&photo);
    let at = seen.probability(Part::Body, 47.5, 40.0);
    assert!((at - 0.5).abs() < 1e-3, "{at}");
    // A picture of half the size has its pixels' centres between those of the photo.
    let half = seen.mask(48, 48);
    assert!((f64::from(half[48 * 20 + 23]) - seen.probability(Part::Body, 46.5, 40.5)).abs() < 1e-6);
}

#[test]
fn outside_of_the_photo_counts_the_nearest_place() {
    let seen = seen(&RgbImage::from_fn(96, 48, |x, _| Rgb([if x < 48 { 0 } else { 255 }; 3])));
    let body = |x, y| seen.probability(Part::Body, x, y);
    assert_eq!(body(1e12, 20.0), body(95.0, 20.0));
    assert_eq!(body(-1e12, 20.0), body(0.0, 20.0));
    assert_eq!(body(f64::INFINITY, f64::NEG_INFINITY), body(95.0, 0.0));
    assert_eq!(body(f64::NAN, 20.0), body(0.0, 20.0));
}
