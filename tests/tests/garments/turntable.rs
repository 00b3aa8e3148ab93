//! The turntable's page in a browser without WebGL: it loads, and shows the garment. Skipped where
//! no Chromium is on the path. A browser beside other tests may come too late, so `.ci/wide` runs
//! it.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{Rgba, RgbaImage};
use std::path::{Path, PathBuf};
use std::process::Command;
use toile_core::artifact::OutputFiles;
use toile_core::testkit::{Trial, cases, dress, folder};
use toile_stages::render::{ModelScene, Orbit};

const BROWSERS: [&str; 4] = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"];

fn browser() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    BROWSERS.iter().flat_map(|b| folders.iter().map(move |f| f.join(b))).find(|p| p.is_file())
}

/// A turntable of the suite's model.
fn page(dir: &Path, params: &str) -> PathBuf {
    let registry = toile::registry();
    let card = registry.cards().find(|c| c.name == "Turntable").unwrap();
    let stage = registry.make(card, params).unwrap();
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
    let page = page(&dir, "(views: 4, tiers: 2, size: 240)");
    let dom = String::from_utf8(chromium(&browser, &dir, &["--dump-dom"], &page)).unwrap();
    assert!(dom.contains("data-tt-loaded=\"yes\""), "the views were not read");
    let shot = dir.join("shot.png");
    chromium(&browser, &dir, &[&format!("--screenshot={}", shot.display())], &page);
    let picture = image::open(shot).unwrap().into_rgb8();
    // The stage is light grey around the garment, and darker where the garment or the mannequin is.
    let dark = picture.pixels().filter(|p| p.0.iter().all(|c| *c < 190)).count();
    assert!(dark > 5_000, "{dark} dark pixels");
}

/// Puts the picture on the page's canvas into the page's text, two seconds after the views are
/// read.
const SHOW: &str = "<script>const wait = setInterval(() => {
  if (!document.querySelector('[data-tt-loaded]')) return;
  clearInterval(wait);
  setTimeout(() => {
    const text = document.createElement('pre');
    text.textContent = 'shot:' + document.querySelectorAll('canvas')[1].toDataURL('image/png') + ':end';
    document.body.append(text);
  }, 2000);
}, 50);</script>";

/// What the page shows at a turn and a height, degrees.
fn shown(browser: &Path, dir: &Path, page: &Path, azimuth: f64, elevation: f64) -> RgbaImage {
    let at = PathBuf::from(format!("{}#azimuth={azimuth}&elevation={elevation}", page.display()));
    // A browser's time may run out before the page has drawn: it is asked anew.
    let ask = |_| {
        let dom =
            String::from_utf8(chromium(browser, dir, &["--dump-dom", "--virtual-time-budget=600000"], &at))
                .unwrap();
        dom.split_once("shot:data:image/png;base64,").map(|(_, rest)| rest.to_owned())
    };
    let rest = (0..20).find_map(ask).unwrap();
    let bytes = STANDARD.decode(rest.split_once(":end").unwrap().0).unwrap();
    image::load_from_memory(&bytes).unwrap().into_rgba8()
}

/// The stage's ground.
const GROUND: f64 = 232.0;

/// Peak signal-to-noise ratio over the pixels that the truth covers whole, dB; what is shown lies
/// on the stage's ground.
fn psnr(shown: &RgbaImage, truth: &RgbaImage) -> f64 {
    let on_ground = |p: [u8; 4], c: usize| {
        let a = f64::from(p[3]) / 255.0;
        f64::from(p[c]) * a + GROUND * (1.0 - a)
    };
    let seen = || shown.pixels().zip(truth.pixels()).filter(|(_, t)| t.0[3] == 255);
    let squares: f64 =
        seen().flat_map(|(s, t)| (0..3).map(|c| (on_ground(s.0, c) - f64::from(t.0[c])).powi(2))).sum();
    assert!(seen().count() > 10_000, "{} pixels", seen().count());
    10.0 * (255.0_f64.powi(2) * 3.0 * seen().count() as f64 / squares).log10()
}

/// Rendered views laid over each other with these weights: what a page would show that moves no
/// pixel.
fn faded(views: &[(RgbaImage, f64)]) -> RgbaImage {
    RgbaImage::from_fn(views[0].0.width(), views[0].0.height(), |x, y| {
        let sum = |value: &dyn Fn([u8; 4]) -> f64| -> f64 {
            views.iter().map(|(view, weight)| weight * value(view.get_pixel(x, y).0)).sum()
        };
        let cover = sum(&|p| f64::from(p[3]));
        let colour = |c: usize| (sum(&|p| f64::from(p[c]) * f64::from(p[3])) / cover.max(1e-9)).round() as u8;
        Rgba([colour(0), colour(1), colour(2), cover.round() as u8])
    })
}

/// Places between the views of 24 azimuths and the tiers of -5, 15 and 40 degrees, with the nearest
/// views and their weights, and the least that `Depth` shows of them and that `Flow` gains over
/// laying the views over each other, dB.
type Place = ((f64, f64), &'static [(f64, f64, f64)], (f64, f64));
const PLACES: [Place; 5] = [
    ((7.5, 15.0), &[(0.0, 15.0, 0.5), (15.0, 15.0, 0.5)], (35.0, 3.0)),
    ((52.5, 15.0), &[(45.0, 15.0, 0.5), (60.0, 15.0, 0.5)], (35.0, 4.0)),
    ((187.5, 5.0), &[(180.0, 15.0, 0.5), (195.0, -5.0, 0.5)], (35.0, 1.0)),
    ((48.75, 15.0), &[(45.0, 15.0, 0.75), (60.0, 15.0, 0.25)], (35.0, 4.0)),
    ((0.0, 27.5), &[(0.0, 15.0, 0.5), (0.0, 40.0, 0.5)], (35.0, 1.5)),
];

#[test]
#[ignore = "slow: .ci/wide"]
fn between_views_the_page_shows_what_would_have_been_rendered() {
    let Some(browser) = browser() else { return eprintln!("skipped: no Chromium on the path") };
    let (_keep, dir) = folder().unwrap();
    let model = dress::model();
    let orbit = Orbit::around(&model, 360, 480, &[-5.0, 15.0, 40.0]);
    let scene = ModelScene::draft(&model);
    let cut_out =
        |a: f64, e: f64| -> RgbaImage { scene.cut_outs(&orbit, a.to_radians(), &[e.to_radians()]).remove(0) };
    let pages = ["Depth", "Flow"].map(|way| {
        let params =
            format!("(name: \"{way}\", views: 24, tiers: 3, size: 480, quality: 90, interpolate: {way})");
        let page = page(&dir, &params);
        let html = std::fs::read_to_string(&page).unwrap();
        eprintln!("{way}: {} kB", html.len() / 1000);
        std::fs::write(&page, html.replacen("</body>", &format!("{SHOW}</body>"), 1)).unwrap();
        page
    });
    for ((azimuth, elevation), nearest, (least, gain)) in PLACES {
        let truth = cut_out(azimuth, elevation);
        let [depth, flow] =
            pages.each_ref().map(|page| psnr(&shown(&browser, &dir, page, azimuth, elevation), &truth));
        let views: Vec<(RgbaImage, f64)> = nearest.iter().map(|(a, e, w)| (cut_out(*a, *e), *w)).collect();
        let fade = psnr(&faded(&views), &truth);
        let text = format!(
            "at {azimuth}, {elevation} degrees: Depth {depth:.1} dB, Flow {flow:.1} dB, views laid over each other {fade:.1} dB"
        );
        eprintln!("{text}");
        assert!(depth > least && flow > fade + gain && depth > flow, "{text}");
    }
}
