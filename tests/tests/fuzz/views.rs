//! Sets of photos that make no panorama, no view and no light field, and some that do.
//!
//! A case is a row of numbers: which stage with which parameters, then four bytes a photo: which
//! picture, how it is spoilt, and by how much.

use crate::dice::Dice;
use crate::fuzz;
use image::{Rgb, RgbImage, imageops};
use std::sync::{Arc, LazyLock};
use toile_core::artifact::{ArtifactType, Photo, Shared};
use toile_core::{Artifact, Cancel, Context, ErrorCode, Inputs, PortValue, Registry, testkit};
use toile_tests::root;

static REGISTRY: LazyLock<Registry> = LazyLock::new(toile::registry);

/// What a photo has beside its pixels.
static PHOTO: LazyLock<Photo> = LazyLock::new(testkit::photo);

/// The stages with parameters, at their bounds as well.
const STAGES: [(&str, &str); 14] = [
    ("Cylinder", "(lens: Degrees(60))"),
    ("Cylinder", "(lens: Degrees(60), turn: Part, blend: Feather)"),
    ("Cylinder", "(lens: Degrees(5))"),
    ("Cylinder", "(lens: Degrees(150), crop: false)"),
    ("Cylinder", "(lens: Equivalent(26), turn: Whole)"),
    ("Cylinder", "(lens: Pixels(69), exposure: false)"),
    ("Cylinder", "()"),
    ("FlowView", "()"),
    ("FlowView", "(at: 1)"),
    ("DepthView", "(turn: 8)"),
    ("DepthView", "(turn: 60, near: 0.05, far: 1000, lens: Degrees(150))"),
    ("DepthView", "(turn: 0, at: 0)"),
    ("LightField", "()"),
    ("LightField", "(across: 1, down: 1, focus: 2000, every: 2)"),
];
/// Names of photos: in order, by row and column, and such as nobody would choose.
const NAMES: [&str; 10] =
    ["1", "2", "10", "r1c1", "r1c2", "r2c1", "r2c2", "front", "é 7", "r18446744073709551616c1"];

/// Photos of the sample, small.
fn pictures() -> Vec<RgbImage> {
    let small = |k: usize| {
        let file = root().join(format!("pipelines/samples/views/turn/{k:02}.jpg"));
        imageops::thumbnail(&image::open(file).unwrap().to_rgb8(), 80, 60)
    };
    (1..=12).map(small).collect()
}

fn case(dice: &mut Dice) -> Vec<u8> {
    let count = dice.below(8);
    let (stage, first) = (dice.below(STAGES.len()) as u8, dice.below(12));
    let mut bytes = vec![stage, dice.below(4) as u8];
    for k in 0..count {
        // Half of the sets are a turn as it should be, but for what is spoilt.
        let picture = if bytes[1] < 2 { (first + k) % 12 } else { dice.below(12) };
        let spoilt = if dice.below(3) == 0 { 1 + dice.below(9) } else { 0 };
        bytes.extend([picture as u8, spoilt as u8, dice.next() as u8, dice.next() as u8]);
    }
    bytes
}

/// A picture spoilt in one of nine ways.
fn spoilt(picture: &RgbImage, how: u8, a: u8, b: u8) -> RgbImage {
    let (w, h) = picture.dimensions();
    let (x, y) = (u32::from(a) % w, u32::from(b) % h);
    match how {
        1 => RgbImage::from_pixel(w, h, Rgb([a, b, a])),
        2 => RgbImage::from_fn(w, h, |x, y| Rgb([a.wrapping_mul(x as u8 ^ y as u8).wrapping_add(b); 3])),
        3 => {
            RgbImage::from_fn(
                w,
                h,
                |x, _| Rgb([if x / (1 + u32::from(a) % 9) % 2 == 0 { 0 } else { 255 }; 3]),
            )
        }
        4 => RgbImage::new(u32::from(a), u32::from(b)),
        5 => imageops::crop_imm(picture, 0, 0, (x + 1).min(w), (y + 1).min(h)).to_image(),
        6 => imageops::rotate180(picture),
        7 => RgbImage::from_fn(w, h, |i, j| *picture.get_pixel((i + x) % w, (j + y) % h)),
        8 => RgbImage::from_fn(w, h, |i, j| Rgb(picture.get_pixel(i, j).0.map(|v| v / (1 + a % 64)))),
        9 => imageops::resize(
            picture,
            1 + u32::from(a) * 2,
            48 + u32::from(b) % 3,
            imageops::FilterType::Nearest,
        ),
        _ => picture.clone(),
    }
}

/// Runs the stage; true where it made something.
fn made(bytes: &[u8], pictures: &[RgbImage]) -> Result<bool, String> {
    let [stage, names, photos @ ..] = bytes else { return Ok(false) };
    let (name, params) = STAGES[usize::from(*stage) % STAGES.len()];
    let mut set = std::collections::BTreeMap::new();
    for (k, photo) in photos.chunks_exact(4).enumerate() {
        let own = NAMES[(k * (1 + usize::from(*names) / 3) + usize::from(names % 2) * 3) % NAMES.len()];
        let pixels = spoilt(&pictures[usize::from(photo[0]) % pictures.len()], photo[1], photo[2], photo[3]);
        let photo = Photo { pixels: Shared::new(pixels), mirrored: photo[2] % 16 == 15, ..PHOTO.clone() };
        set.insert(own.to_owned(), Arc::new(photo) as Arc<dyn Artifact>);
    }
    let card = REGISTRY.named(name).next().ok_or("there is no such stage")?;
    let stage = REGISTRY.make(card, params)?;
    let cx = Context::new(name, &root(), Cancel::new(), Arc::new(()));
    match stage.run_ports(&Inputs(vec![Some(PortValue::Set(Photo::KIND, set))]), &cx) {
        Err(e) if e.code == ErrorCode::Internal => Err(format!("{name} calls it its own fault: {e}")),
        Err(e) if e.message.is_empty() || e.hint.is_none() => {
            Err(format!("{name} refuses without a remedy: {e}"))
        }
        Err(_) => Ok(false),
        Ok(made) => {
            for (_, a) in made.iter().flat_map(PortValue::entries) {
                a.check().map_err(|e| format!("{name} gave a {} that cannot be: {e}", a.kind()))?;
            }
            match cx.take_figures().iter().find(|f| !f.value.is_finite()) {
                Some(f) => Err(format!("{name}: its figure `{}` is {}", f.name, f.value)),
                None => Ok(true),
            }
        }
    }
}

#[test]
fn photo_sets() {
    let pictures = pictures();
    // Every stage makes something of photos as they should be.
    let turn: Vec<u8> = (0..3).flat_map(|k| [k, 0, 0, 0]).collect();
    assert_eq!(made(&[&[1, 0][..], &turn].concat(), &pictures), Ok(true));
    for stage in [7, 9, 12] {
        assert_eq!(made(&[&[stage, 0][..], &turn[..8]].concat(), &pictures), Ok(true), "{stage}");
    }
    fuzz("photo_set", 120, case, |bytes| made(bytes, &pictures).map(drop));
}
