//! The commands of the README, of docs/reference/cli.md and of docs/guide run, word for word and in
//! that order, and end with exit code 0.
//!
//! A command is a line of an indented block that begins with `toile `, `cargo ` or `.ci/`, and in
//! the README a piece of code within a line that does. Those of the program run in a copy of
//! `pipelines`, which some of them change, beside the files of a reader that the guide names. A
//! whole run that the guide alone names is checked by `toile validate` here, and run by `.ci/wide`.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What these tests are a part of.
const OURSELVES: [&str; 2] = ["cargo test --release --workspace", ".ci/wide"];

/// Files that the guide takes for a reader's own, and which of ours stand for them.
const OWN_FILES: [(&str, &str); 10] = [
    ("mine.jpg", "samples/tshirt/front.jpg"),
    ("front.jpg", "samples/vest/front.jpg"),
    ("back.jpg", "samples/vest/back.jpg"),
    ("skirt.jpg", "samples/skirt/front.jpg"),
    ("my_specification.json", "samples/pattern/shirt_specification.json"),
    ("inner_specification.json", "samples/pattern/trousers_specification.json"),
    ("outer_specification.json", "samples/pattern/shirt_specification.json"),
    ("mine.svg", "samples/pattern/pleats.svg"),
    ("seams.ron", "samples/pattern/pleats_seams.ron"),
    ("pipelines/mine.ron", "vest.ron"),
];

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Where commands stand: the README, the page of all commands, the guide.
fn pages() -> Vec<PathBuf> {
    let mut guide = files(&root().join("docs/guide"), ".md");
    guide.sort();
    [root().join("README.md"), root().join("docs/reference/cli.md")].into_iter().chain(guide).collect()
}

/// A page's commands in its order.
fn commands_of(page: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(page).unwrap();
    let is_readme = page.ends_with("README.md");
    let pieces = text.lines().flat_map(|line| match line.strip_prefix("    ") {
        Some(code) => vec![code],
        None if is_readme => line.split('`').skip(1).step_by(2).collect(),
        None => Vec::new(),
    });
    let is_command = |piece: &&str| ["toile ", "cargo ", ".ci/"].iter().any(|start| piece.starts_with(start));
    pieces.filter(is_command).map(str::to_owned).collect()
}

/// A command, and whether the guide alone names it.
struct Told {
    command: String,
    by_guide: bool,
}

/// All commands, each once, in the order of the pages.
fn commands() -> Vec<Told> {
    let mut seen = BTreeSet::new();
    let all = pages().into_iter().enumerate().flat_map(|(i, page)| {
        commands_of(&page).into_iter().map(move |command| Told { command, by_guide: i > 1 })
    });
    all.filter(|told| seen.insert(told.command.clone())).collect()
}

/// Those that measure for minutes, one that records from two whole runs, and batches.
fn is_long(command: &str) -> bool {
    let is_batch = command.starts_with("toile batch") && !command.contains("--check");
    is_batch
        || ["toile trade", "toile tune", "toile bench", "toile golden accept"]
            .iter()
            .any(|start| command.starts_with(start))
}

/// Those that need what another command has built.
fn needs_build(command: &str) -> bool {
    command.starts_with("cargo ") || command.contains("target/")
}

/// A run of the guide that takes a garment to its end.
fn is_whole_run(told: &Told) -> bool {
    told.by_guide && told.command.starts_with("toile run ")
}

/// Files that `own_files` brings, and runs with.
fn is_of_own_files(command: &str) -> bool {
    ["me.obj", "mine.dxf", "mine.svg"].iter().any(|file| command.contains(file))
}

/// No photo of ours shows an object of known size.
fn needs_scale(command: &str) -> bool {
    command.contains("scale: ")
}

/// The check of the pipeline that a run's command names, with its settings.
fn validation(command: &str) -> String {
    let mut words = command.split(' ');
    let mut kept = Vec::new();
    while let Some(word) = words.next() {
        match word {
            "--out" | "--until" => drop(words.next()),
            "--keep" => (),
            "run" => kept.push("validate"),
            _ => kept.push(word),
        }
    }
    kept.join(" ")
}

/// A folder with a copy of the shipped pipelines and a reader's files.
pub(crate) fn scratch() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    let pipelines = dir.path().join("pipelines");
    copy(&root().join("pipelines"), &pipelines);
    for (own, ours) in OWN_FILES {
        std::fs::copy(pipelines.join(ours), dir.path().join(own)).unwrap();
    }
    std::fs::copy(pipelines.join("samples/garment/vest.obj"), dir.path().join("me.obj")).unwrap();
    std::fs::write(dir.path().join("mine.dxf"), crate::own_files::drawing()).unwrap();
    std::fs::create_dir(dir.path().join("patterns")).unwrap();
    for name in ["shirt.json", "trousers.json"] {
        let ours = format!("samples/pattern/{}", name.replace(".json", "_specification.json"));
        std::fs::copy(pipelines.join(ours), dir.path().join("patterns").join(name)).unwrap();
    }
    let garment =
        |id: &str| format!("{{\"id\": \"{id}\", \"set\": {{\"pattern.file\": \"patterns/{id}.json\"}}}}\n");
    std::fs::write(dir.path().join("patterns.jsonl"), ["shirt", "trousers"].map(garment).concat()).unwrap();
    let garment = std::fs::read_to_string(pipelines.join("samples/garment/vest.obj")).unwrap();
    std::fs::write(dir.path().join("dress.obj"), in_centimetres(&garment)).unwrap();
    dir
}

/// An OBJ file in metres with its vertices in centimetres.
fn in_centimetres(obj: &str) -> String {
    let longer = |line: &str| match line.strip_prefix("v ") {
        Some(numbers) => {
            let numbers = numbers.split_whitespace().map(|n| (100.0 * n.parse::<f64>().unwrap()).to_string());
            format!("v {}", numbers.collect::<Vec<_>>().join(" "))
        }
        None => line.to_owned(),
    };
    obj.lines().map(longer).collect::<Vec<_>>().join("\n")
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().map(Result::unwrap) {
        let to = to.join(entry.file_name());
        match entry.path().is_dir() {
            true => copy(&entry.path(), &to),
            false => drop(std::fs::copy(entry.path(), to).unwrap()),
        }
    }
}

/// The command as a shell runs it, with the program on its path, and with a cache of its own.
fn shell(command: &str, folder: &Path, cache: &Path) -> Command {
    let program = Path::new(env!("CARGO_BIN_EXE_toile")).parent().unwrap();
    let mut path = OsString::from(program);
    path.push(":");
    path.push(std::env::var_os("PATH").unwrap_or_default());
    let mut shell = Command::new("sh");
    shell.args(["-c", command]).current_dir(folder).env("PATH", path).env("TOILE_CACHE", cache);
    shell
}

pub(crate) fn passes(command: &str, folder: &Path, cache: &Path) {
    let start = Instant::now();
    let out = shell(command, folder, cache).output().unwrap();
    let text = [out.stdout, out.stderr].map(|b| String::from_utf8_lossy(&b).into_owned()).concat();
    assert_eq!(out.status.code(), Some(0), "{command}:\n{text}");
    eprintln!("{:5.1} s  {command}", start.elapsed().as_secs_f64());
}

/// `toile studio`: it prints its address, answers there, and ends on Ctrl-C.
fn serves(command: &str, folder: &Path, cache: &Path) {
    let mut shell = shell(&format!("exec {command} --no-open"), folder, cache);
    let mut child = shell.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let address = line.strip_prefix("studio: http://").and_then(|l| l.strip_suffix("  (Ctrl-C ends it)\n"));
    let (host, token) =
        address.unwrap_or_else(|| panic!("{command}: {line}")).split_once("/?token=").unwrap();
    let mut stream = TcpStream::connect(host).unwrap();
    let ask = format!(
        "GET / HTTP/1.1\r\nHost: {host}\r\nAuthorization: Bearer {token}\r\nConnection: close\r\n\r\n"
    );
    stream.write_all(ask.as_bytes()).unwrap();
    let mut page = String::new();
    stream.read_to_string(&mut page).unwrap();
    assert!(page.starts_with("HTTP/1.1 200 OK\r\n") && page.contains("<html"), "{command}: {page}");
    let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(interrupt.success());
    assert_eq!(child.wait().unwrap().code(), Some(0), "{command}");
}

/// A command that goes on until Ctrl-C: it writes what it is for, goes on, and is ended.
fn goes_on(command: &str, folder: &Path, cache: &Path, writes: &Path) {
    let mut child = shell(&format!("exec {command}"), folder, cache).stderr(Stdio::null()).spawn().unwrap();
    let until = Instant::now() + Duration::from_secs(120);
    while !writes.is_file() && Instant::now() < until {
        std::thread::sleep(Duration::from_millis(50));
    }
    let ended = child.try_wait().unwrap();
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(writes.is_file() && ended.is_none(), "{command}: {ended:?}");
}

#[test]
fn the_commands_run() {
    let dir = scratch();
    let cache = dir.path().join("cache");
    let quick =
        |t: &Told| t.command.starts_with("toile ") && !is_long(&t.command) && !needs_build(&t.command);
    let commands: Vec<Told> = commands().into_iter().filter(quick).collect();
    assert!(commands.len() > 40, "{}", commands.len());
    for told in commands {
        let command = &told.command;
        match command.contains("--watch") {
            _ if command.starts_with("toile studio") => serves(command, dir.path(), &cache),
            true => {
                let report = dir.path().join("out/vest/report.html");
                let _ = std::fs::remove_file(&report);
                goes_on(command, dir.path(), &cache, &report);
            }
            false if is_whole_run(&told) => passes(&validation(command), dir.path(), &cache),
            // The crate is written twice, with its role stated and without.
            false => {
                let _ = std::fs::remove_dir_all(dir.path().join("my-otsu"));
                passes(command, dir.path(), &cache);
            }
        }
    }
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_commands_that_take_long_run() {
    let dir = scratch();
    let commands: Vec<Told> = commands().into_iter().filter(|t| is_long(&t.command)).collect();
    assert!(commands.len() > 4, "{}", commands.len());
    commands.iter().for_each(|t| passes(&t.command, dir.path(), &dir.path().join("cache")));
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_whole_runs_of_the_guide_run() {
    let dir = scratch();
    let whole = |t: &Told| {
        let is_left_out =
            t.command.contains("--watch") || needs_scale(&t.command) || is_of_own_files(&t.command);
        is_whole_run(t) && !is_left_out
    };
    let commands: Vec<Told> = commands().into_iter().filter(whole).collect();
    assert!(commands.len() > 15, "{}", commands.len());
    // The guide flattens what another page has made.
    passes("toile run pipelines/vest.ron --out out/vest", dir.path(), &dir.path().join("cache"));
    commands.iter().for_each(|t| passes(&t.command, dir.path(), &dir.path().join("cache")));
}

#[test]
#[ignore = "slow: .ci/wide"]
fn what_builds_the_program_runs() {
    let dir = tempfile::tempdir().unwrap();
    let commands: Vec<Told> = commands().into_iter().filter(|t| needs_build(&t.command)).collect();
    let built: Vec<&str> = commands.iter().map(|t| &*t.command).filter(|c| !OURSELVES.contains(c)).collect();
    assert_eq!(built.len(), 5, "{built:?}");
    for command in built {
        let mut shell = shell(command, &root(), &dir.path().join("cache"));
        let status = shell.env("CARGO_INSTALL_ROOT", dir.path()).status().unwrap();
        assert!(status.success(), "{command}: {status}");
    }
    assert!(dir.path().join("bin/toile").is_file());
}

#[test]
fn the_tests_are_run_as_the_readme_says() {
    let commands = commands_of(&root().join("README.md"));
    let ourselves: Vec<&str> =
        commands.iter().map(String::as_str).filter(|c| OURSELVES.contains(c)).collect();
    assert_eq!(ourselves, OURSELVES);
    let run = std::fs::read_to_string(root().join(".ci/run")).unwrap();
    assert!(run.lines().any(|line| line == OURSELVES[0]), "{run}");
    assert!(root().join(OURSELVES[1]).is_file());
}

#[test]
fn a_run_is_checked_with_its_settings() {
    assert_eq!(
        validation("toile run a.ron --set 'b.c=\"1 mm\"' --until Otsu --keep --out out/x"),
        "toile validate a.ron --set 'b.c=\"1 mm\"'"
    );
}

#[test]
fn the_readme_names_the_least_rust_version() {
    let manifest = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let version = manifest.lines().find_map(|line| line.strip_prefix("rust-version = ")).unwrap();
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    assert!(readme.contains(&format!("Rust {} or newer", version.trim_matches('"'))), "{version}");
}

/// Files with that ending below a folder, but for what is built.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().map(|e| e.unwrap().path());
    entries
        .flat_map(|path| match path.is_dir() {
            true if path.ends_with("target") || path.ends_with("out") => Vec::new(),
            true => files(&path, ending),
            false => Some(path).filter(|p| p.to_string_lossy().ends_with(ending)).into_iter().collect(),
        })
        .collect()
}

#[test]
fn a_crate_whose_sources_are_not_tested_has_no_tests_in_them() {
    let manifests = files(&root(), "Cargo.toml");
    let untested = manifests.iter().filter(|m| {
        let text = std::fs::read_to_string(m).unwrap();
        text.split_once("[lib]")
            .is_some_and(|(_, lib)| lib.split("\n[").next().unwrap().contains("\ntest = false\n"))
    });
    let untested: Vec<&Path> = untested.map(|m| m.parent().unwrap()).collect();
    assert!(untested.len() > 5, "{untested:?}");
    for source in untested.iter().flat_map(|folder| files(&folder.join("src"), ".rs")) {
        let text = std::fs::read_to_string(&source).unwrap();
        assert!(!text.contains("#[test]"), "{} has tests that nobody runs", source.display());
    }
}

#[test]
fn a_test_that_is_left_out_is_one_of_the_wide_ones() {
    let reasons = [
        "slow: .ci/wide",
        "a measurement",
        "long: all pairs on the 20 x 20 square",
        "the other process of plugin_files",
        "a program for the test beside it",
    ];
    for source in files(&root(), ".rs") {
        let text = std::fs::read_to_string(&source).unwrap();
        for line in text.lines().map(str::trim).filter(|line| line.starts_with("#[ignore")) {
            let said = reasons.iter().any(|reason| line == format!("#[ignore = \"{reason}\"]"));
            assert!(said, "{}: {line}", source.display());
        }
    }
}

/// Files of tests are parts of few programs; one that no program names would never run.
#[test]
fn every_file_of_tests_belongs_to_a_program() {
    let mut looked_at = 0;
    for manifest in files(&root(), "Cargo.toml") {
        let text = std::fs::read_to_string(&manifest).unwrap();
        if !text.contains("\nautotests = false\n") {
            continue;
        }
        let folder = manifest.with_file_name("tests");
        let parts = std::fs::read_to_string(folder.join("main.rs")).unwrap();
        for path in std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()) {
            let name = path.file_stem().unwrap().to_str().unwrap();
            let programs = [format!("\"tests/{name}.rs\""), format!("\"tests/{name}/main.rs\"")];
            let is_program = programs.iter().any(|p| text.contains(&format!("\npath = {p}\n")));
            let is_source = path.extension().is_some_and(|e| e == "rs")
                || ["main.rs", "mod.rs"].iter().any(|f| path.join(f).is_file());
            let is_part = parts.lines().any(|line| line == format!("mod {name};"));
            assert!(!is_source || is_program || is_part, "no program runs {}", path.display());
            looked_at += 1;
        }
    }
    assert!(looked_at > 25, "{looked_at}");
}
