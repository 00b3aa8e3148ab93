//! What pipelines leave out by facts of their scene: `toile explain` tells it, `toile trade --ablate` turns it round.
#![allow(clippy::unwrap_used)]

use image::{RgbImage, codecs::jpeg::JpegEncoder};
use serde_json::Value;
use std::path::Path;
use toile_tests::{Answer, pipeline, root, toile};

/// The lines on decisions that `explain` prints, without what a decision saves, which depends on the machine.
fn decisions(arguments: &[&str]) -> String {
    let answer = toile(&[&["explain"], arguments].concat());
    assert_eq!((answer.code, answer.err.as_str()), (0, ""));
    let lines = answer.out.lines().skip_while(|l| !l.starts_with("decisions:"));
    lines.filter(|l| !l.starts_with("      saves   about ")).collect::<Vec<_>>().join("\n")
}

const HEAD: &str =
    "decisions: what is left out or simplified (`toile trade PIPELINE --ablate` measures each)";

/// A picture of that size; rules look at its header alone.
fn blank(path: &Path, (w, h): (u32, u32)) -> String {
    let mut bytes = Vec::new();
    JpegEncoder::new(&mut bytes).encode_image(&RgbImage::new(w, h)).unwrap();
    std::fs::write(path, bytes).unwrap();
    format!("photos.front.file={}", path.display())
}

#[test]
fn small_photos_are_taken_as_they_are() {
    let told = decisions(&[&pipeline("vest.ron")]);
    assert!(told.starts_with(HEAD), "{told}");
    for rule in ["joined-pixels", "texture-size"] {
        assert!(!told.contains(rule), "{told}");
    }
}

#[test]
fn large_photos_are_brought_down_for_the_outline_and_for_textures() {
    let dir = tempfile::tempdir().unwrap();
    let large = blank(&dir.path().join("front.jpg"), (3360, 3840));
    let told = decisions(&[&pipeline("vest.ron"), "--set", &large]);
    let outline = "
  NeighbourhoodMean    simplified photos for the outline: 3 x 3 pixels joined (joined-pixels)
      by      pixels of about 0.15 mm, no more than 0.50 mm is asked for
      within  outline 1 mm
      else    --set 'stages.NeighbourhoodMean.pixel=\"0 mm\"'
      source  sampling: Nyquist 1928; Canny 1986";
    let texture = "
  PhotoTexturer        simplified textures: at most 2048 px to a side (texture-size)
      by      the photos' longer side has 3840 px
      within  texture 4 levels
      else    --set 'stages.PhotoTexturer.size=8192'
      source  area average: Williams 1983";
    assert!(told.contains(outline) && told.contains(texture), "{told}");
    let turned =
        ["--set", "stages.NeighbourhoodMean.pixel=\"0 mm\"", "--set", "stages.PhotoTexturer.size=8192"];
    let told = decisions(&[&[&*pipeline("vest.ron"), "--set", &large], &turned[..]].concat());
    assert!(!told.contains("joined-pixels") && !told.contains("texture-size"), "{told}");
}

#[test]
fn photos_that_cannot_be_read_leave_nothing_out() {
    let told = decisions(&[&pipeline("vest.ron"), "--set", "photos.front.file=\"gone.jpg\""]);
    assert!(!told.contains("joined-pixels") && !told.contains("texture-size"), "{told}");
}

#[test]
fn the_reports_views_are_those_of_the_preview_where_there_is_one() {
    let told = decisions(&[&pipeline("vest.ron")]);
    let words = "
  Report               off        views of the result, drawn for the report (report-views)
      by      Preview draws the same model before it
      within  same bits";
    assert!(told.contains(words), "{told}");
    assert!(told.contains("      else    --set 'stages.Report.views=Drawn'"), "{told}");
    for turned in ["stages.Report.views=Drawn", "stages.Preview.frame=Whole", "stages.Preview.size=600"] {
        assert!(!decisions(&[&pipeline("vest.ron"), "--set", turned]).contains("report-views"), "{turned}");
    }
}

/// The skirt, with a cloth that nothing asks for.
const SKIRT: &str = r#"(
    name: "skirt",
    scene: Scene(file: "FILE"),
    fabric: Preset("cotton poplin"),
    stages: [ Rest(), GarmentObj() ],
)
"#;

fn skirt(dir: &Path) -> String {
    let scene = root().join("pipelines/samples/scene/skirt.json");
    let scene = scene.canonicalize().unwrap().display().to_string();
    let file = dir.join("skirt.ron");
    std::fs::write(&file, SKIRT.replace("FILE", &scene)).unwrap();
    file.display().to_string()
}

#[test]
fn what_nobody_asks_for_is_told_and_runs_on_request() {
    let dir = tempfile::tempdir().unwrap();
    let file = skirt(dir.path());
    let words = "
  Preset               off        the whole stage (unasked)
      by      nothing asked for depends on it
      within  same bits
      saves   nothing that could be expected
      else    --also Preset
      source  dead code: Kennedy 1981";
    let told = decisions(&[&file]);
    assert!(told.contains(words), "{told}");
    assert!(!decisions(&[&file, "--until", "Scene"]).contains("unasked"));
    let out = dir.path().join("out").display().to_string();
    let run =
        |more: &[&str]| toile(&[&["run", &file, "--until", "Scene", "--out", &out, "--json"], more].concat());
    let skipped = |answer: &Answer| {
        let metrics: Value = serde_json::from_str(&answer.out).unwrap();
        let stages = metrics["stages"].as_array().unwrap().clone();
        stages.iter().find(|s| s["id"] == "Preset").unwrap()["skipped"].is_string()
    };
    assert!(skipped(&run(&[])));
    assert!(!skipped(&run(&["--also", "Preset"])));
    let unknown = run(&["--also", "Pleats"]);
    assert_ne!(unknown.code, 0);
    assert!(unknown.out.contains("there is no stage `Pleats` in this pipeline"), "{}", unknown.out);
}

#[test]
fn each_decision_is_turned_round_and_held_to_its_tolerance() {
    let dir = tempfile::tempdir().unwrap();
    let (file, out) = (skirt(dir.path()), dir.path().join("ablation"));
    let answer = toile(&["trade", &file, "--ablate", "--repeats", "1", "--out", &out.display().to_string()]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.out.contains("\n    turned round by --set 'scene.distances=Ahead'\n"), "{}", answer.out);
    assert!(answer.out.contains("\n    turned round by --also Preset\n"), "{}", answer.out);
    let record: Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("ablation.json")).unwrap()).unwrap();
    let rows = record["rows"].as_array().unwrap();
    let rules: Vec<_> = rows.iter().map(|r| r["rule"].as_str().unwrap()).collect();
    assert_eq!(rules, ["asked-distances", "unasked"]);
    for row in rows {
        assert_eq!(row["change"]["same_bits"], true, "{row}");
        assert!(row["change"]["distance_mm"]["max"].as_f64().unwrap() < 1e-9, "{row}");
        assert_ne!(row["verdict"], "changes_more", "{row}");
        assert_eq!(row["cpu_s"].as_array().unwrap().len(), 1);
    }
    let csv = std::fs::read_to_string(out.join("ablation.csv")).unwrap();
    assert_eq!(csv.lines().count(), 3, "{csv}");
    let both = toile(&["trade", &file, "--ablate", "--knob", "Rest.speed=1e-3..1e-2"]);
    assert!(both.err.contains("'--ablate' cannot be used with '--knob <KEY=VALUES>'"), "{}", both.err);
}

#[test]
fn a_pipeline_that_leaves_nothing_out_has_nothing_to_turn_round() {
    let (scene, ahead) = (pipeline("scene.ron"), ["--set", "scene.distances=Ahead"]);
    assert_eq!(decisions(&[&[&*scene], &ahead[..]].concat()), "decisions: nothing is left out or simplified");
    let answer = toile(&[&["trade", &*scene, "--ablate"], &ahead[..]].concat());
    let words = "error: nothing is left out or simplified in this pipeline\n  help: `toile explain` shows the decisions of a pipeline\n";
    assert_eq!((answer.code, answer.err.as_str()), (3, words));
}
