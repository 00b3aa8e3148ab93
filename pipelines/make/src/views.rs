//! Photos of one scene from many places, with the truth: a brick studio, and a figure in it.
//!
//! `turn` holds photos of a camera that turns in the studio and the whole panorama; `pair` two
//! photos around the figure and the one between; `grid` photos of a camera that is moved across and
//! down before it, and one from between. Every ray is followed to what it meets.

use crate::colour::{LinearColour, blend, encode, scale, smoothstep, srgb};
use crate::noise::{fractal, hash};
use crate::panorama;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use rayon::prelude::*;
use serde_json::json;
use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

/// A file's path below the samples, and its bytes.
type SampleFile = (String, Vec<u8>);

/// The camera that turns: size, focal length in pixels, and where it looks, degrees.
const TURN_SIZE: [u32; 2] = [400, 300];
const TURN_FOCAL: f64 = 346.41;
const TURN_DEG: [f64; 12] = [0.0, 31.5, 58.2, 92.7, 120.4, 147.9, 181.3, 209.6, 242.2, 268.9, 301.1, 330.8];
/// Rows of the true panorama above and below its middle.
const TURN_ROWS: u32 = 120;
/// The camera around the figure.
const PAIR_SIZE: [u32; 2] = [320, 400];
const PAIR_FOCAL: f64 = 700.0;
const PAIR_DEG: f64 = 8.0;
/// The camera before the figure, and how far it is moved from photo to photo, metres.
const GRID_SIZE: [u32; 2] = [160, 200];
const GRID_FOCAL: f64 = 350.0;
const GRID: u32 = 5;
const GRID_STEP_M: f64 = 0.04;
/// Where the true view between the photos of the grid is, in shares of the grid.
const GRID_VIEW: [f64; 2] = [0.4, 0.6];
/// From the camera to the axis of the figure, and on to the wall behind it, metres.
const DISTANCE_M: f64 = 1.6;
const WALL_M: f64 = 1.2;
/// Rays a pixel, across and down.
const RAYS: u32 = 3;

/// Writes all of them.
pub(crate) fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    for (path, bytes) in turn()?.into_iter().chain(pair()?).chain(grid()?) {
        let file = folder.join(path);
        file.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        std::fs::write(file, bytes)?;
    }
    Ok(())
}

/// Photos all around the studio.
pub(crate) fn turn() -> Result<Vec<SampleFile>, Box<dyn Error>> {
    let mut files = Vec::new();
    for (k, degrees) in TURN_DEG.iter().enumerate() {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let photo = picture(TURN_SIZE, |[x, y]| {
            let [x, y] = [x / TURN_FOCAL, y / TURN_FOCAL];
            studio([cos * x + sin, -y, sin * x - cos])
        });
        files.push((format!("turn/{:02}.jpg", k + 1), jpeg(&photo, 85)?));
    }
    let around = (TAU * TURN_FOCAL).round();
    let truth = picture([around as u32, 2 * TURN_ROWS], |[x, y]| {
        // The middle column looks where the first photo does.
        let angle = TAU * (x - 0.5) / around;
        studio([angle.sin(), -y / TURN_FOCAL, -angle.cos()])
    });
    files.push(("turn/truth.jpg".into(), jpeg(&truth, 85)?));
    let text = json!({ "focal_px": TURN_FOCAL, "angles_deg": TURN_DEG });
    files.push(("turn/truth.json".into(), format!("{text:#}\n").into_bytes()));
    Ok(files)
}

/// Two photos around the figure, and the one half way.
pub(crate) fn pair() -> Result<Vec<SampleFile>, Box<dyn Error>> {
    let seen = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let from = [DISTANCE_M * sin, 0.0, -DISTANCE_M * cos];
        picture(PAIR_SIZE, |[x, y]| {
            let [x, y] = [x / PAIR_FOCAL, y / PAIR_FOCAL];
            scene(from, [cos * x - sin, -y, sin * x + cos])
        })
    };
    let mut files = Vec::new();
    for (name, share) in [("left", -0.5), ("right", 0.5), ("truth", 0.0)] {
        files.push((format!("pair/{name}.jpg"), jpeg(&seen(share * PAIR_DEG), 92)?));
    }
    Ok(files)
}

/// Photos of a grid, each cut so that the axis of the figure stays in place.
pub(crate) fn grid() -> Result<Vec<SampleFile>, Box<dyn Error>> {
    let seen = |column: f64, row: f64| {
        let middle = f64::from(GRID - 1) / 2.0;
        let from = [(column - middle) * GRID_STEP_M, (middle - row) * GRID_STEP_M, -DISTANCE_M];
        picture(GRID_SIZE, |[x, y]| {
            let [x, y] = [x, -y].map(|v| v / GRID_FOCAL * DISTANCE_M);
            scene(from, [x - from[0], y - from[1], DISTANCE_M])
        })
    };
    let mut files = Vec::new();
    for (row, column) in (0..GRID).flat_map(|r| (0..GRID).map(move |c| (r, c))) {
        let photo = seen(f64::from(column), f64::from(row));
        files.push((format!("grid/r{}c{}.jpg", row + 1, column + 1), jpeg(&photo, 90)?));
    }
    let [across, down] = GRID_VIEW.map(|share| share * f64::from(GRID - 1));
    files.push(("grid/truth.jpg".into(), jpeg(&seen(across, down), 92)?));
    Ok(files)
}

/// A picture of what each place shows, pixels from its middle.
fn picture([w, h]: [u32; 2], seen: impl Fn([f64; 2]) -> LinearColour + Sync) -> RgbImage {
    let pixel = |k: u32| {
        let place = [f64::from(k % w) - f64::from(w - 1) / 2.0, f64::from(k / w) - f64::from(h - 1) / 2.0];
        let mut sum = [0.0; 3];
        for ray in 0..RAYS * RAYS {
            let within = [ray % RAYS, ray / RAYS].map(|i| (f64::from(i) + 0.5) / f64::from(RAYS) - 0.5);
            let light = seen([place[0] + within[0], place[1] + within[1]]);
            (0..3).for_each(|c| sum[c] += light[c]);
        }
        sum.map(|v| (encode(v / f64::from(RAYS * RAYS)) * 255.0).round() as u8)
    };
    let levels: Vec<u8> = (0..w * h).into_par_iter().flat_map_iter(pixel).collect();
    RgbImage::from_raw(w, h, levels).unwrap_or_default()
}

fn jpeg(picture: &RgbImage, quality: u8) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, quality).encode_image(picture)?;
    Ok(bytes)
}

/// The studio around the camera, of brick.
fn studio(d: [f64; 3]) -> LinearColour {
    let (wall, p) = panorama::met(d);
    let light = panorama::seen(d);
    match wall {
        1 => scale(light, 0.8 + 0.25 * fractal(13, p[0] * 3.0, p[2] * 3.0, 4)),
        0 => scale(light, brick(p[2], p[1])),
        _ => scale(light, brick(p[0], p[1])),
    }
}

/// How light a wall of bricks is, 25 x 10 cm each.
fn brick(along: f64, up: f64) -> f64 {
    let row = (up / 0.1).floor();
    let at = along / 0.25 + 0.5 * row.rem_euclid(2.0);
    let inside = |v: f64, joint: f64| smoothstep(0.0, joint, 0.5 - ((v - v.floor()) - 0.5).abs());
    let tint = 0.55 + 0.4 * hash(17, at.floor() as i64, row as i64);
    let joint = inside(at, 0.06) * inside(up / 0.1, 0.15);
    let grain = 1.0 + 0.15 * fractal(19, along * 30.0, up * 30.0, 3);
    (0.45 + (tint - 0.45) * joint) * grain
}

/// What a ray meets: the figure, else the wall behind it.
fn scene(from: [f64; 3], d: [f64; 3]) -> LinearColour {
    let n = d.iter().map(|v| v * v).sum::<f64>().sqrt();
    let d = d.map(|v| v / n);
    let at = |t: f64| [0, 1, 2].map(|c| from[c] + t * d[c]);
    let (mut t, end) = (1.0, 2.1);
    while t < end {
        let off = outside(at(t));
        if off < 1e-4 {
            return dressed(at(t));
        }
        t += 0.5 * off;
    }
    let wall = at((WALL_M - from[2]) / d[2]);
    scale(srgb(190, 180, 168), brick(wall[0], wall[1]))
}

/// Half the width of the figure at a height, metres, and how deep it is to that: shoulders, waist
/// and a skirt.
fn half_width(y: f64) -> f64 {
    let skirt = 0.09 * smoothstep(-0.02, -0.42, y);
    let shoulders = 0.045 * smoothstep(0.0, 0.2, y) - 0.1 * smoothstep(0.24, 0.36, y);
    0.13 + skirt + shoulders
}

/// About how far a place is outside of the figure, metres.
fn outside(p: [f64; 3]) -> f64 {
    let around = p[0].atan2(-p[2]);
    let folds = 1.0 + 0.05 * smoothstep(0.0, -0.4, p[1]) * (9.0 * around + 0.6 * (5.0 * p[1]).sin()).cos();
    let half = half_width(p[1]) * folds;
    let side = (p[0].hypot(p[2] / 0.75) - half) * 0.75;
    side.max(p[1] - 0.36).max(-0.43 - p[1])
}

/// The colour of the figure: a dress with a print, in the light of a window.
fn dressed(p: [f64; 3]) -> LinearColour {
    let slope = [0, 1, 2].map(|c| {
        let moved = |by: f64| outside([0, 1, 2].map(|k| p[k] + if k == c { by } else { 0.0 }));
        moved(1e-4) - moved(-1e-4)
    });
    let n = slope.iter().map(|v| v * v).sum::<f64>().sqrt().max(1e-12);
    let lit = (slope[0] * 0.5 + slope[1] * 0.4 - slope[2] * 0.77) / n;
    let (around, up) = (p[0].atan2(-p[2]) * 0.16, p[1]);
    let dot = |size: f64, seed: u64| {
        let cell = [around / size, up / size].map(f64::floor);
        let off = [0, 1].map(|c| 0.3 + 0.4 * hash(seed + c, cell[0] as i64, cell[1] as i64));
        let far = (around / size - cell[0] - off[0]).hypot(up / size - cell[1] - off[1]);
        smoothstep(0.28, 0.2, far)
    };
    let cloth = blend(srgb(46, 70, 112), srgb(232, 222, 200), dot(0.035, 23));
    let cloth = blend(cloth, srgb(196, 92, 70), 0.9 * dot(0.052, 29));
    let weave = 1.0 + 0.08 * fractal(31, around * 160.0, up * 160.0, 2);
    scale(cloth, (0.35 + 0.65 * lit.max(0.0)) * weave)
}
