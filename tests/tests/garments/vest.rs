//! The README's job: two photos in, a sewn and draped vest out, within its quality limits; in the
//! quality that is quickest, since goldens and the README's commands run the file as it stands.

use serde_json::Value;
use std::path::Path;
use toile_tests::{pipeline, toile};

fn run(name: &str, out: &Path, more: &[&str]) -> Value {
    let (file, dir) = (pipeline(name), out.display().to_string());
    let answer = toile(&[&["run", &file, "--out", &dir, "--json"], more].concat());
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    serde_json::from_str(&answer.out).unwrap()
}

/// The limits of the product's promise, stricter than or equal to the run's own.
fn assert_wearable(metrics: &Value) {
    let g = &metrics["garment"];
    let figure = |v: &Value| v.as_f64().unwrap();
    assert!(figure(&g["seam_gap_max_m"]) < 1e-3, "{g}");
    assert_eq!(g["body_penetration"]["vertices"], 0, "{g}");
    assert_eq!(g["self_crossings"], 0, "{g}");
    assert!(figure(&g["edge_strain"]["p99"]) < 0.05, "{g}");
    assert_eq!(g["converged"], true, "{g}");
    for (name, panel) in metrics["panels"].as_object().unwrap() {
        assert!(figure(&panel["area_error"]).abs() < 0.01, "{name}: {panel}");
        assert!(figure(&panel["outline_error"]).abs() < 0.01, "{name}: {panel}");
    }
}

#[test]
fn the_vest_is_wearable_and_its_files_are_there() {
    let dir = tempfile::tempdir().unwrap();
    let metrics = run("vest.ron", dir.path(), &["--quality", "Draft"]);
    assert_wearable(&metrics);
    for file in [
        "garment.glb",
        "garment.obj",
        "garment.mtl",
        "front.png",
        "back.png",
        "side.png",
        "report.html",
        "metrics.json",
    ] {
        assert!(dir.path().join(file).metadata().unwrap().len() > 100, "{file}");
    }
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_tshirt_is_wearable() {
    let dir = tempfile::tempdir().unwrap();
    assert_wearable(&run("tshirt.ron", dir.path(), &[]));
}

#[test]
#[ignore = "slow: .ci/wide"]
fn one_and_two_threads_give_the_same_bits() {
    let (one, two) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    run("vest.ron", one.path(), &["--threads", "1", "--quality", "Draft"]);
    run("vest.ron", two.path(), &["--threads", "2", "--quality", "Draft"]);
    for file in ["garment.glb", "garment.obj", "front.png", "back.png", "side.png"] {
        let read = |dir: &Path| std::fs::read(dir.join(file)).unwrap();
        assert!(read(one.path()) == read(two.path()), "{file} differs");
    }
}

#[test]
fn one_and_two_threads_give_a_scene_the_same_bits() {
    let (one, two) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    run("scene.ron", one.path(), &["--threads", "1"]);
    run("scene.ron", two.path(), &["--threads", "2"]);
    let read = |dir: &Path| std::fs::read(dir.join("result.obj")).unwrap();
    assert!(read(one.path()) == read(two.path()));
}

#[test]
fn until_a_stage_writes_its_pictures_and_nothing_else() {
    let dir = tempfile::tempdir().unwrap();
    run("vest.ron", dir.path(), &["--until", "Otsu"]);
    let mut names: Vec<String> = Vec::new();
    for entry in std::fs::read_dir(dir.path()).unwrap() {
        names.push(entry.unwrap().file_name().into_string().unwrap());
    }
    names.sort();
    assert_eq!(names, ["metrics.json", "stages"]);
    assert!(dir.path().join("stages/Otsu/front.png").exists());
    assert!(dir.path().join("stages/Otsu/back.png").exists());
}

#[test]
#[ignore = "slow: .ci/wide"]
fn a_garment_with_one_photo_works() {
    let dir = tempfile::tempdir().unwrap();
    assert_wearable(&run(
        "vest.ron",
        dir.path(),
        &["--quality", "Draft", "--set", "photos.back=MirrorOf(\"front\")"],
    ));
}
