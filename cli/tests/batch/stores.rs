//! Manifests and results in object stores: what is refused, word for word. With a store they run in
//! `tests/engines/check.sh s3`.

use super::{ran, set, toile};

fn refused(arguments: &[&str]) -> String {
    let dir = set(1);
    let (code, out, err) = ran(toile(dir.path(), &[&["batch"], arguments].concat()));
    assert_eq!((code, out.as_str()), (Some(3), ""), "{err}");
    err
}

#[cfg(not(feature = "object-store"))]
#[test]
fn a_program_without_object_stores_says_how_to_build_one() {
    let words = "error: this program was built without object stores\n  help: cargo install --path cli --features object-store\n";
    for place in ["s3://set/in/set.jsonl", "gs://set/set.jsonl", "az://set/set.jsonl", "abfs://set/set.jsonl"]
    {
        assert_eq!(refused(&[place, "--pipeline", "sheet.ron"]), words);
    }
    assert_eq!(refused(&["in/manifest.jsonl", "--pipeline", "sheet.ron", "--out", "s3://set/out"]), words);
}

#[test]
fn what_does_not_go_with_a_store_is_refused_in_words() {
    let manifest = ["in/manifest.jsonl", "--pipeline"];
    let with = |more: &[&str]| refused(&[&manifest[..], more].concat());
    assert_eq!(
        with(&["s3://set/sheet.ron"]),
        "error: the pipeline \"s3://set/sheet.ron\" lies in a store\n  help: fetch it first: a pipeline and its own files are read from this machine\n"
    );
    assert_eq!(
        with(&["sheet.ron", "--work", "w"]),
        "error: --work goes with results in a store alone\n  help: name the folder with --out, or a store, like --out s3://bucket/out\n"
    );
    assert_eq!(
        with(&["sheet.ron", "--out", "s3://set/out", "--deadline", "8h"]),
        "error: --deadline chooses a quality in a folder that all shares see, and \"s3://set/out\" is none\n  help: choose it once with a folder of this machine, then name it: --quality NAME\n"
    );
    assert_eq!(
        with(&["sheet.ron", "--out", "s3://set//out"]),
        "error: \"s3://set//out\" is no place in an object store\n  help: write it like s3://bucket/folder/set.jsonl\n"
    );
}
