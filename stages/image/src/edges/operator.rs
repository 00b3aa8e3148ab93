//! What an edge operator sees around the boundary, and the kernels the operators are made of.

use super::band::{BandPicture, PicturePatch, TileBand};
use image::RgbImage;

/// An operator's answer in the band.
pub(crate) enum OperatorResponse<'a> {
    /// An edge is a ridge of the signal.
    Ridge {
        /// Gradient magnitude.
        signal: BandPicture<'a>,
        /// What counts as an edge.
        accept: Accept<'a>,
        /// Where the operator is centred, pixels right of and below its pixel.
        centre: f64,
    },
    /// An edge is a zero crossing of the signal.
    ZeroCrossing {
        /// Second derivative.
        signal: BandPicture<'a>,
        /// The least change of the signal over a pixel, grey levels a pixel squared.
        least: f64,
    },
}

/// Which ridges are edges.
pub(crate) enum Accept<'a> {
    /// All that reach a level.
    Above(f64),
    /// Those within a pixel of a marked one.
    Marked(BandPicture<'a>),
}

/// An edge operator.
pub(crate) trait Operator: Sync {
    /// Evaluates it in the band.
    fn respond<'a>(&self, photo: &RgbImage, band: &'a TileBand) -> OperatorResponse<'a>;

    /// By how much the smoothing window along the outline is longer than usual.
    fn smooth(&self) -> f64 {
        1.0
    }
}

/// Samples of a Gaussian that sum to 1, three standard deviations to each side.
pub(crate) fn gaussian(sigma: f64) -> Vec<f32> {
    let r = (3.0 * sigma).ceil().max(1.0) as i64;
    let weights: Vec<f64> = (-r..=r).map(|i| (-((i * i) as f64) / (2.0 * sigma * sigma)).exp()).collect();
    let total: f64 = weights.iter().sum();
    weights.iter().map(|w| (w / total) as f32).collect()
}

/// Central difference along one axis, smoothed by `across` on the other: Sobel's (1, 2, 1) or
/// Prewitt's (1, 1, 1).
pub(crate) fn gradient(grey: &PicturePatch, across: [f32; 3]) -> (PicturePatch, PicturePatch) {
    let difference = [-1.0, 0.0, 1.0];
    (grey.separable(&difference, &across), grey.separable(&across, &difference))
}

/// A ridge operator without hysteresis: gradient magnitude of 3 x 3 kernels over a threshold.
pub(crate) fn plain_ridge<'a>(
    photo: &RgbImage,
    band: &'a TileBand,
    across: [f32; 3],
    threshold: f64,
) -> OperatorResponse<'a> {
    let tiles = band.map(photo, 1, |grey| {
        let (gx, gy) = gradient(&grey, across);
        gx.zip(&gy, f32::hypot)
    });
    OperatorResponse::Ridge { signal: band.plane(tiles), accept: Accept::Above(threshold), centre: 0.0 }
}
