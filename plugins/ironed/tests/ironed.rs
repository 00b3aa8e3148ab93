//! The filter by itself, and what the stage promises.

use image::{Rgb, RgbImage};
use toile_core::Context;
use toile_ironed::{Ironed, Settings, iron};

toile_core::contracts!(Ironed);

const SETTINGS: Settings = Settings { strength: 1.0, contrast: 0.25, detail: 4.0, reach: 80.0 };

/// A cloth of two colours with wrinkles of 30 px that change its light by 12 %.
fn wrinkled(depth: f64) -> RgbImage {
    RgbImage::from_fn(300, 200, |x, y| {
        let shade = 1.0 + depth * (f64::from(x) * std::f64::consts::TAU / 30.0 + f64::from(y) * 0.05).sin();
        let cloth = if (100..160).contains(&x) { [0.06, 0.08, 0.2] } else { [0.5, 0.35, 0.3] };
        Rgb(cloth.map(|c: f64| (255.0 * (c * shade).powf(1.0 / 2.2)).round() as u8))
    })
}

/// Root mean square of the levels' deviation from their mean, over columns, in shares of light.
fn spread(image: &RgbImage, columns: std::ops::Range<u32>) -> (f64, f64) {
    let light = |x, y| (f64::from(image.get_pixel(x, y)[0]) / 255.0).powf(2.2);
    let all: Vec<f64> = columns.flat_map(|x| (20..180).map(move |y| light(x, y))).collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    ((all.iter().map(|v| (v / mean - 1.0).powi(2)).sum::<f64>() / all.len() as f64).sqrt(), mean)
}

#[test]
fn wrinkles_go_and_the_print_stays() {
    let (before, flat) = (wrinkled(0.12), wrinkled(0.0));
    let inside = vec![true; 300 * 200];
    let (after, shading) = iron(&before, &inside, &SETTINGS, &Context::quiet()).unwrap();
    for columns in [10..90, 110..150, 180..290] {
        let ((was, _), (is, mean), (_, truth)) = (
            spread(&before, columns.clone()),
            spread(&after, columns.clone()),
            spread(&flat, columns.clone()),
        );
        assert!(is < 0.25 * was, "columns {columns:?}: {was:.4} became {is:.4}");
        assert!(
            (mean / truth - 1.0).abs() < 0.02,
            "columns {columns:?}: the colour moved from {truth} to {mean}"
        );
    }
    assert!((0.06..0.1).contains(&shading), "{shading}");
}

#[test]
fn without_strength_nothing_changes() {
    let before = wrinkled(0.1);
    let inside = vec![true; 300 * 200];
    let settings = Settings { strength: 0.0, ..SETTINGS };
    assert_eq!(iron(&before, &inside, &settings, &Context::quiet()).unwrap().0, before);
}
