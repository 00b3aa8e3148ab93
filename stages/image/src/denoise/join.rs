//! Whole pixels joined into larger ones.
//!
//! Method: each square of n x n pixels becomes their mean (sRGB levels, rounded to nearest, as the
//! neighbourhood mean rounds); what is left over at the right and lower border, less than n pixels,
//! is cut off. Whole factors keep every pixel's weight equal, so that the joined photo has no
//! pattern of its own. Cost: one pass over the pixels.

use image::{GrayImage, RgbImage};
use rayon::prelude::*;
use toile_core::prelude::*;

/// Pixels that stay along the shorter side.
const LEAST_SIDE: u32 = 1000;

/// How many pixels of a photo, to a side, may be joined so that one is at most `pixel` wide,
/// metres, in a photo whose garment is as wide as its frame; 1 where the scale is not known.
pub(super) fn joint(photo: &Photo, pixel: f64) -> u32 {
    let (w, h) = photo.pixels.dimensions();
    let by_scale = photo.px_per_metre.map(|s| f64::from(w) / s);
    by_scale.or(photo.garment_width).map_or(1, |width| joint_of((w, h), width, pixel))
}

/// The same by the photo's size, px, and the width of its frame, metres.
pub(super) fn joint_of((w, h): (u32, u32), frame_width: f64, pixel: f64) -> u32 {
    let allowed = pixel * f64::from(w) / frame_width;
    let most = (w.min(h) / LEAST_SIDE).max(1);
    if allowed.is_finite() { (allowed as u32).clamp(1, most) } else { 1 }
}

/// The photo with `n` x `n` of its pixels joined; the same where `n` is 1.
pub(super) fn joined(photo: &Photo, n: u32, cx: &Context) -> Result<Photo, StageError> {
    if n <= 1 {
        return Ok(photo.clone());
    }
    let (w, h) = photo.pixels.dimensions();
    let size = (w / n, h / n);
    let pixels = means::<3>(photo.pixels.as_raw(), w, size, n, cx)?;
    let alpha = photo.alpha.as_ref().map(|a| means::<1>(a.as_raw(), w, size, n, cx)).transpose()?;
    let lost = || StageError::internal("a photo lost pixels");
    let alpha = alpha.map(|a| GrayImage::from_raw(size.0, size.1, a).ok_or_else(lost)).transpose()?;
    Ok(Photo {
        pixels: Shared::new(RgbImage::from_raw(size.0, size.1, pixels).ok_or_else(lost)?),
        alpha: alpha.map(Shared::new),
        px_per_metre: photo.px_per_metre.map(|s| s / f64::from(n)),
        joined: photo.joined * n,
        ..photo.clone()
    })
}

/// Means over squares of `n` x `n` pixels of `C` samples; `width` is that of the source, px.
fn means<const C: usize>(
    source: &[u8],
    width: u32,
    (w, h): (u32, u32),
    n: u32,
    cx: &Context,
) -> Result<Vec<u8>, StageError> {
    let (n, stride, line) = (n as usize, width as usize * C, w as usize * C);
    let count = (n * n) as u32;
    let mut out = vec![0; line * h as usize];
    out.par_chunks_mut(line.max(1)).enumerate().try_for_each(|(y, row)| {
        if y % 64 == 0 {
            cx.check()?;
        }
        let mut sums = vec![0u32; line];
        for from in source[y * n * stride..].chunks_exact(stride).take(n) {
            for (x, pixel) in from.chunks_exact(n * C).take(w as usize).enumerate() {
                pixel.iter().enumerate().for_each(|(k, v)| sums[x * C + k % C] += u32::from(*v));
            }
        }
        row.iter_mut().zip(&sums).for_each(|(to, sum)| *to = ((sum + count / 2) / count) as u8);
        Ok::<(), StageError>(())
    })?;
    Ok(out)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn photo(w: u32, h: u32, width: Option<f64>) -> Photo {
        let pixels = RgbImage::from_fn(w, h, |x, y| image::Rgb([x as u8, y as u8, (x + y) as u8]));
        Photo {
            pixels: Shared::new(pixels),
            alpha: Some(Shared::new(GrayImage::from_fn(w, h, |x, _| image::Luma([x as u8])))),
            px_per_metre: None,
            garment_width: width,
            mirrored: false,
            joined: 1,
            file: "a.png".into(),
        }
    }

    #[test]
    fn as_many_pixels_are_joined_as_their_width_allows() {
        // 0.25 mm per pixel: two of them are half a millimetre.
        assert_eq!(joint_of((4000, 3000), 1.0, 0.5e-3), 2);
        assert_eq!(joint_of((4000, 3000), 1.0, 0.499e-3), 1);
        assert_eq!(joint_of((4000, 3000), 0.5, 0.5e-3), 3, "a thousand pixels stay along the shorter side");
        assert_eq!(joint_of((1400, 1600), 0.1, 0.5e-3), 1);
        assert_eq!(joint_of((4000, 3000), 1.0, 0.0), 1);
        assert_eq!(joint_of((4000, 3000), 0.0, 0.5e-3), 1, "no width is no scale");
        assert_eq!(joint(&photo(8, 8, None), 0.5e-3), 1);
        let scaled = Photo { px_per_metre: Some(4000.0), ..photo(4000, 2000, None) };
        assert_eq!(joint(&scaled, 0.5e-3), 2);
    }

    #[test]
    fn squares_become_their_means_and_the_rest_is_cut_off() {
        let from = Photo { px_per_metre: Some(2000.0), ..photo(7, 5, None) };
        let to = joined(&from, 2, &Context::quiet()).unwrap();
        assert_eq!(to.pixels.dimensions(), (3, 2));
        // Levels 2, 3, 2, 3: the mean 2.5 is rounded up.
        assert_eq!(to.pixels.get_pixel(1, 1).0, [3, 3, 5]);
        assert_eq!(to.alpha.as_ref().unwrap().get_pixel(2, 0).0, [5]);
        assert_eq!((to.joined, to.px_per_metre), (2, Some(1000.0)));
        assert!(to.check().is_ok());
        let same = joined(&from, 1, &Context::quiet()).unwrap();
        assert_eq!((same.pixels, same.joined), (from.pixels, 1));
    }
}
