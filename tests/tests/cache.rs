//! The cache on whole pipelines: the same bytes with and without it, and only what changed runs
//! again.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use toile_tests::{Answer, pipeline, toile, without_rest};

/// A copy of the vest's pipeline in a folder of its own, with its photos and a cache.
struct Bench {
    dir: TempDir,
    ron: PathBuf,
}

/// The vest as placed, not sewn: quick to run, and short of its quality limits.
fn unsewn(text: &str) -> String {
    without_rest(text).replace("Preview(), Report(),", "Report(pictures: 32),")
}

impl Bench {
    fn new(edit: impl Fn(&str) -> String) -> Self {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir_all(dir.path().join("samples/vest")).unwrap();
        for photo in ["samples/vest/front.jpg", "samples/vest/back.jpg"] {
            fs::copy(pipeline(photo), dir.path().join(photo)).unwrap();
        }
        let ron = dir.path().join("vest.ron");
        fs::write(&ron, edit(&fs::read_to_string(pipeline("vest.ron")).unwrap())).unwrap();
        Bench { dir, ron }
    }

    fn path(&self, name: &str) -> String {
        self.dir.path().join(name).display().to_string()
    }

    fn toile(&self, command: &str, more: &[&str]) -> Answer {
        let (ron, cache) = (self.ron.display().to_string(), self.path("cache"));
        toile(&[&[command, &ron, "--cache-dir", &cache], more].concat())
    }

    /// Runs into a folder; returns the exit code and the metrics.
    fn run(&self, out: &str, more: &[&str]) -> (u8, Value) {
        let dir = self.path(out);
        let answer = self.toile("run", &[&["--out", &dir, "--json"], more].concat());
        assert!(!answer.out.is_empty(), "{}", answer.err);
        (answer.code, serde_json::from_str(&answer.out).unwrap())
    }

    /// Runs without a cache.
    fn run_bare(&self, out: &str, more: &[&str]) -> (u8, Value) {
        let (ron, dir) = (self.ron.display().to_string(), self.path(out));
        let answer = toile(&[&["run", &ron, "--out", &dir, "--json", "--no-cache"], more].concat());
        (answer.code, serde_json::from_str(&answer.out).unwrap())
    }

    fn file(&self, out: &str, name: &str) -> Vec<u8> {
        fs::read(self.dir.path().join(out).join(name)).unwrap()
    }
}

/// The ids of the stages that ran, or that came from the cache.
fn stages(metrics: &Value, cached: bool) -> Vec<&str> {
    let all = metrics["stages"].as_array().unwrap().iter();
    all.filter(|s| s["cached"] == cached && s["skipped"].is_null())
        .map(|s| s["id"].as_str().unwrap())
        .collect()
}

/// Metrics without what differs from run to run: times, the machine's memory, the cache itself.
fn timeless(metrics: &Value) -> Value {
    let mut m = metrics.clone();
    m["wall_s"] = Value::Null;
    m["garment"]["peak_memory_bytes"] = Value::Null;
    for stage in m["stages"].as_array_mut().unwrap() {
        (stage["wall_s"], stage["cached"]) = (Value::Null, Value::Null);
        stage.as_object_mut().unwrap().retain(|key, _| key != "used" && key != "predicted");
    }
    m
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_vest_has_the_same_bytes_with_and_without_a_cache_and_is_not_sewn_twice() {
    let bench = Bench::new(str::to_owned);
    let draft = ["--quality", "Draft"];
    let (bare, cold, warm) =
        (bench.run_bare("bare", &draft), bench.run("cold", &draft), bench.run("warm", &draft));
    assert_eq!((bare.0, cold.0, warm.0), (0, 0, 0));
    assert!(stages(&bare.1, true).is_empty() && stages(&cold.1, true).is_empty());
    assert_eq!(stages(&warm.1, false), Vec::<&str>::new());
    for file in ["garment.glb", "garment.obj", "garment.mtl", "garment_front.jpg", "front.png", "origin.json"]
    {
        let bytes = bench.file("bare", file);
        assert!(bytes == bench.file("cold", file) && bytes == bench.file("warm", file), "{file}");
    }
    assert_eq!(bench.file("cold", "report.html"), bench.file("warm", "report.html"));
    assert_eq!(timeless(&bare.1), timeless(&cold.1));
    assert_eq!(timeless(&bare.1), timeless(&warm.1));

    let (code, textured) =
        bench.run("textured", &["--quality", "Draft", "--set", "stages.PhotoTexturer.inset=\"3 mm\""]);
    assert_eq!(code, 0);
    let ran = stages(&textured, false);
    assert!(
        !ran.contains(&"StaticEquilibrium") && !ran.contains(&"Measure") && !ran.contains(&"Mannequin"),
        "{ran:?}"
    );
    assert!(ran.contains(&"PhotoTexturer") && ran.contains(&"Glb") && ran.contains(&"Report"), "{ran:?}");
}

#[test]
fn a_result_short_of_its_limits_is_so_from_the_cache_as_well() {
    let bench = Bench::new(unsewn);
    let (cold, warm) = (bench.run("cold", &[]), bench.run("warm", &[]));
    assert_eq!((cold.0, warm.0), (4, 4));
    assert!(!warm.1["shortfalls"].as_array().unwrap().is_empty());
    assert_eq!(timeless(&cold.1), timeless(&warm.1));
    assert!(stages(&warm.1, false).is_empty());
}

#[test]
fn an_edited_photo_leaves_the_other_panel_alone() {
    let bench = Bench::new(unsewn);
    bench.run("out", &[]);
    fs::copy(pipeline("samples/vest/back.jpg"), bench.dir.path().join("samples/vest/front.jpg")).unwrap();
    let why = bench.toile("why", &["NeighbourhoodMean"]);
    assert_eq!((why.code, why.err.as_str()), (0, ""));
    assert_eq!(
        why.out,
        "NeighbourhoodMean: would run: upstream \"Photos\" would run again\n  \
         since Photos: would run: file samples/vest/front.jpg changed\n"
    );
    let (_, metrics) = bench.run("out", &["--until", "Photos"]);
    assert_eq!(stages(&metrics, false), ["Photos"]);
    // With the photos read again, what stands still is known panel by panel.
    assert_eq!(
        bench.toile("why", &["NeighbourhoodMean"]).out,
        "NeighbourhoodMean (back): from the cache\n\
         NeighbourhoodMean (front): would run: upstream \"Photos\" changed\n"
    );
}

#[test]
fn a_run_without_cache_leaves_none_and_until_and_keep_give_their_files_from_it() {
    let bench = Bench::new(unsewn);
    bench.run_bare("bare", &[]);
    assert!(!Path::new(&bench.path("cache")).exists());
    let until = ["--until", "Otsu"];
    bench.run("cold", &until);
    let (code, metrics) = bench.run("warm", &until);
    assert_eq!((code, stages(&metrics, false).len()), (0, 0));
    let mask = "stages/Otsu/front.png";
    assert_eq!(bench.file("cold", mask), bench.file("warm", mask));
}

#[test]
fn damage_is_a_warning_and_the_result_the_same() {
    let bench = Bench::new(unsewn);
    let cold = bench.run("cold", &["--until", "Otsu"]);
    let mut folders = vec![bench.dir.path().join("cache/v1/blobs")];
    while let Some(folder) = folders.pop() {
        for item in fs::read_dir(folder).unwrap() {
            let path = item.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false => fs::write(path, "not what it was").unwrap(),
            }
        }
    }
    let (dir, damage) = (bench.path("warm"), "its content does not have its digest; it is made anew");
    let answer = bench.toile("run", &["--out", &dir, "--until", "Otsu"]);
    assert_eq!(answer.code, 0);
    for of in ["Otsu (front)", "Otsu (back)", "Photos (front)"] {
        let line = format!("warning: damaged cache entry of {of}: {damage}\n");
        assert!(answer.err.contains(&line), "{}", answer.err);
    }
    assert_eq!(bench.file("cold", "stages/Otsu/back.png"), bench.file("warm", "stages/Otsu/back.png"));
    let again = bench.run("again", &["--until", "Otsu"]);
    assert_eq!(timeless(&cold.1), timeless(&again.1));
    assert!(stages(&again.1, false).is_empty());
}

#[test]
fn a_cache_that_cannot_be_written_is_one_warning() {
    let bench = Bench::new(unsewn);
    fs::write(bench.path("cache"), "a file").unwrap();
    let dir = bench.path("out");
    let answer = bench.toile("run", &["--out", &dir, "--until", "Otsu"]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let head = format!("warning: cannot write to the cache \"{}/v1\": ", bench.path("cache"));
    assert!(answer.err.starts_with(&head), "{}", answer.err);
    assert!(answer.err.ends_with("; the run goes on without keeping results\n"), "{}", answer.err);
    assert_eq!(answer.err.lines().count(), 1, "{}", answer.err);
}

#[test]
fn the_cache_is_shown_pruned_and_cleared() {
    let bench = Bench::new(unsewn);
    let cache = bench.path("cache");
    let show = |more: &[&str]| toile(&[&["cache", "--cache-dir", &cache], more].concat());
    assert_eq!(show(&[]).out, format!("{cache}/v1: 0 runs of stages, 0 artifacts, 0 B\n"));
    bench.run("out", &["--until", "Otsu"]);
    let usage: Value = serde_json::from_str(&show(&["--json"]).out).unwrap();
    // Two photos, smoothed, and their masks; Photos stands twice, since it reads files.
    assert_eq!((&usage["runs"], &usage["artifacts"]), (&Value::from(6), &Value::from(6)));
    assert!(usage["bytes"].as_u64().unwrap() > 1_000_000, "{usage}");
    let pruned: Value = serde_json::from_str(&show(&["--prune", "1 MB", "--json"]).out).unwrap();
    assert!(pruned["bytes"].as_u64().unwrap() <= 1_000_000, "{pruned}");
    assert!(show(&["--clear"]).out.starts_with("freed "));
    assert_eq!(show(&[]).out, format!("{cache}/v1: 0 runs of stages, 0 artifacts, 0 B\n"));
    let bad = show(&["--prune", "much"]);
    assert_eq!(bad.code, 2);
    assert!(
        bad.err.contains("\"much\" is not a size; write a number and a unit, like \"500 MB\""),
        "{}",
        bad.err
    );
}
