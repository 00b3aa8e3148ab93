//! What becomes of damage, of a full cache and of one that cannot be made.

use super::bench::{ALL, Bench, STAGES, file};
use crate::cache::{Cache, Usage};
use crate::{RunOptions, run};
use std::fs;
use std::sync::Arc;
use toile_core::{Cancel, Listener};

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
    // Bytes2 stands twice: under its key, and under its key with its files. Equal photos are stored
    // once.
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
    assert_eq!(bench.cache().usage().unwrap(), Usage::default());
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
