//! `toile lock`, and runs against a lock.

use std::fs;
use std::path::Path;
use toile_tests::{Answer, pipeline, toile};

const PIPELINE: &str = r#"(
    name: "locked",
    photos: { "front": (file: "front.jpg", width: "52 cm") },
    stages: [ NeighbourhoodMean(radius: 1), Otsu() ],
)"#;

fn run(dir: &Path, more: &[&str]) -> Answer {
    let (ron, out) = (dir.join("vest.ron").display().to_string(), dir.join("out").display().to_string());
    toile(&[&["run", &ron, "--locked", "--out", &out], more].concat())
}

#[test]
fn a_run_against_a_lock_says_what_differs() {
    let dir = tempfile::tempdir().unwrap();
    let ron = dir.path().join("vest.ron");
    let name = ron.display().to_string();
    fs::write(&ron, PIPELINE).unwrap();
    fs::copy(pipeline("samples/vest/front.jpg"), dir.path().join("front.jpg")).unwrap();

    let none = run(dir.path(), &[]);
    assert_eq!(none.code, 3);
    assert!(none.err.starts_with(&format!("error: cannot read the lock \"{name}.lock\": ")), "{}", none.err);
    assert!(none.err.ends_with(&format!("; `toile lock {name}` writes one\n")), "{}", none.err);

    let cache = dir.path().join("cache").display().to_string();
    let answer = toile(&["lock", &name, "--cache-dir", &cache]);
    assert_eq!((answer.code, answer.out), (0, format!("{name}.lock: 3 stages locked\n")), "{}", answer.err);
    let text = fs::read_to_string(dir.path().join("vest.ron.lock")).unwrap();
    assert_eq!(toile(&["lock", &name, "--no-cache"]).code, 0);
    let again = fs::read_to_string(dir.path().join("vest.ron.lock")).unwrap();
    assert_eq!(text, again, "the same with and without a cache");
    assert!(text.contains("\"package\": \"toile-image "), "{text}");

    let same = run(dir.path(), &[]);
    assert_eq!((same.code, same.err.as_str()), (0, ""));
    let other = run(dir.path(), &["--set", "stages.Otsu.bias=2.0"]);
    assert_eq!(other.code, 4);
    let lines: Vec<&str> = other.err.lines().collect();
    assert_eq!(lines[0], "lock: Otsu: bias 0.0 -> 2.0");
    assert!(lines[1].starts_with("lock: Otsu: result ") && lines.len() == 2, "{lines:?}");

    // What is not run has no result, and is no difference; its parameters are.
    let until = run(dir.path(), &["--until", "NeighbourhoodMean"]);
    assert_eq!((until.code, until.err.as_str()), (0, ""));
    let other = run(dir.path(), &["--until", "NeighbourhoodMean", "--set", "stages.Otsu.bias=2.0"]);
    assert_eq!((other.code, other.err.as_str()), (4, "lock: Otsu: bias 0.0 -> 2.0\n"));

    fs::copy(pipeline("samples/vest/back.jpg"), dir.path().join("front.jpg")).unwrap();
    let photo = run(dir.path(), &[]);
    let starts: Vec<&str> = photo.err.lines().map(|l| l.split(" result").next().unwrap()).collect();
    assert_eq!((photo.code, starts), (4, vec!["lock: Photos:", "lock: NeighbourhoodMean:", "lock: Otsu:"]));

    fs::write(dir.path().join("vest.ron.lock"), "{}").unwrap();
    let broken = run(dir.path(), &[]);
    assert_eq!(broken.code, 3);
    let head = format!("error: cannot use the lock \"{name}.lock\": it is no lock file: missing field");
    assert!(broken.err.starts_with(&head), "{}", broken.err);
}
