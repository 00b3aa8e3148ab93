//! Masks as flags and as pictures.

use image::GrayImage;

/// A picture of `w` x `h` pixels from one flag per pixel.
pub(super) fn picture(mask: &[bool], w: usize, h: usize) -> GrayImage {
    let mut out = GrayImage::new(w as u32, h as u32);
    out.iter_mut().zip(mask).for_each(|(v, on)| *v = if *on { 255 } else { 0 });
    out
}

/// One flag a pixel.
pub(super) fn bits(mask: &GrayImage) -> Vec<bool> {
    mask.as_raw().iter().map(|v| *v != 0).collect()
}
