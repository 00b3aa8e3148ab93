//! Whole pipelines, timed: `cargo bench -p toile-tests`. docs/log/README.md keeps the
//! figures.
#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{Criterion, criterion_group, criterion_main};
use image::imageops::{FilterType, resize};
use std::path::{Path, PathBuf};
use toile_tests::{pipeline, root, toile};

/// Height of a 12-megapixel photo of the samples' shape, px.
const TWELVE_MEGAPIXELS: (u32, u32) = (3240, 3704);

fn run(arguments: &[&str]) {
    let answer = toile(arguments);
    assert_eq!(answer.code, 0, "{}", answer.err);
}

/// A sample photo, enlarged to 12 megapixels.
fn enlarged(side: &str, dir: &Path) -> PathBuf {
    let sample = image::open(root().join(format!("pipelines/samples/vest/{side}.jpg"))).unwrap().to_rgb8();
    let path = dir.join(format!("{side}.jpg"));
    resize(&sample, TWELVE_MEGAPIXELS.0, TWELVE_MEGAPIXELS.1, FilterType::CatmullRom).save(&path).unwrap();
    path
}

fn image_half(c: &mut Criterion) {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out").display().to_string();
    let set = |side| format!("photos.{side}.file={:?}", enlarged(side, dir.path()).display().to_string());
    let (front, back, vest) = (set("front"), set("back"), pipeline("vest.ron"));
    let arguments = ["run", &vest, "--until", "Canny", "--out", &out, "--set", &front, "--set", &back];
    c.bench_function("image half, two photos of 12 megapixels", |b| b.iter(|| run(&arguments)));
}

fn garments(c: &mut Criterion) {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().display().to_string();
    for name in toile_tests::PIPELINES {
        let file = pipeline(name);
        c.bench_function(name, |b| b.iter(|| run(&["run", &file, "--out", &out])));
    }
}

criterion_group! { name = pipelines; config = Criterion::default().sample_size(10); targets = image_half, garments }
criterion_main!(pipelines);
