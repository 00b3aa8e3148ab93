//! `toile new-stage`: what it writes builds, loads and passes its own tests; what it refuses it
//! names.
//!
//! Crates are built by `.ci/wide` alone: they share the workspace's target folder, and still
//! compile for a minute what has other features there.

use std::collections::BTreeSet;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::Path;
use std::process::Command;
use toile_core::Role;
use toile_tests::{Answer, root, toile};

fn new_stage(arguments: &[&str], dir: &Path) -> Answer {
    toile(&[&["new-stage"], arguments, &["--dir", dir.to_str().unwrap()]].concat())
}

/// Writes a crate; gives its folder's name.
fn written(arguments: &[&str], dir: &Path) -> String {
    let answer = new_stage(arguments, dir);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let folder = answer.out.lines().next().unwrap().strip_prefix("wrote ").unwrap();
    Path::new(folder.split_once(", the ").unwrap().0).file_name().unwrap().to_str().unwrap().to_owned()
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
        .output()
        .unwrap();
    let text = [out.stdout, out.stderr].map(|b| String::from_utf8_lossy(&b).into_owned()).concat();
    assert!(out.status.success(), "cargo {arguments:?} in {}:\n{text}", folder.display());
    text
}

/// The crates that are built for a package with its build scripts, without what its tests need;
/// none where cargo is not at hand.
fn crates(package: &str) -> Option<BTreeSet<String>> {
    let arguments = ["tree", "--offline", "-p", package, "-e", "normal,build", "--prefix", "none"];
    let out = Command::new(env!("CARGO")).args(arguments).current_dir(root()).output().ok()?;
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let text = String::from_utf8(out.stdout).unwrap();
    Some(text.lines().filter(|l| !l.is_empty() && !l.ends_with("(*)")).map(str::to_owned).collect())
}

/// What the author of a mesher builds: the crate that `toile new-stage` writes depends on
/// toile-core alone, and `plugins/lattice` on a triangulation as well.
#[test]
fn the_author_of_a_mesher_builds_thirty_crates_at_most() {
    let (Some(core), Some(lattice)) = (crates("toile-core"), crates("toile-lattice")) else { return };
    assert!(core.len() < 30, "with the mesher itself {}: {core:#?}", core.len() + 1);
    let spade = crates("spade").unwrap_or_default();
    let own: Vec<_> = lattice.iter().filter(|c| core.contains(*c) || !spade.contains(*c)).collect();
    assert!(own.len() <= 30, "without those of its triangulation {}: {own:#?}", own.len());
    assert!(core.iter().all(|c| lattice.contains(c)), "both are counted alike");
}

/// Each contract is a test, kept or not promised, and the crate has one of its own.
const TESTS: &str = "test result: ok. 11 passed";

#[test]
#[ignore = "slow: .ci/wide"]
fn a_crate_builds_and_loads() {
    let dir = tempfile::tempdir().unwrap();
    let folder = written(&["my_otsu", "--role", "binariser"], dir.path());
    assert_eq!(folder, "my-otsu");
    let text = cargo(&dir.path().join(&folder), &["build", "--lib"]);
    assert!(!text.contains("warning: "), "{text}");
    loads("MyOtsu", "my_otsu", "binariser");
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_crate_of_every_role_builds_and_passes_its_own_tests() {
    let dir = tempfile::tempdir().unwrap();
    let word = |role: Role| role.as_str().replace(' ', "-");
    let crates = Role::ALL.map(|role| {
        let name = format!("fresh_{}", word(role).replace('-', "_"));
        (role, written(&[&name, "--role", &word(role)], dir.path()))
    });
    // One workspace of all, so that cargo is started once.
    let members: Vec<String> = crates.iter().map(|(_, folder)| format!("{folder:?}")).collect();
    for (_, folder) in &crates {
        let manifest = dir.path().join(folder).join("Cargo.toml");
        let text = std::fs::read_to_string(&manifest).unwrap();
        std::fs::write(&manifest, text.replace("[workspace]\n", "")).unwrap();
    }
    let workspace = format!("[workspace]\nresolver = \"3\"\nmembers = [{}]\n", members.join(", "));
    std::fs::write(dir.path().join("Cargo.toml"), workspace).unwrap();
    let text = cargo(dir.path(), &["test", "--workspace", "--test", "stage"]);
    assert!(!text.contains("warning: "), "{text}");
    assert_eq!(text.matches(TESTS).count(), Role::ALL.len(), "{text}");
    // The benchmarks are alike but for their names: one is built and run, once through.
    cargo(dir.path(), &["test", "-p", "fresh-reader", "--benches"]);
    for (role, folder) in crates {
        let name: String = folder.split('-').map(|word| word[..1].to_uppercase() + &word[1..]).collect();
        loads(&name, &folder.replace('-', "_"), role.as_str());
    }
}

/// The crate's library is a plugin.
fn loads(name: &str, library: &str, role: &str) {
    let program = std::env::current_exe().unwrap();
    let file = program.with_file_name(format!("{DLL_PREFIX}{library}{DLL_SUFFIX}"));
    let answer = toile(&["stage", name, "--plugin", file.to_str().unwrap()]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.out.contains(&format!("{name} ({role}")), "{}", answer.out);
    assert!(answer.out.contains("  Deterministic            "), "{}", answer.out);
}

#[test]
fn the_crate_depends_on_the_source_tree_that_the_program_was_built_from() {
    let dir = tempfile::tempdir().unwrap();
    let folder = written(&["FineMesher"], dir.path());
    let manifest = std::fs::read_to_string(dir.path().join(folder).join("Cargo.toml")).unwrap();
    let core = root().join("core").canonicalize().unwrap();
    assert!(
        manifest.contains(&format!("\ntoile-core = {{ path = {:?} }}\n", core.to_str().unwrap())),
        "{manifest}"
    );
}

#[test]
fn the_role_is_what_the_name_ends_with_else_a_binariser() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let first = |name: &str| {
        let answer = new_stage(&[name], at);
        assert_eq!(answer.code, 0, "{}", answer.err);
        answer.out.lines().next().unwrap().replace(&at.display().to_string(), "")
    };
    assert_eq!(first("FineMesher"), "wrote /fine-mesher, the mesher FineMesher");
    assert_eq!(first("my_edge_detector"), "wrote /my-edge-detector, the edge detector MyEdgeDetector");
    assert_eq!(first("wool-fabric"), "wrote /wool-fabric, the fabric WoolFabric");
    assert_eq!(first("my_otsu"), "wrote /my-otsu, the binariser MyOtsu");
    assert_eq!(first("Somebody"), "wrote /somebody, the binariser Somebody");
}

#[test]
fn what_a_pipeline_needs_is_printed_ready_to_be_pasted() {
    let dir = tempfile::tempdir().unwrap();
    let printed = |name: &str, role: &str| {
        let answer = new_stage(&[name, "--role", role], dir.path());
        assert_eq!(answer.code, 0, "{}", answer.err);
        let lines = answer.out.lines().skip(3).map(|l| l.replace(&dir.path().display().to_string(), "DIR"));
        lines.collect::<Vec<_>>()
    };
    let library = |folder: &str, name: &str| {
        format!("    plugins: [\"DIR/{folder}/target/release/{DLL_PREFIX}{name}{DLL_SUFFIX}\"],")
    };
    let binariser = [
        "in a pipeline:".to_owned(),
        library("my-otsu", "my_otsu"),
        "    stages: [..., MyOtsu(), ...],".into(),
    ];
    assert_eq!(printed("my_otsu", "binariser"), binariser);
    let body = ["in a pipeline:".to_owned(), library("my-body", "my_body"), "    body: MyBody(),".into()];
    assert_eq!(printed("MyBody", "body"), body);
}

/// The mask of a sample beside its truth: the shared part of both.
fn agreement(mask: &Path, truth: &Path) -> f64 {
    let [found, truth] = [mask, truth].map(|path| image::open(path).unwrap().to_luma8());
    assert_eq!(found.dimensions(), truth.dimensions());
    let pairs = || found.iter().zip(truth.iter()).map(|(a, b)| (*a > 127, *b > 127));
    let (both, either) =
        (pairs().filter(|(a, b)| *a && *b).count(), pairs().filter(|(a, b)| *a || *b).count());
    both as f64 / either as f64
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_binariser_that_is_written_marks_the_garments_of_the_samples() {
    let dir = tempfile::tempdir().unwrap();
    let folder = written(&["sample_binariser"], dir.path());
    cargo(&dir.path().join(&folder), &["build", "--lib"]);
    let library =
        std::env::current_exe().unwrap().with_file_name(format!("{DLL_PREFIX}sample_binariser{DLL_SUFFIX}"));
    for garment in ["vest", "tshirt"] {
        let samples = root().join("pipelines/samples").join(garment);
        let text = format!(
            "(plugins: [{library:?}], photos: {{\"front\": (file: {:?}, width: \"50 cm\"), \"back\": (file: {:?}, width: \"50 cm\")}}, stages: [SampleBinariser(), Canny()])",
            samples.join("front.jpg"),
            samples.join("back.jpg")
        );
        let file = dir.path().join(format!("{garment}.ron"));
        std::fs::write(&file, text).unwrap();
        let out = dir.path().join(garment);
        let answer = toile(&["run", file.to_str().unwrap(), "--keep", "--out", out.to_str().unwrap()]);
        assert_eq!(answer.code, 0, "{}", answer.err);
        for side in ["front", "back"] {
            let mask = out.join("stages/SampleBinariser").join(format!("{side}.png"));
            let shared = agreement(&mask, &samples.join(format!("{side}.mask.png")));
            assert!(shared > 0.98, "{garment} {side}: {shared}");
        }
    }
}

#[test]
fn the_header_of_plugins_is_printed() {
    let answer = toile(&["plugin-header"]);
    assert_eq!((answer.code, answer.err.as_str()), (0, ""));
    assert_eq!(answer.out, std::fs::read_to_string(root().join("core/include/toile_plugin.h")).unwrap());
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |name: &str, role: &str| {
        let answer = new_stage(&[name, "--role", role], dir.path());
        assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{name} {role}");
        answer.err
    };
    let word = "cannot name a stage; write a name like FineMesher or fine_mesher";
    for name in [
        "my mesher",
        "",
        "Ä",
        "A",
        "Fine-Mesher",
        "fine__mesher",
        "_fine",
        "../Up",
        "1st",
        "Self",
        "match",
        "core",
    ] {
        assert_eq!(refused(name, "mesher"), format!("error: \"{name}\" {word}\n"));
    }
    assert_eq!(
        refused("Otsu", "mesher"),
        "error: there is a binariser `Otsu` already; choose another name\n"
    );
    assert_eq!(
        refused("outline", "mesher"),
        "error: there is a style `Outline` already; choose another name\n"
    );
    assert_eq!(
        refused("Photo", "binariser"),
        "error: the crate needs `Photo` for something else; choose another name\n"
    );
    let there = "reader, denoiser, panorama, view-interpolator, binariser, edge-detector, style, mesher, smoother, body, \
                 fabric, placement, collider, stitcher, draper, flattener, texturer, writer";
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
    let core = dir.path().join("none").display().to_string();
    let answer = new_stage(&["Fine", "--role", "mesher", "--core", &core], dir.path());
    assert_eq!((answer.code, answer.err), (3, format!("error: there is no crate in {core}\n")));
    assert!(!dir.path().join("fine").exists());
}
