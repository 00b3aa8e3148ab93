//! The neighbourhood mean: every pixel becomes the mean of its neighbours and itself.
//!
//! `g(i, j) = sum of w_uv f(i+u, j+v)` with equal weights that sum to one. The neighbourhood holds
//! the pixels that can be reached in `radius` steps over the mask's neighbours: with `Eight` the
//! square of (2 radius + 1)^2 pixels, with `Four` the diamond |u| + |v| <= radius (5 pixels of
//! weight 0.2 at radius 1).
//!
//! Cost: the square's sums slide down and along the rows, so the radius costs nothing; 12
//! megapixels take about 20 ms on two cores at radius 1 and 30 ms above. The diamond costs 2
//! radius + 1 additions a sample. Integer sums: the result is the mean rounded to nearest, exactly.
//!
//! Limits: blurs edges by its radius; the edge detector finds them again at their middle.

use super::bands::{CHANNELS, ClampedRows, by_bands, pad};
use super::join::{joined, joint};
use super::joined_pixels;
use image::RgbImage;
use std::ops::Range;
use toile_core::Known;
use toile_core::cost::Size;
use toile_core::decide::Decision;
use toile_core::prelude::*;

/// Which pixels count as neighbours.
#[choice]
#[derive(Copy, Eq)]
pub enum Neighbours {
    /// Left, right, above, below: a diamond.
    Four,
    /// The diagonal ones as well: a square.
    Eight,
}

/// Replaces every pixel by the mean of its neighbourhood.
///
/// Takes sensor noise and weave out of the photo before it is binarised. The larger the radius, the
/// more detail is lost. `Eight` averages a square of (2 radius + 1)^2 pixels, `Four` a diamond.
///
/// Large photos are brought down first, whole pixels joined, as far as `pixel` allows: what follows
/// them takes that much less time, and their grain goes as well. Textures are still taken from the
/// photo as it was read.
#[stage(
    role = Denoiser,
    version = 2,
    source = "Rosenfeld and Kak, Digital Picture Processing, 1976",
    example = "NeighbourhoodMean(mask: Eight, radius: 1)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct NeighbourhoodMean {
    /// Which pixels count as neighbours.
    #[param(default = Neighbours::Eight)]
    pub mask: Neighbours,
    /// How many steps over neighbours the mean reaches.
    #[param(default = 1, min = 1, max = 50, unit = "px")]
    pub radius: u32,
    /// Pixels are joined until they are this wide, at the most, where the garment is as wide as the
    /// frame; 1000 of them stay along the shorter side. `"0 mm"` joins none.
    #[param(default = Length::mm(0.5), min = 0.0, max = 0.01, trades)]
    pub pixel: Length,
}

#[stage]
impl NeighbourhoodMean {
    pub(crate) fn run(&self, photo: &Photo, cx: &Context) -> Result<Photo, StageError> {
        let photo = joined(photo, joint(photo, self.pixel.metres()), cx)?;
        Ok(photo.with_pixels(neighbourhood_mean(&photo.pixels, self.mask, self.radius as usize, cx)?))
    }

    /// Fewer pixels than it is given.
    pub(crate) fn sizes(&self, given: &Size, _cx: &Context) -> Option<Size> {
        joined_pixels::foreseen(given, self.pixel.metres())
    }

    pub(crate) fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        joined_pixels::rule(known, self.pixel.metres()).into_iter().collect()
    }
}

/// Rows a thread takes at a time; the rows around a band are summed twice, so wide masks take more.
fn band_rows(radius: usize) -> usize {
    (4 * radius).max(64)
}

/// The mean over all pixels within `radius` (at most 50) steps; the frame's pixels are repeated
/// outwards.
pub fn neighbourhood_mean(
    image: &RgbImage,
    mask: Neighbours,
    radius: usize,
    cx: &Context,
) -> Result<RgbImage, StageError> {
    let rows = ClampedRows::new(image);
    by_bands(image, band_rows(radius), cx, |band, out| match mask {
        Neighbours::Eight => square(rows, radius, band, out),
        Neighbours::Four => diamond(rows, radius, band, out),
    })
}

/// Divides by a fixed whole number, rounding to nearest, without a division.
#[derive(Clone, Copy)]
struct Divider {
    reciprocal: u64,
    half: u64,
}

impl Divider {
    /// Exact for counts to 2^14 and sums to 255 times that: the reciprocal's error of 2^-40 grows
    /// to 2^-18, less than the 1 / count by which a quotient may lie below a whole number.
    fn new(count: usize) -> Self {
        let count = count as u64;
        Divider { reciprocal: (1u64 << 40).div_ceil(count), half: count / 2 }
    }

    fn mean(self, sum: u32) -> u8 {
        (((u64::from(sum) + self.half) * self.reciprocal) >> 40) as u8
    }
}

fn square(rows: ClampedRows, radius: usize, band: Range<usize>, out: &mut [u8]) {
    let r = radius as isize;
    let stride = rows.stride();
    // Sums down the columns: at most 101 * 255, which fits.
    let mut columns = vec![0u16; stride];
    for dy in -r..=r {
        add(&mut columns, rows.at(band.start, dy));
    }
    let mut padded = vec![0u16; stride + 2 * radius * CHANNELS];
    for (y, row) in band.clone().zip(out.chunks_exact_mut(stride)) {
        if y > band.start {
            slide(&mut columns, rows.at(y, r), rows.at(y - 1, -r));
        }
        pad(&columns, radius, &mut padded);
        if radius == 1 {
            mean_of_nine(&padded, row);
        } else {
            mean_along(&padded, radius, row);
        }
    }
}

fn add(columns: &mut [u16], row: &[u8]) {
    columns.iter_mut().zip(row).for_each(|(c, &v)| *c += u16::from(v));
}

/// Moves the columns' window down by a row.
fn slide(columns: &mut [u16], enters: &[u8], leaves: &[u8]) {
    for ((c, &new), &old) in columns.iter_mut().zip(enters).zip(leaves) {
        *c = *c + u16::from(new) - u16::from(old);
    }
}

/// Nine pixels from three column sums, in 16-bit arithmetic that the compiler vectorises.
fn mean_of_nine(padded: &[u16], row: &mut [u8]) {
    // ceil(2^16 / 9); exact for sums to 2,299, as the error stays below 2,299 * 0.23 / 2^16 < 1
    // / 9.
    const NINTH: u32 = 7282;
    let (left, middle, right) = (padded, &padded[CHANNELS..], &padded[2 * CHANNELS..]);
    for (((out, &a), &b), &c) in row.iter_mut().zip(left).zip(middle).zip(right) {
        *out = ((u32::from(a + b + c + 4) * NINTH) >> 16) as u8;
    }
}

fn mean_along(padded: &[u16], radius: usize, row: &mut [u8]) {
    let side = 2 * radius + 1;
    let divider = Divider::new(side * side);
    let mut sums = [0u32; CHANNELS];
    for pixel in padded.chunks_exact(CHANNELS).take(side - 1) {
        sums.iter_mut().zip(pixel).for_each(|(s, &v)| *s += u32::from(v));
    }
    let enters = padded[(side - 1) * CHANNELS..].chunks_exact(CHANNELS);
    for ((out, new), old) in row.chunks_exact_mut(CHANNELS).zip(enters).zip(padded.chunks_exact(CHANNELS)) {
        for c in 0..CHANNELS {
            sums[c] += u32::from(new[c]);
            out[c] = divider.mean(sums[c]);
            sums[c] -= u32::from(old[c]);
        }
    }
}

/// Sums of runs by running totals along each row, added up over the diamond's rows.
fn diamond(rows: ClampedRows, radius: usize, band: Range<usize>, out: &mut [u8]) {
    let stride = rows.stride();
    let r = radius as isize;
    let divider = Divider::new(2 * radius * (radius + 1) + 1);
    let first = band.start as isize - r;
    let totals: Vec<Vec<u32>> =
        (first..band.end as isize + r).map(|y| running_totals(rows.at(0, y), radius)).collect();
    let mut sums = vec![0u32; stride];
    for (i, row) in out.chunks_exact_mut(stride).enumerate() {
        sums.fill(0);
        for (k, total) in totals[i..=i + 2 * radius].iter().enumerate() {
            let reach = radius - k.abs_diff(radius);
            let before = &total[(radius - reach) * CHANNELS..];
            let behind = &total[(radius + reach + 1) * CHANNELS..];
            sums.iter_mut().zip(behind).zip(before).for_each(|((s, &b), &a)| *s += b - a);
        }
        row.iter_mut().zip(&sums).for_each(|(out, &s)| *out = divider.mean(s));
    }
}

/// For each channel: the sum of all samples before each pixel of the padded row.
fn running_totals(row: &[u8], radius: usize) -> Vec<u32> {
    let mut padded = vec![0u8; row.len() + 2 * radius * CHANNELS];
    pad(row, radius, &mut padded);
    let mut totals = vec![0u32; padded.len() + CHANNELS];
    for (i, &v) in padded.iter().enumerate() {
        totals[i + CHANNELS] = totals[i] + u32::from(v);
    }
    totals
}
