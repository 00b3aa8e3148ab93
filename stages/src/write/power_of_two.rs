//! Textures whose sides are powers of two.
//!
//! Sides are scaled by linear interpolation (a tent filter where they shrink); texture coordinates count in shares of the picture and stay.
//! Cost: a pass over each texture that changes. Limit: of a picture that repeats, the outermost texels are weighed without those beyond.

use image::RgbImage;
use image::imageops::{FilterType, resize};
use rayon::prelude::*;
use toile_core::artifact::{Model, Shared};

/// A side may lose this share of its length, rather than grow to the next power.
const LOSS: f64 = 0.2;

/// Brings all textures to powers of two.
pub(super) fn to_powers_of_two(model: &mut Model) {
    let is_map: Vec<bool> = (0..model.textures.len()).map(|t| model.is_normal_map(t)).collect();
    model.textures.par_iter_mut().zip(is_map).for_each(|(texture, is_map)| {
        let (w, h) = texture.pixels.dimensions();
        let size = (side(w), side(h));
        if size != (w, h) {
            let mut pixels = resize(&*texture.pixels, size.0, size.1, FilterType::Triangle);
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

    #[test]
    fn normals_keep_their_length() {
        let mut map = RgbImage::from_pixel(1, 1, image::Rgb([128, 128, 200]));
        to_length_one(&mut map);
        assert_eq!(map.get_pixel(0, 0).0, [128, 128, 255]);
    }
}
