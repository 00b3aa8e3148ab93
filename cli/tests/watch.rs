//! `toile run --watch`, through the process: an edit runs the pipeline again, Ctrl-C ends it.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Far above what a run takes: the test proves what happens, not how fast the machine is.
const PATIENCE: Duration = Duration::from_secs(60);

const PIPELINE: &str = r#"(
    name: "watched",
    photos: { "front": (file: "front.jpg", width: "52 cm") },
    stages: [ NeighbourhoodMean(radius: 1), Otsu() ],
)"#;

/// A watching process and what it says, line by line. It is ended with the test.
struct Watch {
    child: Child,
    lines: Receiver<String>,
}

impl Watch {
    fn start(folder: &Path, more: &[&str]) -> Self {
        let path = |name: &str| folder.join(name).into_os_string();
        let mut child = Command::new(env!("CARGO_BIN_EXE_toile"))
            .args(["run", "--watch"])
            .args([path("vest.ron"), "--out".into(), path("out"), "--cache-dir".into(), path("cache")])
            .args(more)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (send, lines) = channel();
        let err = BufReader::new(child.stderr.take().unwrap());
        std::thread::spawn(move || err.lines().map_while(Result::ok).try_for_each(|l| send.send(l)));
        Watch { child, lines }
    }

    /// The next line that holds `words`.
    fn hear(&self, words: &str) -> String {
        let mut heard = Vec::new();
        let until = Instant::now() + PATIENCE;
        while let Ok(line) = self.lines.recv_timeout(until.saturating_duration_since(Instant::now())) {
            if line.contains(words) {
                return line;
            }
            heard.push(line);
        }
        panic!("nothing with \"{words}\" in {heard:#?}");
    }
}

impl Watch {
    /// The end of a run that reached its end.
    fn done(&self) -> String {
        let line = self.hear("done in ");
        assert!(line.starts_with("done in "), "{line}");
        line
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../pipelines/samples/vest")
}

/// Puts a file in place as editors do: beside it first, then renamed.
fn replace(path: &Path, bytes: &[u8]) {
    let new = path.with_extension("new");
    fs::write(&new, bytes).unwrap();
    fs::rename(new, path).unwrap();
}

fn metrics(folder: &Path) -> String {
    fs::read_to_string(folder.join("out/metrics.json")).unwrap()
}

/// Whether each stage came from the cache, in the order of the file.
fn cached(folder: &Path) -> Vec<bool> {
    metrics(folder).lines().filter(|l| l.contains("\"cached\"")).map(|l| l.contains("true")).collect()
}

#[test]
fn an_edit_of_pipeline_or_photo_runs_what_changed_and_ctrl_c_ends_it() {
    let dir = tempfile::tempdir().unwrap();
    let (ron, photo) = (dir.path().join("vest.ron"), dir.path().join("front.jpg"));
    fs::write(&ron, PIPELINE).unwrap();
    fs::copy(samples().join("front.jpg"), &photo).unwrap();
    let mut watch = Watch::start(dir.path(), &[]);
    let line = watch.done();
    assert!(line.ends_with("s; watching 2 files, Ctrl-C ends it"), "{line}");
    assert_eq!(cached(dir.path()), [false, false, false]);

    replace(&ron, PIPELINE.replace("Otsu()", "Otsu(bias: 2)").as_bytes());
    assert_eq!(watch.hear("changed"), format!("changed: {}", ron.display()));
    watch.done();
    assert_eq!(cached(dir.path()), [true, true, false]);

    replace(&photo, &fs::read(samples().join("back.jpg")).unwrap());
    assert_eq!(watch.hear("changed"), format!("changed: {}", photo.display()));
    watch.done();
    assert_eq!(cached(dir.path()), [false, false, false]);

    // A fault does not end it, nor does a photo that is gone for a while.
    fs::write(&ron, "(stages: [").unwrap();
    watch.hear("not done in ");
    fs::write(&ron, PIPELINE).unwrap();
    watch.done();
    fs::remove_file(&photo).unwrap();
    watch.hear("not done in ");
    fs::copy(samples().join("front.jpg"), &photo).unwrap();
    watch.done();
    assert_eq!(cached(dir.path()), [true, true, true]);

    let done = Command::new("kill").arg("-INT").arg(watch.child.id().to_string()).status().unwrap();
    assert!(done.success());
    let until = Instant::now() + PATIENCE;
    let status = loop {
        match watch.child.try_wait().unwrap() {
            Some(status) => break status,
            None if Instant::now() > until => panic!("it does not end"),
            None => std::thread::sleep(Duration::from_millis(20)),
        }
    };
    assert_eq!(status.code(), Some(0));
}

/// The plugin in C, compiled to the file itself; `white` is what it takes every level from.
fn build_invert(library: &Path, white: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let source = library.with_extension("c");
    let text = fs::read_to_string(root.join("plugins/c/invert.c")).unwrap();
    assert!(text.contains("made->white = 255;"));
    fs::write(&source, text.replace("made->white = 255;", &format!("made->white = {white};"))).unwrap();
    let built = library.with_extension("built");
    let mut compiler = Command::new(std::env::var("CC").unwrap_or_else(|_| "cc".into()));
    compiler.args(["-std=c11", "-O1", "-shared", "-fPIC", "-I"]).arg(root.join("core/include"));
    assert!(compiler.arg("-o").arg(&built).arg(&source).status().unwrap().success());
    // Written over, which is the harder case: the old code is loaded while its file changes.
    fs::write(library, fs::read(built).unwrap()).unwrap();
}

#[test]
fn a_plugin_that_is_built_anew_runs_anew() {
    let dir = tempfile::tempdir().unwrap();
    let (ron, photo) = (dir.path().join("vest.ron"), dir.path().join("front.jpg"));
    let library =
        dir.path().join(format!("{}invert{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX));
    let text = PIPELINE.replace("stages: [", "plugins: [\"invert\"], stages: [ InvertC(),");
    fs::write(&ron, text).unwrap();
    fs::copy(samples().join("front.jpg"), &photo).unwrap();
    let watch = Watch::start(dir.path(), &["--keep"]);
    let picture = || fs::read(dir.path().join("out/stages/InvertC/front.png")).unwrap();

    // Named, but not built yet: it is waited for.
    watch.hear("the plugin \"invert\" is refused");
    watch.hear("not done in ");
    build_invert(&library, "255");
    assert_eq!(watch.hear("changed"), format!("changed: {}", library.display()));
    watch.done();
    let first = picture();

    build_invert(&library, "200");
    watch.hear("changed");
    watch.done();
    assert_eq!(cached(dir.path()), [true, false, false, false]);
    assert_ne!(picture(), first, "the new code ran");

    build_invert(&library, "255");
    watch.hear("changed");
    watch.done();
    assert_eq!(picture(), first, "and the old one again, from the cache or not");
}
