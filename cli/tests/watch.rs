//! `toile run --watch`, through the process: an edit runs the pipeline again, Ctrl-C ends it.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic)]

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
    fn start(folder: &Path) -> Self {
        let path = |name: &str| folder.join(name).into_os_string();
        let mut child = Command::new(env!("CARGO_BIN_EXE_toile"))
            .args(["run", "--watch"])
            .args([path("vest.ron"), "--out".into(), path("out"), "--cache-dir".into(), path("cache")])
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
    let mut watch = Watch::start(dir.path());
    let line = watch.hear("watching");
    assert!(line.starts_with("done in ") && line.ends_with("s; watching 2 files, Ctrl-C ends it"), "{line}");
    assert_eq!(cached(dir.path()), [false, false, false]);

    replace(&ron, PIPELINE.replace("Otsu()", "Otsu(bias: 2)").as_bytes());
    assert_eq!(watch.hear("changed"), format!("changed: {}", ron.display()));
    watch.hear("done in ");
    assert_eq!(cached(dir.path()), [true, true, false]);

    replace(&photo, &fs::read(samples().join("back.jpg")).unwrap());
    assert_eq!(watch.hear("changed"), format!("changed: {}", photo.display()));
    watch.hear("done in ");
    assert_eq!(cached(dir.path()), [false, false, false]);

    // A fault does not end it, nor does a photo that is gone for a while.
    fs::write(&ron, "(stages: [").unwrap();
    watch.hear("not done in ");
    fs::write(&ron, PIPELINE).unwrap();
    watch.hear("done in ");
    fs::remove_file(&photo).unwrap();
    watch.hear("not done in ");
    fs::copy(samples().join("front.jpg"), &photo).unwrap();
    watch.hear("done in ");
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
