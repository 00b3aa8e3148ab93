//! Ctrl-C stops a run within half a second and leaves no half-written file.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Far above the promised half second: the test proves that the run does stop and what it leaves,
/// not how fast the machine is.
const PATIENCE: Duration = Duration::from_secs(20);

fn start(out: &Path) -> Child {
    let pipeline = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pipelines/vest.ron");
    Command::new(env!("CARGO_BIN_EXE_toile"))
        .args(["run", "--no-cache"])
        .arg(pipeline)
        .arg("--out")
        .arg(out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn interrupt(child: &Child) {
    let done = Command::new("kill").arg("-INT").arg(child.id().to_string()).status().unwrap();
    assert!(done.success());
}

fn wait(child: &mut Child) -> Option<i32> {
    let started = Instant::now();
    while started.elapsed() < PATIENCE {
        if let Some(status) = child.try_wait().unwrap() {
            return status.code();
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    child.kill().unwrap();
    None
}

#[test]
fn ctrl_c_ends_with_code_5_and_writes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let mut child = start(&out);
    std::thread::sleep(Duration::from_millis(700));
    interrupt(&child);
    assert_eq!(wait(&mut child), Some(5));
    assert!(!out.exists(), "{:?}", std::fs::read_dir(&out).unwrap().collect::<Vec<_>>());
}
