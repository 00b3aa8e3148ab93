//! A cache that runs out of space gives a warning, seen through the process: its files may not grow
//! beyond a limit of the shell, as on a disk that is full.

use std::path::Path;
use std::process::Command;

#[test]
fn a_full_disk_is_one_warning_and_the_run_goes_on() {
    let dir = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let run = |limit: &str| {
        let script = format!(
            "trap '' XFSZ; {limit} exec \"$0\" run \"$1\" --until Otsu --out \"$2/out\" --cache-dir \"$2/cache\""
        );
        let output = Command::new("sh")
            .args(["-c", &script, env!("CARGO_BIN_EXE_toile")])
            .arg(root.join("pipelines/vest.ron"))
            .arg(dir.path())
            .output()
            .unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    // 50 kB: enough for the masks that the run gives, not for the photos that the cache would keep.
    let (code, err) = run("ulimit -f 100;");
    assert_eq!(code, Some(0), "{err}");
    let head = format!("warning: cannot write to the cache \"{}/cache/v1\": ", dir.path().display());
    assert!(err.starts_with(&head), "{err}");
    assert!(
        err.ends_with("; the run goes on without keeping results\n") && err.lines().count() == 1,
        "{err}"
    );
    assert!(dir.path().join("out/stages/Otsu/front.png").exists());
    // With space again the same cache works as before.
    assert_eq!(run(""), (Some(0), String::new()));
    assert_eq!(run(""), (Some(0), String::new()));
}
