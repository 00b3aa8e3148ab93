//! Colours between pixels.

use image::RgbImage;
use std::borrow::Cow;
use toile_core::artifact::Photo;

/// The colour at a place within half a pixel of the picture, by the cubic that passes through the
/// pixels (Keys 1981, a = -1/2); none beyond. Levels may leave 0 to 255 beside sharp edges.
pub fn cubic(picture: &RgbImage, x: f64, y: f64) -> Option<[f32; 3]> {
    let (w, h) = (f64::from(picture.width()), f64::from(picture.height()));
    if !(x >= -0.5 && y >= -0.5 && x <= w - 0.5 && y <= h - 0.5) {
        return None;
    }
    let (fx, fy) = (x.floor(), y.floor());
    let (wx, wy) = (weights((x - fx) as f32), weights((y - fy) as f32));
    let (x, y) = (fx as i64, fy as i64);
    let column = |k: i64| (x - 1 + k).clamp(0, i64::from(picture.width()) - 1) as usize;
    let columns = [0, 1, 2, 3].map(column);
    let raw = picture.as_raw();
    let mut sum = [0f32; 3];
    for (k, wy) in (0i64..).zip(wy) {
        let row = (y - 1 + k).clamp(0, i64::from(picture.height()) - 1) as usize * picture.width() as usize;
        for (column, wx) in columns.iter().zip(wx) {
            let at = 3 * (row + column);
            let weight = wx * wy;
            (0..3).for_each(|c| sum[c] += weight * f32::from(raw[at + c]));
        }
    }
    Some(sum)
}

fn weights(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2]
}

/// The pixels of a photo, turned round where it stands for its mirror image.
pub fn flipped(photo: &Photo) -> Cow<'_, RgbImage> {
    let pixels = photo.pixels.as_ref();
    if photo.mirrored { Cow::Owned(image::imageops::flip_horizontal(pixels)) } else { Cow::Borrowed(pixels) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use image::Rgb;

    #[test]
    fn pixels_are_kept_and_slopes_are_straight() {
        let picture = RgbImage::from_fn(6, 5, |x, y| Rgb([(20 * x) as u8, (30 * y) as u8, 7]));
        assert_eq!(cubic(&picture, 2.0, 3.0), Some([40.0, 90.0, 7.0]));
        let [r, g, b] = cubic(&picture, 2.25, 1.5).unwrap();
        assert!((r - 45.0).abs() < 1e-3 && (g - 45.0).abs() < 1e-3 && (b - 7.0).abs() < 1e-3);
        assert!(cubic(&picture, -0.5, 4.5).is_some());
        assert_eq!([cubic(&picture, -0.6, 0.0), cubic(&picture, f64::NAN, 0.0)], [None; 2]);
    }
}
