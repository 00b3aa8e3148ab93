//! The bilateral filter that makes the guide.
//!
//! Each pixel is the mean of those within [`RADIUS`], weighted by how near they are in place and in
//! colour (Tomasi & Manduchi 1998); the colour's fall-off is three times the grain. 25 weights per
//! pixel, from a table.

use image::RgbImage;
use std::ops::Range;
use toile_core::{Context, StageError};

/// Half the window's width: a guide needs no more, the guided filter does the rest.
const RADIUS: usize = 2;
/// Standard deviation in place, px.
const PLACE: f64 = 1.5;
/// Standard deviation in colour, in those of the grain.
const COLOUR: f64 = 3.0;
/// Greatest squared distance of two colours.
const FARTHEST: usize = 3 * 255 * 255;
/// This many consecutive squared distances share one entry of the table.
const STEP: usize = 16;

/// The smoothed rows of a photo, channels side by side.
pub(crate) fn smooth(
    photo: &RgbImage,
    rows: Range<usize>,
    noise: f64,
    cx: &Context,
) -> Result<Vec<f32>, StageError> {
    let (w, h) = (photo.width() as usize, photo.height() as usize);
    let raw = photo.as_raw();
    let falloff = 2.0 * (COLOUR * noise).powi(2);
    let table: Vec<f32> =
        (0..=FARTHEST / STEP).map(|d| (-((d * STEP) as f64) / falloff).exp() as f32).collect();
    let place: Vec<f32> =
        (0..=2 * RADIUS * RADIUS).map(|d| (-(d as f64) / (2.0 * PLACE * PLACE)).exp() as f32).collect();
    let at = |x: usize, y: usize| {
        let k = 3 * (y * w + x);
        [raw[k], raw[k + 1], raw[k + 2]]
    };
    let mut out = Vec::with_capacity(3 * w * rows.len());
    for y in rows {
        cx.check()?;
        for x in 0..w {
            let own = at(x, y);
            let (mut sum, mut weight) = ([0.0f32; 3], 0.0f32);
            for v in y.saturating_sub(RADIUS)..(y + RADIUS + 1).min(h) {
                for u in x.saturating_sub(RADIUS)..(x + RADIUS + 1).min(w) {
                    let other = at(u, v);
                    let step = |c: usize| usize::from(own[c].abs_diff(other[c])).pow(2);
                    let near = place[u.abs_diff(x).pow(2) + v.abs_diff(y).pow(2)];
                    let alike = near * table[(step(0) + step(1) + step(2)) / STEP];
                    (0..3).for_each(|c| sum[c] += alike * f32::from(other[c]));
                    weight += alike;
                }
            }
            // A pixel is alike to itself, so the weight is never nothing.
            out.extend(sum.map(|s| s / weight));
        }
    }
    Ok(out)
}
