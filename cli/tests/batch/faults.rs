//! Garments that fail in every way, each alone; folders and disks that do not take a batch.

use super::{batch, content, line, ran, results, set, toile, words, write_large, write_scene};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

fn faults(dir: &Path) -> Vec<(String, Value)> {
    results(dir, "out").into_iter().map(|(id, line)| (id, line["fault"].clone())).collect()
}

fn good(id: &str) -> (String, Value) {
    (id.into(), Value::Null)
}

fn reason(dir: &Path, id: &str) -> String {
    fs::read_to_string(dir.join("out/garments").join(id).join("failed/reason.txt")).unwrap()
}

#[test]
fn a_garment_that_fails_is_kept_and_can_be_run_again_alone() {
    let dir = set(3);
    fs::write(dir.path().join("in/s1.json"), "{").unwrap();
    let (code, out, err) = ran(batch(dir.path(), "out", &[]));
    assert_eq!(code, Some(4), "{err}");
    assert!(out.starts_with("3 garments: 2 good, 1 pattern_loading\n"), "{out}");
    let failed = ("g1".to_owned(), "pattern_loading".into());
    assert_eq!(faults(dir.path()), [good("g0"), failed.clone(), good("g2")]);
    let lines = results(dir.path(), "out");
    let message = "Scene: not a garment-scene-1: EOF while parsing an object at line 1 column 1";
    assert_eq!(lines["g1"]["message"], message);
    assert!(reason(dir.path(), "g1").starts_with(message), "{}", reason(dir.path(), "g1"));
    let record: Value =
        serde_json::from_slice(&fs::read(dir.path().join("out/garments/g1/record.json")).unwrap()).unwrap();
    assert_eq!(record["set"][0][1], "s1.json", "what went in is kept");
    assert!(record["reads"]["s1.json"].is_string(), "{record}");
    // It is as it was, so it is not run again, and still counts.
    let (code, _, err) = ran(batch(dir.path(), "out", &[]));
    assert_eq!((code, err.as_str()), (Some(4), "3 garments: 0 to run, 3 done or not asked for\n"));
    let (_, _, err) = ran(batch(dir.path(), "out", &["--retry-only", "timeout"]));
    assert_eq!(err, "3 garments: 0 to run, 3 done or not asked for\n");
    let (_, _, err) = ran(batch(dir.path(), "out", &["--retry-only", "pattern_loading"]));
    assert!(err.contains("[1/1] g1: pattern_loading: "), "{err}");
    // Mended, it is run by itself.
    write_scene(dir.path(), 1, 0.02);
    let (code, _, err) = ran(batch(dir.path(), "out", &[]));
    assert_eq!(code, Some(0), "{err}");
    assert!(err.starts_with("3 garments: 1 to run, 2 done"), "{err}");
    assert!(!dir.path().join("out/garments/g1/failed").exists());
    assert_eq!(
        ran(batch(dir.path(), "out", &["--only", "x"])).2,
        "error: the manifest has no garment \"x\"\n"
    );
}

#[test]
fn a_garment_that_takes_too_long_is_stopped_alone() {
    let dir = set(3);
    write_large(dir.path(), 1, 150);
    let (code, out, err) = ran(batch(dir.path(), "out", &["--max-time", "2s"]));
    assert_eq!(code, Some(4), "{err}");
    assert!(out.starts_with("3 garments: 2 good, 1 timeout\n"), "{out}");
    let said = "it was stopped after 2 s, the limit of --max-time\nhelp: give it more with --max-time, and run it again with --retry-only timeout\n";
    assert_eq!(reason(dir.path(), "g1"), said);
    let line = &results(dir.path(), "out")["g1"];
    assert_eq!((&line["exit"], &line["stage"]), (&5.into(), &"StaticEquilibrium".into()));
    assert!(
        dir.path().join("out/garments/g1/failed/stages/Scene/garment.obj").is_file(),
        "what was made until then"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_garment_that_takes_all_memory_costs_itself_alone() {
    let dir = set(3);
    write_large(dir.path(), 1, 200);
    let (code, out, err) = ran(batch(dir.path(), "out", &["--max-memory", "90 MB"]));
    assert_eq!(code, Some(4), "{err}");
    assert!(out.starts_with("3 garments: 2 good, 1 out_of_memory\n"), "{out}{err}");
    assert!(
        reason(dir.path(), "g1")
            .starts_with("it took more than 90.0 MB, the limit of --max-memory or --memory\n")
    );
}

/// Two that do not fit beside each other, by what they really take: one is run again alone.
#[cfg(target_os = "linux")]
#[test]
fn garments_that_do_not_fit_beside_each_other_are_run_one_after_the_other() {
    let dir = set(2);
    [0, 1].iter().for_each(|&k| write_large(dir.path(), k, 60));
    let (code, out, err) = ran(batch(dir.path(), "alone", &["--jobs", "1"]));
    assert_eq!(code, Some(0), "{out}{err}");
    let costs = fs::read_to_string(dir.path().join("alone/costs.jsonl")).unwrap();
    let cost: Value = serde_json::from_str(costs.lines().next().unwrap()).unwrap();
    let memory = format!("{} B", cost["peak_bytes"].as_u64().unwrap() * 3 / 2);
    let (code, out, err) = ran(batch(dir.path(), "out", &["--jobs", "2", "--memory", &memory]));
    assert_eq!(code, Some(0), "{out}{err}");
    assert!(content(dir.path(), "out") == content(dir.path(), "alone"));
}

/// The process of a garment that is being run by the batch of that id.
#[cfg(target_os = "linux")]
fn process_of(batch: u32) -> Option<u32> {
    fs::read_dir("/proc").unwrap().flatten().find_map(|entry| {
        let status = fs::read_to_string(entry.path().join("status")).ok()?;
        let parent = status.lines().find_map(|l| l.strip_prefix("PPid:"))?.trim().parse::<u32>().ok()?;
        (parent == batch).then(|| entry.file_name().to_str()?.parse().ok())?
    })
}

#[cfg(target_os = "linux")]
#[test]
fn a_garment_whose_process_crashes_costs_itself_alone() {
    let dir = set(3);
    write_large(dir.path(), 0, 60);
    let mut child = batch(dir.path(), "out", &["--jobs", "1"]).spawn().unwrap();
    let until = Instant::now() + Duration::from_secs(60);
    let process = loop {
        assert!(Instant::now() < until && child.try_wait().unwrap().is_none());
        if let Some(process) = process_of(child.id()) {
            break process;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    assert!(Command::new("kill").arg("-ABRT").arg(process.to_string()).status().unwrap().success());
    let (code, out, err) = words(&child.wait_with_output().unwrap());
    assert_eq!(code, Some(4), "{err}");
    assert!(out.starts_with("3 garments: 2 good, 1 crashed\n"), "{out}");
    assert!(
        reason(dir.path(), "g0").starts_with("its process was ended by signal 6\n"),
        "{}",
        reason(dir.path(), "g0")
    );
    // It was no fault of its own.
    assert_eq!(ran(batch(dir.path(), "out", &["--retry-only", "crashed"])).0, Some(0));
}

#[test]
fn a_folder_is_written_by_one_batch() {
    let dir = set(2);
    write_large(dir.path(), 0, 150);
    let mut child = batch(dir.path(), "out", &["--jobs", "1"]).spawn().unwrap();
    let until = Instant::now() + Duration::from_secs(60);
    while !dir.path().join("out/work/").is_dir() && Instant::now() < until {
        std::thread::sleep(Duration::from_millis(5));
    }
    let help = "  help: wait for its end, or choose another folder with --out; shares of one count, like 1/2 and 2/2, may write together\n";
    let out = dir.path().join("out");
    let said = format!("error: another batch writes \"{}\" now, as share 1/1\n{help}", out.display());
    for share in ["1/1", "2/2"] {
        assert_eq!(
            ran(batch(dir.path(), "out", &["--shard", share])),
            (Some(3), String::new(), said.clone())
        );
    }
    child.kill().unwrap();
    child.wait().unwrap();
    fs::write(dir.path().join("in/manifest.jsonl"), line(1)).unwrap();
    assert_eq!(ran(batch(dir.path(), "out", &[])).0, Some(0), "a batch that was killed holds nothing");
}

/// As in `full_disk`: files may not grow beyond a limit of the shell.
#[test]
fn a_full_disk_stops_the_batch_and_nothing_is_lost() {
    let dir = set(3);
    write_large(dir.path(), 1, 40);
    assert_eq!(ran(batch(dir.path(), "whole", &[])).0, Some(0));
    let script = "trap '' XFSZ; ulimit -f 100; exec \"$0\" batch in/manifest.jsonl --pipeline sheet.ron --out out --no-cache --jobs 1";
    let full = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_toile")])
        .current_dir(dir.path())
        .output()
        .unwrap();
    let (code, _, err) = words(&full);
    assert_eq!(code, Some(5), "{err}");
    let told = err.lines().find(|l| l.starts_with("error: ")).unwrap();
    assert!(told.starts_with("error: the garment \"g1\" cannot be kept: cannot write \""), "{told}");
    assert!(
        err.ends_with(
            "  help: what was done before is kept: start the batch again, and it goes on from there\n"
        ),
        "{err}"
    );
    assert_eq!(faults(dir.path()), [good("g0")]);
    let (code, _, err) = ran(batch(dir.path(), "out", &[]));
    assert_eq!(code, Some(0), "{err}");
    assert!(err.starts_with("3 garments: 2 to run, 1 done"), "{err}");
    assert!(content(dir.path(), "out") == content(dir.path(), "whole"));
}

#[test]
fn a_pipeline_with_a_fault_is_told_before_any_garment_is_run() {
    let dir = set(2);
    fs::write(dir.path().join("sheet.ron"), "(scene: Scene(file: \"none.json\"), stages: [NoSuchStage()])")
        .unwrap();
    let (code, out, err) = ran(batch(dir.path(), "out", &[]));
    assert_eq!((code, out.as_str()), (Some(3), ""), "{err}");
    assert!(err.contains("NoSuchStage"), "{err}");
    assert!(!dir.path().join("out").exists());
    let (code, _, err) = ran(toile(dir.path(), &["batch", "none.jsonl", "--pipeline", "sheet.ron"]));
    assert_eq!(code, Some(3));
    assert!(err.starts_with("error: cannot read the manifest \"none.jsonl\": No such file"), "{err}");
}
