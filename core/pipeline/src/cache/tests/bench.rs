//! A folder with photos, a pipeline of small stages that say when they run, and a cache.

use crate::cache::{Cache, Cause};
use crate::load::{Override, Pipeline, load};
use crate::{RunError, RunOptions, RunResult, forecast, run};
use image::{Rgb, RgbImage};
use std::fs;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use tempfile::TempDir;
use toile_core::prelude::*;
use toile_core::{Cancel, Listener};

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
pub(super) struct Bench {
    pub(super) test: &'static str,
    pub(super) dir: TempDir,
    pub(super) cache: PathBuf,
    pub(super) stages: &'static str,
}

pub(super) const STAGES: &str = "Bytes2(test: T), Modulo(test: T), Levels(test: T), Log(test: T)";

impl Bench {
    pub(super) fn new(test: &'static str, stages: &'static str) -> Self {
        let dir = tempfile::tempdir().unwrap();
        let bench = Bench { test, cache: dir.path().join("cache"), dir, stages };
        bench.write("front", 7);
        bench.write("back", 9);
        bench
    }

    pub(super) fn write(&self, name: &str, level: u8) {
        fs::write(self.dir.path().join(format!("{name}.txt")), [level]).unwrap();
    }

    pub(super) fn pipeline(&self, sets: &[&str]) -> Pipeline {
        let mut registry = Registry::new();
        registry.add::<Bytes2>().add::<Modulo>().add::<Dice>().add::<Levels>().add::<Log>();
        let text = format!("(stages: [{}])", self.stages.replace('T', &format!("{:?}", self.test)));
        let sets: Vec<Override> = sets.iter().map(|s| s.parse().unwrap()).collect();
        load(&text, "bench.ron", self.dir.path(), &registry, &sets).unwrap()
    }

    pub(super) fn cache(&self) -> Arc<Cache> {
        Arc::new(Cache::new(&self.cache))
    }

    /// Runs; returns the result, what was run (sorted), and the cache's warnings.
    pub(super) fn run(&self, sets: &[&str]) -> (Result<RunResult, RunError>, Vec<String>, Vec<String>) {
        let (pipeline, cache) = (self.pipeline(sets), self.cache());
        let listener: Arc<dyn Listener> = Arc::new(());
        let options = RunOptions { cache: Some(cache.clone()), ..RunOptions::default() };
        let result = run(&pipeline, &options, &Cancel::new(), &listener);
        (result, self.ran(), cache.take_warnings())
    }

    /// What was run since this was last asked.
    pub(super) fn ran(&self) -> Vec<String> {
        let mut runs = RUNS.lock().unwrap();
        let own = format!("{} ", self.test);
        let mut mine: Vec<String> =
            runs.iter().filter_map(|r| r.strip_prefix(&own)).map(str::to_owned).collect();
        runs.retain(|r| !r.starts_with(&own));
        mine.sort();
        mine
    }

    /// The causes of every stage and entry that would run.
    pub(super) fn why(&self, sets: &[&str]) -> Vec<String> {
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
    pub(super) fn files(&self, shelf: &str) -> Vec<PathBuf> {
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

pub(super) fn file<'r>(result: &'r RunResult, path: &str) -> &'r [u8] {
    &result.files.iter().find(|f| f.path == path).unwrap().bytes
}

pub(super) const ALL: [&str; 5] = ["Bytes2", "Levels", "Log", "Modulo back", "Modulo front"];
