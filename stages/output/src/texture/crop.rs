//! The panel's part of its photo, scaled down.
//!
//! Area average in linear light over the pixels **inside the panel only**, so that no background is
//! mixed in at the outline. Cost: every source pixel once or twice. At scale 1 pixels are copied
//! unchanged.

use super::inside::PixelBox;
use crate::render::{LINEAR, encode};
use image::{GrayImage, RgbImage};
use rayon::prelude::*;

/// A scaled crop: colours and which of its pixels have one.
pub(super) struct Crop {
    pub(super) pixels: RgbImage,
    /// 255 where the panel covers at least half of the pixel.
    pub(super) inside: GrayImage,
}

/// The size of the crop: the box, or what is left of it when its longer side is brought down to
/// `size` px.
pub(super) fn scaled_size(area: PixelBox, size: u32) -> [u32; 2] {
    let longer = area.width.max(area.height);
    let fit = |side: u32| match longer > size {
        true => {
            ((u64::from(side) * u64::from(size) + u64::from(longer) / 2) / u64::from(longer)).max(1) as u32
        }
        false => side,
    };
    [fit(area.width), fit(area.height)]
}

/// Averages the photo's pixels in the box that `inside` keeps.
pub(super) fn crop(photo: &RgbImage, area: PixelBox, inside: &GrayImage, size: [u32; 2]) -> Crop {
    let [width, height] = size;
    let columns = spans(area.width, width);
    let rows = spans(area.height, height);
    let source = CropSource { photo, area, inside };
    let mut pixels = RgbImage::new(width, height);
    let mut kept = GrayImage::new(width, height);
    let lines = pixels.par_chunks_mut(width as usize * 3).zip(kept.par_chunks_mut(width as usize));
    lines.zip(&rows).for_each(|((line, kept), row)| {
        for ((pixel, kept), column) in line.chunks_exact_mut(3).zip(kept).zip(&columns) {
            if let Some(colour) = source.average(column, row) {
                pixel.copy_from_slice(&colour);
                *kept = 255;
            }
        }
    });
    Crop { pixels, inside: kept }
}

/// The source pixels under one pixel of the crop: the first, and the weight of each.
struct WeightedSpan {
    first: u32,
    weights: Vec<f32>,
}

/// How `from` source pixels are shared out among `to` pixels.
fn spans(from: u32, to: u32) -> Vec<WeightedSpan> {
    let step = f64::from(from) / f64::from(to);
    let span = |i: u32| {
        let (a, b) = (f64::from(i) * step, f64::from(i + 1) * step);
        let (first, last) = (a.floor() as u32, (b.ceil() as u32).min(from));
        let weight = |k: u32| (b.min(f64::from(k + 1)) - a.max(f64::from(k))).max(0.0) as f32;
        WeightedSpan { first, weights: (first..last).map(weight).collect() }
    };
    (0..to).map(span).collect()
}

struct CropSource<'a> {
    photo: &'a RgbImage,
    area: PixelBox,
    inside: &'a GrayImage,
}

impl CropSource<'_> {
    /// Mean colour of the inside; `None` where less than half is inside.
    fn average(&self, columns: &WeightedSpan, rows: &WeightedSpan) -> Option<[u8; 3]> {
        let (mut sum, mut weight, mut all) = ([0.0; 3], 0.0, 0.0);
        let mut only = [0; 3];
        for (y, wy) in (rows.first..).zip(&rows.weights) {
            for (x, wx) in (columns.first..).zip(&columns.weights) {
                let w = wx * wy;
                all += w;
                if let Some(colour) = self.pixel(x, y) {
                    weight += w;
                    only = colour;
                    (0..3).for_each(|c| sum[c] += w * LINEAR[colour[c] as usize]);
                }
            }
        }
        let single = columns.weights.len() == 1 && rows.weights.len() == 1;
        match weight >= 0.5 * all && weight > 0.0 {
            true if single => Some(only),
            true => Some(sum.map(|s| encode(s / weight))),
            false => None,
        }
    }

    /// The photo's pixel, where it exists and the panel covers it.
    fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        if self.inside.get_pixel(x, y).0[0] == 0 {
            return None;
        }
        let px = u32::try_from(self.area.left + i64::from(x)).ok()?;
        let py = u32::try_from(self.area.top + i64::from(y)).ok()?;
        self.photo.get_pixel_checked(px, py).map(|p| p.0)
    }
}
