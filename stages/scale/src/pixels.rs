//! Reduced copies of a photo, and colours between its pixels.
//!
//! Pixel centres lie at integer coordinates. A reduced pixel is the mean of a square of `k` pixels,
//! so a place p of the reduced copy is `k p + (k - 1) / 2` of the photo.

use image::RgbImage;
use nalgebra::Point2;
use rayon::prelude::*;

pub(crate) type Rgb = [f32; 3];

/// A photo reduced by a whole number.
#[derive(Debug)]
pub(crate) struct ReducedPhoto {
    pub(crate) w: usize,
    pub(crate) h: usize,
    /// Pixels of the photo along a side of a pixel.
    pub(crate) k: usize,
    pub(crate) rgb: Vec<Rgb>,
}

impl ReducedPhoto {
    /// The photo with `k` x `k` pixels made one; what is left over at the right and below is left
    /// out.
    pub(crate) fn of(photo: &RgbImage, k: usize) -> Self {
        let (w, h) = (photo.width() as usize / k, photo.height() as usize / k);
        let mut rgb = vec![[0.0; 3]; w * h];
        rgb.par_chunks_mut(w.max(1)).enumerate().for_each(|(y, row)| reduce_row(photo, k, y, row));
        ReducedPhoto { w, h, k, rgb }
    }

    /// A place of the copy as a place of the photo.
    pub(crate) fn to_photo(&self, p: Point2<f64>) -> Point2<f64> {
        let k = self.k as f64;
        p.map(|v| v * k + (k - 1.0) / 2.0)
    }
}

/// One row of the reduced copy.
fn reduce_row(photo: &RgbImage, k: usize, y: usize, row: &mut [Rgb]) {
    let stride = photo.width() as usize * 3;
    let raw = photo.as_raw();
    for v in y * k..(y + 1) * k {
        let line = &raw[v * stride..(v + 1) * stride];
        for (out, block) in row.iter_mut().zip(line.chunks_exact(3 * k)) {
            for px in block.chunks_exact(3) {
                (0..3).for_each(|c| out[c] += f32::from(px[c]));
            }
        }
    }
    let share = 1.0 / (k * k) as f32;
    row.iter_mut().flatten().for_each(|v| *v *= share);
}

/// The colour at a place between pixels, bilinear; the rim's colours beyond the frame.
pub(crate) fn colour(photo: &RgbImage, x: f64, y: f64) -> Rgb {
    let (w, h) = (photo.width() as usize, photo.height() as usize);
    let (x, y) = (x.clamp(0.0, (w - 1) as f64), y.clamp(0.0, (h - 1) as f64));
    let (i, j) = ((x as usize).min(w.saturating_sub(2)), (y as usize).min(h.saturating_sub(2)));
    let (u, v) = ((x - i as f64) as f32, (y - j as f64) as f32);
    let raw = photo.as_raw();
    let (right, down) = (if w > 1 { 3 } else { 0 }, if h > 1 { 3 * w } else { 0 });
    let at = 3 * (j * w + i);
    std::array::from_fn(|c| {
        let px = |o: usize| f32::from(raw[at + o + c]);
        (px(0) * (1.0 - u) + px(right) * u) * (1.0 - v) + (px(down) * (1.0 - u) + px(right + down) * u) * v
    })
}

/// Whether a place lies in the frame.
pub(crate) fn inside(photo: &RgbImage, p: Point2<f64>) -> bool {
    let (w, h) = (f64::from(photo.width()), f64::from(photo.height()));
    p.x >= 0.0 && p.y >= 0.0 && p.x <= w - 1.0 && p.y <= h - 1.0
}
