//! Photos of garments laid flat: an outline filled with cloth on a ground, with grain, at 14 pixels
//! a centimetre.

use image::{ImageFormat, Rgb, RgbImage};
use std::io::Cursor;

/// Pixels a centimetre, and ground around the garment, cm.
const PX: f64 = 14.0;
const MARGIN: f64 = 12.0;

/// The right half of an outline, cm, from the middle of the neck or waist to the middle of the hem,
/// y down.
type Half = Vec<[f64; 2]>;

/// A wide T-shirt, 76 cm from cuff to cuff, on boards.
pub(crate) fn boxy_tee() -> Vec<u8> {
    let half = vec![
        [0.0, 2.5],
        [4.0, 2.0],
        [7.0, 0.8],
        [8.5, 0.0],
        [23.0, 4.0],
        [38.0, 17.0],
        [31.5, 26.5],
        [27.0, 23.0],
        [27.2, 45.0],
        [27.5, 68.0],
        [0.0, 69.0],
    ];
    let boards = |x: f64, y: f64| {
        let board = (y / 9.0).floor();
        let shade = 0.9 + 0.1 * (board * 2.4).sin() + 0.03 * (x * 0.9 + 6.0 * (0.05 * x + board).sin()).sin();
        if y.rem_euclid(9.0) < 0.15 { [60.0, 42.0, 30.0] } else { [176.0, 132.0, 92.0].map(|c| c * shade) }
    };
    drawn(&half, [38.0, 62.0, 118.0], boards)
}

/// A narrow, long T-shirt, 76 cm from cuff to cuff, on a pale sheet.
pub(crate) fn slim_tee() -> Vec<u8> {
    let half = vec![
        [0.0, 2.0],
        [4.5, 1.6],
        [7.0, 0.6],
        [8.0, 0.0],
        [20.5, 3.8],
        [38.0, 12.0],
        [33.5, 26.5],
        [24.5, 21.0],
        [23.5, 44.0],
        [25.0, 72.0],
        [0.0, 72.6],
    ];
    let sheet = |x: f64, y: f64| [222.0, 220.0, 214.0].map(|c: f64| c + 4.0 * (0.11 * x + 0.07 * y).sin());
    drawn(&half, [148.0, 42.0, 46.0], sheet)
}

/// A flared skirt, 62 cm wide at the hem: half of its waist and its length, cm.
pub(crate) fn skirt(waist: f64, length: f64) -> Vec<u8> {
    let half = vec![
        [0.0, 0.8],
        [waist, 0.0],
        [waist + 5.0, 0.35 * length],
        [31.0, length - 1.5],
        [16.0, length],
        [0.0, length + 0.5],
    ];
    let floor = |x: f64, y: f64| {
        let tile = ((x / 30.0).floor() + (y / 30.0).floor()).rem_euclid(2.0);
        [196.0 + 10.0 * tile, 190.0 + 8.0 * tile, 176.0 + 8.0 * tile]
    };
    drawn(&half, [44.0, 92.0, 74.0], floor)
}

fn drawn(half: &Half, cloth: [f64; 3], ground: impl Fn(f64, f64) -> [f64; 3]) -> Vec<u8> {
    let outline: Vec<[f64; 2]> =
        half.iter().copied().chain(half.iter().rev().map(|[x, y]| [-x, *y])).collect();
    let most = |axis: usize| outline.iter().map(|p| p[axis]).fold(f64::MIN, f64::max);
    let (width, height) = (2.0 * (most(0) + MARGIN), most(1) + 2.0 * MARGIN);
    let picture = RgbImage::from_fn((width * PX) as u32, (height * PX) as u32, |i, j| {
        let at = |sub: f64, of: u32| (f64::from(of) + sub) / PX;
        // Four samples per pixel.
        let inside = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]]
            .iter()
            .filter(|[u, v]| is_inside(&outline, [at(*u, i) - width / 2.0, at(*v, j) - MARGIN]))
            .count() as f64
            / 4.0;
        let (x, y) = (at(0.5, i), at(0.5, j));
        let weave = 1.0 + 0.05 * (11.0 * x).sin() * (11.0 * y).sin();
        let floor = ground(x, y);
        Rgb(std::array::from_fn(|c| {
            let colour = inside * cloth[c] * weave + (1.0 - inside) * floor[c];
            (colour + grain(i, j, c as u32)).clamp(0.0, 255.0) as u8
        }))
    });
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
    bytes.into_inner()
}

/// By the crossings of a line to the right.
fn is_inside(outline: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let sides = outline.iter().zip(outline.iter().cycle().skip(1));
    let crossed = sides
        .filter(|([ax, ay], [bx, by])| (*ay > y) != (*by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax));
    crossed.count() % 2 == 1
}

/// Noise of 4 grey levels, the same on every run.
fn grain(x: u32, y: u32, channel: u32) -> f64 {
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ channel.wrapping_mul(0xC2B2_AE3D);
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    h ^= h >> 12;
    f64::from(h % 1000) / 125.0 - 4.0
}
