//! Real photos, carried through to the draped garment.
//!
//! The photos are no part of the repository: `TOILE_SHARED` names a folder with
//! `data/photos/*.jpg`; without it the tests say "skipped". docs/log/2026-11-27-photos.md reports
//! on all photos.

use std::path::PathBuf;
use toile_tests::{pipeline, toile};

/// The photo, or nothing where there is no folder of photos.
fn photo(name: &str) -> Option<PathBuf> {
    let Some(shared) = std::env::var_os("TOILE_SHARED") else {
        println!("skipped: TOILE_SHARED is not set");
        return None;
    };
    Some(PathBuf::from(shared).join("data/photos").join(name))
}

/// Runs a pipeline on a photo and holds it against its own quality limits: exit code 0.
fn drapes(file: &str, name: &str, sets: &[&str]) {
    let Some(photo) = photo(name) else { return };
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let (file, photo) = (pipeline(file), format!("photos.front.file={:?}", photo.display().to_string()));
    let out_text = out.display().to_string();
    let mut args = vec!["run", &file, "--out", &out_text, "--set", &photo];
    sets.iter().for_each(|s| args.extend(["--set", s]));
    let answer = toile(&args);
    assert_eq!(answer.code, 0, "{}{}", answer.out, answer.err);
    let picture = image::open(out.join("front.png")).unwrap();
    assert!(picture.width() > 100);
}

#[test]
fn a_black_tee_on_a_white_rug() {
    let sets = ["photos.front.width=\"80 cm\""];
    drapes("photo_tee.ron", "tee_black_on_white_rug.jpg", &sets);
}

#[test]
fn a_raglan_tee_on_dark_wood() {
    let sets = ["photos.front.width=\"88 cm\""];
    drapes("photo_tee.ron", "tee_raglan_on_dark_wood.jpg", &sets);
}

#[test]
fn a_yellow_vest_on_stone() {
    drapes("photo_vest.ron", "vest_yellow.jpg", &["photos.front.width=\"50 cm\""]);
}

#[test]
fn trousers_are_no_tee_and_no_vest() {
    let Some(photo) = photo("trousers_a.jpg") else { return };
    let photo = format!("photos.front.file={:?}", photo.display().to_string());
    for file in ["photo_tee.ron", "photo_vest.ron"] {
        let answer = toile(&["run", &pipeline(file), "--until", "GridMesher", "--set", &photo]);
        assert_eq!(answer.code, 3, "{}{}", answer.out, answer.err);
    }
}
