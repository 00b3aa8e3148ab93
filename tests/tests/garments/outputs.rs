//! What is written, and what keeps a command from writing.

use std::fs;
use std::path::{Path, PathBuf};
use toile_tests::{pipeline, toile};

/// The sample scene's pipeline in a folder of its own, with something in it replaced.
fn scene(dir: &Path, from: &str, to: &str) -> PathBuf {
    let text = fs::read_to_string(pipeline("scene.ron")).unwrap();
    let text = text.replace("samples/", &format!("{}/samples/", pipeline("")));
    assert!(text.contains(from), "{text}");
    let path = dir.join("scene.ron");
    fs::write(&path, text.replace(from, to)).unwrap();
    path
}

#[test]
fn two_stages_that_write_one_file_are_refused_and_nothing_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let writer = "GarmentObj(name: \"result\"),";
    let twice = format!("{writer} GarmentObj(id: \"Again\", name: \"result\"),");
    let ron = scene(dir.path(), writer, &twice).display().to_string();
    let out = dir.path().join("out");
    let answer = toile(&["run", &ron, "--out", &out.display().to_string(), "--no-cache"]);
    assert_eq!(answer.code, 3, "{}", answer.err);
    assert!(answer.err.contains("Again: it writes \"result.obj\", as `GarmentObj` does"), "{}", answer.err);
    assert!(answer.err.contains("help: give one of them another `name`, or leave one out"), "{}", answer.err);
    assert!(!out.exists());
}

#[test]
fn an_output_folder_that_cannot_be_is_refused_before_the_run() {
    let dir = tempfile::tempdir().unwrap();
    let ron = scene(dir.path(), "result", "result").display().to_string();
    // A run would end out of time.
    let short = ["--set", "stages.StaticEquilibrium.time_limit=0.001", "--no-cache"];
    let taken = dir.path().join("taken");
    fs::write(&taken, "a file").unwrap();
    let out = taken.join("out").display().to_string();
    let answer = toile(&[&["run", &ron, "--out", &out][..], &short].concat());
    assert_eq!(answer.code, 3);
    assert!(answer.err.contains(&format!("cannot write \"{out}\": ")), "{}", answer.err);
    assert!(answer.err.contains("choose another folder with --out"), "{}", answer.err);
    assert_eq!(fs::read_to_string(taken).unwrap(), "a file");
}

#[test]
fn a_golden_that_cannot_be_read_is_no_golden_that_agrees() {
    let dir = tempfile::tempdir().unwrap();
    let ron = scene(dir.path(), "result", "result");
    let golden = dir.path().join("goldens/scene.txt");
    fs::create_dir_all(&golden).unwrap();
    let answer = toile(&["golden", "check", &ron.display().to_string()]);
    assert_eq!(answer.code, 3, "{}", answer.out);
    let words = format!("error: cannot read the golden \"{}\": ", golden.display());
    assert!(answer.err.starts_with(&words), "{}", answer.err);
}
