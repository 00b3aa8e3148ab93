//! Runs with a cache: what runs again, what does not, and what becomes of damage.
#![allow(clippy::unwrap_used)]

use super::{Cache, Cause};
use crate::pipeline::{Override, Pipeline, load};
use crate::prelude::*;
use crate::{Cancel, Event, Listener, RunError, RunOptions, RunResult, forecast, run};
use image::{Rgb, RgbImage};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use tempfile::TempDir;

/// Every run of a stage of this file: test, stage and entry.
static RUNS: Mutex<Vec<String>> = Mutex::new(Vec::new());

fn note(test: &str, what: String) {
    RUNS.lock().unwrap_or_else(PoisonError::into_inner).push(format!("{test} {what}"));
}

/// Reads two files: a byte each, which is the level of a photo of one pixel.
#[stage(role = Reader, contracts(Deterministic))]
struct Bytes2 {
    /// The test.
    #[param(default = String::new())]
    test: String,
}

#[stage]
impl Bytes2 {
    fn run(&self, cx: &Context) -> Result<Set<Photo>, StageError> {
        note(&self.test, "Bytes2".into());
        let read = |name: &str| {
            let bytes = cx.read(&format!("{name}.txt"))?;
            let level = bytes.first().copied().ok_or_else(|| StageError::invalid("it is empty"))?;
            let pixels = Shared::new(RgbImage::from_pixel(2, 1, Rgb([level; 3])));
            let (file, mirrored) = (name.to_owned(), false);
            let photo = Photo {
                pixels,
                alpha: None,
                px_per_metre: None,
                garment_width: None,
                mirrored,
                joined: 1,
                file,
            };
            Ok((name.to_owned(), photo))
        };
        ["back", "front"].into_iter().map(read).collect()
    }
}

/// Keeps the lower part of each level.
#[stage(role = Denoiser, contracts(Deterministic))]
struct Modulo {
    /// Levels are counted up to here.
    #[param(default = 100, min = 1, max = 255)]
    levels: u8,
    /// The test.
    #[param(default = String::new())]
    test: String,
}

#[stage]
impl Modulo {
    fn run(&self, photo: &Photo, cx: &Context) -> Result<Photo, StageError> {
        note(&self.test, format!("Modulo {}", cx.entry()));
        let mut pixels = photo.pixels.as_ref().clone();
        pixels.iter_mut().for_each(|v| *v %= self.levels);
        cx.figure("level", f64::from(pixels.get_pixel(0, 0)[0]) / 3.0, "grey levels");
        cx.warn("it is small");
        Ok(photo.with_pixels(pixels))
    }
}

/// As Modulo, without a promise.
#[stage(role = Denoiser)]
struct Dice {
    /// The test.
    #[param(default = String::new())]
    test: String,
}

#[stage]
impl Dice {
    fn run(&self, photo: &Photo, cx: &Context) -> Result<Photo, StageError> {
        note(&self.test, format!("Dice {}", cx.entry()));
        Ok(photo.clone())
    }
}

/// Writes the levels.
#[stage(role = Writer, contracts(Deterministic))]
struct Levels {
    /// The test.
    #[param(default = String::new())]
    test: String,
}

#[stage]
impl Levels {
    fn run(&self, photos: Set<Photo>, _cx: &Context) -> Result<OutputFiles, StageError> {
        note(&self.test, "Levels".into());
        let levels: Vec<u8> = photos.iter().map(|(_, p)| p.pixels.get_pixel(0, 0)[0]).collect();
        Ok(OutputFiles::one("levels.bin", levels))
    }
}

/// Writes which stages there were.
#[stage(role = Writer, contracts(Deterministic))]
struct Log {
    /// The test.
    #[param(default = String::new())]
    test: String,
}

#[stage]
impl Log {
    fn run(&self, log: &RunLog, _cx: &Context) -> Result<OutputFiles, StageError> {
        note(&self.test, "Log".into());
        let line = |s: &StageRecord| format!("{} {}\n", s.id, s.outputs.len());
        Ok(OutputFiles::one("log.txt", log.stages.iter().map(line).collect::<String>().into_bytes()))
    }
}

/// A folder with two photos, a pipeline and a cache.
struct Bench {
    test: &'static str,
    dir: TempDir,
    cache: PathBuf,
    stages: &'static str,
}

const STAGES: &str = "Bytes2(test: T), Modulo(test: T), Levels(test: T), Log(test: T)";

impl Bench {
    fn new(test: &'static str, stages: &'static str) -> Self {
        let dir = tempfile::tempdir().unwrap();
        let bench = Bench { test, cache: dir.path().join("cache"), dir, stages };
        bench.write("front", 7);
        bench.write("back", 9);
        bench
    }

    fn write(&self, name: &str, level: u8) {
        fs::write(self.dir.path().join(format!("{name}.txt")), [level]).unwrap();
    }

    fn pipeline(&self, sets: &[&str]) -> Pipeline {
        let mut registry = Registry::new();
        registry.add::<Bytes2>().add::<Modulo>().add::<Dice>().add::<Levels>().add::<Log>();
        let text = format!("(stages: [{}])", self.stages.replace('T', &format!("{:?}", self.test)));
        let sets: Vec<Override> = sets.iter().map(|s| s.parse().unwrap()).collect();
        load(&text, "bench.ron", self.dir.path(), &registry, &sets).unwrap()
    }

    fn cache(&self) -> Arc<Cache> {
        Arc::new(Cache::new(&self.cache))
    }

    /// Runs; returns the result, what was run (sorted), and the cache's warnings.
    fn run(&self, sets: &[&str]) -> (Result<RunResult, RunError>, Vec<String>, Vec<String>) {
        let (pipeline, cache) = (self.pipeline(sets), self.cache());
        let listener: Arc<dyn Listener> = Arc::new(());
        let options = RunOptions { cache: Some(cache.clone()), ..RunOptions::default() };
        let result = run(&pipeline, &options, &Cancel::new(), &listener);
        (result, self.ran(), cache.take_warnings())
    }

    /// What was run since this was last asked.
    fn ran(&self) -> Vec<String> {
        let mut runs = RUNS.lock().unwrap();
        let own = format!("{} ", self.test);
        let mut mine: Vec<String> =
            runs.iter().filter_map(|r| r.strip_prefix(&own)).map(str::to_owned).collect();
        runs.retain(|r| !r.starts_with(&own));
        mine.sort();
        mine
    }

    /// The causes of every stage and entry that would run.
    fn why(&self, sets: &[&str]) -> Vec<String> {
        let outlooks = forecast(&self.pipeline(sets), &RunOptions::default(), &self.cache()).unwrap();
        let mut lines = Vec::new();
        for o in outlooks {
            for (entry, causes) in o.entries {
                let words = |c: Vec<Cause>| c.iter().map(Cause::to_string).collect::<Vec<_>>().join("; ");
                lines.extend(causes.map(|c| format!("{} {entry}: {}", o.stage, words(c))));
            }
        }
        lines
    }

    /// All files on a shelf of the cache.
    fn files(&self, shelf: &str) -> Vec<PathBuf> {
        let mut found = Vec::new();
        let mut folders = vec![self.cache().folder().join(shelf)];
        while let Some(folder) = folders.pop() {
            for item in fs::read_dir(folder).unwrap() {
                let path = item.unwrap().path();
                if path.is_dir() { folders.push(path) } else { found.push(path) }
            }
        }
        found
    }
}

fn file<'r>(result: &'r RunResult, path: &str) -> &'r [u8] {
    &result.files.iter().find(|f| f.path == path).unwrap().bytes
}

const ALL: [&str; 5] = ["Bytes2", "Levels", "Log", "Modulo back", "Modulo front"];

#[test]
fn a_second_run_runs_nothing_and_gives_the_same() {
    let bench = Bench::new("second", STAGES);
    let (cold, ran, _) = bench.run(&[]);
    assert_eq!(ran, ALL);
    let (warm, ran, warnings) = bench.run(&[]);
    assert_eq!((ran.len(), warnings.len()), (0, 0));
    let (cold, warm) = (cold.unwrap(), warm.unwrap());
    assert_eq!(file(&warm, "levels.bin"), [9, 7]);
    let files = |r: &RunResult| r.files.iter().map(|f| (f.path.clone(), f.bytes.clone())).collect::<Vec<_>>();
    assert_eq!(files(&cold), files(&warm));
    assert_eq!(cold.results, warm.results);
    for (a, b) in cold.metrics.stages.iter().zip(&warm.metrics.stages) {
        assert!(!a.cached && b.cached, "{}", a.id);
        assert_eq!((&a.figures, &a.warnings), (&b.figures, &b.warnings));
    }
    assert_eq!(warm.metrics.stages[1].figures["back.level"], 3.0);
    assert_eq!(warm.metrics.stages[1].warnings, ["back: it is small", "front: it is small"]);
}

#[test]
fn warnings_of_cached_results_are_told_again() {
    #[derive(Default)]
    struct Ears(Mutex<Vec<String>>);
    impl Listener for Ears {
        fn event(&self, stage: &str, entry: &str, event: &Event) {
            if let Event::Warning(text) = event {
                self.0.lock().unwrap().push(format!("{stage} {entry}: {text}"));
            }
        }
    }
    let bench = Bench::new("warnings", STAGES);
    bench.run(&[]).0.unwrap();
    let ears = Arc::new(Ears::default());
    let listener: Arc<dyn Listener> = ears.clone();
    let options = RunOptions { cache: Some(bench.cache()), ..RunOptions::default() };
    run(&bench.pipeline(&[]), &options, &Cancel::new(), &listener).unwrap();
    assert_eq!(*ears.0.lock().unwrap(), ["Modulo back: it is small", "Modulo front: it is small"]);
}

#[test]
fn an_edited_parameter_runs_its_stage_and_what_depends_on_it() {
    let bench = Bench::new("edit", STAGES);
    bench.run(&[]).0.unwrap();
    let (result, ran, _) = bench.run(&["stages.Modulo.levels=8"]);
    assert_eq!(file(&result.unwrap(), "levels.bin"), [1, 7]);
    assert_eq!(ran, ["Levels", "Log", "Modulo back", "Modulo front"]);
    assert!(bench.run(&[]).1.is_empty(), "going back finds the older result");
}

#[test]
fn equal_outputs_stop_the_run_right_there() {
    let bench = Bench::new("cutoff", "Bytes2(test: T), Modulo(test: T), Levels(test: T)");
    bench.run(&[]).0.unwrap();
    let (_, ran, _) = bench.run(&["stages.Modulo.levels=50"]);
    assert_eq!(ran, ["Modulo back", "Modulo front"]);
}

#[test]
fn an_edited_photo_runs_its_own_panel_alone() {
    let bench = Bench::new("panel", STAGES);
    bench.run(&[]).0.unwrap();
    bench.write("front", 8);
    let (result, ran, _) = bench.run(&[]);
    assert_eq!(file(&result.unwrap(), "levels.bin"), [9, 8]);
    assert_eq!(ran, ["Bytes2", "Levels", "Log", "Modulo front"]);
    bench.write("front", 7);
    assert!(bench.run(&[]).1.is_empty(), "the file's older content is known");
}

#[test]
fn a_stage_that_promises_nothing_is_always_run_and_those_after_it_are_not() {
    let bench = Bench::new("dice", "Bytes2(test: T), Dice(test: T), Modulo(test: T), Levels(test: T)");
    bench.run(&[]).0.unwrap();
    let (result, ran, _) = bench.run(&[]);
    assert_eq!(file(&result.unwrap(), "levels.bin"), [9, 7]);
    assert_eq!(bench.why(&[])[0], "Dice back: it is not deterministic and always runs");
    assert_eq!(ran[..2], ["Dice back", "Dice front"]);
}

#[test]
fn errors_are_not_kept() {
    let bench = Bench::new("errors", STAGES);
    fs::write(bench.dir.path().join("front.txt"), []).unwrap();
    for _ in 0..2 {
        let (result, ran, _) = bench.run(&[]);
        assert_eq!(
            (result.unwrap_err().error.message.as_str(), ran),
            ("it is empty", vec!["Bytes2".to_owned()])
        );
    }
    fs::remove_file(bench.dir.path().join("front.txt")).unwrap();
    assert_eq!(bench.run(&[]).0.unwrap_err().error.message, "cannot read \"front.txt\": no such file");
    bench.write("front", 7);
    assert_eq!(bench.run(&[]).1, ALL);
}

#[test]
fn a_damaged_artifact_is_told_and_made_anew() {
    let bench = Bench::new("blob", STAGES);
    let clean = bench.run(&[]).0.unwrap();
    for path in bench.files("blobs") {
        let mut bytes = fs::read(&path).unwrap();
        let last = bytes.len() - 1;
        bytes[last] ^= 1;
        fs::write(&path, bytes).unwrap();
    }
    let (result, ran, warnings) = bench.run(&[]);
    assert_eq!(file(&result.unwrap(), "levels.bin"), file(&clean, "levels.bin"));
    assert_eq!(ran, ALL);
    assert_eq!(
        warnings[0],
        "damaged cache entry of Levels: its content does not have its digest; it is made anew"
    );
    assert!(
        warnings.contains(
            &"damaged cache entry of Modulo (front): its content does not have its digest; it is made anew"
                .into()
        )
    );
    let (_, ran, warnings) = bench.run(&[]);
    assert_eq!((ran.len(), warnings.len()), (0, 0), "the damage is mended");
}

#[test]
fn a_cut_manifest_is_told_and_made_anew() {
    let bench = Bench::new("manifest", STAGES);
    bench.run(&[]).0.unwrap();
    for path in bench.files("runs") {
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    }
    assert_eq!(bench.why(&[])[0], "Bytes2 : damaged entry: its content does not have its digest");
    let (result, ran, warnings) = bench.run(&[]);
    assert_eq!((file(&result.unwrap(), "levels.bin"), ran.len(), warnings.len()), (&[9, 7][..], 5, 5));
    assert!(bench.run(&[]).2.is_empty());
}

#[test]
fn what_was_pruned_is_made_again_without_a_word() {
    let bench = Bench::new("pruned", STAGES);
    bench.run(&[]).0.unwrap();
    let usage = bench.cache().usage().unwrap();
    // Bytes2 stands twice: under its key, and under its key with its files. Equal photos are stored once.
    assert_eq!((usage.runs, usage.artifacts), (6, 4));
    assert_eq!(bench.cache().prune(usage.bytes).unwrap(), 0);
    for path in bench.files("blobs") {
        fs::remove_file(path).unwrap();
    }
    assert_eq!(bench.why(&[])[0], "Bytes2 : its result was pruned");
    let (_, ran, warnings) = bench.run(&[]);
    // What Modulo made has the content of what it took, which is there again.
    assert_eq!((ran, warnings.len()), (vec!["Bytes2".to_owned(), "Levels".into(), "Log".into()], 0));
    assert_eq!(bench.cache().prune(0).unwrap(), usage.bytes);
    assert_eq!(bench.cache().usage().unwrap(), super::Usage::default());
    assert_eq!(bench.run(&[]).1, ALL);
}

#[test]
fn what_was_used_last_is_kept_longest() {
    let bench = Bench::new("lru", STAGES);
    bench.run(&["stages.Modulo.levels=8"]).0.unwrap();
    std::thread::sleep(std::time::Duration::from_millis(20));
    bench.run(&["stages.Modulo.levels=6"]).0.unwrap();
    std::thread::sleep(std::time::Duration::from_millis(20));
    assert!(bench.run(&["stages.Modulo.levels=8"]).1.is_empty());
    let bytes = bench.cache().usage().unwrap().bytes;
    bench.cache().prune(bytes - 1).unwrap();
    assert!(bench.run(&["stages.Modulo.levels=8"]).1.is_empty(), "it was used again");
    assert!(!bench.run(&["stages.Modulo.levels=6"]).1.is_empty());
}

#[test]
fn a_cache_beyond_its_limit_is_pruned_after_the_run() {
    let bench = Bench::new("limit", STAGES);
    let cache = Arc::new(Cache::new(&bench.cache).with_limit(1000));
    let listener: Arc<dyn Listener> = Arc::new(());
    let options = RunOptions { cache: Some(cache.clone()), ..RunOptions::default() };
    run(&bench.pipeline(&[]), &options, &Cancel::new(), &listener).unwrap();
    assert!(cache.usage().unwrap().bytes <= 1000);
}

#[test]
fn a_folder_that_cannot_be_made_is_one_warning() {
    let mut bench = Bench::new("nofolder", STAGES);
    let file = bench.dir.path().join("file");
    fs::write(&file, "no folder").unwrap();
    bench.cache = file;
    let (result, ran, warnings) = bench.run(&[]);
    assert_eq!((result.unwrap().files.len(), ran.len(), warnings.len()), (2, 5, 1));
    let folder = bench.cache().folder().display().to_string();
    let (head, tail) =
        (format!("cannot write to the cache \"{folder}\": "), "; the run goes on without keeping results");
    assert!(warnings[0].starts_with(&head) && warnings[0].ends_with(tail), "{}", warnings[0]);
}

#[test]
fn runs_at_once_share_the_cache() {
    let bench = Bench::new("shared", STAGES);
    std::thread::scope(|scope| {
        let runs: Vec<_> = (0..4).map(|_| scope.spawn(|| bench.run(&[]))).collect();
        for run in runs {
            let (result, _, warnings) = run.join().unwrap();
            assert_eq!((file(&result.unwrap(), "levels.bin"), warnings.len()), (&[9, 7][..], 0));
        }
    });
    bench.ran();
    assert!(bench.run(&[]).1.is_empty());
}

#[test]
fn the_cause_of_a_run_is_told_field_by_field() {
    let bench = Bench::new("why", STAGES);
    assert_eq!(
        bench.why(&[]),
        ["Bytes2 : never run", "Modulo : never run", "Levels : never run", "Log : never run"]
    );
    bench.run(&[]).0.unwrap();
    assert!(bench.why(&[]).is_empty());
    assert_eq!(
        bench.why(&["stages.Modulo.levels=8"]),
        [
            "Modulo back: levels 100 -> 8; upstream \"Bytes2\" unchanged",
            "Modulo front: levels 100 -> 8; upstream \"Bytes2\" unchanged",
            "Levels : upstream \"Modulo\" would run again",
            "Log : a stage before it would run again",
        ]
    );
    bench.write("front", 8);
    assert_eq!(
        bench.why(&[])[..2],
        ["Bytes2 : file front.txt changed", "Modulo back: upstream \"Bytes2\" would run again"]
    );
    bench.run(&[]).0.unwrap();
    assert!(bench.ran().is_empty(), "asking runs nothing");
}

#[test]
fn every_ingredient_is_part_of_the_key() {
    use super::key::{Fed, Ingredients, Used};
    use super::{Hash, key::with_reads};
    let fed = |value| Used { port: "photo".into(), from: "A".into(), value };
    let base = || Ingredients {
        name: "Otsu".into(),
        role: "binariser".into(),
        version: 1,
        plugin: None,
        params: "(bias: 0.0)".into(),
        entry: "front".into(),
        inputs: vec![fed(Fed::One(Hash::of(b"photo")))],
    };
    let set = |name: &str| Fed::Set([(name.to_owned(), Hash::of(b"photo"))].into());
    let others = [
        Ingredients { name: "Local".into(), ..base() },
        Ingredients { role: "denoiser".into(), ..base() },
        Ingredients { version: 2, ..base() },
        Ingredients { plugin: Some("00".into()), ..base() },
        Ingredients { params: "(bias: 1.0)".into(), ..base() },
        Ingredients { entry: "back".into(), ..base() },
        Ingredients { inputs: vec![fed(Fed::One(Hash::of(b"other")))], ..base() },
        Ingredients { inputs: vec![fed(Fed::Nothing)], ..base() },
        Ingredients { inputs: vec![fed(set("front"))], ..base() },
        Ingredients { inputs: vec![fed(set("back"))], ..base() },
        Ingredients { inputs: vec![], ..base() },
    ];
    let mut keys: Vec<_> = others.iter().map(Ingredients::key).chain([base().key()]).collect();
    keys.sort();
    keys.dedup();
    assert_eq!(keys.len(), others.len() + 1);
    assert_eq!(Ingredients { inputs: vec![fed(Fed::Unknown)], ..base() }.key(), None);
    let renamed = Used { from: "B".into(), ..fed(Fed::One(Hash::of(b"photo"))) };
    assert_eq!(Ingredients { inputs: vec![renamed], ..base() }.key(), base().key(), "ids do not count");
    let key = base().key().unwrap();
    assert_ne!(with_reads(&key, &[]), with_reads(&key, &[("a.jpg".into(), None)]));
}

#[test]
fn files_are_named_by_texts_of_parameters_however_deep() {
    let params =
        "(file: \"a.obj\", sets: {\"front\": (map: \"b \\\"c.mtl\")}, edge: \"3 mm\", on: true, n: 1.5)";
    assert_eq!(crate::pipeline::texts_of(params), ["a.obj", "b \"c.mtl", "3 mm"]);
    assert!(crate::pipeline::texts_of("(broken").is_empty());
}

#[test]
fn the_folder_comes_from_the_environment_in_a_fixed_order() {
    let path = |p: &str| Some(PathBuf::from(p));
    let folder = super::default_folder;
    assert_eq!(folder(path("/t"), path("/x"), path("/h")), path("/t"));
    assert_eq!(folder(None, path("/x"), path("/h")), path("/x/toile"));
    assert_eq!(folder(None, path("relative"), path("/h")), path("/h/.cache/toile"));
    assert_eq!(folder(None, None, None), None);
    assert!(Cache::new(Path::new("/t")).folder().ends_with("v1"));
}
