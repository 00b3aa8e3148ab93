//! Why a stage would run, and what names its result.

use super::bench::{Bench, STAGES};
use crate::cache::{Cache, default_folder};
use std::path::{Path, PathBuf};
use toile_core::artifact::Digest;

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
    use crate::cache::key::{Fed, FedPort, Ingredients, with_reads};
    let fed = |value| FedPort { port: "photo".into(), from: "A".into(), value };
    let base = || Ingredients {
        name: "Otsu".into(),
        role: "binariser".into(),
        version: 1,
        plugin: None,
        params: "(bias: 0.0)".into(),
        entry: "front".into(),
        inputs: vec![fed(Fed::One(Digest::of(b"photo")))],
    };
    let set = |name: &str| Fed::Set([(name.to_owned(), Digest::of(b"photo"))].into());
    let others = [
        Ingredients { name: "Local".into(), ..base() },
        Ingredients { role: "denoiser".into(), ..base() },
        Ingredients { version: 2, ..base() },
        Ingredients { plugin: Some("00".into()), ..base() },
        Ingredients { params: "(bias: 1.0)".into(), ..base() },
        Ingredients { entry: "back".into(), ..base() },
        Ingredients { inputs: vec![fed(Fed::One(Digest::of(b"other")))], ..base() },
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
    let renamed = FedPort { from: "B".into(), ..fed(Fed::One(Digest::of(b"photo"))) };
    assert_eq!(Ingredients { inputs: vec![renamed], ..base() }.key(), base().key(), "ids do not count");
    let key = base().key().unwrap();
    assert_ne!(with_reads(&key, &[]), with_reads(&key, &[("a.jpg".into(), None)]));
}

#[test]
fn files_are_named_by_texts_of_parameters_however_deep() {
    let params =
        "(file: \"a.obj\", sets: {\"front\": (map: \"b \\\"c.mtl\")}, edge: \"3 mm\", on: true, n: 1.5)";
    assert_eq!(crate::load::texts_of(params), ["a.obj", "b \"c.mtl", "3 mm"]);
    assert!(crate::load::texts_of("(broken").is_empty());
}

#[test]
fn the_folder_comes_from_the_environment_in_a_fixed_order() {
    let path = |p: &str| Some(PathBuf::from(p));
    let folder = default_folder;
    assert_eq!(folder(path("/t"), path("/x"), path("/h")), path("/t"));
    assert_eq!(folder(None, path("/x"), path("/h")), path("/x/toile"));
    assert_eq!(folder(None, path("relative"), path("/h")), path("/h/.cache/toile"));
    assert_eq!(folder(None, None, None), None);
    assert!(Cache::new(Path::new("/t")).folder().ends_with("v1"));
}
