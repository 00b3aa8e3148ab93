//! Makes the samples under `pipelines/samples`: photos, each with its true mask and outline, a
//! prepared scene, a panorama, views of one scene from many places, and sewing patterns of a shirt,
//! trousers, a dress and a one-piece.
//!
//! The pictures are drawn, not taken, so that tests have a truth; they are the same bits on every
//! run. Another folder may be given as the first argument, and as the second a factor for the
//! photos' resolution: `toile-samples out/large 2.4` makes photos of 12.9 and 16.6 megapixels.

mod cloth;
mod colour;
mod garment;
mod ground;
mod near;
mod noise;
mod panorama;
mod pattern;
mod print;
mod render;
mod scene;
mod truth;
mod views;

use cloth::{RimFinish, Structure};
use colour::srgb;
use garment::{NamedOutline, WearerSide};
use ground::Ground;
use image::codecs::jpeg::JpegEncoder;
use render::{PhotoSetup, render};
use std::error::Error;
use std::path::{Path, PathBuf};

/// JPEG quality; the files stay below 300 kB each.
const QUALITY: u8 = 80;

fn main() -> Result<(), Box<dyn Error>> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    let folder = std::env::args_os().nth(1).map_or(default, PathBuf::from);
    let factor: f64 = std::env::args().nth(2).map_or(Ok(1.0), |f| f.parse())?;
    for side in [WearerSide::Front, WearerSide::Back] {
        write(&folder.join("vest"), side, &enlarged(vest_shot(side), factor), &garment::vest(side))?;
        write(&folder.join("tshirt"), side, &enlarged(tshirt_shot(side), factor), &garment::tshirt(side))?;
    }
    for (name, shot, outline) in single() {
        write(&folder.join(name), WearerSide::Front, &enlarged(shot, factor), &outline)?;
    }
    panorama::write(&folder.join("panorama"))?;
    pattern::write(&folder.join("pattern"))?;
    views::write(&folder.join("views"))?;
    scene::write(&folder.join("scene"))
}

/// The same picture by a camera of that many times the resolution.
fn enlarged(shot: PhotoSetup, factor: f64) -> PhotoSetup {
    PhotoSetup {
        size: shot.size.map(|n| (f64::from(n) * factor).round() as u32),
        px_per_mm: shot.px_per_mm * factor,
        origin: shot.origin.map(|x| (x + 0.5) * factor - 0.5),
        ..shot
    }
}

/// The garments of one photo.
fn single() -> [(&'static str, PhotoSetup, NamedOutline); 8] {
    let knit = PhotoSetup {
        seed: 31,
        size: [1900, 1130],
        px_per_mm: 1.5,
        origin: [948.7, 1071.8],
        ground: Ground::Linen,
        structure: Structure::Knit,
        base: srgb(116, 50, 58),
        thread: srgb(150, 92, 98),
        print: print::plain,
        finish: |edge| match edge {
            "hem" => RimFinish::Hemmed(22.0),
            "cuff_left" | "cuff_right" => RimFinish::Bound(38.0, srgb(96, 40, 48)),
            "neck" => RimFinish::Bound(18.0, srgb(98, 42, 50)),
            _ => RimFinish::Seam,
        },
    };
    let skirt = PhotoSetup {
        seed: 41,
        size: [1420, 1260],
        px_per_mm: 2.0,
        origin: [709.3, 1180.4],
        ground: Ground::Oak,
        structure: Structure::Woven,
        base: srgb(38, 66, 92),
        thread: srgb(92, 118, 140),
        print: print::border,
        finish: |edge| match edge {
            "hem" => RimFinish::Hemmed(24.0),
            "neck" => RimFinish::Hemmed(34.0),
            _ => RimFinish::Seam,
        },
    };
    let dress = PhotoSetup {
        seed: 51,
        size: [1240, 1630],
        px_per_mm: 1.55,
        origin: [622.1, 1560.2],
        ground: Ground::Linen,
        structure: Structure::Woven,
        base: srgb(34, 72, 70),
        thread: srgb(88, 124, 120),
        print: print::dots,
        finish: |edge| match edge {
            "hem" => RimFinish::Hemmed(18.0),
            "neck" | "armhole_left" | "armhole_right" => RimFinish::Bound(8.0, srgb(26, 56, 54)),
            _ => RimFinish::Seam,
        },
    };
    let trousers = PhotoSetup {
        seed: 61,
        size: [1060, 1660],
        px_per_mm: 1.5,
        origin: [528.6, 1590.7],
        ground: Ground::Oak,
        structure: Structure::Woven,
        base: srgb(52, 56, 66),
        thread: srgb(98, 102, 112),
        print: print::plain,
        finish: |edge| match edge {
            "neck" => RimFinish::Hemmed(38.0),
            _ => RimFinish::Seam,
        },
    };
    let shorts = PhotoSetup {
        seed: 71,
        size: [1380, 1140],
        px_per_mm: 2.0,
        origin: [689.3, 1040.6],
        ground: Ground::Linen,
        structure: Structure::Woven,
        base: srgb(84, 92, 62),
        thread: srgb(128, 134, 104),
        print: print::plain,
        finish: |edge| match edge {
            "neck" => RimFinish::Hemmed(34.0),
            _ => RimFinish::Seam,
        },
    };
    let onepiece = PhotoSetup {
        seed: 81,
        size: [1440, 1480],
        px_per_mm: 2.4,
        origin: [719.6, 1388.3],
        ground: Ground::Oak,
        structure: Structure::Knit,
        base: srgb(66, 108, 118),
        thread: srgb(112, 146, 152),
        print: print::dots,
        finish: |edge| match edge {
            "neck" | "cuff_left" | "cuff_right" => RimFinish::Bound(10.0, srgb(48, 82, 92)),
            _ => RimFinish::Seam,
        },
    };
    let shirt = PhotoSetup {
        seed: 91,
        size: [2040, 1230],
        px_per_mm: 1.5,
        origin: [1018.3, 1150.2],
        ground: Ground::Oak,
        structure: Structure::Woven,
        base: srgb(74, 96, 130),
        thread: srgb(110, 132, 164),
        print: print::placket,
        finish: |edge| match edge {
            "hem" => RimFinish::Hemmed(8.0),
            "cuff_left" | "cuff_right" => RimFinish::Bound(55.0, srgb(64, 84, 116)),
            "neck" => RimFinish::Bound(26.0, srgb(64, 84, 116)),
            _ => RimFinish::Seam,
        },
    };
    let pleated = PhotoSetup {
        seed: 101,
        base: srgb(86, 58, 92),
        thread: srgb(128, 98, 134),
        ground: Ground::Linen,
        print: print::pleats,
        ..skirt
    };
    [
        ("shirt", shirt, garment::shirt()),
        ("pleated", pleated, garment::skirt()),
        ("longsleeve", knit, garment::longsleeve()),
        ("shorts", shorts, garment::shorts()),
        ("onepiece", onepiece, garment::onepiece()),
        ("skirt", skirt, garment::skirt()),
        ("dress", dress, garment::dress()),
        ("trousers", trousers, garment::trousers()),
    ]
}

fn vest_shot(side: WearerSide) -> PhotoSetup {
    let front = side == WearerSide::Front;
    PhotoSetup {
        seed: if front { 11 } else { 12 },
        size: [1400, 1600],
        px_per_mm: 2.35,
        origin: if front { [703.3, 1517.6] } else { [694.8, 1512.2] },
        ground: Ground::Oak,
        structure: Structure::Woven,
        base: srgb(40, 53, 86),
        thread: srgb(96, 112, 140),
        print: if front { print::vest_front } else { print::vest_back },
        finish: |edge| match edge {
            "hem" => RimFinish::Hemmed(16.0),
            "neck" | "armhole_left" | "armhole_right" => RimFinish::Bound(9.0, srgb(30, 40, 66)),
            _ => RimFinish::Seam,
        },
    }
}

fn tshirt_shot(side: WearerSide) -> PhotoSetup {
    let front = side == WearerSide::Front;
    PhotoSetup {
        seed: if front { 21 } else { 22 },
        size: [1800, 1600],
        px_per_mm: 2.1,
        origin: if front { [896.4, 1526.3] } else { [905.7, 1521.5] },
        ground: Ground::Linen,
        structure: Structure::Knit,
        base: srgb(50, 78, 64),
        thread: srgb(92, 118, 104),
        print: if front { print::tshirt_front } else { print::tshirt_back },
        finish: |edge| match edge {
            "hem" => RimFinish::Hemmed(22.0),
            "cuff_left" | "cuff_right" => RimFinish::Hemmed(19.0),
            "neck" => RimFinish::Bound(17.0, srgb(42, 66, 55)),
            _ => RimFinish::Seam,
        },
    }
}

fn write(
    folder: &Path,
    side: WearerSide,
    shot: &PhotoSetup,
    outline: &NamedOutline,
) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let name = if side == WearerSide::Front { "front" } else { "back" };
    let (photo, mask) = render(shot, outline);
    let mut jpeg = Vec::new();
    JpegEncoder::new_with_quality(&mut jpeg, QUALITY).encode_image(&photo)?;
    std::fs::write(folder.join(format!("{name}.jpg")), jpeg)?;
    std::fs::write(folder.join(format!("{name}.mask.png")), truth::mask_png(&mask)?)?;
    std::fs::write(folder.join(format!("{name}.outline.json")), truth::outline_json(shot, outline))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn the_committed_scene_is_that_of_this_program() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples/scene");
        for (name, text) in scene::files() {
            assert!(std::fs::read_to_string(folder.join(name)).unwrap() == text, "{name}: run the program");
        }
    }

    #[test]
    fn the_committed_panorama_is_that_of_this_program() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples/panorama/studio.jpg");
        assert!(std::fs::read(file).unwrap() == panorama::jpeg().unwrap(), "run the program");
    }

    #[test]
    fn the_committed_views_are_those_of_this_program() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples/views");
        for files in [views::turn(), views::pair(), views::grid()] {
            for (path, bytes) in files.unwrap() {
                assert!(std::fs::read(folder.join(&path)).unwrap() == bytes, "{path}: run the program");
            }
        }
    }

    #[test]
    fn the_committed_patterns_are_those_of_this_program() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples/pattern");
        for (name, text) in pattern::files().unwrap() {
            assert!(std::fs::read_to_string(folder.join(name)).unwrap() == text, "{name}: run the program");
        }
    }

    #[test]
    fn the_committed_outlines_are_those_of_this_program() {
        for side in [WearerSide::Front, WearerSide::Back] {
            let name = if side == WearerSide::Front { "front" } else { "back" };
            for (garment, shot, outline) in [
                ("vest", vest_shot(side), garment::vest(side)),
                ("tshirt", tshirt_shot(side), garment::tshirt(side)),
            ] {
                let file = Path::new(env!("CARGO_MANIFEST_DIR"))
                    .join(format!("../samples/{garment}/{name}.outline.json"));
                let committed = std::fs::read_to_string(file).unwrap();
                assert!(
                    truth::outline_json(&shot, &outline) == committed,
                    "{garment} {name}: run the program"
                );
            }
        }
    }
}
