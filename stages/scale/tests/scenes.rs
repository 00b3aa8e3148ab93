//! Objects in drawn scenes.
#![allow(clippy::unwrap_used, dead_code, missing_docs, unreachable_pub)]

#[path = "../examples/score/objects.rs"]
mod objects;
#[path = "../examples/score/random.rs"]
mod random;
#[path = "../examples/score/scene.rs"]
mod scene;
#[path = "../examples/score/texture.rs"]
mod texture;
#[path = "../examples/score/thing.rs"]
mod thing;

use image::RgbImage;
use nalgebra::Point2;
use random::Random;
use scene::{Scene, camera, through};
use toile_scale::{KnownObject, RectifyOptions, ScaleError, ScaleKind, draw, find, rectify};

/// A thing on a plain ground without a garment, tilted by some degrees about an oblique axis.
fn scene(size: (u32, u32), density: f64, degrees: f64, thing: thing::Thing, at: [f64; 3]) -> Scene {
    let mut r = Random::new(11);
    let mut s = Scene::draw(&mut r, size.0, size.1, density, 0.0);
    s.to_pixels = camera(size.0, size.1, density, degrees.to_radians(), 0.6, 0.1, 26.5);
    s.ground = texture::Ground {
        kind: 0,
        base: [95.0, 80.0, 60.0],
        other: [120.0, 100.0, 80.0],
        size: 0.1,
        turn: 0.2,
        seed: 4,
    };
    (s.shadow, s.light, s.noise, s.blur, s.quality) = (None, [0.05, 0.1, 1.0], 2.0, 0.8, 90);
    s.things = vec![thing::Thing { x: at[0], y: at[1], turn: at[2], ..thing }];
    s
}

/// The largest relative error of lengths between the corners and the middle of the frame.
fn error(s: &Scene, found: &toile_scale::Found) -> f64 {
    let back = s.to_pixels.try_inverse().unwrap();
    let (w, h) = (f64::from(s.width), f64::from(s.height));
    let places = [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h], [w / 2.0, h / 2.0]].map(|[x, y]| Point2::new(x, y));
    let mut worst = 0f64;
    for (i, a) in places.iter().enumerate() {
        for b in &places[..i] {
            let truth = (through(&back, a.x, a.y) - through(&back, b.x, b.y)).norm();
            worst = worst.max((found.distance(*a, *b).unwrap() / truth - 1.0).abs());
        }
    }
    worst
}

#[test]
fn a_sheet_gives_the_plane_of_a_tilted_ground() {
    let sheet = objects::a4(&mut Random::new(2), [90.0; 3]);
    let s = scene((1000, 750), 1000.0, 20.0, sheet, [0.1, -0.05, 0.7]);
    let found = find(&s.photo(), KnownObject::A4).unwrap();
    assert_eq!(found.kind, ScaleKind::Plane);
    assert!(error(&s, &found) < 0.004, "{}", error(&s, &found));
    let centre = through(&s.to_pixels, 0.1, -0.05);
    assert!(found.ground(centre).unwrap().coords.norm() < 0.001);
}

#[test]
fn a_card_of_150_pixels_gives_lengths_beside_it() {
    let card = objects::card(&mut Random::new(5), [95.0, 80.0, 60.0]);
    let s = scene((1000, 750), 1750.0, 12.0, card, [0.05, 0.05, 0.4]);
    let found = find(&s.photo(), KnownObject::BankCard).unwrap();
    assert!(error(&s, &found) < 0.015, "{}", error(&s, &found));
}

#[test]
fn a_business_card_is_no_bank_card() {
    let card = objects::decoy(&mut Random::new(5), [95.0, 80.0, 60.0], 1);
    let s = scene((1000, 750), 1750.0, 12.0, card, [0.05, 0.05, 0.4]);
    assert_eq!(find(&s.photo(), KnownObject::BankCard), Err(ScaleError::NoneFound { object: "bank card" }));
}

#[test]
fn a_chessboard_is_counted() {
    let board = objects::chess(&mut Random::new(3), [95.0, 80.0, 60.0]);
    let s = scene((1000, 750), 1000.0, 25.0, board, [0.0, 0.0, 0.5]);
    let found = find(&s.photo(), KnownObject::Chessboard { square_um: 25_000, corners: None }).unwrap();
    assert_eq!(found.marks.len(), 9 * 6);
    assert!(error(&s, &found) < 0.004, "{}", error(&s, &found));
    let stated = KnownObject::Chessboard { square_um: 25_000, corners: Some((6, 9)) };
    assert_eq!(find(&s.photo(), stated).unwrap().homography, found.homography);
    let other = KnownObject::Chessboard { square_um: 25_000, corners: Some((7, 9)) };
    assert_eq!(find(&s.photo(), other), Err(ScaleError::NoneFound { object: "chessboard" }));
}

#[test]
fn a_ruler_gives_a_scale_and_refuses_a_tilt() {
    let ruler = objects::ruler(&mut Random::new(4), [95.0, 80.0, 60.0], true, 0.2);
    let s = scene((1000, 750), 4000.0, 0.0, ruler.clone(), [0.0, 0.0, 0.3]);
    let found = find(&s.photo(), KnownObject::Ruler).unwrap();
    assert_eq!((found.kind, found.tilt), (ScaleKind::Line, None));
    assert!((found.px_per_metre / 4000.0 - 1.0).abs() < 0.005, "{}", found.px_per_metre);
    let tilted = scene((1000, 750), 4000.0, 25.0, ruler, [0.0, 0.0, -1.2]);
    assert!(matches!(find(&tilted.photo(), KnownObject::Ruler), Err(ScaleError::RulerTilted { .. })));
}

#[test]
fn the_rectified_photo_shows_the_object_at_its_size() {
    let sheet = objects::a4(&mut Random::new(2), [90.0; 3]);
    let s = scene((1000, 750), 1000.0, 25.0, sheet, [0.1, -0.05, 0.7]);
    let photo = s.photo();
    let found = find(&photo, KnownObject::A4).unwrap();
    let options = RectifyOptions { px_per_metre: Some(800.0), ..RectifyOptions::default() };
    let above = rectify(&photo, &found, &options).unwrap();
    assert_eq!(above.px_per_metre, 800.0);
    let corners = found.corners.map(|p| {
        let q = above.homography * p.to_homogeneous();
        Point2::new(q.x / q.z, q.y / q.z)
    });
    assert!(((corners[1] - corners[0]).norm() - 0.297 * 800.0).abs() < 0.5);
    // A tilted photo is no rectangle on the ground: some of the picture is empty.
    let empty = above.image.pixels().filter(|p| p[3] == 0).count();
    assert!(empty > 1000 && 2 * empty < above.image.pixels().len());
    // Paper stays paper.
    let middle = nalgebra::center(&corners[0], &corners[2]);
    assert!(above.image.get_pixel(middle.x as u32, middle.y as u32)[3] == 255);
}

#[test]
fn the_outline_is_drawn() {
    let sheet = objects::a4(&mut Random::new(2), [90.0; 3]);
    let photo = scene((1000, 750), 1000.0, 0.0, sheet, [0.1, -0.05, 0.7]).photo();
    let found = find(&photo, KnownObject::A4).unwrap();
    let changed = |p: &RgbImage| p.pixels().zip(photo.pixels()).filter(|(a, b)| a != b).count();
    assert!(changed(&draw(&photo, &found)) > 500);
}

#[test]
fn one_thread_and_three_give_the_same_bits() {
    let card = objects::card(&mut Random::new(5), [95.0, 80.0, 60.0]);
    let photo = scene((800, 600), 1750.0, 12.0, card, [0.0, 0.0, 0.4]).photo();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let found = find(&photo, KnownObject::BankCard).unwrap();
            let above = rectify(&photo, &found, &RectifyOptions::default()).unwrap();
            (found, above)
        })
    };
    assert_eq!(run(1), run(3));
}
