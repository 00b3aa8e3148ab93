//! Opening and closing of masks by a disc.
//!
//! Erosion and dilation by a disc of radius r: a pixel is reached where some row within r holds a
//! marked pixel within the disc's half-width for that row (Serra, 1982). The distances along the
//! rows are found once; the rest is a compare of bytes that the compiler vectorises.
//!
//! Cost: 2 r + 1 bytes per pixel, about 10 ms for 12 megapixels at radius 3. Limits: radius 100.

use image::GrayImage;
use rayon::prelude::*;

/// The largest radius of the disc, pixels.
pub const MAX_RADIUS: u32 = 100;

/// Marks every pixel within `radius` of a marked one.
pub fn dilate(mask: &GrayImage, radius: u32) -> GrayImage {
    grow(mask, radius, 255)
}

/// Clears every pixel within `radius` of a clear one. What lies past the frame counts as marked.
pub fn erode(mask: &GrayImage, radius: u32) -> GrayImage {
    grow(mask, radius, 0)
}

/// Erosion, then dilation: takes off specks and hairs thinner than the disc.
pub fn open(mask: &GrayImage, radius: u32) -> GrayImage {
    if radius == 0 { mask.clone() } else { dilate(&erode(mask, radius), radius) }
}

/// Dilation, then erosion: closes gaps narrower than the disc.
pub fn close(mask: &GrayImage, radius: u32) -> GrayImage {
    if radius == 0 { mask.clone() } else { erode(&dilate(mask, radius), radius) }
}

/// Spreads the pixels of one value over the disc.
fn grow(mask: &GrayImage, radius: u32, value: u8) -> GrayImage {
    let (w, h) = mask.dimensions();
    let stride = w as usize;
    let radius = radius.min(MAX_RADIUS) as i64;
    if stride == 0 || h == 0 {
        return mask.clone();
    }
    let mut near = vec![0u8; mask.as_raw().len()];
    near.par_chunks_mut(stride).zip(mask.par_chunks(stride)).for_each(|(d, row)| distances(row, value, d));
    let mut out = GrayImage::new(w, h);
    out.par_chunks_mut(stride).enumerate().for_each(|(y, row)| {
        row.fill(!value);
        for dy in -radius..=radius {
            let at = y as i64 + dy;
            if !(0..i64::from(h)).contains(&at) {
                continue;
            }
            // Half a pixel more than r makes small discs round rather than crosses.
            let half_width = ((radius * radius + radius - dy * dy).max(0) as f64).sqrt() as u8;
            let line = &near[at as usize * stride..][..stride];
            for (out, &d) in row.iter_mut().zip(line) {
                *out = if d <= half_width { value } else { *out };
            }
        }
    });
    out
}

/// Distance along the row to the nearest pixel of the value; 255 where it is that or more.
fn distances(row: &[u8], value: u8, out: &mut [u8]) {
    let mut sweep = |indices: &mut dyn Iterator<Item = usize>, first: bool| {
        let mut d = 255u8;
        for x in indices {
            d = if row[x] == value { 0 } else { d.saturating_add(1) };
            out[x] = if first { d } else { out[x].min(d) };
        }
    };
    sweep(&mut (0..row.len()), true);
    sweep(&mut (0..row.len()).rev(), false);
}
