#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use image::{Rgb, RgbImage};
use proptest::prelude::*;
use toile_core::prelude::*;

/// A picture of noise.
fn noise(w: u32, h: u32, seed: u64) -> RgbImage {
    let mut state = seed | 1;
    RgbImage::from_fn(w, h, |_, _| {
        Rgb([(); 3].map(|()| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 56) as u8
        }))
    })
}

/// Every pixel of the square around (x, y) in reading order, clamped to the frame, with its offset.
fn window(image: &RgbImage, x: u32, y: u32, r: i64) -> Vec<(i64, i64, [u8; 3])> {
    let (w, h) = image.dimensions();
    let at = |v: u32, d: i64, n: u32| (i64::from(v) + d).clamp(0, i64::from(n) - 1) as u32;
    (-r..=r)
        .flat_map(|v| (-r..=r).map(move |u| (u, v)))
        .map(|(u, v)| (u, v, image.get_pixel(at(x, u, w), at(y, v, h)).0))
        .collect()
}

/// A filter as its definition reads.
fn naive(image: &RgbImage, r: i64, f: impl Fn(&[(i64, i64, [u8; 3])], usize) -> f64) -> RgbImage {
    RgbImage::from_fn(image.width(), image.height(), |x, y| {
        let near = window(image, x, y, r);
        Rgb([0, 1, 2].map(|c| (f(&near, c) + 0.5).floor() as u8))
    })
}

fn naive_mean(image: &RgbImage, mask: Neighbours, r: i64) -> RgbImage {
    naive(image, r, |near, c| {
        let inside = near.iter().filter(|(u, v, _)| mask == Neighbours::Eight || u.abs() + v.abs() <= r);
        let values: Vec<f64> = inside.map(|(_, _, p)| f64::from(p[c])).collect();
        values.iter().sum::<f64>() / values.len() as f64
    })
}

fn naive_median(image: &RgbImage, r: i64) -> RgbImage {
    naive(image, r, |near, c| {
        let mut values: Vec<u8> = near.iter().map(|(_, _, p)| p[c]).collect();
        values.sort_unstable();
        f64::from(values[values.len() / 2])
    })
}

fn naive_weighted(image: &RgbImage, r: i64, weight: impl Fn(i64, i64, [u8; 3], [u8; 3]) -> f64) -> RgbImage {
    naive(image, r, |near, c| {
        let centre = near[near.len() / 2].2;
        let weighted = near.iter().map(|(u, v, p)| (weight(*u, *v, *p, centre), f64::from(p[c])));
        let (sum, total) = weighted.fold((0.0, 0.0), |(s, t), (w, p)| (s + w * p, t + w));
        sum / total
    })
}

fn bell(x: f64, sigma: f64) -> f64 {
    (-x * x / (2.0 * sigma * sigma)).exp()
}

fn largest_difference(a: &RgbImage, b: &RgbImage) -> u8 {
    a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

#[test]
fn the_mean_of_a_single_bright_pixel_is_spread_over_the_mask() {
    let mut image = RgbImage::new(5, 5);
    image.put_pixel(2, 2, Rgb([180, 90, 9]));
    let cx = Context::quiet();
    let eight = neighbourhood_mean(&image, Neighbours::Eight, 1, &cx).unwrap();
    assert_eq!(eight.get_pixel(1, 1).0, [20, 10, 1]);
    assert_eq!(eight.get_pixel(0, 0).0, [0, 0, 0]);
    let four = neighbourhood_mean(&image, Neighbours::Four, 1, &cx).unwrap();
    assert_eq!(four.get_pixel(2, 1).0, [36, 18, 2]);
    assert_eq!(four.get_pixel(1, 1).0, [0, 0, 0]);
}

#[test]
fn the_median_removes_a_speck_and_keeps_an_edge() {
    let mut image = RgbImage::from_fn(20, 20, |x, _| Rgb([if x < 10 { 40 } else { 200 }; 3]));
    let clean = image.clone();
    image.put_pixel(4, 7, Rgb([255; 3]));
    for radius in [1, 2, 4] {
        assert_eq!(median(&image, radius, &Context::quiet()).unwrap(), clean);
    }
}

#[test]
fn the_bilateral_filter_smooths_noise_and_keeps_an_edge() {
    let image = RgbImage::from_fn(24, 24, |x, y| {
        let tone = if x < 12 { 60 } else { 200 };
        Rgb([tone + ((x * 7 + y * 13) % 5) as u8; 3])
    });
    let out = bilateral(&image, 3, 2.0, 20.0, &Context::quiet()).unwrap();
    let row: Vec<u8> = (9..15).map(|x| out.get_pixel(x, 12).0[0]).collect();
    assert!(row[..3].iter().all(|v| (61..=63).contains(v)), "{row:?}");
    assert!(row[3..].iter().all(|v| (201..=203).contains(v)), "{row:?}");
}

#[test]
fn stages_keep_alpha_scale_and_name() {
    let photo = Photo {
        pixels: noise(9, 7, 3).into(),
        alpha: Some(image::GrayImage::new(9, 7).into()),
        px_per_metre: Some(800.0),
        garment_width: None,
        mirrored: true,
        joined: 1,
        file: "a.png".into(),
    };
    let out = NeighbourhoodMean::default().run(&photo, &Context::quiet()).unwrap();
    assert!(out.mirrored && out.alpha.is_some());
    assert_eq!((out.px_per_metre, out.file.as_str()), (Some(800.0), "a.png"));
    assert_ne!(out.pixels, photo.pixels);
}

#[test]
fn a_cancelled_run_stops() {
    let cx = Context::quiet();
    cx.cancel().cancel();
    let error = median(&noise(9, 9, 1), 2, &cx).unwrap_err();
    assert_eq!((error.code, error.to_string()), (ErrorCode::Cancelled, "stopped on request".into()));
}

#[test]
fn an_empty_picture_stays_empty() {
    let cx = Context::quiet();
    let empty = RgbImage::new(0, 4);
    assert_eq!(neighbourhood_mean(&empty, Neighbours::Eight, 3, &cx).unwrap(), empty);
    assert_eq!(gaussian(&empty, 1.0, &cx).unwrap(), empty);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let image = noise(300, 301, 77);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let cx = Context::quiet();
            vec![
                neighbourhood_mean(&image, Neighbours::Eight, 3, &cx).unwrap(),
                neighbourhood_mean(&image, Neighbours::Four, 3, &cx).unwrap(),
                median(&image, 5, &cx).unwrap(),
                gaussian(&image, 2.0, &cx).unwrap(),
                bilateral(&image, 2, 2.0, 30.0, &cx).unwrap(),
            ]
        })
    };
    assert!(run(1) == run(3));
}

/// A mean of 255 * 10,201 is the largest sum there is.
#[test]
fn the_largest_radius_does_not_overflow() {
    let image = RgbImage::from_pixel(130, 4, Rgb([255, 254, 1]));
    for mask in [Neighbours::Four, Neighbours::Eight] {
        assert_eq!(neighbourhood_mean(&image, mask, 50, &Context::quiet()).unwrap(), image);
    }
    assert_eq!(median(&image, 50, &Context::quiet()).unwrap(), image);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn every_filter_is_its_definition(w in 1u32..24, h in 1u32..90, seed in any::<u64>(), r in 1usize..6) {
        let (image, cx, ri) = (noise(w, h, seed), Context::quiet(), r as i64);
        for mask in [Neighbours::Four, Neighbours::Eight] {
            prop_assert_eq!(neighbourhood_mean(&image, mask, r, &cx).unwrap(), naive_mean(&image, mask, ri));
        }
        prop_assert_eq!(median(&image, r, &cx).unwrap(), naive_median(&image, ri));
        let sigma = r as f64 / 3.0;
        let reference = naive_weighted(&image, ri, |u, v, _, _| bell(((u * u + v * v) as f64).sqrt(), sigma));
        prop_assert!(largest_difference(&gaussian(&image, sigma, &cx).unwrap(), &reference) <= 1);
    }

    #[test]
    fn the_bilateral_filter_is_its_definition(w in 1u32..12, h in 1u32..12, seed in any::<u64>(), r in 1usize..4) {
        let image = noise(w, h, seed);
        let reference = naive_weighted(&image, r as i64, |u, v, p, centre| {
            let distance: u32 = (0..3).map(|c| u32::from(p[c].abs_diff(centre[c]))).sum();
            bell(((u * u + v * v) as f64).sqrt(), 1.3) * bell(f64::from(distance) / 3.0, 40.0)
        });
        let out = bilateral(&image, r, 1.3, 40.0, &Context::quiet()).unwrap();
        prop_assert!(largest_difference(&out, &reference) <= 1);
    }

    #[test]
    fn a_constant_stays_what_it_is(w in 1u32..40, h in 1u32..40, tone in any::<[u8; 3]>(), r in 1usize..50) {
        let (image, cx) = (RgbImage::from_pixel(w, h, Rgb(tone)), Context::quiet());
        prop_assert_eq!(&neighbourhood_mean(&image, Neighbours::Eight, r, &cx).unwrap(), &image);
        prop_assert_eq!(&neighbourhood_mean(&image, Neighbours::Four, r, &cx).unwrap(), &image);
        prop_assert_eq!(&median(&image, r, &cx).unwrap(), &image);
        prop_assert_eq!(&gaussian(&image, r as f64 * 0.4, &cx).unwrap(), &image);
        prop_assert_eq!(&bilateral(&image, r.min(15), 2.0, 20.0, &cx).unwrap(), &image);
    }
}
