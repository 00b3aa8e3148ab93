//! Canny's edge detector.
//!
//! Method (J. Canny, *A computational approach to edge detection*, 1986): Gaussian smoothing, Sobel
//! gradient, non-maximum suppression across the gradient, hysteresis between two thresholds. Its
//! edge pixels say where the garment ends; the place is then taken from the gradient's ridge to a
//! fraction of a pixel. Cost: about 60 ns per pixel of the band. Limits: corners are rounded by the
//! smoothing, and are put back as the intersection of their sides ([`super::corners`]).

use super::band::{BandPicture, PicturePatch, TileBand};
use super::operator::{Accept, Operator, OperatorResponse, gaussian, gradient};
use super::outline::detect;
use image::RgbImage;
use toile_core::prelude::*;

/// Finds the outline at the ridges of the smoothed gradient, with hysteresis (Canny 1986).
///
/// The most reliable of the operators: it answers once to an edge, and a weak stretch of rim counts
/// where it continues a strong one. Where no edge is seen the mask's own rim is kept.
#[stage(
    role = EdgeDetector,
    source = "J. Canny, 1986",
    example = "Canny(low: 20, high: 60)",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, ScaleEquivariant, RefusesEmpty)
)]
pub struct Canny {
    /// Gradient above which a pixel belongs to an edge that is strong elsewhere.
    #[param(default = 20.0, min = 0.0, max = 2000.0, unit = "Sobel units: 8 × grey levels a pixel")]
    low: f64,
    /// Gradient above which a pixel starts an edge.
    #[param(default = 60.0, min = 0.0, max = 2000.0, unit = "Sobel units: 8 × grey levels a pixel")]
    high: f64,
    /// Standard deviation of the smoothing: more quietens weave and grain but rounds detail off.
    #[param(default = 1.4, min = 0.3, max = 10.0, unit = "px", trades)]
    sigma: f64,
    /// How much smoother the outline is between its corners than the edge that was seen: 2 to 3
    /// smooths the ragged rim of a small photo, 1 keeps every wave.
    #[param(default = 3.0, min = 0.5, max = 6.0)]
    smooth: f64,
}

#[stage]
impl Canny {
    pub(crate) fn run(&self, photo: &Photo, mask: &Mask, cx: &Context) -> Result<Outline, StageError> {
        self.ordered()?;
        detect(self, photo, mask, cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.ordered().err().into_iter().collect()
    }

    fn ordered(&self) -> Result<(), StageError> {
        if self.low > self.high {
            let text = format!("`low` is {}, above `high`, which is {}", self.low, self.high);
            return Err(StageError::new(ErrorCode::InvalidParameter, text)
                .hint("an edge starts above `high` and goes on above `low`")
                .at("low"));
        }
        Ok(())
    }
}

impl Operator for Canny {
    fn smooth(&self) -> f64 {
        self.smooth
    }

    fn respond<'a>(&self, photo: &RgbImage, band: &'a TileBand) -> OperatorResponse<'a> {
        let kernel = gaussian(self.sigma);
        let halo = kernel.len() / 2 + 2;
        let (ridges, thin): (Vec<PicturePatch>, Vec<PicturePatch>) = band
            .map(photo, halo, |grey| {
                let (gx, gy) = gradient(&grey.separable(&kernel, &kernel), [1.0, 2.0, 1.0]);
                let magnitude = gx.zip(&gy, f32::hypot);
                let thin = non_maximum_suppression(&magnitude, &gx, &gy);
                (magnitude.core(1), thin)
            })
            .into_iter()
            .unzip();
        let edges = hysteresis(band, &band.plane(thin), self.low as f32, self.high as f32);
        OperatorResponse::Ridge { signal: band.plane(ridges), accept: Accept::Marked(edges), centre: 0.0 }
    }
}

/// Keeps a magnitude only where it is the greatest across the edge; neighbours are interpolated in
/// the direction of the gradient. The result is smaller by one pixel on each side.
fn non_maximum_suppression(magnitude: &PicturePatch, gx: &PicturePatch, gy: &PicturePatch) -> PicturePatch {
    let n = magnitude.side;
    let keep = |i: usize| {
        let m = magnitude.data[i];
        let (dx, dy) = (gx.data[i], gy.data[i]);
        let steep = dy.abs() > dx.abs();
        let (long, short) = if steep { (dy, dx) } else { (dx, dy) };
        let share = if long == 0.0 { 0.0 } else { (short / long).abs() };
        // Steps along the main axis and across it, towards the gradient.
        let main = if steep { n as i64 } else { 1 };
        let side = if steep { 1 } else { n as i64 };
        let side = if (short < 0.0) == (long < 0.0) { side } else { -side };
        let at = |offset: i64| magnitude.data[(i as i64 + offset) as usize];
        let ahead = at(main) * (1.0 - share) + at(main + side) * share;
        let behind = at(-main) * (1.0 - share) + at(-main - side) * share;
        // On a plateau of two the first one stays.
        if m > behind && m >= ahead { m } else { 0.0 }
    };
    let side = n - 2;
    let data = (0..side * side).map(|k| keep((k / side + 1) * n + k % side + 1)).collect();
    PicturePatch { side, data }
}

/// Marks what is above `low` and connected (8 neighbours) with something above `high`.
fn hysteresis<'a>(band: &'a TileBand, thin: &BandPicture<'a>, low: f32, high: f32) -> BandPicture<'a> {
    let mut marked = band.blank();
    let mut todo: Vec<[usize; 2]> = Vec::new();
    let [w, h] = band.size();
    for [x, y] in band.pixels() {
        if thin.at(x as i64, y as i64) > high {
            marked.set(x, y, 1.0);
            todo.push([x, y]);
        }
    }
    while let Some([x, y]) = todo.pop() {
        for ny in y.saturating_sub(1)..=(y + 1).min(h - 1) {
            for nx in x.saturating_sub(1)..=(x + 1).min(w - 1) {
                let (i, j) = (nx as i64, ny as i64);
                if thin.at(i, j) > low && marked.at(i, j) == 0.0 {
                    marked.set(nx, ny, 1.0);
                    todo.push([nx, ny]);
                }
            }
        }
    }
    marked
}
