//! `toile batch` and `toile manifest` as programs: garments so small that a run takes milliseconds.

mod faults;
mod killed;
mod manifests;
mod qualities;
mod results;
mod stores;

use crate::sheet::sheet;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// A garment and its file. `none.json` is not there: every garment brings its own scene.
const PIPELINE: &str = "(name: \"sheet\", scene: Scene(file: \"none.json\"), stages: [StaticEquilibrium(speed: 0.01), GarmentObj()])";

/// A folder with a pipeline, a scene for each of so many garments, and their manifest.
fn set(count: usize) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("sheet.ron"), PIPELINE).unwrap();
    fs::create_dir(dir.path().join("in")).unwrap();
    for k in 0..count {
        write_scene(dir.path(), k, 0.01 + 1e-4 * k as f64);
    }
    let lines: String = (0..count).map(line).collect();
    fs::write(dir.path().join("in/manifest.jsonl"), lines).unwrap();
    dir
}

/// The scene of one garment: how far it leans decides how it hangs.
fn write_scene(dir: &Path, garment: usize, lean: f64) {
    let mut scene = sheet();
    scene["positions"][2][2] = lean.into();
    fs::write(dir.join(format!("in/s{garment}.json")), scene.to_string()).unwrap();
}

/// A garment that takes seconds and much memory: a sheet of so many squares a side.
fn write_large(dir: &Path, garment: usize, side: usize) {
    let n = side + 1;
    let at = |i: usize| ((i % n) as f64 / side as f64, (i / n) as f64 / side as f64);
    let flat: Vec<[f64; 2]> = (0..n * n).map(|i| [at(i).0, at(i).1]).collect();
    let lifted: Vec<[f64; 3]> = (0..n * n).map(|i| [at(i).0, at(i).1, 0.02 * at(i).1]).collect();
    let corner = |k: usize| k / side * n + k % side;
    let halves = |a: usize| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]];
    let triangles: Vec<[usize; 3]> = (0..side * side).flat_map(|k| halves(corner(k))).collect();
    let mut scene = sheet();
    scene["panels"] = json!([{ "name": "sheet", "vertices": [0, n * n], "triangles": [0, triangles.len()] }]);
    scene["pinned"] = json!([n * side, n * n - 1]);
    scene["rest_uv"] = json!(flat);
    scene["positions"] = json!(lifted);
    scene["triangles"] = json!(triangles);
    fs::write(dir.join(format!("in/s{garment}.json")), scene.to_string()).unwrap();
}

fn line(garment: usize) -> String {
    format!("{{\"id\": \"g{garment}\", \"set\": {{\"scene.file\": \"s{garment}.json\"}}}}\n")
}

fn toile(dir: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
    command
        .current_dir(dir)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// A batch of the manifest into `out`.
fn batch(dir: &Path, out: &str, more: &[&str]) -> Command {
    let all = ["batch", "in/manifest.jsonl", "--pipeline", "sheet.ron", "--out", out, "--no-cache"];
    toile(dir, &[&all[..], more].concat())
}

/// The exit code, standard output and standard error.
fn words(output: &Output) -> (Option<i32>, String, String) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

fn ran(mut command: Command) -> (Option<i32>, String, String) {
    words(&command.output().unwrap())
}

/// The lines of `results.jsonl` by their ids.
fn results(dir: &Path, out: &str) -> BTreeMap<String, Value> {
    let text = fs::read_to_string(dir.join(out).join("results.jsonl")).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    lines.map(|line| (line["id"].as_str().unwrap().to_owned(), line)).collect()
}

/// Every file of an output folder with its content, but for what holds times and locks.
fn content(dir: &Path, out: &str) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    below(&dir.join(out), "", &mut files);
    let differs = |name: &str| {
        name.starts_with("locks/")
            || ["costs.jsonl", "metrics.json", "report.html", "record.json"]
                .iter()
                .any(|end| name.ends_with(end))
    };
    files.retain(|name, _| !differs(name));
    files
}

fn below(folder: &Path, before: &str, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in fs::read_dir(folder).unwrap().map(|e| e.unwrap()) {
        let name = format!("{before}{}", entry.file_name().to_string_lossy());
        match entry.path().is_dir() {
            true => below(&entry.path(), &format!("{name}/"), files),
            false => drop(files.insert(name, fs::read(entry.path()).unwrap())),
        }
    }
}
