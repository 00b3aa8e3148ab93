//! A photographer's studio all around, as an equirectangular picture: warm walls, a floor, a large
//! window and a lamp with a screen.
//!
//! The room is a box around the camera; the direction of every pixel is followed to the wall that
//! it meets.

use crate::QUALITY;
use crate::colour::{LinearColour, blend, encode, scale, smoothstep, srgb};
use crate::noise::fractal;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use std::error::Error;
use std::path::Path;

const WIDTH: u32 = 1024;
/// From the camera to the walls left and right, floor and ceiling, back and front, metres.
const ROOM: [[f64; 2]; 3] = [[-3.6, 4.2], [-1.2, 2.4], [-3.8, 4.6]];

/// Writes `studio.jpg`.
pub(crate) fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("studio.jpg"), jpeg()?)?;
    Ok(())
}

/// The picture as a file.
pub(crate) fn jpeg() -> Result<Vec<u8>, Box<dyn Error>> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode_image(&picture())?;
    Ok(bytes)
}

fn picture() -> RgbImage {
    RgbImage::from_fn(WIDTH, WIDTH / 2, |x, y| {
        let around = std::f64::consts::TAU * ((f64::from(x) + 0.5) / f64::from(WIDTH) - 0.5);
        let down = std::f64::consts::PI * (f64::from(y) + 0.5) / f64::from(WIDTH / 2);
        let towards = [down.sin() * around.sin(), down.cos(), -down.sin() * around.cos()];
        image::Rgb(seen(towards).map(|v| (encode(v) * 255.0).round() as u8))
    })
}

/// The wall that a direction meets, by the axis that it stands across, and where.
pub(crate) fn met(d: [f64; 3]) -> (usize, [f64; 3]) {
    let way = |k: usize| if d[k] > 0.0 { ROOM[k][1] / d[k] } else { ROOM[k][0] / d[k].min(-1e-9) };
    let wall = (0..3).min_by(|a, b| way(*a).total_cmp(&way(*b))).unwrap_or(0);
    (wall, d.map(|v| v * way(wall)))
}

/// The light that comes from a direction.
pub(crate) fn seen(d: [f64; 3]) -> LinearColour {
    let (wall, p) = met(d);
    let lit = 0.72 + 0.28 * smoothstep(6.0, 0.5, distance(p, [3.6, 1.2, 1.5]));
    match (wall, d[wall] > 0.0) {
        (1, true) => scale(srgb(226, 222, 214), lit),
        (1, false) => {
            let boards = 0.92 + 0.08 * fractal(5, p[0] * 6.0, p[2] * 0.8, 3);
            scale(
                blend(srgb(150, 126, 100), srgb(120, 98, 76), smoothstep(1.0, 4.0, p[0].hypot(p[2]))),
                lit * boards,
            )
        }
        // The window: two panes to the wearer's left.
        (0, true) if window(p[2], p[1]) => scale(srgb(255, 255, 252), 1.0),
        // A lamp behind a screen, to the right and in front.
        (0, false) if (p[2] - 1.6).abs() < 0.7 && (p[1] - 0.9).abs() < 0.7 => srgb(255, 244, 224),
        _ => {
            let plaster = 0.97 + 0.03 * fractal(9, p[0] + p[2], p[1] * 2.0, 4);
            let skirting = if p[1] < ROOM[1][0] + 0.14 { 0.8 } else { 1.0 };
            scale(srgb(222, 217, 208), lit * plaster * skirting)
        }
    }
}

fn window(along: f64, up: f64) -> bool {
    let pane = (along - 0.6).abs() < 1.5 && (along - 0.6).abs() > 0.06;
    pane && (0.0..1.9).contains(&up) && (up - 1.3).abs() > 0.04
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}
