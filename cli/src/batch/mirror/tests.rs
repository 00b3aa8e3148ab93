//! A store in memory: what is sent in which order, what is fetched, and shares that end together.
#![allow(clippy::unwrap_used)]

use super::Mirror;
use super::client::Bucket;
use super::inputs::StoredInputs;
use super::place::StorePlace;
use super::results::StoredResults;
use super::sender::sent;
use object_store::memory::InMemory;
use object_store::path::Path as Key;
use object_store::{ObjectMeta, ObjectStoreExt};
use std::cell::Cell;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use toile_core::Cancel;

fn place(text: &str) -> StorePlace {
    StorePlace::named(Path::new(text)).unwrap().unwrap()
}

/// A store, and a bucket of it for a place.
fn bucket(at: &str) -> (Arc<InMemory>, Bucket) {
    let store = Arc::new(InMemory::new());
    let bucket = Bucket::of(store.clone(), &place(at)).unwrap();
    (store, bucket)
}

fn put(bucket: &Bucket, key: &str, text: &str) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file");
    fs::write(&path, text).unwrap();
    bucket.send_all(&[(key.to_owned(), path)]).unwrap();
}

fn head(store: &InMemory, key: &str) -> Option<ObjectMeta> {
    let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
    runtime.block_on(store.head(&Key::from(key))).ok()
}

/// A garment's folder with these files, each of which holds its name.
fn garment(work: &Path, id: &str, names: &[&str]) {
    for name in names {
        let path = work.join("garments").join(id).join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, name).unwrap();
    }
}

#[test]
fn a_garment_is_sent_with_its_record_last() {
    let (store, bucket) = bucket("s3://set/out");
    let work = tempfile::tempdir().unwrap();
    let names = ["a.obj", "failed/reason.txt", "record.json", "thumb.jpg"];
    garment(work.path(), "g", &names);
    // A record is there, and a file that the garment has no more.
    put(&bucket, "out/garments/g/record.json", "old");
    put(&bucket, "out/garments/g/old.obj", "old");
    put(&bucket, "out/garments/g2/a.obj", "another's");
    sent(&bucket, &place("s3://set/out"), &work.path().join("garments/g"), "g").unwrap();
    let there: Vec<String> = bucket.below("out/garments/g").unwrap().into_keys().collect();
    assert_eq!(there, names.map(|name| format!("out/garments/g/{name}")));
    let at = |name: &str| head(&store, &format!("out/garments/g/{name}")).unwrap().last_modified;
    assert!(names.iter().all(|name| at(name) <= at("record.json")));
    assert_eq!(bucket.read("out/garments/g/record.json").unwrap().unwrap(), b"record.json");
    assert!(bucket.read("out/garments/g2/a.obj").unwrap().is_some());
}

#[cfg(unix)]
#[test]
fn a_garment_that_is_sent_in_part_has_no_record_there() {
    let (_, bucket) = bucket("s3://set/out");
    let work = tempfile::tempdir().unwrap();
    garment(work.path(), "g", &["a.obj", "record.json"]);
    let folder = work.path().join("garments/g");
    sent(&bucket, &place("s3://set/out"), &folder, "g").unwrap();
    std::os::unix::fs::symlink("nowhere", folder.join("b.obj")).unwrap();
    let e = sent(&bucket, &place("s3://set/out"), &folder, "g").unwrap_err();
    assert!(e.message.starts_with(&format!("cannot read \"{}/b.obj\": ", folder.display())), "{e}");
    assert_eq!(bucket.read("out/garments/g/record.json").unwrap(), None);
}

#[test]
fn garments_are_sent_while_others_are_run() {
    let (_, bucket) = bucket("s3://set");
    let work = tempfile::tempdir().unwrap();
    let results = StoredResults::new(bucket, &place("s3://set"), work.path());
    for k in 0..20 {
        garment(work.path(), &format!("g{k}"), &["thumb.jpg", "record.json"]);
        results.send(&format!("g{k}")).unwrap();
    }
    assert_eq!(results.end_sending(&Cancel::new()), Ok(0));
    results.look(["g3", "g19"]).unwrap();
    assert!((0..20).all(|k| results.has_picture(&format!("g{k}"))) && !results.has_picture("g20"));
    assert_eq!(results.record("g3"), None, "it is no record");
    // One that is not there ends the sending.
    results.send("none").unwrap();
    let e = results.end_sending(&Cancel::new()).unwrap_err();
    assert!(e.message.starts_with("cannot read \""), "{e}");
}

#[test]
fn a_share_that_ends_with_another_writes_the_results_again() {
    let (store, bucket) = bucket("s3://set/out");
    let work = tempfile::tempdir().unwrap();
    let other = Bucket::of(store, &place("s3://set/out")).unwrap();
    let results = StoredResults::new(bucket, &place("s3://set/out"), work.path());
    let mirror = Mirror { inputs: None, results: Some(results) };
    let rounds = Cell::new(0);
    let write = || {
        rounds.set(rounds.get() + 1);
        for name in ["costs.jsonl", "index.html", "results.jsonl"] {
            fs::write(work.path().join(name), format!("{name} {}", rounds.get())).unwrap();
        }
        if rounds.get() < 3 {
            put(&other, "out/results.jsonl", &format!("another's {}", rounds.get()));
        }
        Ok(rounds.get())
    };
    assert_eq!(mirror.write_shared(&[], &write), Ok(3));
    for name in ["costs.jsonl", "index.html", "results.jsonl"] {
        let text = other.read(&format!("out/{name}")).unwrap().unwrap();
        assert_eq!(String::from_utf8(text).unwrap(), format!("{name} 3"));
    }
    assert_eq!(mirror.results_in_words(Path::new("out")), "s3://set/out");
}

#[test]
fn inputs_are_fetched_as_they_lie_in_the_bucket() {
    let (store, bucket) = bucket("s3://set/in/set.jsonl");
    let other = Bucket::of(store, &place("s3://set/in/set.jsonl")).unwrap();
    for key in ["in/set.jsonl", "in/a.json", "in/b.json", "photos/c.jpg"] {
        put(&other, key, key);
    }
    let dir = tempfile::tempdir().unwrap();
    let fetched =
        |bucket| StoredInputs::fetched(bucket, &place("s3://set/in/set.jsonl"), dir.path()).unwrap();
    let (inputs, manifest) = fetched(bucket);
    assert_eq!(manifest, dir.path().join("inputs/in/set.jsonl"));
    inputs.look(["a.json", "../photos/c.jpg", "none.json"]).unwrap();
    let has = |file: &str| inputs.has(file);
    assert!(has("a.json") && has("./b.json") && has("../photos/c.jpg"));
    assert!(!has("none.json") && !has("../../x.json") && !has("/in/a.json"));
    inputs.bring(["a.json", "../photos/c.jpg", "none.json", "/etc/none"]).unwrap();
    let read = |name: &str| fs::read_to_string(dir.path().join("inputs").join(name)).ok();
    assert_eq!(read("in/a.json").as_deref(), Some("in/a.json"));
    assert_eq!(read("photos/c.jpg").as_deref(), Some("photos/c.jpg"));
    assert_eq!(read("in/b.json"), None, "nobody asked for it");
    // What has changed is fetched again by the next batch, what is gone there goes here.
    put(&other, "in/a.json", "changed");
    other.remove_all(&["photos/c.jpg".to_owned()]).unwrap();
    let (inputs, _) = fetched(other);
    inputs.bring(["a.json", "../photos/c.jpg"]).unwrap();
    assert_eq!((read("in/a.json").as_deref(), read("photos/c.jpg")), (Some("changed"), None));
}

#[test]
fn a_manifest_that_is_not_there_is_told_by_its_place() {
    let (_, bucket) = bucket("s3://set/in/set.jsonl");
    let dir = tempfile::tempdir().unwrap();
    let Err(e) = StoredInputs::fetched(bucket, &place("s3://set/in/set.jsonl"), dir.path()) else {
        unreachable!("there is no manifest")
    };
    assert_eq!(e.message, "cannot read the manifest \"s3://set/in/set.jsonl\": there is no such file");
    assert_eq!(e.hint.unwrap(), "send it there first, or name another; \"s3://set\" is the bucket");
}
