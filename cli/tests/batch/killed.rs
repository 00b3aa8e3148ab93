//! `kill -9` in the middle, and Ctrl-C: started again, the batch comes to the result of one that
//! was never disturbed.

use super::{batch, content, ran, set, write_large};
use std::io::Read;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

/// Waits until so many garments are in their place.
fn wait_for(child: &mut Child, garments: &std::path::Path, count: usize) {
    let until = Instant::now() + Duration::from_secs(60);
    while std::fs::read_dir(garments).map_or(0, Iterator::count) < count {
        assert!(Instant::now() < until, "{count} garments are not done within a minute");
        if let Some(status) = child.try_wait().unwrap() {
            let mut words = String::new();
            child.stderr.take().unwrap().read_to_string(&mut words).unwrap();
            unreachable!("it ended before {count} garments were done: {status}\n{words}");
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Kills a batch of so many garments so often, each time after some more garments.
fn killed(garments: usize, kills: usize) {
    let dir = set(garments);
    assert_eq!(ran(batch(dir.path(), "whole", &[])).0, Some(0));
    let whole = content(dir.path(), "whole");
    for kill in 0..kills {
        let mut child = batch(dir.path(), "out", &[]).spawn().unwrap();
        let done = 1 + kill * garments / kills;
        wait_for(&mut child, &dir.path().join("out/garments"), done);
        // A part of the time of a garment, so that kills meet all that it does.
        std::thread::sleep(Duration::from_millis(7 * kill as u64 % 40));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let (code, out, err) = ran(batch(dir.path(), "out", &[]));
    assert_eq!(code, Some(0), "{err}");
    assert!(out.starts_with(&format!("{garments} garments: {garments} good\n")), "{out}");
    let merged = content(dir.path(), "out");
    assert!(
        merged == whole,
        "{:?}",
        merged.keys().filter(|k| merged.get(*k) != whole.get(*k)).collect::<Vec<_>>()
    );
    let left = std::fs::read_dir(dir.path().join("out/work")).unwrap().count();
    assert_eq!(left, 0, "what was at work is swept");
}

#[test]
fn killed_five_times_it_comes_to_the_same_bits() {
    killed(40, 5);
}

#[test]
#[ignore = "slow: .ci/wide"]
fn killed_twenty_times_in_200_garments_it_comes_to_the_same_bits() {
    killed(200, 20);
}

#[test]
fn ctrl_c_keeps_what_is_done() {
    let dir = set(4);
    write_large(dir.path(), 3, 150);
    let mut child = batch(dir.path(), "out", &["--jobs", "1"]).spawn().unwrap();
    wait_for(&mut child, &dir.path().join("out/garments"), 3);
    let asked = Command::new("kill").arg("-INT").arg(child.id().to_string()).status().unwrap();
    assert!(asked.success());
    let (code, out, err) = super::words(&child.wait_with_output().unwrap());
    assert_eq!(code, Some(5), "{err}");
    assert!(out.starts_with("4 garments: 3 good, 1 not run yet\n"), "{out}");
    assert!(err.ends_with("stopped; started again, the batch goes on from here\n"), "{err}");
}

/// A share that was killed before it wrote the results of all leaves that to `--merge`.
#[test]
fn results_of_all_shares_are_written_without_a_run() {
    let dir = set(4);
    assert_eq!(ran(batch(dir.path(), "whole", &[])).0, Some(0));
    for share in ["1/2", "2/2"] {
        assert_eq!(ran(batch(dir.path(), "out", &["--shard", share])).0, Some(0));
    }
    for name in ["results.jsonl", "costs.jsonl", "index.html"] {
        std::fs::remove_file(dir.path().join("out").join(name)).unwrap();
    }
    let (code, out, err) = ran(batch(dir.path(), "out", &["--merge"]));
    assert_eq!((code, err.as_str()), (Some(0), ""));
    assert!(out.starts_with("4 garments: 4 good\n"), "{out}");
    assert!(content(dir.path(), "out") == content(dir.path(), "whole"));
    // A garment that has not been run is told and not run.
    std::fs::remove_dir_all(dir.path().join("out/garments/g2")).unwrap();
    let (code, out, _) = ran(batch(dir.path(), "out", &["--merge"]));
    assert_eq!(code, Some(0));
    assert!(out.starts_with("4 garments: 3 good, 1 not run yet\n"), "{out}");
    assert!(!dir.path().join("out/garments/g2").exists());
}

#[test]
fn results_of_another_batch_are_not_written_over() {
    let dir = set(2);
    assert_eq!(ran(batch(dir.path(), "out", &[])).0, Some(0));
    let before = content(dir.path(), "out");
    let (code, _, err) = ran(batch(dir.path(), "out", &["--merge", "--no-verify"]));
    let root = dir.path().join("out").display().to_string();
    assert_eq!(
        (code, err),
        (
            Some(3),
            format!(
                "error: \"{root}\" holds no garment of this batch\n  help: run it first; pipeline, values and options have to be those that it was run with\n"
            )
        )
    );
    assert!(content(dir.path(), "out") == before);
    let (code, _, err) = ran(batch(dir.path(), "out", &["--merge", "--shard", "1/2"]));
    assert_eq!(code, Some(2), "{err}");
}
