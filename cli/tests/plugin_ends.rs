//! Plugins that end the program, or do not let it end: each is named, through the process.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Far above what is promised: the tests prove what is said, not how fast the machine is.
const PATIENCE: Duration = Duration::from_secs(60);
const BAD: &str = "plugin \"bad\" 1.2.3";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The plugin in C that is wrong in one way, and a pipeline with its stage.
fn bad(case: &str, dir: &Path) -> PathBuf {
    let library = dir.join(format!("{}bad{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX));
    let mut compiler = Command::new(std::env::var("CC").unwrap_or_else(|_| "cc".into()));
    compiler.args(["-std=c11", "-O1", "-shared", "-fPIC", "-I"]).arg(root().join("core/include"));
    compiler.arg(format!("-DCASE_{case}")).arg("-o").arg(&library).arg(root().join("tests/faulty/bad.c"));
    assert!(compiler.status().unwrap().success());
    let photo = root().join("pipelines/samples/vest/front.jpg");
    let text = format!(
        "(plugins: [{library:?}], photos: {{\"front\": (file: {photo:?}, width: \"52 cm\")}}, stages: [Passes(), Otsu()])"
    );
    fs::write(dir.join("p.ron"), text).unwrap();
    library
}

fn toile(dir: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
    command
        .current_dir(dir)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

const RUN: [&str; 5] = ["run", "p.ron", "--no-cache", "--out", "out"];

fn answer(output: &Output) -> (Option<i32>, String, String) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn a_plugin_that_ends_the_program_is_named_with_code_70() {
    let help = "  help: this is a bug of the plugin, please report it to its author\n";
    for case in ["EXITS", "QUICK_EXITS", "EXITS_IN_LOOP", "EXITS_IN_CREATE"] {
        let dir = tempfile::tempdir().unwrap();
        bad(case, dir.path());
        let (code, out, err) = answer(&toile(dir.path(), &RUN).output().unwrap());
        let said = format!("error: {BAD} ended the program from within, by `exit`\n{help}");
        assert_eq!((code, out.as_str(), err), (Some(70), "", said), "{case}");
        assert!(!dir.path().join("out").exists());
    }
    let dir = tempfile::tempdir().unwrap();
    let library = bad("EXITS_IN_CREATE", dir.path());
    let (code, out, _) = answer(&toile(dir.path(), &["validate", "p.ron", "--json"]).output().unwrap());
    assert_eq!(code, Some(70));
    assert!(out.starts_with("{\"error\":\"internal\"") && out.lines().count() == 1, "{out}");
    bad("EXITS_ON_LOAD", dir.path());
    for command in [&["stages"][..], &["doctor"], &["validate", "p.ron"]] {
        let named = toile(dir.path(), command).args(["--plugin", "libbad.so"]).output().unwrap();
        let (code, _, err) = answer(&named);
        let said =
            format!("error: the plugin \"{}\" ended the program from within, by `exit`\n{help}", "libbad.so");
        assert_eq!((code, err), (Some(70), said), "{}", library.display());
    }
}

#[test]
fn a_plugin_that_is_right_ends_nothing() {
    let dir = tempfile::tempdir().unwrap();
    bad("NONE", dir.path());
    let (code, out, err) = answer(&toile(dir.path(), &RUN).output().unwrap());
    assert_eq!((code, err.as_str()), (Some(0), ""), "{out}");
}

/// Waits until the process has loaded the plugin and is at work.
fn settle(child: &Child) {
    let maps = format!("/proc/{}/maps", child.id());
    let until = Instant::now() + PATIENCE;
    while Instant::now() < until && !fs::read_to_string(&maps).is_ok_and(|m| m.contains("libbad")) {
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_millis(700));
}

/// Whether this process leaves the end of its terminal unheard, as under `nohup`: the program then
/// does so too, and would go on for ever.
fn is_hup_ignored() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|l| l.strip_prefix("SigIgn:"));
    ignored.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).unwrap() & 1 == 1)
}

fn signalled(dir: &Path, arguments: &[&str], signals: &[&str]) -> (Option<i32>, String, String) {
    let child = toile(dir, arguments).spawn().unwrap();
    settle(&child);
    for signal in signals {
        assert!(Command::new("kill").arg(signal).arg(child.id().to_string()).status().unwrap().success());
        std::thread::sleep(Duration::from_millis(300));
    }
    answer(&child.wait_with_output().unwrap())
}

#[test]
fn whichever_signal_stops_a_plugin_that_loops_it_is_named_at_its_place() {
    let dir = tempfile::tempdir().unwrap();
    bad("SPINS", dir.path());
    for signal in ["-INT", "-TERM", "-HUP"] {
        if signal == "-HUP" && is_hup_ignored() {
            eprintln!("skipped: -HUP, which is ignored here and in all that is started from here");
            continue;
        }
        let (code, _, err) = signalled(dir.path(), &RUN, &[signal]);
        assert_eq!(code, Some(5), "{signal}: {err}");
        let said = format!("Passes (front): {BAD} did not stop within 2 s of being asked");
        assert!(err.contains(&said) && err.contains("p.ron:1"), "{signal}: {err}");
    }
    let (code, out, _) = signalled(dir.path(), &[&RUN[..], &["--json"]].concat(), &["-INT"]);
    assert_eq!(code, Some(5));
    assert!(out.contains("\"error\":\"cancelled\""), "{out}");
}

#[test]
fn a_second_signal_ends_the_program_at_once_and_says_what_was_at_work() {
    let dir = tempfile::tempdir().unwrap();
    bad("SPINS", dir.path());
    let (code, _, err) = signalled(dir.path(), &RUN, &["-INT", "-INT"]);
    assert_eq!(code, Some(5));
    let head = format!("error: stopped: {BAD}, its stage `Passes` did not stop within ");
    assert!(err.starts_with(&head), "{err}");
}

#[test]
fn a_plugin_that_loops_while_it_makes_a_stage_is_named() {
    let dir = tempfile::tempdir().unwrap();
    bad("SPINS_IN_CREATE", dir.path());
    let (code, _, err) = signalled(dir.path(), &["validate", "p.ron"], &["-INT"]);
    assert_eq!(code, Some(5));
    // The time is what has passed, 0.4 s or more.
    let head = format!("error: stopped: {BAD}, while it makes its stage `Passes` did not stop within ");
    let rest = err.strip_prefix(&head).unwrap_or_else(|| panic!("{err}"));
    let seconds: f64 = rest.split(' ').next().unwrap().parse().unwrap();
    assert!(seconds >= 0.4 && rest.contains(" s of being asked\n"), "{err}");
}

#[test]
fn under_nohup_a_run_goes_on_when_its_terminal_closes() {
    let dir = tempfile::tempdir().unwrap();
    bad("SPINS", dir.path());
    let script = "trap '' HUP; exec \"$0\" run p.ron --no-cache --out out";
    let mut child = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_toile")])
        .current_dir(dir.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    settle(&child);
    let kill = |signal: &str| Command::new("kill").arg(signal).arg(child.id().to_string()).status().unwrap();
    assert!(kill("-HUP").success());
    std::thread::sleep(Duration::from_secs(4));
    // A process that is gone cannot be signalled, and a process that has ended is waited for.
    assert!(kill("-TERM").success());
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(5));
}
