//! Any small image with any object gives finite numbers or a typed error.
#![allow(clippy::unwrap_used)]

use image::{Rgb, RgbImage};
use proptest::prelude::*;
use toile_scale::{KnownObject, RectifyOptions, draw, find, rectify};

/// Noise, or a few boxes of even colour on a ground, from bytes.
fn image(w: u32, h: u32, bytes: &[u8], boxes: bool) -> RgbImage {
    let at = |i: usize| bytes[i % bytes.len()];
    let mut picture = RgbImage::from_fn(w, h, |x, y| {
        let i = (y * w + x) as usize;
        if boxes { Rgb([at(0), at(1), at(2)]) } else { Rgb([at(3 * i), at(3 * i + 1), at(3 * i + 2)]) }
    });
    for n in 0..if boxes { 4 } else { 0 } {
        let v = |k: usize| u32::from(at(9 * n + k));
        let (x0, y0) = (v(3) * w / 256, v(4) * h / 256);
        let (x1, y1) = ((x0 + v(5) * w / 256).min(w), (y0 + v(6) * h / 256).min(h));
        for (x, y) in (x0..x1).flat_map(|x| (y0..y1).map(move |y| (x, y))) {
            picture.put_pixel(x, y, Rgb([at(9 * n + 7), at(9 * n + 8), at(9 * n + 9)]));
        }
    }
    picture
}

fn objects() -> impl Strategy<Value = KnownObject> {
    let corners = prop::option::of((3u32..10, 3u32..10));
    prop_oneof![
        Just(KnownObject::BankCard),
        Just(KnownObject::A4),
        Just(KnownObject::Letter),
        Just(KnownObject::Ruler),
        (1000u32..100_000, corners)
            .prop_map(|(square_um, corners)| KnownObject::Chessboard { square_um, corners }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn gives_finite_numbers_or_an_error(
        w in 1u32..160, h in 1u32..160, boxes: bool, object in objects(),
        bytes in prop::collection::vec(any::<u8>(), 40..3000),
    ) {
        let photo = image(w, h, &bytes, boxes);
        match find(&photo, object) {
            Ok(found) => {
                let numbers = [found.px_per_metre, found.residual, found.confidence, found.tilt.unwrap_or(0.0)];
                prop_assert!(numbers.iter().chain(found.homography.iter()).all(|v| v.is_finite()));
                prop_assert!(found.px_per_metre > 0.0 && (0.0..=1.0).contains(&found.confidence));
                prop_assert!(found.corners.iter().chain(&found.marks).flat_map(|p| p.iter()).all(|v| v.is_finite()));
                prop_assert_eq!(draw(&photo, &found).dimensions(), photo.dimensions());
                let options = RectifyOptions { px_per_metre: Some(200.0), ..RectifyOptions::default() };
                if let Ok(above) = rectify(&photo, &found, &options) {
                    prop_assert!(above.px_per_metre.is_finite() && above.image.width() <= 30_000);
                }
            }
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}
