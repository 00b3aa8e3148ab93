//! Plugins that pipelines and arguments name.

use std::path::Path;
use toile_tests::plugins::library;
use toile_tests::toile;

fn write(dir: &Path, plugins: &str, stage: &str) -> String {
    let photo = toile_tests::root().join("pipelines/samples/vest/front.jpg");
    let text = format!(
        "(\n    name: \"p\",\n    plugins: {plugins},\n    photos: {{\"front\": (file: {photo:?}, width: \"52 cm\")}},\n    stages: [{stage}, Otsu()],\n)\n"
    );
    let path = dir.join("p.ron");
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn digest() -> String {
    blake3::hash(&std::fs::read(library("toile_faulty")).unwrap()).to_hex().to_string()
}

#[test]
fn a_pipeline_names_its_plugin_with_or_without_its_digest() {
    let dir = tempfile::tempdir().unwrap();
    let file = library("toile_faulty");
    let out = dir.path().join("out").display().to_string();
    for plugins in [format!("[{file:?}]"), format!("[(file: {file:?}, blake3: {:?})]", digest())] {
        let pipeline = write(dir.path(), &plugins, "Shades(by: 0.9)");
        let answer = toile(&["run", &pipeline, "--until", "Shades", "--out", &out]);
        assert_eq!(answer.code, 0, "{}", answer.err);
        assert!(dir.path().join("out/stages/Shades/front.png").is_file());
    }
}

#[test]
fn a_plugin_may_be_named_without_the_systems_dress() {
    let dir = tempfile::tempdir().unwrap();
    let bare = library("toile_faulty").with_file_name("toile-faulty");
    let answer = toile(&["validate", &write(dir.path(), &format!("[{bare:?}]"), "Shades()")]);
    assert_eq!(answer.code, 0, "{}", answer.err);
}

#[test]
fn another_digest_than_the_pinned_one_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let file = library("toile_faulty");
    let pin = "0".repeat(64);
    let pipeline = write(dir.path(), &format!("[(file: {file:?}, blake3: \"{pin}\")]"), "Shades()");
    let answer = toile(&["validate", &pipeline, "--json"]);
    assert_eq!(answer.code, 3);
    let expected = format!("its digest is {}, pinned is {pin}", digest());
    assert!(answer.out.contains(&expected), "{}", answer.out);
}

#[test]
fn a_digest_that_is_none_is_a_fault_of_the_file() {
    let dir = tempfile::tempdir().unwrap();
    let pipeline = write(dir.path(), "[(file: \"x.so\", blake3: \"12\")]", "Otsu(id: \"o\")");
    let answer = toile(&["validate", &pipeline]);
    assert_eq!(answer.code, 3);
    assert!(answer.err.contains("`blake3` must be 64 hexadecimal digits"), "{}", answer.err);
}

#[test]
fn a_plugin_is_not_looked_for() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::copy(library("toile_faulty"), dir.path().join("libtoile_faulty.so")).unwrap();
    let answer = toile(&["validate", &write(dir.path(), "[]", "Shades()")]);
    assert_eq!(answer.code, 3);
    assert!(answer.err.contains("unknown stage `Shades`"), "{}", answer.err);
}

#[test]
fn arguments_name_plugins_as_well() {
    let file = library("toile_faulty").display().to_string();
    let answer = toile(&["stage", "Shades", "--plugin", &file]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    assert!(answer.out.contains("From: plugin \"toile-faulty\" 0.1.0"), "{}", answer.out);
    let missing = toile(&["stage", "Shades", "--plugin", "gone.so"]);
    assert_eq!(missing.code, 3);
    assert_eq!(
        missing.err,
        "error: the plugin \"gone.so\" is refused: there is no such file\n  help: build it first, and name the library, like target/release/libtoile_sdf.so\n"
    );
}

#[test]
fn a_refused_plugin_stays_in_the_list_with_its_reason() {
    let answer = toile(&["stages", "--plugin", "gone.so"]);
    assert_eq!(answer.code, 0);
    assert!(answer.out.contains("refused plugins\n  gone.so: there is no such file"), "{}", answer.out);
    let json = toile(&["stages", "--json", "--plugin", "gone.so"]);
    let json: serde_json::Value = serde_json::from_str(&json.out).unwrap();
    assert_eq!(json["refused"][0]["reason"], "there is no such file");
}

#[test]
fn a_stage_of_a_plugin_that_panics_is_named_at_its_place() {
    let dir = tempfile::tempdir().unwrap();
    let pipeline = write(dir.path(), &format!("[{:?}]", library("toile_faulty")), "PanicsInRun()");
    let out = dir.path().join("out").display().to_string();
    let answer = toile(&["run", &pipeline, "--out", &out]);
    assert_eq!(answer.code, 70, "{}", answer.err);
    assert!(
        answer.err.contains("PanicsInRun (front): plugin \"toile-faulty\" 0.1.0 panicked: a photo of"),
        "{}",
        answer.err
    );
    assert!(answer.err.contains("p.ron:5"), "{}", answer.err);
}

#[test]
fn a_file_that_a_plugin_reads_is_part_of_what_its_result_depends_on() {
    let dir = tempfile::tempdir().unwrap();
    let pipeline = write(dir.path(), &format!("[{:?}]", library("toile_faulty")), "Tints()");
    let [out, cache] = ["out", "cache"].map(|d| dir.path().join(d).display().to_string());
    let picture = || {
        let answer = toile(&["run", &pipeline, "--until", "Tints", "--out", &out, "--cache-dir", &cache]);
        assert_eq!(answer.code, 0, "{}", answer.err);
        (std::fs::read(dir.path().join("out/stages/Tints/front.png")).unwrap(), answer.out)
    };
    std::fs::write(dir.path().join("tint.txt"), [10]).unwrap();
    let (first, _) = picture();
    let (again, said) = picture();
    assert!(first == again && said.contains("0 stages run"), "{said}");
    std::fs::write(dir.path().join("tint.txt"), [90]).unwrap();
    assert!(picture().0 != first, "a changed file gives another result");
}

/// Rust code that can end the program lies in one folder; but for the views of numpy.
#[test]
fn unsafe_code_lies_in_the_plugin_boundary_alone() {
    let root = toile_tests::root();
    let mut found = Vec::new();
    for folder in ["core", "stages", "cli", "plugins", "tests", "pipelines", "python"] {
        look(&root.join(folder), &mut found);
    }
    let outside: Vec<_> = found
        .iter()
        .filter(|p| {
            !p.contains("core/src/plugin/")
                && !p.contains("core/pipeline/src/plugin/")
                && !p.contains("core/derive/")
                && !p.ends_with("python/src/view.rs")
        })
        .collect();
    assert!(outside.is_empty(), "{outside:?}");
    assert!(found.len() > 3);
}

fn look(dir: &Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(dir).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() && !path.ends_with("target") {
            look(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            let marks = [
                concat!("unsafe", " {"),
                concat!("unsafe", " fn"),
                concat!("unsafe", " impl"),
                concat!("unsafe", " extern"),
            ];
            if marks.iter().any(|m| text.contains(m)) {
                found.push(path.display().to_string());
            }
        }
    }
}
