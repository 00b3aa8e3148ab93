//! Blocks that are where they are known to be.
#![allow(clippy::unwrap_used)]

use super::*;
use image::{Rgba, RgbaImage};
use proptest::prelude::*;

/// A textured disc in an empty picture, moved.
fn disc(width: u32, height: u32, [dx, dy]: [i32; 2]) -> RgbaImage {
    RgbaImage::from_fn(width, height, |x, y| {
        let (x, y) = (x as i32 - dx, y as i32 - dy);
        let (u, v) = (x - width as i32 / 2, y - height as i32 / 2);
        if u * u + v * v > (height as i32 / 4).pow(2) {
            return Rgba([0; 4]);
        }
        // Patches of three sizes without a period: some can be seen in every reduction.
        let grey =
            40 + [5, 17, 41].map(|side| patch(x.div_euclid(side), y.div_euclid(side))).iter().sum::<u8>();
        Rgba([grey, grey, grey, 255])
    })
}

/// Anything up to 60, the same for the same place.
fn patch(x: i32, y: i32) -> u8 {
    let n = (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
    let n = (n ^ n >> 15).wrapping_mul(0x2c1b_3c6d);
    ((n ^ n >> 13) % 61) as u8
}

fn between(a: &RgbaImage, b: &RgbaImage) -> FlowField {
    motion(&Pyramid::of(a), &Pyramid::of(b), &Context::quiet()).unwrap()
}

#[test]
fn a_shifted_picture_gives_its_shift() {
    for shift in [[0, 0], [1, -2], [13, 5], [-31, 22]] {
        let found = between(&disc(300, 400, [0, 0]), &disc(300, 400, shift));
        let known: Vec<Vector> = found.vectors.iter().flatten().copied().collect();
        assert!(known.len() > 100);
        assert!(known.iter().all(|v| *v == shift.map(|s| 4 * s)), "{shift:?}: {known:?}");
        let back = between(&disc(300, 400, shift), &disc(300, 400, [0, 0]));
        assert!(back.vectors.iter().flatten().all(|v| *v == shift.map(|s| -4 * s)));
    }
}

#[test]
fn half_a_pixel_is_found_within_a_quarter() {
    // Twice as large, moved by one pixel, and brought down.
    let small = |shift| image::imageops::thumbnail(&disc(600, 800, shift), 300, 400);
    let found = between(&small([0, 0]), &small([5, 0]));
    let inner = found.vectors[12 * found.columns + 9].unwrap();
    assert!((inner[0] - 10).abs() <= 1 && inner[1].abs() <= 1, "{inner:?}");
}

#[test]
fn nothing_moves_where_nothing_is_seen() {
    let (empty, full) = (RgbaImage::new(300, 400), disc(300, 400, [3, 3]));
    let found = between(&full, &disc(300, 400, [6, 3]));
    assert_eq!(found.vectors[0], None, "the corner is empty");
    assert!(between(&empty, &full).vectors.iter().all(Option::is_none));
    assert_eq!(between(&empty, &full).whole(), vec![[0, 0]; 19 * 25]);
}

#[test]
fn a_stopped_run_ends() {
    let cancel = toile_core::Cancel::new();
    cancel.cancel();
    let cx = Context::new("Turntable", std::path::Path::new("."), cancel, std::sync::Arc::new(()));
    let view = Pyramid::of(&disc(48, 64, [0, 0]));
    assert!(motion(&view, &view, &cx).is_err());
}

#[test]
fn the_fit_finds_the_side_that_is_lower() {
    assert_eq!((fit(10, 0, 10), fit(20, 0, 10), fit(10, 0, 20), fit(5, 5, 5)), (0, 1, -1, 0));
    assert_eq!((fit(20, 0, 0), fit(0, 0, 20), fit(0, 9, 0)), (2, -2, 0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_two_views_have_a_motion_of_every_block(
        width in 1..90u32, height in 1..230u32, seed in any::<u32>(), empty in 0..3u8,
    ) {
        let noise = |k: u32| RgbaImage::from_fn(width, height, |x, y| {
            let n = (x * 31 + y * 17 + k * 101).wrapping_mul(seed | 1).rotate_left(x % 13);
            Rgba(n.to_le_bytes().map(|v| if u32::from(empty) > k { 0 } else { v }))
        });
        let found = between(&noise(0), &noise(1));
        prop_assert_eq!(found.vectors.len(), (width.div_ceil(16) * height.div_ceil(16)) as usize);
        // What each level adds to what the coarsest one reaches: a full search and steps, twice as
        // much on the level below.
        let reach = (height as i32 / 8 + 4 * (WIDE + STEPS as i32 + 1)) * PARTS;
        prop_assert!(found.vectors.iter().flatten().flatten().all(|c| c.abs() <= reach));
        let blocks = found.vectors.len();
        prop_assert_eq!(found.whole().len(), blocks);
    }
}
