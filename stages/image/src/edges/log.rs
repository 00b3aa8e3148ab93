//! The Laplacian of a Gaussian.
//!
//! Method: zero crossings of the second derivative of the smoothed picture (D. Marr and E.
//! Hildreth, *Theory of edge detection*, 1980), by two separable kernels, which is exact. Cost:
//! about 70 ns per pixel of the band. Limits: on curved rims zero crossings lie a little outside
//! the edge.

use super::band::{PicturePatch, TileBand};
use super::operator::{Operator, OperatorResponse, gaussian};
use super::outline::detect;
use image::RgbImage;
use toile_core::prelude::*;

/// Finds the outline at the zero crossings of the Laplacian of a Gaussian.
#[stage(
    role = EdgeDetector,
    source = "D. Marr and E. Hildreth, 1980",
    example = "LaplacianOfGaussian(sigma: 1.6)",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, ScaleEquivariant, RefusesEmpty)
)]
pub struct LaplacianOfGaussian {
    /// Standard deviation of the smoothing.
    #[param(default = 1.6, min = 0.3, max = 10.0, unit = "px", trades)]
    sigma: f64,
    /// Change of the signal over one pixel at a zero crossing that counts as an edge.
    #[param(default = 1.0, min = 0.0, max = 500.0, unit = "grey levels a pixel squared")]
    threshold: f64,
}

#[stage]
impl LaplacianOfGaussian {
    pub(crate) fn run(&self, photo: &Photo, mask: &Mask, cx: &Context) -> Result<Outline, StageError> {
        detect(self, photo, mask, cx)
    }
}

impl Operator for LaplacianOfGaussian {
    fn respond<'a>(&self, photo: &RgbImage, band: &'a TileBand) -> OperatorResponse<'a> {
        let (smooth, second) = (gaussian(self.sigma), second_derivative(self.sigma));
        let tiles: Vec<PicturePatch> = band.map(photo, smooth.len() / 2, |grey| {
            grey.separable(&second, &smooth).zip(&grey.separable(&smooth, &second), |a, b| a + b)
        });
        OperatorResponse::ZeroCrossing { signal: band.plane(tiles), least: self.threshold }
    }
}

/// The second derivative of the Gaussian's samples; their sum is made zero, so that an even picture
/// gives zero.
fn second_derivative(sigma: f64) -> Vec<f32> {
    let smooth = gaussian(sigma);
    let r = smooth.len() as f64 / 2.0 - 0.5;
    let raw: Vec<f64> = smooth
        .iter()
        .enumerate()
        .map(|(i, &g)| {
            let x = (i as f64 - r) / sigma;
            f64::from(g) * (x * x - 1.0) / (sigma * sigma)
        })
        .collect();
    let mean: f64 = raw.iter().sum::<f64>() / raw.len() as f64;
    raw.iter().map(|v| (v - mean) as f32).collect()
}
