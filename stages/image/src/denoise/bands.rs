//! Filters over bands of rows in parallel.

use image::RgbImage;
use rayon::prelude::*;
use std::ops::Range;
use toile_core::{Context, StageError};

/// Samples of a pixel.
pub(super) const CHANNELS: usize = 3;

/// An image as rows of bytes, with rows and columns past the frame clamped to it.
#[derive(Clone, Copy)]
pub(super) struct ClampedRows<'a> {
    data: &'a [u8],
    stride: usize,
    height: usize,
}

impl<'a> ClampedRows<'a> {
    pub(super) fn new(image: &'a RgbImage) -> Self {
        let (w, h) = image.dimensions();
        ClampedRows { data: image.as_raw(), stride: w as usize * CHANNELS, height: h as usize }
    }

    /// Bytes of a row.
    pub(super) fn stride(&self) -> usize {
        self.stride
    }

    /// Pixels of a row.
    pub(super) fn width(&self) -> usize {
        self.stride / CHANNELS
    }

    /// The row `y + dy`, clamped.
    pub(super) fn at(&self, y: usize, dy: isize) -> &'a [u8] {
        let y = y.saturating_add_signed(dy).min(self.height - 1);
        &self.data[y * self.stride..(y + 1) * self.stride]
    }
}

/// Copies `row` into the middle of `padded`, which is `radius` pixels longer on each side, and
/// repeats its end pixels outwards.
pub(super) fn pad<T: Copy>(row: &[T], radius: usize, padded: &mut [T]) {
    let margin = radius * CHANNELS;
    let end = margin + row.len();
    padded[margin..end].copy_from_slice(row);
    for c in 0..CHANNELS {
        padded[..margin].iter_mut().skip(c).step_by(CHANNELS).for_each(|v| *v = row[c]);
        let last = row[row.len() - CHANNELS + c];
        padded[end..].iter_mut().skip(c).step_by(CHANNELS).for_each(|v| *v = last);
    }
}

/// Fills a new image by bands of `band_rows` rows: `fill` gets the band's rows and its bytes.
///
/// # Errors
/// When the run is cancelled, which is asked before every band.
pub(super) fn by_bands(
    image: &RgbImage,
    band_rows: usize,
    cx: &Context,
    fill: impl Fn(Range<usize>, &mut [u8]) + Sync,
) -> Result<RgbImage, StageError> {
    let (w, h) = image.dimensions();
    let mut out = vec![0; image.as_raw().len()];
    let stride = w as usize * CHANNELS;
    if !out.is_empty() {
        out.par_chunks_mut(stride * band_rows).enumerate().try_for_each(|(i, bytes)| {
            cx.check()?;
            let first = i * band_rows;
            fill(first..first + bytes.len() / stride, bytes);
            Ok(())
        })?;
    }
    RgbImage::from_raw(w, h, out).ok_or_else(|| StageError::internal("a filter lost pixels"))
}
