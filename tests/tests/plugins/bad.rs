//! Libraries that are no plugins, or broken ones: each is refused or reported by name.

use crate::plugins::kit::{bad, make, photo, run};
use std::path::Path;
use std::sync::Arc;
use toile_pipeline::plugin::load_plugin;

/// Why a plugin is refused.
fn refused(case: &str) -> String {
    let dir = tempfile::tempdir().unwrap();
    bad(case, dir.path()).map(|_| ()).unwrap_err().reason
}

#[test]
fn a_wrong_declaration_is_refused() {
    assert_eq!(refused("NO_SYMBOL"), "it declares no plugin");
    assert_eq!(refused("WRONG_MAGIC"), "its declaration does not begin with TOILEPLG");
    assert_eq!(refused("NEWER_MAJOR"), "it is built for ABI 2.2, this program supports 1.0 to 1.2");
    assert_eq!(refused("NEWER_MINOR"), "it is built for ABI 1.9, this program supports 1.0 to 1.2");
    assert_eq!(refused("SHORT_DECLARATION"), "its declaration has 40 bytes, at least 72 are needed");
    assert_eq!(refused("SHORT_TABLES"), "its stage tables have 64 bytes, at least 192 are needed");
    assert_eq!(refused("NULL_STAGES"), "it lacks the function `stages`");
}

#[test]
fn wrong_stage_tables_are_refused() {
    assert_eq!(refused("NO_STAGES"), "it lists 0 stages, 1 to 1000 are possible");
    assert_eq!(refused("NULL_RUN"), "its stage `Passes` lacks the function `run`");
    assert_eq!(refused("TAKEN_NAME"), "the stage name `Otsu` is taken by a stage of this program");
    assert_eq!(refused("NO_NAME"), "\"no name\" is no name for a stage");
    assert_eq!(refused("NOT_UTF8"), "a text is not UTF-8");
    assert_eq!(refused("UNKNOWN_ROLE"), "its stage `Passes`: there is no role `ironer`");
    let both = "its stage `Passes`: the parameter `cell` is finer both where it is less and where it is more";
    assert_eq!(refused("FINER_BOTH_WAYS"), both);
    assert_eq!(refused("UNKNOWN_KIND"), "its stage `Passes`: there is no kind `hologram`");
}

#[test]
fn the_hint_says_what_to_do() {
    let dir = tempfile::tempdir().unwrap();
    let newer = bad("NEWER_MAJOR", dir.path()).map(|_| ()).unwrap_err();
    assert_eq!(newer.hint.as_deref(), Some("use a newer toile"));
    let taken = bad("TAKEN_NAME", dir.path()).map(|_| ()).unwrap_err();
    assert_eq!(taken.hint.as_deref(), Some("its author must choose another name"));
}

#[test]
fn what_is_no_library_is_never_loaded() {
    let dir = tempfile::tempdir().unwrap();
    let mut registry = toile::registry();
    let mut refused = |name: &str, content: &[u8]| {
        let path = dir.path().join(name);
        std::fs::write(&path, content).unwrap();
        load_plugin(&mut registry, &path, None).unwrap_err().reason
    };
    assert_eq!(refused("empty.so", b""), "it is empty");
    assert_eq!(refused("words.so", b"a garment"), "it is a text, not a library: it begins with `a garment`");
    let half = refused("half.so", b"\x7fELF...toile_plugin\0");
    assert!(half == "it declares no plugin" || half.starts_with("the system cannot load it: "), "{half}");
    let torn = refused("torn.so", b"\x7fELF\0toile_plugin\0 and no more");
    assert!(torn.starts_with("the system cannot load it: "), "{torn}");
    assert_eq!(load_plugin(&mut registry, dir.path(), None).unwrap_err().reason, "it is not a file");
    let pipe = dir.path().join("pipe.so");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    assert_eq!(
        load_plugin(&mut registry, &pipe, None).unwrap_err().reason,
        "it is a pipe or a device, not a file"
    );
    let gone = load_plugin(&mut registry, &dir.path().join("gone.so"), None).unwrap_err();
    assert_eq!(gone.reason, "there is no such file");
    assert_eq!(registry.refused().len(), 7, "a refused plugin stays listed");
}

/// It would end the program where it is called first.
#[test]
fn a_function_that_is_not_there_is_told_when_the_plugin_is_loaded() {
    let dir = tempfile::tempdir().unwrap();
    let refused = bad("LACKS_FUNCTION", dir.path()).map(|_| ()).unwrap_err();
    assert_eq!(refused.reason, "the system cannot load it: undefined symbol: toile_helper");
    assert_eq!(
        refused.hint.as_deref(),
        Some(
            "it calls `toile_helper`, which none of the libraries has that it is linked to: link that one as well \
             (`cc ... -lNAME`), and build it again"
        )
    );
}

#[test]
fn a_library_that_a_plugin_needs_and_the_system_does_not_find_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name).display().to_string();
    let cc = |arguments: &[&str]| {
        let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
        let made = std::process::Command::new(compiler).args(["-shared", "-fPIC"]).args(arguments).output();
        let made = made.unwrap();
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    };
    std::fs::write(at("helper.c"), "int toile_helper(void) { return 0; }").unwrap();
    cc(&["-o", &at("libtoile_helper.so"), &at("helper.c")]);
    let include = toile_tests::root().join("core/include").display().to_string();
    let source = toile_tests::root().join("tests/faulty/bad.c").display().to_string();
    let (flags, folder) = (["-DCASE_LACKS_LIBRARY", "-I", &include, &source], at(""));
    let linked = ["-L", &folder, "-ltoile_helper", "-o"];
    cc(&[&flags[..], &linked, &[&at("libneeds.so")]].concat());
    let refused =
        || load_plugin(&mut toile::registry(), Path::new(&at("libneeds.so")), None).map(|_| ()).unwrap_err();
    let words = "the system cannot load it: libtoile_helper.so: cannot open shared object file: No such file or directory";
    let beside = refused();
    assert_eq!(beside.reason, words);
    let hint = format!(
        "libtoile_helper.so lies beside it, where the system does not look: start with LD_LIBRARY_PATH={}",
        dir.path().canonicalize().unwrap().display()
    );
    assert_eq!(beside.hint, Some(hint));
    std::fs::remove_file(at("libtoile_helper.so")).unwrap();
    let gone = refused();
    assert_eq!(gone.reason, words);
    let hint =
        "it needs libtoile_helper.so: install that, or tell the system its folder, LD_LIBRARY_PATH=FOLDER";
    assert_eq!(gone.hint.as_deref(), Some(hint));
}

/// An interrupted link or copy leaves a part of a library, which the system would map as if it were
/// whole.
#[test]
fn a_library_that_was_cut_short_is_refused_wherever_it_ends() {
    let dir = tempfile::tempdir().unwrap();
    let whole = std::fs::read(toile_tests::plugins::library("toile_faulty")).unwrap();
    let mut registry = toile::registry();
    for share in 1..40 {
        let path = dir.path().join(format!("{share}.so"));
        std::fs::write(&path, &whole[..whole.len() * share / 40]).unwrap();
        let refused = load_plugin(&mut registry, &path, None).unwrap_err();
        let head = "the system cannot load it: it is cut short: its tables name ";
        assert!(refused.reason.starts_with(head), "{share}: {}", refused.reason);
        assert!(refused.reason.ends_with(&format!("it has {}", whole.len() * share / 40)));
        let hint = "an interrupted build or copy leaves such a file: build it again";
        assert_eq!(refused.hint.as_deref(), Some(hint));
    }
    std::fs::write(dir.path().join("whole.so"), &whole).unwrap();
    load_plugin(&mut registry, &dir.path().join("whole.so"), None).unwrap();
}

/// What a run of the plugin says.
fn run_error(case: &str) -> String {
    let dir = tempfile::tempdir().unwrap();
    let registry = bad(case, dir.path()).unwrap();
    let stage = make(&registry, "Passes", "()");
    run(stage.as_ref(), vec![Arc::new(photo())]).unwrap_err().message
}

#[test]
fn a_run_that_gives_what_cannot_be_is_reported() {
    assert_eq!(
        run_error("CLAIMS_ALLOC"),
        "plugin \"bad\" 1.2.3: it asks for 1125899906842624 bytes, 4294967296 are left of the 4294967296 that one run may have"
    );
    assert_eq!(
        run_error("CLAIMS_RECORD"),
        "plugin \"bad\" 1.2.3: the field `pixels` claims 1125899906842624 bytes, 4294967296 are left of what is allowed"
    );
    assert_eq!(
        run_error("NULL_DATA"),
        "plugin \"bad\" 1.2.3: the field `pixels` has 12 elements at address zero"
    );
    assert_eq!(
        run_error("NO_FIELDS"),
        "plugin \"bad\" 1.2.3: its photo cannot be used: the field `size` is missing"
    );
    assert_eq!(run_error("UNKNOWN_STATUS"), "plugin \"bad\" 1.2.3 gave back 77, which means nothing");
    assert_eq!(run_error("SILENT"), "plugin \"bad\" 1.2.3 failed and did not say why");
    assert_eq!(run_error("TWICE"), "plugin \"bad\" 1.2.3: it gave its photo twice");
    assert_eq!(run_error("OTHER_PORT"), "plugin \"bad\" 1.2.3: it gave to output 3 of 1");
    assert_eq!(run_error("NO_OUTPUT"), "plugin \"bad\" 1.2.3 did not give its photo");
}

#[test]
fn without_a_fault_the_same_plugin_passes_photos_on() {
    let dir = tempfile::tempdir().unwrap();
    let registry = bad("NONE", dir.path()).unwrap();
    let stage = make(&registry, "Passes", "()");
    let made = run(stage.as_ref(), vec![Arc::new(photo())]).unwrap();
    assert_eq!(crate::plugins::kit::only(&made), format!("{:?}", photo()));
}
