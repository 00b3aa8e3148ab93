//! A mask found at a reduced size, brought to the photo's own size with its boundary set there.
//!
//! Away from the boundary the small mask is right. Within about a small pixel of it, every pixel is
//! judged by colour: the means F of the garment and B of the ground nearby give the pixel's share
//! of garment, a = (I - B).(F - B) / |F - B|^2, and the boundary lies where a is one half. Where
//! both colours vary more than they differ (a print, a rug) colour says little, and the smoothed
//! shape of the small mask decides; the Fisher ratio of the two blends from one to the other.
//!
//! Cost: only the band along the boundary is looked at pixel by pixel; 12 megapixels take about 20
//! ms.

use super::small::{Lab, SmallPhoto, lab};
use image::GrayImage;
use rayon::prelude::*;
use toile_core::prelude::*;

/// How far around a boundary pixel the colours of both sides are taken, small pixels.
const REACH: usize = 4;

/// Colours on both sides of the boundary near a small pixel.
#[derive(Debug, Clone, Copy)]
struct BoundaryColours {
    ground: Lab,
    /// (F - B) / |F - B|^2.
    toward: Lab,
    /// How far colour is to be trusted, 0 to 1.
    trust: f64,
}

/// The photo's mask from a small one.
pub(super) fn refine(
    photo: &Photo,
    small: &SmallPhoto,
    mask: &[bool],
    cx: &Context,
) -> Result<GrayImage, StageError> {
    let soft = soften(mask, small.w, small.h);
    let sides: Vec<Option<BoundaryColours>> = (0..mask.len())
        .into_par_iter()
        .map(|i| (soft[i] > 0.0 && soft[i] < 1.0).then(|| sides(small, mask, i)).flatten())
        .collect();
    let (w, h) = photo.pixels.dimensions();
    let mut out = GrayImage::new(w, h);
    out.par_chunks_mut(w as usize).enumerate().try_for_each(|(y, row)| {
        if y % 64 == 0 {
            cx.check()?;
        }
        MaskRow { photo, small, soft: &soft, sides: &sides, y }.fill(row);
        Ok::<(), StageError>(())
    })?;
    Ok(out)
}

/// The mask as shares, smoothed by the weights 1 2 1 both ways: one half lies on the boundary.
fn soften(mask: &[bool], w: usize, h: usize) -> Vec<f64> {
    let at = |x: usize, y: usize| f64::from(u8::from(mask[y * w + x]));
    let soft = |i: usize| {
        let (x, y) = (i % w, i / w);
        let xs = [x.saturating_sub(1), x, x, (x + 1).min(w - 1)];
        let ys = [y.saturating_sub(1), y, y, (y + 1).min(h - 1)];
        ys.iter().flat_map(|&y| xs.iter().map(move |&x| at(x, y))).sum::<f64>() / 16.0
    };
    (0..w * h).map(soft).collect()
}

fn sides(small: &SmallPhoto, mask: &[bool], i: usize) -> Option<BoundaryColours> {
    let (x, y) = (i % small.w, i / small.w);
    let (w, h) = (small.w, small.h);
    let (mut sum, mut square, mut count) = ([Lab::zeros(); 2], [0.0; 2], [0.0; 2]);
    for v in y.saturating_sub(REACH)..(y + REACH + 1).min(h) {
        for u in x.saturating_sub(REACH)..(x + REACH + 1).min(w) {
            let k = v * w + u;
            // Pixels on the boundary are mixed of both colours.
            let pure = [(u.wrapping_sub(1), v), (u + 1, v), (u, v.wrapping_sub(1)), (u, v + 1)]
                .iter()
                .all(|&(a, b)| a >= w || b >= h || mask[b * w + a] == mask[k]);
            if pure {
                let side = usize::from(mask[k]);
                sum[side] += small.lab[k];
                square[side] += small.lab[k].norm_squared();
                count[side] += 1.0;
            }
        }
    }
    if count[0] == 0.0 || count[1] == 0.0 {
        return None;
    }
    let mean = [sum[0] / count[0], sum[1] / count[1]];
    let variance = |s: usize| (square[s] / count[s] - mean[s].norm_squared()).max(0.0);
    let contrast = (mean[1] - mean[0]).norm_squared();
    if contrast == 0.0 {
        return None;
    }
    let trust = contrast / (contrast + variance(0) + variance(1) + NOISE);
    Some(BoundaryColours { ground: mean[0], toward: (mean[1] - mean[0]) / contrast, trust: trust * trust })
}

/// Variance of a pixel of the photo by itself, squared Lab units.
const NOISE: f64 = 9.0;

/// One row of the photo's mask.
struct MaskRow<'a> {
    photo: &'a Photo,
    small: &'a SmallPhoto,
    soft: &'a [f64],
    sides: &'a [Option<BoundaryColours>],
    y: usize,
}

impl MaskRow<'_> {
    /// Goes from one column of small pixels' centres to the next: between two that agree, above and
    /// below, all is one.
    fn fill(&self, row: &mut [u8]) {
        let (w, h) = (self.small.w, self.small.h);
        let v = ((self.y as f64 + 0.5) / self.small.scale.1 - 0.5).clamp(0.0, (h - 1) as f64);
        let (top, fy) = (v as usize, v.fract());
        let bottom = (top + 1).min(h - 1);
        // Down one column of small pixels.
        let column = |x: usize| (self.soft[top * w + x], self.soft[bottom * w + x]);
        for (x, out) in row.iter_mut().enumerate() {
            let u = ((x as f64 + 0.5) / self.small.scale.0 - 0.5).clamp(0.0, (w - 1) as f64);
            let (left, fx) = (u as usize, u.fract());
            let (a, b) = (column(left), column((left + 1).min(w - 1)));
            let share = (a.0 * (1.0 - fx) + b.0 * fx) * (1.0 - fy) + (a.1 * (1.0 - fx) + b.1 * fx) * fy;
            let on = match share {
                s if s <= 0.0 => false,
                s if s >= 1.0 => true,
                s => {
                    let near = (v.round() as usize) * w + u.round() as usize;
                    self.judge(s, near, x) > 0.5
                }
            };
            *out = if on { 255 } else { 0 };
        }
    }

    /// The garment's share of a pixel near the boundary.
    fn judge(&self, shape: f64, near: usize, x: usize) -> f64 {
        let Some(sides) = &self.sides[near] else { return shape };
        let p = self.photo.pixels.get_pixel(x as u32, self.y as u32).0;
        let colour = (lab(p.map(f64::from)) - sides.ground).dot(&sides.toward).clamp(0.0, 1.0);
        sides.trust * colour + (1.0 - sides.trust) * shape
    }
}
