//! Textures whose sides are powers of two.
//!
//! Sides are scaled by linear interpolation, by a tent filter where they shrink, in linear light
//! (normal maps as they stand); texture coordinates count in shares of the picture and stay. Cost:
//! a pass over each texture that changes, row by row.

use crate::render::Coding;
use image::RgbImage;
use rayon::prelude::*;
use toile_core::artifact::{Model, Shared, Texture};

/// A side may lose this share of its length, rather than grow to the next power.
const LOSS: f64 = 0.2;

/// Brings all textures to powers of two.
pub(super) fn to_powers_of_two(model: &mut Model) {
    let is_map: Vec<bool> = (0..model.textures.len()).map(|t| model.is_normal_map(t)).collect();
    model.textures.par_iter_mut().zip(is_map).for_each(|(texture, is_map)| {
        let (w, h) = texture.pixels.dimensions();
        let size = [side(w), side(h)];
        if size != [w, h] {
            let mut pixels = resampled(texture, size, if is_map { Coding::Shares } else { Coding::Colours });
            if is_map {
                to_length_one(&mut pixels);
            }
            texture.pixels = Shared::new(pixels);
        }
    });
}

/// The power of two for a side, px.
fn side(side: u32) -> u32 {
    let above = side.max(1).next_power_of_two();
    let below = above / 2;
    if f64::from(below) >= (1.0 - LOSS) * f64::from(side) { below.max(1) } else { above }
}

/// A texture with sides of `size`, px.
fn resampled(texture: &Texture, size: [u32; 2], coding: Coding) -> RgbImage {
    let (width, height) = texture.pixels.dimensions();
    let columns = taps(width, size[0], texture.repeats);
    let rows = taps(height, size[1], texture.repeats);
    let (raw, table, stride) = (texture.pixels.as_raw(), coding.table(), 3 * width as usize);
    let mut pixels = RgbImage::new(size[0], size[1]);
    let row = |sums: &mut Vec<f32>, (row, out): (&Vec<(usize, f32)>, &mut [u8])| {
        sums.clear();
        sums.resize(stride, 0.0);
        for (y, weight) in row {
            let from = &raw[y * stride..(y + 1) * stride];
            sums.iter_mut().zip(from).for_each(|(sum, v)| *sum += weight * table[usize::from(*v)]);
        }
        for (pixel, column) in out.chunks_exact_mut(3).zip(&columns) {
            for (c, value) in pixel.iter_mut().enumerate() {
                *value = coding.encode(column.iter().map(|(x, weight)| weight * sums[3 * x + c]).sum());
            }
        }
    };
    rows.par_iter().zip(pixels.par_chunks_mut(3 * size[0] as usize)).for_each_init(Vec::new, row);
    pixels
}

/// For each of `to` texels the ones of `from` that it is made of, with weights that sum to one.
fn taps(from: u32, to: u32, repeats: bool) -> Vec<Vec<(usize, f32)>> {
    let scale = f64::from(from) / f64::from(to);
    let reach = scale.max(1.0);
    let place = |k: i64| match repeats {
        true => k.rem_euclid(i64::from(from)) as usize,
        false => k.clamp(0, i64::from(from) - 1) as usize,
    };
    let of = |i: u32| {
        let centre = (f64::from(i) + 0.5) * scale - 0.5;
        let near = (centre - reach).ceil() as i64..=(centre + reach).floor() as i64;
        let tent: Vec<(usize, f64)> =
            near.map(|k| (place(k), 1.0 - (k as f64 - centre).abs() / reach)).collect();
        let sum: f64 = tent.iter().map(|t| t.1).sum();
        tent.into_iter().map(|(k, weight)| (k, (weight / sum) as f32)).collect()
    };
    (0..to).map(of).collect()
}

/// Normals between two others are shorter than they.
fn to_length_one(map: &mut RgbImage) {
    for p in map.pixels_mut() {
        let n = p.0.map(|v| f32::from(v) / 127.5 - 1.0);
        let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
        if length > 0.0 {
            p.0 = n.map(|c| ((c / length + 1.0) * 127.5).round() as u8);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_loses_a_fifth_at_most() {
        let sides = [1, 2, 3, 5, 640, 641, 1024, 1239, 1280, 1281, 1427, 2048, 2049, 8192];
        let want = [1, 2, 4, 4, 512, 1024, 1024, 1024, 1024, 2048, 2048, 2048, 2048, 8192];
        assert_eq!(sides.map(side), want);
    }

    fn grey(levels: &[u8], repeats: bool, size: u32, coding: Coding) -> Vec<u8> {
        let pixels = RgbImage::from_fn(levels.len() as u32, 1, |x, _| image::Rgb([levels[x as usize]; 3]));
        let texture = Texture { name: "t".into(), pixels: Shared::new(pixels), repeats };
        resampled(&texture, [size, 1], coding).pixels().map(|p| p.0[0]).collect()
    }

    #[test]
    fn what_grows_is_interpolated_and_what_repeats_over_its_edge_as_well() {
        assert_eq!(grey(&[0, 200], false, 4, Coding::Shares), [0, 50, 150, 200]);
        assert_eq!(grey(&[0, 200], true, 4, Coding::Shares), [50, 50, 150, 150]);
    }

    #[test]
    fn what_shrinks_keeps_its_mean_light() {
        // Half of the light is level 188 in sRGB.
        assert_eq!(grey(&[0, 255, 0, 255], true, 2, Coding::Colours), [188, 188]);
        assert_eq!(grey(&[90; 5], false, 4, Coding::Colours), [90; 4]);
    }

    #[test]
    fn normals_keep_their_length() {
        let mut map = RgbImage::from_pixel(1, 1, image::Rgb([128, 128, 200]));
        to_length_one(&mut map);
        assert_eq!(map.get_pixel(0, 0).0, [128, 128, 255]);
    }
}
