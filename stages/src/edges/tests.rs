#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use image::{GrayImage, RgbImage};
use std::path::Path;
use std::sync::Arc;
use toile_core::prelude::*;

/// A sample's photo, true mask, true outline and named corners, in metres.
struct Sample {
    photo: Photo,
    mask: Mask,
    outline: Vec<Point2>,
    corners: Vec<(String, Point2)>,
}

fn sample(garment: &str, side: &str, width: f64) -> Sample {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pipelines/samples").join(garment);
    let open = |name: String| image::open(base.join(name)).unwrap();
    let text = std::fs::read_to_string(base.join(format!("{side}.outline.json"))).unwrap();
    let truth: serde_json::Value = serde_json::from_str(&text).unwrap();
    let point =
        |v: &serde_json::Value| Point2::new(v[0].as_f64().unwrap() / 1e3, v[1].as_f64().unwrap() / 1e3);
    Sample {
        photo: photo(open(format!("{side}.jpg")).to_rgb8(), Some(width)),
        mask: mask(open(format!("{side}.mask.png")).to_luma8()),
        outline: truth["outline"].as_array().unwrap().iter().map(point).collect(),
        corners: truth["corners"].as_object().unwrap().iter().map(|(k, v)| (k.clone(), point(v))).collect(),
    }
}

fn photo(pixels: RgbImage, garment_width: Option<f64>) -> Photo {
    Photo {
        pixels: Arc::new(pixels),
        alpha: None,
        px_per_metre: None,
        garment_width,
        mirrored: false,
        file: "test.png".into(),
    }
}

fn mask(pixels: GrayImage) -> Mask {
    Mask { pixels: Arc::new(pixels) }
}

fn to_polygon(p: Point2, polygon: &[Point2]) -> f64 {
    let n = polygon.len();
    (0..n)
        .map(|i| {
            let (a, b) = (polygon[i], polygon[(i + 1) % n]);
            let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
            (a + (b - a) * t - p).norm()
        })
        .fold(f64::INFINITY, f64::min)
}

/// Distances of the outline's points to the truth in mm: median, 95th percentile, greatest.
fn deviations(found: &Outline, truth: &[Point2]) -> [f64; 3] {
    let mut d: Vec<f64> = found.outer.points.iter().map(|p| 1e3 * to_polygon(*p, truth)).collect();
    d.sort_by(f64::total_cmp);
    [d[d.len() / 2], d[d.len() * 95 / 100], d[d.len() - 1]]
}

#[test]
fn print_deviations() {
    for (garment, width) in [("vest", 0.52), ("tshirt", 0.72)] {
        for side in ["front", "back"] {
            let s = sample(garment, side, width);
            let t = std::time::Instant::now();
            let found = Canny::default().run(&s.photo, &s.mask, &Context::quiet()).unwrap();
            eprintln!("{garment} {side} {:?} {:?}", deviations(&found, &s.outline), t.elapsed());
            for (name, p) in &s.corners {
                let d = found
                    .outer
                    .corners
                    .iter()
                    .map(|&c| 1e3 * (found.outer.points[c] - p).norm())
                    .fold(1e9, f64::min);
                eprintln!("   {name} {d:.2} mm");
            }
            eprintln!("   {} corners, {} points", found.outer.corners.len(), found.outer.points.len());
        }
    }
}
