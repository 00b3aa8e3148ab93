//! Peak signal-to-noise ratio: `10 log10(255^2 / mean square error)`, dB.

use image::RgbImage;

/// What stands for the ratio of pictures that do not differ, dB.
pub const PSNR_OF_EQUAL: f64 = 99.0;

/// The ratio for that mean square error of levels from 0 to 255, dB.
pub fn psnr_of(mean_square: f64) -> f64 {
    (10.0 * (255.0f64 * 255.0 / mean_square.max(1e-12)).log10()).min(PSNR_OF_EQUAL)
}

/// The ratio of two pictures over the pixels that count, dB; none where their sizes differ or none
/// counts.
pub fn psnr(a: &RgbImage, b: &RgbImage, counts: impl Fn(u32, u32) -> bool) -> Option<f64> {
    if a.dimensions() != b.dimensions() {
        return None;
    }
    let (mut sum, mut n) = (0u64, 0u64);
    for ((x, y, p), q) in a.enumerate_pixels().zip(b.pixels()) {
        if counts(x, y) {
            sum += p.0.iter().zip(q.0).map(|(a, b)| u64::from(a.abs_diff(b)).pow(2)).sum::<u64>();
            n += 3;
        }
    }
    (n > 0).then(|| psnr_of(sum as f64 / n as f64))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use image::Rgb;

    #[test]
    fn a_difference_of_one_level_is_48_decibel() {
        let a = RgbImage::from_pixel(4, 4, Rgb([9; 3]));
        let b = RgbImage::from_pixel(4, 4, Rgb([10; 3]));
        assert!((psnr(&a, &b, |_, _| true).unwrap() - 48.13).abs() < 0.01);
        assert_eq!(psnr(&a, &a, |_, _| true), Some(PSNR_OF_EQUAL));
        assert_eq!(psnr(&a, &b, |_, _| false), None);
        assert_eq!(psnr(&a, &RgbImage::new(3, 4), |_, _| true), None);
    }
}
