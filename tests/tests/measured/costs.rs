//! What runs are expected to take, on the shipped pipelines: sizes, words, the record of earlier
//! runs.

use serde_json::Value;
use std::path::Path;
use std::sync::Arc;
use toile_core::cost::Used;
use toile_core::cost::{Quantity, Size};
use toile_core::{Cancel, Listener};
use toile_pipeline::cost::Meter;
use toile_pipeline::cost::foresee;
use toile_pipeline::{Override, Pipeline, RunOptions, load, run};
use toile_tests::{pipeline, root, toile};
use toile_trade::cost::{Costs, note};

fn loaded(name: &str, overrides: &[Override]) -> Pipeline {
    let text = std::fs::read_to_string(pipeline(name)).unwrap();
    load(&text, name, &root().join("pipelines"), &toile::registry(), overrides).unwrap()
}

/// A meter that only counts.
#[derive(Debug)]
struct Still;

impl Meter for Still {
    fn start(&self) {}
    fn stop(&self) -> Used {
        Used::default()
    }
}

/// What the stages up to `until` really made.
fn made(pipeline: &Pipeline, until: &str) -> Vec<(String, Size)> {
    let meter: Arc<dyn Meter> = Arc::new(Still);
    let options = RunOptions { until: Some(until.into()), meter: Some(meter), ..RunOptions::default() };
    let listener: Arc<dyn Listener> = Arc::new(());
    let result = run(pipeline, &options, &Cancel::new(), &listener).unwrap();
    result.costs.into_iter().map(|c| (c.stage, c.made)).collect()
}

fn edge(mm: u32) -> Override {
    Override { path: "stages.GridMesher.edge".into(), value: format!("\"{mm} mm\"") }
}

#[test]
fn sizes_are_foreseen_before_anything_runs() {
    for (name, mm) in [("vest.ron", 16), ("vest.ron", 30), ("tshirt.ron", 12)] {
        let pipeline = loaded(name, &[edge(mm)]);
        let foreseen = foresee(&pipeline, &|_, _| None);
        for (stage, fact) in made(&pipeline, "Arrange") {
            let foreseen = &foreseen[pipeline.find(&stage).unwrap()].made;
            for (quantity, fact) in fact.iter() {
                let ratio = foreseen.get(quantity).unwrap() / fact;
                let near = if quantity == Quantity::Pixels { 0.0 } else { 0.25 };
                assert!((ratio - 1.0).abs() <= near, "{name} {mm} mm, {stage}: {ratio} of {quantity:?}");
            }
        }
    }
}

#[test]
fn a_scene_is_foreseen_to_the_triangle() {
    let pipeline = loaded("scene.ron", &[]);
    let foreseen = foresee(&pipeline, &|_, _| None);
    let fact = &made(&pipeline, "Scene")[0].1;
    for quantity in [Quantity::Triangles, Quantity::BodyTriangles] {
        assert_eq!(foreseen[0].made.get(quantity), fact.get(quantity), "{quantity:?}");
    }
}

#[test]
fn a_refined_garment_is_foreseen_to_the_triangle() {
    let parts = Override { path: "stages.Subdivide.parts".into(), value: "3".into() };
    let pipeline = loaded("skirt.ron", &[parts]);
    let foreseen = foresee(&pipeline, &|_, _| None);
    let triangles = |stage: &str| foreseen[pipeline.find(stage).unwrap()].made.get(Quantity::Triangles);
    for (stage, fact) in made(&pipeline, "Settle") {
        assert_eq!(triangles(&stage), fact.get(Quantity::Triangles), "{stage}");
    }
    assert_eq!(triangles("GarmentObj"), Some(9.0 * triangles("StaticEquilibrium").unwrap()));
}

#[test]
fn a_way_of_its_own_has_records_of_its_own() {
    let pipeline = loaded("skirt.ron", &[]);
    let meter: Arc<dyn Meter> = Arc::new(Still);
    let options = RunOptions { meter: Some(meter), ..RunOptions::default() };
    let listener: Arc<dyn Listener> = Arc::new(());
    let costs = run(&pipeline, &options, &Cancel::new(), &listener).unwrap().costs;
    let noted: Vec<String> =
        note(&pipeline, &costs, &Costs::default(), 1).into_iter().map(|r| r.stage).collect();
    assert_eq!(noted[1..4], ["StaticEquilibrium", "Subdivide", "StaticEquilibrium(from_here: true)"]);
}

#[test]
fn photos_that_are_not_there_leave_sizes_unknown() {
    let gone = Override { path: "photos.front.file".into(), value: "\"gone.jpg\"".into() };
    let foreseen = foresee(&loaded("vest.ron", &[gone]), &|_, _| None);
    assert_eq!(foreseen[0].made.get(Quantity::Pixels), None);
}

#[test]
fn explain_says_what_a_run_will_take() {
    let answer = toile(&["explain", &pipeline("vest.ron"), "--until", "Otsu"]);
    assert_eq!((answer.code, answer.err.as_str()), (0, ""));
    let told = answer.out.lines().skip_while(|l| !l.starts_with("expected"));
    let told: Vec<&str> = told.take_while(|l| !l.starts_with("decisions")).collect();
    assert_eq!(
        told[0],
        "expected where nothing comes from the cache: wall time and memory at its peak beyond what is held before"
    );
    assert!(
        told[1].starts_with("(80 of 100 runs lie in the range; from the shipped figures of "),
        "{}",
        told[1]
    );
    assert!(told[1].ends_with(" cores; none of this machine's runs is known yet)"), "{}", told[1]);
    let names: Vec<&str> = told[2..].iter().map(|l| l[..22].trim()).collect();
    assert_eq!(names, ["Photos", "NeighbourhoodMean", "Otsu", "all, one by one"]);
    for line in &told[2..] {
        assert_eq!(line.matches(" to ").count(), 2, "a range of time and one of memory: {line}");
        assert!(!line.contains("not known") && !line.contains("stand in"), "{line}");
    }
}

fn run_scene(cache: &Path, more: &[&str]) -> toile_tests::Answer {
    let (file, cache, out) =
        (pipeline("scene.ron"), cache.display().to_string(), cache.join("out").display().to_string());
    let all = [&["run", &file, "--cache-dir", &cache, "--out", &out, "--until", "Scene"], more].concat();
    toile(&all)
}

#[test]
fn a_run_says_what_it_took_beside_what_was_expected() {
    let dir = tempfile::tempdir().unwrap();
    let plain = run_scene(dir.path(), &[]);
    assert_eq!(plain.code, 0, "{}", plain.err);
    assert!(!plain.out.contains("expected"), "only when asked: {}", plain.out);
    let file = std::fs::read_to_string(dir.path().join("out/metrics.json")).unwrap();
    let stage = serde_json::from_str::<Value>(&file).unwrap()["stages"][0].clone();
    assert_eq!(stage["id"], "Scene");
    assert!(stage["used"]["wall_s"].as_f64().unwrap() > 0.0, "{stage}");
    let expected = &stage["predicted"]["wall_s"];
    let at = |key: &str| expected[key].as_f64().unwrap();
    assert!(0.0 < at("low") && at("low") < at("value") && at("value") < at("high"), "{stage}");

    let other = dir.path().join("second");
    let told = run_scene(&other, &["--verbose"]);
    let line = told.out.lines().find(|l| l.contains(" took ")).unwrap();
    assert!(line.starts_with("  Scene                took ") && line.contains(" expected "), "{line}");
    assert!(told.out.lines().any(|l| l.starts_with("expected times: ") && l.contains(" of 1 within 30 %, ")));
}

#[test]
fn what_a_run_took_is_known_to_the_next() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(run_scene(dir.path(), &[]).code, 0);
    let (file, cache) = (pipeline("scene.ron"), dir.path().display().to_string());
    let explain = || toile(&["explain", &file, "--cache-dir", &cache, "--until", "Scene"]);
    let answer = explain();
    assert!(
        answer.out.contains("; from one run of a stage on this machine and the shipped figures of "),
        "{}",
        answer.out
    );
    // A result that comes from the cache took nothing.
    assert_eq!(run_scene(dir.path(), &[]).code, 0);
    assert_eq!(explain().out, answer.out);

    let store = walk(dir.path()).into_iter().find(|p| p.ends_with("costs.jsonl")).unwrap();
    std::fs::write(&store, "{\"scheme\":").unwrap();
    let spoilt = explain();
    let words = format!(
        "warning: what earlier runs took, \"{}\", is damaged; the shipped figures stand in\n",
        store.display()
    );
    assert_eq!((spoilt.code, spoilt.err), (0, words));
    assert!(spoilt.out.contains("none of this machine's runs is known yet"));
    // A run goes on without a word, and mends it.
    let run = run_scene(dir.path(), &["--set", "scene.file=samples/scene/./skirt.json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    assert_eq!(explain().err, "");
}

fn walk(dir: &Path) -> Vec<std::path::PathBuf> {
    let items = std::fs::read_dir(dir).unwrap().map(|e| e.unwrap().path());
    items.flat_map(|p| if p.is_dir() { walk(&p) } else { vec![p] }).collect()
}

#[test]
fn records_are_measured_and_checked_by_the_bench() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("costs.jsonl").display().to_string();
    let measured = toile(&["bench", "costs", &pipeline("scene.ron"), "--out", &out]);
    assert_eq!(measured.code, 0, "{}", measured.err);
    assert!(measured.out.starts_with("5 runs of stages on "), "{}", measured.out);
    let checked = toile(&["bench", "costs", "--from", &out, "--check"]);
    let words = "within 30 %: 0 % (0 of 5) of all, 0 % (0 of ";
    assert!(checked.out.contains(words), "nothing else to fit to: {}", checked.out);
    std::fs::write(&out, "nonsense").unwrap();
    let refused = toile(&["bench", "costs", "--from", &out]);
    assert_eq!((refused.code, refused.err), (3, format!("error: \"{out}\" is damaged\n")));
}

#[test]
fn springs_are_measured_on_garments_cut_along_their_outline() {
    for kind in ["tee", "vest"] {
        let file = format!("springs_{kind}.ron");
        let text = std::fs::read_to_string(root().join("tests/costs").join(&file)).unwrap();
        let springs = load(&text, &file, &root().join("tests/costs"), &toile::registry(), &[]).unwrap();
        assert!(springs.find("SpringDraper").is_some() && springs.find("Outline").is_some(), "{file}");
        assert!(springs.find("StaticEquilibrium").is_none(), "{file}");
    }
}
