//! Pictures from pictures, held against the truth of the scene that their samples are drawn from.

use image::RgbImage;
use serde_json::Value;
use std::fs;
use std::path::Path;
use toile_stages::views::picture::psnr;
use toile_tests::{pipeline, root, toile};

/// Runs a published experiment with these settings into a folder; the figures of its second stage.
fn run(name: &str, settings: &[&str], out: &Path) -> Value {
    let (file, out_text) = (pipeline(&format!("published/{name}.ron")), out.display().to_string());
    let mut arguments = vec!["run", &file, "--out", &out_text];
    settings.iter().for_each(|s| arguments.extend(["--set", s]));
    let answer = toile(&arguments);
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    let metrics: Value = serde_json::from_slice(&fs::read(out.join("metrics.json")).unwrap()).unwrap();
    metrics["stages"][1]["figures"].clone()
}

fn picture(path: impl AsRef<Path>) -> RgbImage {
    image::open(path).unwrap().to_rgb8()
}

fn sample(name: &str) -> std::path::PathBuf {
    root().join("pipelines/samples/views").join(name)
}

#[test]
fn photos_of_a_whole_turn_are_registered_within_half_a_pixel() {
    let dir = tempfile::tempdir().unwrap();
    let figures = run("t_panorama", &[], dir.path());
    let truth: Value = serde_json::from_slice(&fs::read(sample("turn/truth.json")).unwrap()).unwrap();
    let focal = truth["focal_px"].as_f64().unwrap();
    let angles: Vec<f64> =
        truth["angles_deg"].as_array().unwrap().iter().map(|a| a.as_f64().unwrap()).collect();
    for (k, angle) in angles.iter().enumerate() {
        let next = (k + 1) % angles.len();
        let turned = (angles[next] - angle).rem_euclid(360.0).to_radians() * focal;
        let of = |axis: &str| figures[format!("shift_{axis}.{:02}", next + 1)].as_f64().unwrap();
        let off = (of("x") - turned).hypot(of("y"));
        assert!(off < 0.15, "photo {:02} is off by {off} px", next + 1);
    }
    assert!((figures["focal_px"].as_f64().unwrap() / focal - 1.0).abs() < 1e-3, "{figures}");

    let (made, truth) = (picture(dir.path().join("panorama.png")), picture(sample("turn/truth.jpg")));
    assert_eq!(made.width(), truth.width());
    let above = (made.height() - truth.height()) / 2;
    let inner = image::imageops::crop_imm(&made, 0, above, truth.width(), truth.height()).to_image();
    let score = psnr(&inner, &truth, |_, _| true).unwrap();
    println!("panorama: {score:.1} dB");
    assert!(score > 33.0, "{score} dB");
}

#[test]
fn the_view_between_two_photos_is_that_of_the_scene() {
    let dir = tempfile::tempdir().unwrap();
    let truth = picture(sample("pair/truth.jpg"));
    let [left, right] = ["pair/left.jpg", "pair/right.jpg"].map(|n| picture(sample(n)));
    let faded = RgbImage::from_fn(left.width(), left.height(), |x, y| {
        let (a, b) = (left.get_pixel(x, y).0, right.get_pixel(x, y).0);
        image::Rgb([0, 1, 2].map(|c| a[c].midpoint(b[c])))
    });
    let score = |made: &RgbImage| psnr(made, &truth, |_, _| true).unwrap();
    let by_depth = "stages.FlowView=DepthView(turn: 8, lens: Pixels(700), far: 2)";
    for (name, settings, least) in [("flow", &[][..], 25.5), ("depth", &[by_depth][..], 26.5)] {
        let out = dir.path().join(name);
        run("t_views", settings, &out);
        let (made, faded) = (score(&picture(out.join("view.png"))), score(&faded));
        println!("{name}: {made:.1} dB, faded {faded:.1} dB");
        assert!(made > least && made > faded + 6.0, "{name}: {made} dB, faded {faded} dB");
    }
}

#[test]
fn a_light_field_is_better_the_more_photos_it_has() {
    let dir = tempfile::tempdir().unwrap();
    let truth = picture(sample("grid/truth.jpg"));
    let of = |every: usize| {
        let out = dir.path().join(every.to_string());
        let figures = run("t_lightfield", &[&format!("stages.LightField.every={every}")], &out);
        let score = psnr(&picture(out.join("view.png")), &truth, |_, _| true).unwrap();
        println!("{} photos: {score:.1} dB", figures["photos_used"]);
        score
    };
    let [all, nine, four] = [1, 2, 4].map(of);
    assert!(all > 26.0 && all > nine + 1.0 && nine > four, "{all} {nine} {four}");
}
