//! What pipelines leave out by facts of their scene: `toile explain` lists it, `toile trade
//! --ablate` reverses it.

use image::{RgbImage, codecs::jpeg::JpegEncoder};
use serde_json::Value;
use std::path::Path;
use toile_tests::{Answer, pipeline, root, toile};

/// The lines on decisions that `explain` prints, without what a decision saves, which depends on
/// the machine.
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

#[test]
fn factors_are_of_single_precision_where_that_solves_the_step() {
    let told =
        decisions(&[&pipeline("scene.ron"), "--set", "stages.StaticEquilibrium.bending_continuation=false"]);
    let words = "
  StaticEquilibrium    simplified double precision of each step's factor: only where single does not solve the step (mixed-precision)
      by      about 1024 triangles, whose matrix shows at each step how well it is solved
      within  surface 20 mm
";
    assert!(told.contains(words), "{told}");
    assert!(told.contains("      else    --set 'stages.StaticEquilibrium.precision=Double'"), "{told}");
    let continued = decisions(&[&pipeline("scene.ron")]);
    assert!(continued.contains("      within  surface 8 mm\n"), "{continued}");
    let turned = decisions(&[&pipeline("scene.ron"), "--set", "stages.StaticEquilibrium.precision=Double"]);
    assert!(!turned.contains("mixed-precision"), "{turned}");
}

#[test]
fn regions_at_rest_sleep_unless_they_may_not() {
    let told = decisions(&[&pipeline("scene.ron")]);
    let words = "
  StaticEquilibrium    simplified steps of all vertices: while few of them move, only these (regions-at-rest)
      by      about 1024 triangles, most of which rest before the last ones do
      within  surface 8 mm
";
    assert!(told.contains(words), "{told}");
    assert!(told.contains("      else    --set 'stages.StaticEquilibrium.asleep=false'"), "{told}");
    let turned = decisions(&[&pipeline("scene.ron"), "--set", "stages.StaticEquilibrium.asleep=false"]);
    assert!(!turned.contains("regions-at-rest"), "{turned}");
}

/// The skirt, with a cloth that nothing asks for.
const SKIRT: &str = r#"(
    name: "skirt",
    scene: Scene(file: "FILE"),
    fabric: Preset("cotton poplin"),
    stages: [ StaticEquilibrium(precision: Double, asleep: false), GarmentObj() ],
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
      by      no requested result depends on it
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
    assert!(answer.out.contains("\n    reversed by --set 'scene.distances=Ahead'\n"), "{}", answer.out);
    assert!(answer.out.contains("\n    reversed by --also Preset\n"), "{}", answer.out);
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
    for run in
        ["run 1 of 3: as decided", "run 2 of 3: --set 'scene.distances=Ahead'", "run 3 of 3: --also Preset"]
    {
        assert!(answer.err.contains(run), "{}", answer.err);
    }
    assert!(!answer.err.contains("budget"), "{}", answer.err);
    explained_by(&file, &out);
    let csv = std::fs::read_to_string(out.join("ablation.csv")).unwrap();
    assert_eq!(csv.lines().count(), 3, "{csv}");
    let both = toile(&["trade", &file, "--ablate", "--knob", "StaticEquilibrium.speed=1e-3..1e-2"]);
    assert!(both.err.contains("'--ablate' cannot be used with '--knob <KEY=VALUES>'"), "{}", both.err);
}

/// What each decision of a pipeline saves, as `explain --json` gives it.
fn savings(arguments: &[&str]) -> Vec<Value> {
    let answer = toile(&[&["explain", "--json"], arguments].concat());
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    let all: Value = serde_json::from_str(&answer.out).unwrap();
    all["decisions"].as_array().unwrap().iter().map(|d| d["saves"].clone()).collect()
}

/// Measured figures stand in the place of estimates, where they are of the pipeline as it is.
fn explained_by(file: &str, ablation: &Path) {
    let plain = savings(&[file]);
    assert_eq!(
        (plain[0]["basis"].as_str(), plain[1]["basis"].as_str()),
        (Some("estimated"), Some("modelled"))
    );
    let folder = ablation.display().to_string();
    let told = savings(&[file, "--ablation", &folder]);
    let record: Value =
        serde_json::from_str(&std::fs::read_to_string(ablation.join("ablation.json")).unwrap()).unwrap();
    for (saved, row) in told.iter().zip(record["rows"].as_array().unwrap()) {
        assert_eq!((saved["basis"].as_str(), saved["clock"].as_str()), (Some("measured"), Some("cpu")));
        assert_eq!((&saved["seconds"], &saved["date"]), (&row["saved_s"][0], &record["date"]));
        assert!(saved["noise_s"].is_null(), "one round tells of no noise");
    }
    let table = toile(&["explain", file, "--ablation", &folder]);
    assert!(table.out.contains(" s of processor time in one round, measured on 20"), "{}", table.out);
    let other =
        toile(&["explain", file, "--ablation", &folder, "--set", "stages.StaticEquilibrium.speed=0.01"]);
    let words = "ablation.json\" is not taken: it is of another state of the pipeline\n  help: `toile trade PIPELINE --ablate` measures again\n";
    assert!(other.code == 3 && other.err.ends_with(words), "{}", other.err);
    let gone = toile(&["explain", file, "--ablation", "no/such/folder"]);
    assert!(gone.code == 3 && gone.err.contains("ablation.json\" is not taken: "), "{}", gone.err);
}

#[test]
fn a_share_that_nobody_measured_here_is_called_estimated() {
    let answer = toile(&["explain", &pipeline("vest.ron")]);
    let words = "      saves   estimated: 40 % of what the stage takes without it, about ";
    assert!(answer.out.contains(words), "{}", answer.out);
}

#[test]
fn explain_gives_one_json_object() {
    let answer = toile(&["explain", "--json", &pipeline("vest.ron"), "--until", "GridMesher"]);
    assert_eq!((answer.code, answer.err.as_str()), (0, ""));
    let all: Value = serde_json::from_str(&answer.out).unwrap();
    assert_eq!((all["pipeline"].as_str(), &all["quality"]), (Some("vest"), &Value::Null));
    let qualities = all["qualities"].as_array().unwrap().iter();
    let named: Vec<_> = qualities.map(|q| (q["name"].as_str(), q["max_error_m"].as_f64())).collect();
    let want = [("Draft", 0.002), ("Standard", 0.001), ("Fine", 0.0007)].map(|(n, e)| (Some(n), Some(e)));
    assert_eq!(named, want);
    let stages = all["stages"].as_array().unwrap();
    let stage = |id: &str| stages.iter().find(|s| s["id"] == id).unwrap();
    let (mesher, drape) = (stage("GridMesher"), stage("StaticEquilibrium"));
    assert_eq!((&mesher["runs"], mesher["role"].as_str()), (&Value::Bool(true), Some("mesher")));
    assert_eq!(
        (mesher["takes"][0]["kind"].as_str(), mesher["takes"][0]["from"].as_str()),
        (Some("outline"), Some("Outline"))
    );
    for figure in ["wall_s", "peak_bytes"] {
        let e = &mesher["predicted"][figure];
        let [low, value, high] = ["low", "value", "high"].map(|k| e[k].as_f64().unwrap());
        assert!(0.0 <= low && low <= value && value <= high && value > 0.0, "{e}");
    }
    assert_eq!(drape["skipped"], "not needed until GridMesher");
    assert!(drape["predicted"].is_null() && !drape["runs"].as_bool().unwrap());
    // The whole is the sum of what runs.
    let sum: f64 = stages.iter().filter_map(|s| s["predicted"]["wall_s"]["value"].as_f64()).sum();
    assert!((all["predicted"]["wall_s"]["value"].as_f64().unwrap() / sum - 1.0).abs() < 1e-9);
    assert!(all["predicted_from"].as_str().unwrap().starts_with("from the shipped figures of "));

    let whole = toile(&["explain", "--json", &pipeline("vest.ron")]);
    let whole: Value = serde_json::from_str(&whole.out).unwrap();
    let views =
        whole["decisions"].as_array().unwrap().iter().find(|d| d["rule"] == "report-views").unwrap().clone();
    assert_eq!(
        (views["stage"].as_str(), views["state"].as_str(), views["within"].as_str()),
        (Some("Report"), Some("off"), Some("same bits"))
    );
    assert_eq!(views["turned_round_by"], "--set 'stages.Report.views=Drawn'");
    assert_eq!(
        (views["saves"]["basis"].as_str(), views["saves"]["share"].as_f64()),
        (Some("estimated"), Some(0.4))
    );

    let wrong = toile(&["explain", "--json", &pipeline("vest.ron"), "--set", "stages.Otsu.bia=1"]);
    let faults: Value = serde_json::from_str(&wrong.out).unwrap();
    assert_eq!((wrong.code, faults["faults"][0]["code"].as_str()), (3, Some("bad_override")));
    let unknown = toile(&["explain", "--json", &pipeline("vest.ron"), "--until", "Otzu"]);
    let error: Value = serde_json::from_str(&unknown.out).unwrap();
    assert!(
        unknown.code != 0 && error["message"].as_str().unwrap().starts_with("there is no stage `Otzu`"),
        "{error}"
    );
}

#[test]
fn a_pipeline_that_leaves_nothing_out_has_nothing_to_turn_round() {
    let turned = [
        "scene.distances=Ahead",
        "stages.StaticEquilibrium.precision=Double",
        "stages.StaticEquilibrium.asleep=false",
    ];
    let (scene, ahead) = (pipeline("scene.ron"), turned.map(|t| ["--set", t]).concat());
    assert_eq!(decisions(&[&[&*scene], &ahead[..]].concat()), "decisions: nothing is left out or simplified");
    let answer = toile(&[&["trade", &*scene, "--ablate"], &ahead[..]].concat());
    let words = "error: nothing is left out or simplified in this pipeline\n  help: `toile explain` shows the decisions of a pipeline\n";
    assert_eq!((answer.code, answer.err.as_str()), (3, words));
}
