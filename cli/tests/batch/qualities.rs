//! The quality of a batch, by an error and by a deadline.

use super::{batch, ran, results, set};
use std::fs;
use std::path::Path;

const PIPELINE: &str = "(name: \"sheet\", scene: Scene(file: \"none.json\"), \
    stages: [StaticEquilibrium(speed: 0.01), GarmentObj()], qualities: [\
    Quality(name: \"Draft\", max_error: \"3 mm\", set: [\"stages.StaticEquilibrium.speed=0.02\"]), \
    Quality(name: \"Fine\", max_error: \"1 mm\", set: [\"stages.StaticEquilibrium.speed=0.005\"])])";

fn with_qualities(count: usize) -> tempfile::TempDir {
    let dir = set(count);
    fs::write(dir.path().join("sheet.ron"), PIPELINE).unwrap();
    dir
}

/// The quality at which every garment was made.
fn quality(dir: &Path) -> String {
    let mut names: Vec<String> = results(dir, "out")
        .values()
        .map(|line| {
            line["quality"]["name"].as_str().unwrap().trim_end_matches(", changed by --set").to_owned()
        })
        .collect();
    names.dedup();
    assert_eq!(names.len(), 1, "{names:?}");
    names.remove(0)
}

#[test]
fn the_coarsest_quality_that_keeps_an_error_is_taken() {
    for (most, name, first) in [
        ("5 mm", "Draft", "quality Draft, which keeps 3 mm"),
        ("2 mm", "Fine", "quality Fine, which keeps 1 mm"),
    ] {
        let dir = with_qualities(2);
        let (code, _, err) = ran(batch(dir.path(), "out", &["--max-error", most]));
        assert_eq!((code, err.lines().next()), (Some(0), Some(first)), "{err}");
        assert_eq!(quality(dir.path()), name);
    }
    let dir = with_qualities(2);
    let (code, _, err) = ran(batch(dir.path(), "out", &["--max-error", "0.5 mm"]));
    assert_eq!(code, Some(3));
    assert_eq!(
        err,
        "error: no quality of the pipeline keeps 0.5 mm\n  help: they keep: Draft 3 mm, Fine 1 mm\n"
    );
}

#[test]
fn without_qualities_there_is_nothing_to_choose_from() {
    let dir = set(2);
    for asked in [["--max-error", "5 mm"], ["--deadline", "1h"]] {
        let (code, _, err) = ran(batch(dir.path(), "out", &asked));
        assert_eq!(code, Some(3));
        assert_eq!(
            err,
            "error: the pipeline \"sheet.ron\" has no qualities to choose from\n  help: measure some: toile tune sheet.ron --quality \"Draft=3 mm\" --quality \"Fine=1 mm\"\n"
        );
    }
}

#[test]
fn the_finest_quality_that_is_done_in_time_is_taken_and_kept() {
    let dir = with_qualities(12);
    let (code, out, err) = ran(batch(dir.path(), "out", &["--deadline", "10m"]));
    assert_eq!(code, Some(0), "{out}{err}");
    assert!(err.contains("quality Fine is taken\n12 garments: 4 to run, 8 done or not asked for\n"), "{err}");
    assert_eq!(quality(dir.path()), "Fine");
    assert!(!dir.path().join("out/pilot").exists());
    let (code, _, err) = ran(batch(dir.path(), "out", &["--deadline", "10m"]));
    assert_eq!(code, Some(0), "{err}");
    let first: Vec<&str> = err.lines().take(2).collect();
    let wanted = ["quality Fine, as it was chosen before", "12 garments: 0 to run, 12 done or not asked for"];
    assert_eq!(first, wanted);
    // Another deadline is another choice.
    let (code, _, err) = ran(batch(dir.path(), "out", &["--deadline", "20m"]));
    assert_eq!(code, Some(0), "{err}");
    assert!(err.contains("quality Fine is taken\n12 garments: 0 to run, 12 done"), "{err}");
}

#[test]
fn a_deadline_that_the_coarsest_quality_misses_is_refused() {
    let dir = with_qualities(9);
    let (code, _, err) = ran(batch(dir.path(), "out", &["--deadline", "1ms"]));
    assert_eq!(code, Some(3), "{err}");
    let told = "error: even at the quality Draft the garments are not done in 0 s: they take ";
    assert!(err.contains(told), "{err}");
    let help = "help: give it longer with --deadline, or divide the manifest among machines with --shard\n";
    assert!(err.ends_with(help), "{err}");
}
