//! `toile verify` as a program: exit codes, what it says, the certificate that it writes.

use crate::readme::root;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// The exit code, standard output and standard error.
fn verify(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
    let output = command.current_dir(folder).arg("verify").args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// A square of cloth, and one through which a triangle goes.
const SOUND: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
const PIERCED: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.6 0.3 -0.1\nv 0.6 0.3 0.1\nv 0.7 0.3 0.1\nf 1 2 3\nf 1 3 4\nf 5 6 7\n";

#[test]
fn a_garment_of_another_program_is_judged_and_certified() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::copy(root().join("pipelines/samples/garment/vest.obj"), dir.path().join("vest.obj")).unwrap();
    let (code, out, err) = verify(dir.path(), &["vest.obj"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("holds       self_crossings: 0 pairs, the limit is 0 pairs\n"), "{out}");
    assert!(out.contains("not judged  seam_gap: no pattern was given: name one with `--pattern`\n"), "{out}");
    assert!(out.ends_with("certificate: certificate.json\n"), "{out}");
    let written = std::fs::read_to_string(dir.path().join("certificate.json")).unwrap();
    let (code, out, _) = verify(dir.path(), &["vest.obj", "--json"]);
    assert_eq!((code, out), (0, written));
}

#[test]
fn what_crosses_ends_with_exit_code_4() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("sound.obj"), SOUND).unwrap();
    std::fs::write(dir.path().join("pierced.obj"), PIERCED).unwrap();
    assert_eq!(verify(dir.path(), &["sound.obj", "--out", "sound.json"]).0, 0);
    let (code, out, _) = verify(dir.path(), &["pierced.obj", "--json"]);
    assert_eq!(code, 4);
    let certificate: Value = serde_json::from_str(&out).unwrap();
    let checks = certificate["checks"].as_array().unwrap();
    let crossings = checks.iter().find(|c| c["name"] == "self_crossings").unwrap();
    assert_eq!((&crossings["value"], &crossings["verdict"]), (&1.0.into(), &"fails".into()));
    // One that is compared must hold as well.
    assert_eq!(verify(dir.path(), &["sound.obj", "--compare", "pierced.obj"]).0, 4);
}

#[test]
fn a_file_that_cannot_be_read_ends_with_exit_code_3_and_a_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let (code, out, err) = verify(dir.path(), &["none.obj"]);
    assert_eq!((code, out.as_str()), (3, ""));
    let words = "error: \"none.obj\" cannot be read: No such file or directory (os error 2)\n  help: look at the path and the file's rights\n";
    assert_eq!(err, words);
    assert_eq!(verify(dir.path(), &["none.obj", "--unit", "-1 m"]).0, 2);
    assert!(std::fs::read_dir(dir.path()).unwrap().next().is_none(), "nothing is written");
}
