//! Ridges of the colour gradient, without its sign.
//!
//! The structure tensor of the three channels (Di Zenzo, A note on the gradient of a multi-image,
//! CVGIP 33, 1986) gives at each pixel the direction of the strongest change and its size; a pixel
//! is on a ridge where the size is largest across the edge (Canny, 1986). An edge whose contrast
//! changes sign along it stays one.
//!
//! Cost: about 40 ns a pixel.

use crate::pixels::{ReducedPhoto, Rgb};
use nalgebra::Point2;
use rayon::prelude::*;

/// Size and direction of the colour gradient.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Slope {
    /// Grey levels a pixel.
    pub(crate) size: f32,
    /// Cosine and sine of twice the direction's angle, so that opposite directions are one.
    pub(crate) twice: [f32; 2],
}

/// Slopes of all pixels, and which of them are ridges.
#[derive(Debug)]
pub(crate) struct SlopeRidges {
    pub(crate) w: usize,
    pub(crate) h: usize,
    pub(crate) slopes: Vec<Slope>,
    pub(crate) on: Vec<bool>,
}

impl SlopeRidges {
    /// Ridges of at least `least` grey levels a pixel.
    pub(crate) fn of(small: &ReducedPhoto, least: f32) -> Self {
        let (w, h) = (small.w, small.h);
        let mut slopes = vec![Slope::default(); w * h];
        slopes.par_chunks_mut(w.max(1)).enumerate().for_each(|(y, row)| {
            if y > 0 && y + 1 < h {
                (1..w.saturating_sub(1)).for_each(|x| row[x] = slope(small, x, y));
            }
        });
        let mut on = vec![false; w * h];
        on.par_chunks_mut(w.max(1)).enumerate().for_each(|(y, row)| {
            if y > 1 && y + 2 < h {
                (2..w.saturating_sub(2)).for_each(|x| row[x] = is_ridge(&slopes, w, y * w + x, least));
            }
        });
        SlopeRidges { w, h, slopes, on }
    }

    /// Whether the nearest pixel is on a ridge whose direction across, as `Slope::twice`, is like
    /// `twice`.
    pub(crate) fn along(&self, p: Point2<f64>, twice: [f32; 2]) -> bool {
        let (x, y) = (p.x.round(), p.y.round());
        if !(x >= 0.0 && y >= 0.0 && x < self.w as f64 && y < self.h as f64) {
            return false;
        }
        let i = y as usize * self.w + x as usize;
        self.on[i] && self.slopes[i].twice[0] * twice[0] + self.slopes[i].twice[1] * twice[1] > 0.7
    }
}

/// Slope at an inner pixel, by differences smoothed across (Scharr, 2000).
fn slope(small: &ReducedPhoto, x: usize, y: usize) -> Slope {
    let (w, i) = (small.w, y * small.w + x);
    let at = |j: usize| -> &Rgb { &small.rgb[j] };
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for c in 0..3 {
        let side = |j: usize| 3.0 * at(j - w)[c] + 10.0 * at(j)[c] + 3.0 * at(j + w)[c];
        let level = |j: usize| 3.0 * at(j - 1)[c] + 10.0 * at(j)[c] + 3.0 * at(j + 1)[c];
        let (dx, dy) = ((side(i + 1) - side(i - 1)) / 32.0, (level(i + w) - level(i - w)) / 32.0);
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    of_tensor(xx, xy, yy)
}

fn of_tensor(xx: f32, xy: f32, yy: f32) -> Slope {
    let (difference, cross) = (xx - yy, 2.0 * xy);
    let root = (difference * difference + cross * cross).sqrt();
    let size = ((xx + yy + root) / 2.0).sqrt();
    if root > 0.0 { Slope { size, twice: [difference / root, cross / root] } } else { Slope::default() }
}

/// Whether the slope is the largest across the edge.
fn is_ridge(slopes: &[Slope], w: usize, i: usize, least: f32) -> bool {
    let s = slopes[i];
    if s.size < least {
        return false;
    }
    // The nearest of four directions across the edge.
    let step = if s.twice[0].abs() > s.twice[1].abs() {
        if s.twice[0] > 0.0 { 1 } else { w }
    } else if s.twice[1] > 0.0 {
        w + 1
    } else {
        w - 1
    };
    s.size >= slopes[i - step].size && s.size > slopes[i + step].size
}
