//! Scores the finder on drawn scenes: `score COUNT [KIND [FIRST [PICTURES]]]`.
//!
//! Scenes FIRST to FIRST + COUNT - 1 of each kind are drawn, with the object and without it among
//! things that are like it, or of one KIND (`card`, `a4`, `letter`, `chess`, `ruler mm`,
//! `ruler cm`, or `no card` and so on). A line a kind tells how many were found, in wrong places or
//! where there is none, and by how much lengths all over the frame were off; a line a scene tells
//! what was not right. With a folder PICTURES, photos of those scenes are written there.
#![allow(clippy::print_stdout, missing_docs, unreachable_pub)]

mod objects;
mod random;
mod scene;
mod texture;
mod thing;

use image::RgbImage;
use nalgebra::{Point2, Vector2};
use random::Random;
use scene::{Scene, through};
use std::time::Instant;
use toile_scale::{Found, KnownObject, draw, find};

const KINDS: [&str; 6] = ["card", "a4", "letter", "chess", "ruler mm", "ruler cm"];

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let number = |i: usize, or: u64| args.get(i).and_then(|a| a.parse().ok()).unwrap_or(or);
    let (count, first) = (number(1, 24), number(3, 0));
    let only = args.get(2).filter(|a| *a != "all");
    for kind in KINDS {
        if only.is_none_or(|o| o == kind) {
            present(kind, first..first + count, args.get(4));
        }
    }
    for kind in &KINDS[..5] {
        if only.is_none_or(|o| *o == format!("no {kind}")) {
            absent(kind, first..first + count, args.get(4));
        }
    }
}

fn object(kind: &str) -> KnownObject {
    match kind {
        "card" => KnownObject::BankCard,
        "a4" => KnownObject::A4,
        "letter" => KnownObject::Letter,
        "chess" => KnownObject::Chessboard { square_um: 25_000, corners: None },
        _ => KnownObject::Ruler,
    }
}

fn thing(r: &mut Random, kind: &str, ground: [f64; 3]) -> thing::Thing {
    match kind {
        "card" => objects::card(r, ground),
        "a4" => objects::a4(r, ground),
        "letter" => objects::letter(r, ground),
        "chess" => objects::chess(r, ground),
        _ => {
            let long = if kind == "ruler mm" { r.from(0.15, 0.21) } else { r.from(0.16, 0.31) };
            objects::ruler(r, ground, kind == "ruler mm", long)
        }
    }
}

fn seed(kind: &str, n: u64) -> u64 {
    kind.bytes().fold(n, |s, b| s.wrapping_mul(131).wrapping_add(u64::from(b)))
}

/// Width and height of a photo, pixels, and pixels a metre at its middle.
fn size(kind: &str) -> (u32, u32, f64) {
    match kind {
        "card" => (2000, 1500, 150.0 / 0.0856),
        "ruler mm" => (2000, 1500, 5000.0),
        _ => (1600, 1200, 1450.0),
    }
}

/// A scene with the object beside a garment; the camera is tilted by up to 30 degrees, over rulers
/// not at all.
fn scene(kind: &str, n: u64) -> Option<Scene> {
    let mut r = Random::new(seed(kind, n));
    let ruler = kind.starts_with("ruler");
    (0..50).find_map(|_| {
        let (w, h, density) = size(kind);
        let tilt = if ruler { 0.0 } else { r.from(0.0, 30f64.to_radians()) };
        let mut s = Scene::draw(&mut r, w, h, density, tilt);
        let thing = thing(&mut r, kind, s.ground.base);
        let share = if kind == "card" || ruler { 1.0 } else { r.from(0.5, 0.8) };
        shrink(&mut s.things[0], if kind == "ruler mm" { 0.6 } else { share });
        s.lay(&mut r, thing).then_some(s)
    })
}

/// A scene without the object, and what is like it there.
fn scene_without(kind: &str, n: u64) -> (Scene, &'static str) {
    let mut r = Random::new(seed(kind, n + 77_000));
    let tilt = r.from(0.0, 30f64.to_radians());
    let mut s = Scene::draw(&mut r, 1600, 1200, 1450.0, tilt);
    shrink(&mut s.things[0], 0.7);
    let base = s.ground.base;
    let which = r.below(9);
    let (thing, name) = match which {
        6 if kind != "card" => (objects::card(&mut r, base), "bank card"),
        7 if kind != "a4" => (objects::a4(&mut r, base), "A4"),
        8 if kind != "letter" => (objects::letter(&mut r, base), "Letter"),
        k => (objects::decoy(&mut r, base, k), objects::DECOYS[k % 6]),
    };
    s.lay(&mut r, thing);
    (s, name)
}

fn shrink(t: &mut thing::Thing, share: f64) {
    if let thing::Outline::Polygon(p) = &mut t.outline {
        p.iter_mut().flatten().for_each(|v| *v *= share);
    }
}

/// Root mean square of the relative errors of lengths all over the frame.
fn error(s: &Scene, found: &Found, n: u64) -> f64 {
    let back = s.to_pixels.try_inverse().unwrap_or_default();
    let mut r = Random::new(n);
    let (w, h) = (f64::from(s.width), f64::from(s.height));
    let (mut squares, mut count) = (0.0, 0.0);
    while count < 40.0 {
        let mut at = || Point2::new(r.from(0.0, w), r.from(0.0, h));
        let (a, b) = (at(), at());
        if (b - a).norm() > 0.2 * w {
            let truth = (through(&back, a.x, a.y) - through(&back, b.x, b.y)).norm();
            squares += found.distance(a, b).map_or(1.0, |d| d / truth - 1.0).powi(2);
            count += 1.0;
        }
    }
    (squares / count).sqrt()
}

/// Whether the object was found where it is.
fn hit(s: &Scene, kind: &str, found: &Found) -> bool {
    let Some(truth) = s.things.last() else { return false };
    let middle = found.corners.iter().fold(Vector2::zeros(), |a, p| a + p.coords / 4.0);
    let reach =
        if kind.starts_with("ruler") { 0.7 } else { 0.35 } * found.px_per_metre * truth.outline.reach();
    (middle - through(&s.to_pixels, truth.x, truth.y).coords).norm() < reach
}

fn quantile(v: &mut [f64], q: f64) -> f64 {
    v.sort_by(f64::total_cmp);
    if v.is_empty() { f64::NAN } else { v[((v.len() - 1) as f64 * q).round() as usize] }
}

fn present(kind: &str, numbers: std::ops::Range<u64>, pictures: Option<&String>) {
    let count = numbers.end - numbers.start;
    let (mut wrong, mut errors, mut times, mut notes) = (0, Vec::new(), Vec::new(), Vec::new());
    for n in numbers {
        let Some(s) = scene(kind, n) else { continue };
        let photo = s.photo();
        let start = Instant::now();
        let result = find(&photo, object(kind));
        times.push(start.elapsed().as_secs_f64());
        let note = match &result {
            Ok(f) if hit(&s, kind, f) => {
                errors.push(100.0 * error(&s, f, n));
                errors.last().filter(|e| **e > 1.0).map(|e| format!("lengths {e:.2} % off"))
            }
            Ok(f) => {
                wrong += 1;
                Some(format!("WRONG place {:.0} {:.0}", f.corners[0].x, f.corners[0].y))
            }
            Err(e) => Some(e.to_string().chars().take(90).collect()),
        };
        if let Some(note) = note {
            let ground = texture::KINDS[s.ground.kind];
            notes.push(format!("    {n} on {ground} ({:.0} degrees): {note}", s.tilt.to_degrees()));
            picture(&photo, result.ok().as_ref(), kind, n, pictures);
        }
    }
    let [half, most, all] = [0.5, 0.95, 1.0].map(|q| quantile(&mut errors, q));
    println!(
        "{kind:9} found {}/{count}, wrong {wrong}; length error: median {half:.3} %, p95 {most:.3} %, most {all:.3} %; time {:.2} s",
        errors.len(),
        quantile(&mut times, 0.5)
    );
    notes.iter().for_each(|n| println!("{n}"));
}

fn absent(kind: &str, numbers: std::ops::Range<u64>, pictures: Option<&String>) {
    let count = numbers.end - numbers.start;
    let mut notes = Vec::new();
    for n in numbers {
        let (s, name) = scene_without(kind, n);
        let photo = s.photo();
        if let Ok(f) = find(&photo, object(kind)) {
            let (ground, place) = (texture::KINDS[s.ground.kind], f.corners[0]);
            notes.push(format!("    {n}: {name} on {ground}, took ({:.0}, {:.0})", place.x, place.y));
            picture(&photo, Some(&f), &format!("no {kind}"), n, pictures);
        }
    }
    println!("no {kind:9} taken {}/{count}", notes.len());
    notes.iter().for_each(|n| println!("{n}"));
}

fn picture(photo: &RgbImage, found: Option<&Found>, kind: &str, n: u64, folder: Option<&String>) {
    let Some(folder) = folder else { return };
    let picture = found.map_or_else(|| photo.clone(), |f| draw(photo, f));
    let path = std::path::Path::new(folder).join(format!("{}_{n}.png", kind.replace(' ', "_")));
    if let Err(error) = picture.save(&path) {
        println!("    {} was not written: {error}", path.display());
    }
}
