//! The turntable's page in a browser without WebGL: it loads, and shows the garment. Skipped where no Chromium is on the path. A browser
//! beside other tests may come too late, so `.ci/wide` runs it.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

use std::path::{Path, PathBuf};
use std::process::Command;
use toile_core::artifact::OutputFiles;
use toile_core::testkit::{Trial, cases, folder};

const BROWSERS: [&str; 4] = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"];

fn browser() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    BROWSERS.iter().flat_map(|b| folders.iter().map(move |f| f.join(b))).find(|p| p.is_file())
}

/// A small turntable of the suite's model.
fn page(dir: &Path) -> PathBuf {
    let registry = toile::registry();
    let card = registry.cards().find(|c| c.name == "Turntable").unwrap();
    let stage = registry.make(card, "(views: 4, tiers: 2, size: 240)").unwrap();
    let made = Trial { stage: stage.as_ref(), folder: dir }.run(&cases(card)[0].inputs);
    let values = made.values().unwrap();
    let any: &dyn std::any::Any = values[0].entries()[0].1.as_ref();
    let files: &OutputFiles = any.downcast_ref().unwrap();
    let file = dir.join(&files.0[0].path);
    std::fs::write(&file, &files.0[0].bytes).unwrap();
    file
}

fn chromium(browser: &Path, dir: &Path, arguments: &[&str], page: &Path) -> Vec<u8> {
    let profile = format!("--user-data-dir={}", dir.join("profile").display());
    let fixed = [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-webgl",
        "--disable-3d-apis",
        "--hide-scrollbars",
    ];
    let answer = Command::new(browser)
        .args(fixed)
        .args(["--virtual-time-budget=8000", "--window-size=600,900", &profile])
        .args(arguments)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    answer.stdout
}

#[test]
#[ignore = "slow: .ci/wide"]
fn the_page_loads_without_webgl_and_shows_the_garment() {
    let Some(browser) = browser() else { return eprintln!("skipped: no Chromium on the path") };
    let (_keep, dir) = folder().unwrap();
    let page = page(&dir);
    let dom = String::from_utf8(chromium(&browser, &dir, &["--dump-dom"], &page)).unwrap();
    assert!(dom.contains("data-tt-loaded=\"yes\""), "the views were not read");
    let shot = dir.join("shot.png");
    chromium(&browser, &dir, &[&format!("--screenshot={}", shot.display())], &page);
    let picture = image::open(shot).unwrap().into_rgb8();
    // The stage is light grey around the garment, and darker where the garment or the mannequin is.
    let dark = picture.pixels().filter(|p| p.0.iter().all(|c| *c < 190)).count();
    assert!(dark > 5_000, "{dark} dark pixels");
}
