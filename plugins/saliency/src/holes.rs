//! Fills the holes of a mask, because garments have none.
//!
//! The ground is what is reached from the frame over pixels off the mask, up, down and sideways
//! (flood fill on a stack). Cost: one look at every pixel. Limits: ground that a sleeve closes off
//! against the body is filled, too; `Auto()` opens it again.

use image::{GrayImage, Luma};

/// Marks ground that is reached from the frame.
const REACHED: Luma<u8> = Luma([1]);
const GROUND: Luma<u8> = Luma([0]);

/// The mask, 0 or 255, without holes.
pub(crate) fn filled(mut mask: GrayImage) -> GrayImage {
    let mut open: Vec<(u32, u32)> = frame(&mask).collect();
    while let Some((x, y)) = open.pop() {
        if mask.get_pixel_checked(x, y) == Some(&GROUND) {
            mask.put_pixel(x, y, REACHED);
            open.extend([(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)]);
        }
    }
    mask.pixels_mut().for_each(|p| *p = Luma([u8::from(*p != REACHED) * u8::MAX]));
    mask
}

/// The pixels along the frame.
fn frame(mask: &GrayImage) -> impl Iterator<Item = (u32, u32)> + use<> {
    let (w, h) = mask.dimensions();
    let rows = (0..w).flat_map(move |x| [(x, 0), (x, h.saturating_sub(1))]);
    rows.chain((0..h).flat_map(move |y| [(0, y), (w.saturating_sub(1), y)]))
}
