//! Grey levels, the frame's rim, and which side of a threshold the garment lies on.

use image::{GrayImage, RgbImage};
use rayon::prelude::*;
use toile_core::prelude::*;

/// Whether the garment is the darker or the lighter side.
#[choice]
#[derive(Copy, Eq)]
pub enum Polarity {
    /// What the frame's rim is not.
    Auto,
    /// The garment is darker than the ground.
    Dark,
    /// The garment is lighter than the ground.
    Light,
}

/// Luma (ITU-R BT.601) of every pixel, in integer arithmetic.
pub fn luma(image: &RgbImage) -> GrayImage {
    let (w, h) = image.dimensions();
    let mut grey = GrayImage::new(w, h);
    let rows = image.par_chunks(CHUNK * 3);
    grey.par_chunks_mut(CHUNK).zip(rows).for_each(|(out, rgb)| {
        for (out, p) in out.iter_mut().zip(rgb.chunks_exact(3)) {
            *out = ((u32::from(p[0]) * 77 + u32::from(p[1]) * 150 + u32::from(p[2]) * 29 + 128) >> 8) as u8;
        }
    });
    grey
}

/// Pixels that a thread takes at a time.
pub(super) const CHUNK: usize = 1 << 16;

/// Opacity from which on a pixel belongs to the picture: half, so that the boundary is not shifted.
pub(crate) const OPAQUE: u8 = 128;

/// How many pixels have each level, transparent ones left out.
pub fn histogram(grey: &GrayImage, alpha: Option<&GrayImage>) -> [u64; 256] {
    let count = |(i, chunk): (usize, &[u8])| {
        let mut bins = [0u64; 256];
        match alpha.map(|a| &a.as_raw()[i * CHUNK..i * CHUNK + chunk.len()]) {
            None => chunk.iter().for_each(|&v| bins[usize::from(v)] += 1),
            Some(alpha) => {
                let seen = chunk.iter().zip(alpha).filter(|(_, a)| **a >= OPAQUE);
                seen.for_each(|(&v, _)| bins[usize::from(v)] += 1);
            }
        }
        bins
    };
    // Whole numbers: the order of this sum changes nothing.
    grey.as_raw().par_chunks(CHUNK).enumerate().map(count).reduce(
        || [0; 256],
        |mut a, b| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
            a
        },
    )
}

/// Width of the frame's rim as a share of the shorter side. Garments that leave less margin than
/// this are rare; a wider rim would see them.
const RIM: f64 = 0.02;

/// Width of the rim in pixels: at least one.
pub(super) fn rim_px(w: u32, h: u32) -> u32 {
    ((f64::from(w.min(h)) * RIM) as u32).max(1)
}

/// The share of the rim's pixels that `is` holds for; transparent pixels are left out. Zero where
/// no pixel is left.
pub(super) fn rim_share(mask: &GrayImage, alpha: Option<&GrayImage>, is: impl Fn(u8) -> bool) -> f64 {
    let (w, h) = mask.dimensions();
    let rim = rim_px(w, h);
    let (mut hits, mut total) = (0u64, 0u64);
    let mut look = |x: u32, y: u32| {
        if alpha.is_none_or(|a| a.get_pixel(x, y).0[0] >= OPAQUE) {
            total += 1;
            hits += u64::from(is(mask.get_pixel(x, y).0[0]));
        }
    };
    for y in 0..h {
        let inner = y >= rim && y + rim < h;
        let right = if inner { w.saturating_sub(rim).max(rim) } else { 0 };
        (0..if inner { rim.min(w) } else { w }).for_each(|x| look(x, y));
        if inner {
            (right..w).for_each(|x| look(x, y));
        }
    }
    if total == 0 { 0.0 } else { hits as f64 / total as f64 }
}

/// Turns "dark" marks (255 where the pixel is on the dark side) into the garment's mask.
pub(super) fn by_polarity(dark: GrayImage, photo: &Photo, polarity: Polarity) -> GrayImage {
    let alpha = photo.alpha.as_deref();
    let garment_is_dark = match polarity {
        Polarity::Dark => true,
        Polarity::Light => false,
        Polarity::Auto => rim_share(&dark, alpha, |v| v != 0) < 0.5,
    };
    let mut mask = dark;
    if !garment_is_dark {
        mask.par_chunks_mut(CHUNK).for_each(|c| c.iter_mut().for_each(|v| *v = !*v));
    }
    mask
}

/// Marks the pixels at which `is_dark` holds, given their index.
pub(super) fn mark(grey: &GrayImage, is_dark: impl Fn(usize, u8) -> bool + Sync) -> GrayImage {
    let mut marks = grey.clone();
    marks.par_chunks_mut(CHUNK).enumerate().for_each(|(k, chunk)| {
        for (i, v) in chunk.iter_mut().enumerate() {
            *v = if is_dark(k * CHUNK + i, *v) { 255 } else { 0 };
        }
    });
    marks
}
