//! What every command does as users of a shell expect, through the process.

use crate::sheet::sheet;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const PIPELINE: &str =
    "(name: \"sheet\", scene: Scene(file: \"sheet.json\"), stages: [StaticEquilibrium(speed: 0.01)])";

fn folder() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("sheet.json"), sheet().to_string()).unwrap();
    fs::write(dir.path().join("sheet.ron"), PIPELINE).unwrap();
    dir
}

fn toile(dir: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
    command.current_dir(dir).args(arguments).stdin(Stdio::null());
    command.env_remove("NO_COLOR").env("TOILE_CACHE", dir.join("cache"));
    command
}

fn words(output: &Output) -> (Option<i32>, String, String) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

fn said(dir: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    words(&toile(dir, arguments).output().unwrap())
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_written_is_a_failure_of_every_command() {
    let dir = folder();
    let full = || File::options().write(true).open("/dev/full").unwrap();
    for arguments in [
        &["run", "sheet.ron"][..],
        &["run", "sheet.ron", "--json"],
        &["validate", "sheet.ron"],
        &["explain", "sheet.ron"],
        &["stages"],
        &["stages", "--schema"],
        &["stage", "Otsu", "--json"],
        &["why", "sheet.ron"],
        &["cache"],
        &["doctor"],
        &["man"],
        &["completions", "bash"],
        &["--help"],
        &["--version"],
    ] {
        let output = toile(dir.path(), arguments).stdout(full()).output().unwrap();
        let (code, _, err) = words(&output);
        assert_ne!(code, Some(0), "{arguments:?}");
        let why = "error: standard output cannot be written: No space left on device (os error 28)\n";
        assert!(err.ends_with(why), "{arguments:?}: {err}");
    }
}

#[test]
fn a_reader_that_has_enough_is_no_failure() {
    let dir = folder();
    let script = "\"$0\" stages; echo $? >code";
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &format!("({script}) | head -n 1"), env!("CARGO_BIN_EXE_toile")])
        .current_dir(dir.path());
    assert!(shell.output().unwrap().stderr.is_empty());
    assert_eq!(fs::read_to_string(dir.path().join("code")).unwrap(), "0\n");
}

#[test]
fn more_threads_than_cores_are_bounded_and_that_is_told() {
    let dir = folder();
    let (code, _, err) = said(dir.path(), &["run", "sheet.ron", "--no-cache", "--threads", "1024"]);
    let cores = std::thread::available_parallelism().unwrap().get();
    let has = if cores == 1 { "1 core".to_owned() } else { format!("{cores} cores") };
    let told =
        format!("warning: 1024 threads are requested and this machine has {has}; it works on {cores}\n");
    assert_eq!((code, err), (Some(0), told));
    let metrics = fs::read_to_string(dir.path().join("out/sheet/metrics.json")).unwrap();
    assert!(metrics.contains(&format!("\"threads\": {cores}")), "{metrics}");
}

/// A stack beyond any memory: the system starts no thread.
#[test]
fn without_threads_the_work_is_done_all_the_same() {
    let dir = folder();
    for arguments in
        [&["run", "sheet.ron", "--no-cache"][..], &["run", "sheet.ron", "--no-cache", "--threads", "2"]]
    {
        let output = toile(dir.path(), arguments).env("RUST_MIN_STACK", "70000000000000").output().unwrap();
        let (code, _, err) = words(&output);
        assert_eq!(code, Some(0), "{err}");
        assert_eq!(err, "warning: the system gives no threads; one does all the work\n");
    }
    for arguments in [&["explain", "sheet.ron"][..], &["validate", "sheet.ron"], &["why", "sheet.ron"]] {
        let output = toile(dir.path(), arguments).env("RUST_MIN_STACK", "70000000000000").output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", words(&output).2);
    }
    let output = toile(dir.path(), &["doctor"]).env("RUST_MIN_STACK", "70000000000000").output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", words(&output).2);
}

#[test]
fn colour_is_for_terminals_unless_it_is_asked_for() {
    let dir = folder();
    fs::write(dir.path().join("bad.ron"), "(stages: [Otzu()])").unwrap();
    let coloured = |more: &[&str], no_color: bool| {
        let mut command = toile(dir.path(), &[&["validate", "bad.ron"][..], more].concat());
        if no_color {
            command.env("NO_COLOR", "1");
        }
        let (code, _, err) = words(&command.output().unwrap());
        assert_eq!(code, Some(3));
        err.contains('\u{1B}')
    };
    assert!(!coloured(&[], false) && !coloured(&["--color", "auto"], false));
    assert!(!coloured(&["--color", "never"], false));
    assert!(coloured(&["--color", "always"], false));
    // What is requested by name goes before what holds everywhere.
    assert!(coloured(&["--color", "always"], true));
}

/// On a terminal, which `script` gives: colour, unless NO_COLOR is set or the terminal is dumb.
#[test]
fn on_a_terminal_no_color_and_a_dumb_terminal_are_heeded() {
    let dir = folder();
    fs::write(dir.path().join("bad.ron"), "(stages: [Otzu()])").unwrap();
    let on_terminal = |env: &[(&str, &str)], arguments: &str| {
        let mut script = Command::new("script");
        script.args(["-qec", &format!("{} {arguments}", env!("CARGO_BIN_EXE_toile")), "/dev/null"]);
        script.current_dir(dir.path()).env_remove("NO_COLOR").env("TERM", "xterm").stdin(Stdio::null());
        script.envs(env.iter().copied());
        script.output().ok().map(|o| String::from_utf8_lossy(&o.stdout).into_owned())
    };
    // A system without `script` has no terminal to give.
    let Some(plain) = on_terminal(&[], "validate bad.ron") else { return };
    assert!(plain.contains("Otzu") && plain.contains("\u{1B}["), "{plain:?}");
    for env in [[("NO_COLOR", "1")], [("TERM", "dumb")]] {
        let text = on_terminal(&env, "validate bad.ron").unwrap();
        assert!(text.contains("Otzu") && !text.contains('\u{1B}'), "{env:?}: {text:?}");
    }
    let dumb = on_terminal(&[("TERM", "dumb")], "run sheet.ron --no-cache").unwrap();
    let quiet = on_terminal(&[], "run sheet.ron --no-cache -q").unwrap();
    assert!(!dumb.contains('\u{1B}') && dumb.contains("files in"), "{dumb:?}");
    assert_eq!(quiet, "");
}

#[test]
fn quiet_says_nothing_but_errors_and_answers() {
    let dir = folder();
    let silent = (Some(0), String::new(), String::new());
    assert_eq!(said(dir.path(), &["run", "sheet.ron", "-q", "--threads", "1024"]), silent);
    assert!(dir.path().join("out/sheet/metrics.json").is_file());
    assert_eq!(said(dir.path(), &["validate", "--quiet", "sheet.ron"]), silent);
    let (code, out, _) = said(dir.path(), &["-q", "stages"]);
    assert!(code == Some(0) && out.contains("Otsu"), "{out}");
    let (code, out, _) = said(dir.path(), &["run", "sheet.ron", "-q", "--json"]);
    assert!(code == Some(0) && out.starts_with('{'), "{out}");
    let (code, _, err) = said(dir.path(), &["validate", "-q", "gone.ron"]);
    assert!(code == Some(3) && err.contains("gone.ron"), "{err}");
}

#[test]
fn the_version_names_the_commit_that_the_program_was_built_from() {
    let (code, out, _) = said(Path::new("."), &["--version"]);
    assert_eq!(code, Some(0));
    let version = concat!("toile ", env!("CARGO_PKG_VERSION"));
    let commit = out.trim_end().strip_prefix(version).unwrap();
    let sources = Path::new(env!("CARGO_MANIFEST_DIR"));
    let git = Command::new("git").arg("-C").arg(sources).args(["rev-parse", "--short=12", "HEAD"]).output();
    // Sources without git: the version alone.
    let head = git.ok().filter(|o| o.status.success()).map(|o| words(&o).1.trim().to_owned());
    assert_eq!(commit, head.map_or_else(String::new, |head| format!(" (commit {head})")));
}

#[test]
fn shells_and_the_manual_know_every_command_that_users_have() {
    let dir = folder();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let (code, out, err) = said(dir.path(), &["completions", shell]);
        assert_eq!((code, err.as_str()), (Some(0), ""));
        assert!(out.contains("validate") && out.contains("no-cache"), "{shell}");
        assert!(!out.contains("run-apart"), "{shell}");
    }
    let syntax = format!("{} completions bash | bash -n", env!("CARGO_BIN_EXE_toile"));
    assert!(Command::new("bash").args(["-c", &syntax]).status().is_ok_and(|s| s.success()));
    let (code, page, _) = said(dir.path(), &["man"]);
    assert_eq!(code, Some(0));
    assert!(
        page.contains(".TH toile 1") && page.contains("toile\\-golden") && !page.contains("apart"),
        "{page}"
    );
    let (_, page, _) = said(dir.path(), &["man", "golden", "check"]);
    assert!(page.contains("name the first stage that differs"), "{page}");
    let (code, _, err) = said(dir.path(), &["man", "fly"]);
    assert_eq!((code, err.as_str()), (Some(2), "error: `toile` has no command `fly`\n"));
}

fn piped(dir: &Path, arguments: &[&str], text: &str) -> (Option<i32>, String, String) {
    let mut child = toile(dir, arguments);
    child.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = child.spawn().unwrap();
    // A command that refuses it does not read it.
    let _ = child.stdin.take().unwrap().write_all(text.as_bytes());
    words(&child.wait_with_output().unwrap())
}

#[test]
fn a_pipeline_comes_from_standard_input() {
    let dir = folder();
    let (code, out, err) = piped(dir.path(), &["run", "-", "--no-cache"], PIPELINE);
    assert_eq!((code, err.as_str()), (Some(0), ""), "{out}");
    assert!(dir.path().join("out/stdin/metrics.json").is_file());
    let (code, out, _) = piped(dir.path(), &["validate", "-"], PIPELINE);
    assert_eq!((code, out.split(',').next()), (Some(0), Some("standard input: valid")));
    let (code, _, err) = piped(dir.path(), &["validate", "-"], "(stages: [Otzu()])");
    assert!(code == Some(3) && err.contains("standard input:1:11"), "{err}");
    let (code, out, err) = piped(dir.path(), &["explain", "-", "--no-cache"], PIPELINE);
    assert!(code == Some(0) && out.starts_with("sheet: "), "{out}{err}");
    let (code, out, err) = piped(dir.path(), &["why", "-"], PIPELINE);
    assert!(code == Some(0) && out.contains("StaticEquilibrium"), "{out}{err}");
    for (arguments, why) in [
        (&["run", "-", "--watch"][..], "cannot be watched"),
        (&["run", "-", "--locked"], "has no lock beside it"),
        (&["lock", "-"], "has no place for a lock beside it"),
        (&["migrate", "-"], "has no file to rewrite"),
        (&["golden", "check", "-"], "has no goldens beside it"),
        (&["tune", "-", "--max-error", "3 mm"], "cannot be tuned"),
    ] {
        let said = format!("error: a pipeline from standard input {why}; name a file\n");
        assert_eq!(piped(dir.path(), arguments, PIPELINE), (Some(3), String::new(), said));
    }
}

/// A pipe without a writer, and a link to a device without an end.
fn traps(dir: &Path) -> [PathBuf; 2] {
    let [pipe, device] = ["pipe", "device"].map(|name| dir.join(name));
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", &device).unwrap();
    [pipe, device]
}

#[test]
fn pipes_and_devices_are_no_inputs() {
    let dir = folder();
    let what = "it is a pipe or a device, not a file";
    for trap in traps(dir.path()) {
        let name = trap.file_name().unwrap().to_str().unwrap();
        for command in ["run", "validate", "explain", "why", "lock", "migrate"] {
            let (code, _, err) = said(dir.path(), &[command, name]);
            assert!(code == Some(3) && err.contains(what), "{command} {name}: {err}");
        }
        let sources = [
            format!("(scene: Scene(file: {name:?}), stages: [StaticEquilibrium()])"),
            format!("(photos: {{\"front\": (file: {name:?}, width: \"5 cm\")}}, stages: [Otsu()])"),
            format!("(body: BodyObj(file: {name:?}), stages: [BvhCollider()])"),
        ];
        for text in sources {
            let (code, _, err) = piped(dir.path(), &["run", "-", "--no-cache"], &text);
            assert!(code == Some(3) && err.contains(what), "{text}: {err}");
        }
    }
}

/// All files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let listed: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    let (folders, mut found): (Vec<_>, Vec<_>) = listed.into_iter().partition(|p| p.is_dir());
    found.extend(folders.iter().flat_map(|f| files(f)));
    found
}

#[test]
fn pipes_and_devices_in_the_cache_are_replaced_and_not_read() {
    let dir = folder();
    let run = || said(dir.path(), &["run", "sheet.ron"]).0;
    assert_eq!(run(), Some(0));
    let traps = traps(dir.path());
    for trap in &traps {
        let cached = files(&dir.path().join("cache"));
        assert!(cached.len() > 5, "{cached:?}");
        for file in &cached {
            fs::remove_file(file).unwrap();
            match fs::read_link(trap) {
                Ok(target) => std::os::unix::fs::symlink(target, file).unwrap(),
                Err(_) => assert!(Command::new("mkfifo").arg(file).status().unwrap().success()),
            }
        }
        for command in ["why", "explain"] {
            let (code, _, err) = said(dir.path(), &[command, "sheet.ron"]);
            assert_eq!(code, Some(0), "{command}: {err}");
        }
        assert_eq!(run(), Some(0));
        let (_, out, err) = said(dir.path(), &["run", "sheet.ron"]);
        assert!(out.contains("0 stages run"), "{out}{err}");
    }
}

#[test]
fn what_a_killed_run_left_behind_is_swept_by_the_next() {
    let dir = folder();
    assert_eq!(said(dir.path(), &["run", "sheet.ron"]).0, Some(0));
    let shelf = files(&dir.path().join("cache/v1/blobs"))[0].parent().unwrap().to_owned();
    let left = [
        dir.path().join("out/sheet/.toile-a1B2c3.tmp"),
        shelf.join(".toile-a1B2c3.tmp"),
        shelf.join(".tmpa1B2c3"),
    ];
    left.iter().for_each(|path| fs::write(path, "half").unwrap());
    assert_eq!(
        said(dir.path(), &["run", "sheet.ron", "--set", "stages.StaticEquilibrium.speed=0.02"]).0,
        Some(0)
    );
    assert!(left.iter().all(|path| !path.exists()));
}
