//! A normal map from the fine detail of a photo.
//!
//! The luminance less its blurred self, over some threads, is taken for height, as is usual for
//! bump maps (Blinn, 1978). Shape from shading is not attempted: a dark thread counts as a low one.
//! Cost: a blur of the picture and [`Relief::normal_map`]. Limit: the edges of a print rise or fall
//! a little, as threads do.

use super::relief::Relief;
use image::RgbImage;
use toile_core::prelude::*;
use toile_image::denoise::gaussian;

/// Standard deviation of the blur, metres: what is wider than a few threads is light or print.
const WIDTH: f64 = 1.5e-3;
/// Height of a step from black to white, metres.
const STEP: f32 = 2e-3;
/// Larger differences from the surroundings than this share count as much: they are print.
const LARGEST: f32 = 0.1;

/// The normal map of a texture with `px_per_metre` texels a metre of cloth.
pub(super) fn normal_map(
    pixels: &RgbImage,
    px_per_metre: f64,
    strength: f64,
    cx: &Context,
) -> Result<RgbImage, StageError> {
    let blurred = gaussian(pixels, (WIDTH * px_per_metre).clamp(0.3, 20.0), cx)?;
    let height = |(p, around): (&image::Rgb<u8>, &image::Rgb<u8>)| {
        STEP * (luma(p.0) - luma(around.0)).clamp(-LARGEST, LARGEST)
    };
    let relief = Relief {
        heights: pixels.pixels().zip(blurred.pixels()).map(height).collect(),
        width: pixels.width() as usize,
        height: pixels.height() as usize,
        texel: if px_per_metre > 0.0 { 1.0 / px_per_metre } else { 0.0 },
        repeats: false,
    };
    Ok(relief.normal_map(strength))
}

/// Luma of ITU-R BT.709, 0 to 1: of the coded colours, whose steps look alike.
fn luma(p: [u8; 3]) -> f32 {
    let [r, g, b] = p.map(|v| f32::from(v) / 255.0);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn map(level: impl Fn(u32) -> u8) -> RgbImage {
        let photo = RgbImage::from_fn(64, 64, |x, _| image::Rgb([level(x); 3]));
        normal_map(&photo, 2000.0, 1.0, &Context::quiet()).unwrap()
    }

    #[test]
    fn threads_stand_out_and_slow_light_does_not() {
        let threads = map(|x| if x / 4 % 2 == 0 { 140 } else { 120 });
        // From dark to bright it rises to the right: the normal leans to the left.
        assert!(threads.get_pixel(24, 32).0[0] < 120 && threads.get_pixel(28, 32).0[0] > 136);
        let light = map(|x| 100 + x as u8 / 2);
        assert!(light.pixels().all(|p| p.0[0].abs_diff(128) < 12 && p.0[1].abs_diff(128) < 2));
    }
}
