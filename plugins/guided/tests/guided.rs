//! The stage by itself, and in a pipeline.
#![allow(clippy::unwrap_used)]

use image::{Rgb, RgbImage};
use proptest::prelude::*;
use std::path::Path;
use toile_core::Context;
use toile_guided::{Guided, GuidedBy, guided};

toile_core::contracts!(Guided);

/// Two flat halves with grain of +-8 grey levels.
fn halves() -> RgbImage {
    RgbImage::from_fn(60, 40, |x, y| {
        let grain = ((x * 7919 + y * 104_729) % 17) as u8;
        Rgb([if x < 30 { 40 } else { 180 } + grain; 3])
    })
}

fn spread(image: &RgbImage, columns: std::ops::Range<u32>) -> f64 {
    let levels = columns.flat_map(|x| (5..35).map(move |y| (x, y)));
    let levels: Vec<f64> = levels.map(|(x, y)| f64::from(image.get_pixel(x, y)[0])).collect();
    let mean = levels.iter().sum::<f64>() / levels.len() as f64;
    (levels.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / levels.len() as f64).sqrt()
}

#[test]
fn grain_goes_and_the_edge_stays() {
    for (by, most) in [(GuidedBy::Photo, 0.35), (GuidedBy::Bilateral, 0.3)] {
        let (before, after) = (halves(), guided(&halves(), by, 4, 12.0, &Context::quiet()).unwrap());
        assert!(spread(&after, 5..20) < most * spread(&before, 5..20), "{by:?}: {}", spread(&after, 5..20));
        let step = f64::from(after.get_pixel(31, 20)[0]) - f64::from(after.get_pixel(28, 20)[0]);
        assert!(step > 120.0, "{by:?}: the edge of 140 grey levels became {step}");
    }
}

#[test]
fn a_bilateral_guide_takes_more_grain_off_along_an_edge() {
    let along = |by| spread(&guided(&halves(), by, 4, 12.0, &Context::quiet()).unwrap(), 26..29);
    assert!(
        along(GuidedBy::Bilateral) < 0.6 * along(GuidedBy::Photo),
        "{} {}",
        along(GuidedBy::Bilateral),
        along(GuidedBy::Photo)
    );
}

#[test]
fn strips_leave_no_seam() {
    let tall = RgbImage::from_fn(24, 300, |x, y| Rgb([((x * 7919 + y * 104_729) % 97) as u8; 3]));
    let top = |h: u32| image::imageops::crop_imm(&tall, 0, 0, 24, h).to_image();
    for by in [GuidedBy::Photo, GuidedBy::Bilateral] {
        let [whole, part] = [300, 200].map(|h| guided(&top(h), by, 6, 12.0, &Context::quiet()).unwrap());
        let same = |y: u32| (0..24).all(|x| whole.get_pixel(x, y) == part.get_pixel(x, y));
        assert!((0..180).all(same), "{by:?}");
    }
}

#[test]
fn a_pipeline_names_it_like_any_other_stage() {
    let mut registry = toile::registry();
    toile_guided::register(&mut registry);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let vest = std::fs::read_to_string(root.join("pipelines/vest.ron")).unwrap();
    let text = vest
        .replace("NeighbourhoodMean()", "Guided(radius: 2)")
        .replace("samples/", &format!("{}/pipelines/samples/", root.display()));
    let dir = tempfile::tempdir().unwrap();
    let (file, out) = (dir.path().join("guided.ron"), dir.path().join("out"));
    std::fs::write(&file, text).unwrap();
    let (mut said, mut told) = (Vec::new(), Vec::new());
    let arguments =
        ["toile", "run", file.to_str().unwrap(), "--until", "Canny", "--out", out.to_str().unwrap()];
    let code = toile::command_with(&registry, arguments, &mut said, &mut told);
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&told));
    assert!(out.join("stages/Canny/front.svg").exists());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn any_picture_stays_within_its_own_range(
        (w, h) in (1u32..20, 1u32..20), radius in 1usize..40, noise in 0.1..255.0f64, seed in any::<u32>(),
        by in prop_oneof![Just(GuidedBy::Photo), Just(GuidedBy::Bilateral)],
    ) {
        let level = |x: u32, y: u32| (x.wrapping_mul(seed) ^ y.wrapping_mul(seed.rotate_left(9))) as u8;
        let photo = RgbImage::from_fn(w, h, |x, y| Rgb([level(x, y), 255 - level(y, x), 7]));
        let filtered = guided(&photo, by, radius, noise, &Context::quiet()).unwrap();
        prop_assert_eq!(filtered.dimensions(), (w, h));
        prop_assert!(filtered.pixels().all(|p| p[2] == 7), "a flat channel stays as it is");
    }
}
