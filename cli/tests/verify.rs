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

#[test]
fn a_pattern_drafted_to_measure_is_read_with_its_measurements() {
    let dir = tempfile::tempdir().unwrap();
    for file in ["skirt.sm2d", "body.smis"] {
        std::fs::copy(root().join("pipelines/samples/pattern").join(file), dir.path().join(file)).unwrap();
    }
    std::fs::write(dir.path().join("sound.obj"), SOUND).unwrap();
    let judged =
        |set: &str| verify(dir.path(), &["sound.obj", "--pattern", "skirt.sm2d", "--json", "--set", set]);
    let (code, out, err) = judged("pattern.measurements=\"body.smis\"");
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    let certificate: Value = serde_json::from_str(&out).unwrap();
    let roles: Vec<&str> =
        certificate["inputs"].as_array().unwrap().iter().map(|i| i["role"].as_str().unwrap()).collect();
    assert_eq!(roles, ["pattern", "measurements", "garment"]);
    let (code, out, _) = judged("pattern.measurement=\"body.smis\"");
    assert_eq!(code, 3);
    let refused: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(refused["faults"][0]["message"], "`SeamlyPattern` has no parameter `measurement`");
    assert_eq!(refused["faults"][0]["hint"], "did you mean `pattern.measurements`?");
}

#[test]
fn a_fabric_that_there_is_none_of_is_refused_with_the_one_that_was_meant() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("sound.obj"), SOUND).unwrap();
    let (code, _, err) = verify(dir.path(), &["sound.obj", "--fabric", "denimm"]);
    assert_eq!(code, 3);
    assert!(
        err.starts_with("error: there is no fabric preset \"denimm\"\n  help: did you mean \"denim\"? "),
        "{err}"
    );
    let (code, out, _) =
        verify(dir.path(), &["sound.obj", "--fabric", "Kes(weight: 12.0)", "--friction", "0.4"]);
    assert_eq!(code, 0, "{out}");
    assert!(out.contains("not judged  rest_shift: "), "{out}");
    assert_eq!(verify(dir.path(), &["sound.obj", "--friction", "0.4"]).0, 2);
}
