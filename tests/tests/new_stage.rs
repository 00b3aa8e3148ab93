//! `toile new-stage`: what it writes builds, loads and passes its own tests; what it refuses it names.
#![allow(clippy::unwrap_used)]

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::Path;
use std::process::Command;
use toile_tests::{Answer, root, toile};

const ROLES: [(&str, &str); 9] = [
    ("FreshDenoiser", "denoiser"),
    ("FreshBinariser", "binariser"),
    ("FreshEdges", "edge-detector"),
    ("FreshMesher", "mesher"),
    ("FreshSmoother", "smoother"),
    ("FreshStitcher", "stitcher"),
    ("FreshDraper", "draper"),
    ("FreshCollider", "collider"),
    ("FreshTexturer", "texturer"),
];

fn new_stage(name: &str, role: &str, dir: &Path) -> Answer {
    let core = root().join("core").display().to_string();
    toile(&["new-stage", name, "--role", role, "--dir", dir.to_str().unwrap(), "--core", &core])
}

/// Runs cargo in a folder with the workspace's lock and target, so that nothing is built twice.
fn cargo(folder: &Path, arguments: &[&str]) -> String {
    std::fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
    // This test's program lies in TARGET/PROFILE/deps.
    let program = std::env::current_exe().unwrap();
    let target = program.ancestors().nth(3).unwrap();
    let out = Command::new(env!("CARGO"))
        .args(arguments)
        .args(["--release", "--offline"])
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", target)
        .env("CARGO_PROFILE_RELEASE_DEBUG", "line-tables-only")
        .output()
        .unwrap();
    let text = [out.stdout, out.stderr].map(|b| String::from_utf8_lossy(&b).into_owned()).concat();
    assert!(out.status.success(), "cargo {arguments:?} in {}:\n{text}", folder.display());
    text
}

#[test]
fn every_role_builds_and_passes_its_own_tests() {
    let dir = tempfile::tempdir().unwrap();
    let folders = ROLES.map(|(name, role)| {
        let answer = new_stage(name, role, dir.path());
        assert_eq!(answer.code, 0, "{}", answer.err);
        let folder = answer.out.lines().next().unwrap().strip_prefix("wrote ").unwrap().to_owned();
        folder.rsplit('/').next().unwrap().to_owned()
    });
    // One workspace of all nine, so that cargo is started once.
    let members: Vec<String> = folders.iter().map(|f| format!("{f:?}")).collect();
    for folder in &folders {
        let manifest = dir.path().join(folder).join("Cargo.toml");
        let text = std::fs::read_to_string(&manifest).unwrap();
        std::fs::write(&manifest, text.replace("[workspace]\n", "")).unwrap();
    }
    let workspace = format!("[workspace]\nresolver = \"3\"\nmembers = [{}]\n", members.join(", "));
    std::fs::write(dir.path().join("Cargo.toml"), workspace).unwrap();
    let text = cargo(dir.path(), &["test", "--workspace", "--test", "stage"]);
    assert!(!text.contains("warning: unused"), "{text}");
    assert_eq!(text.matches("test result: ok. 10 passed").count(), 9, "{text}");
    // The benchmarks are alike but for their names: one is built and run, once through.
    cargo(dir.path(), &["test", "-p", "fresh-mesher", "--benches"]);
    for (name, folder) in ROLES.map(|(name, _)| name).iter().zip(&folders) {
        loads(name, &folder.replace('-', "_"));
    }
}

/// The library that the crate's own tests were linked with is a plugin too.
fn loads(name: &str, library: &str) {
    let program = std::env::current_exe().unwrap();
    let file = program.with_file_name(format!("{DLL_PREFIX}{library}{DLL_SUFFIX}"));
    let answer = toile(&["stage", name, "--plugin", file.to_str().unwrap()]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.out.contains("  Deterministic            checked\n"), "{}", answer.out);
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |name: &str, role: &str| {
        let answer = new_stage(name, role, dir.path());
        assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{name} {role}");
        answer.err
    };
    let word = "cannot name a stage; write one word that begins with a capital, like FineMesher";
    for name in ["my mesher", "mesher", "", "Ä", "A", "Fine-Mesher", "../Up", "Self", "1st"] {
        assert_eq!(refused(name, "mesher"), format!("error: \"{name}\" {word}\n"));
    }
    assert_eq!(
        refused("Otsu", "mesher"),
        "error: there is a binariser `Otsu` already; choose another name\n"
    );
    let there = "denoiser, binariser, edge-detector, mesher, smoother, stitcher, draper, collider, texturer";
    assert_eq!(
        refused("Fine", "writer"),
        format!("error: there is no template for a writer; there are {there}\n")
    );
    assert_eq!(refused("Fine", "meshr"), "error: there is no role \"meshr\"; did you mean mesher?\n");
    assert_eq!(refused("Fine", "xyz"), format!("error: there is no role \"xyz\"; there are {there}\n"));
    std::fs::create_dir(dir.path().join("fine")).unwrap();
    let folder = dir.path().join("fine");
    let message = format!("error: {} is there already; choose another name or `--dir`\n", folder.display());
    assert_eq!(refused("Fine", "mesher"), message);
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0, "what is there is left alone");
}

#[test]
fn a_core_that_is_not_there_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let (at, core) = (dir.path().to_str().unwrap(), dir.path().join("none"));
    let core = core.to_str().unwrap();
    let answer = toile(&["new-stage", "Fine", "--role", "mesher", "--dir", at, "--core", core]);
    assert_eq!((answer.code, answer.err), (3, format!("error: there is no crate in {core}\n")));
    assert!(!dir.path().join("fine").exists());
}
