//! The Laplacian.
//!
//! Method: zero crossings of the four-neighbour Laplacian (A. Rosenfeld and A. Kak, 1976). Cost:
//! about 10 ns a pixel of the band. Limits: a second derivative without smoothing answers to grain
//! first; it needs a denoiser before it.

use super::band::{PicturePatch, TileBand};
use super::operator::{Operator, OperatorResponse};
use super::outline::detect;
use image::RgbImage;
use toile_core::prelude::*;

/// Finds the outline at the zero crossings of the Laplacian.
///
/// The plainest of the operators and the most easily misled: put a denoiser before it.
#[stage(
    role = EdgeDetector,
    source = "A. Rosenfeld and A. Kak, 1976",
    example = "Laplacian(threshold: 6)",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, ScaleEquivariant, RefusesEmpty)
)]
pub struct Laplacian {
    /// Change of the signal over one pixel at a zero crossing that counts as an edge.
    #[param(default = 6.0, min = 0.0, max = 2000.0, unit = "grey levels a pixel squared")]
    threshold: f64,
}

#[stage]
impl Laplacian {
    pub(crate) fn run(&self, photo: &Photo, mask: &Mask, cx: &Context) -> Result<Outline, StageError> {
        detect(self, photo, mask, cx)
    }
}

impl Operator for Laplacian {
    fn respond<'a>(&self, photo: &RgbImage, band: &'a TileBand) -> OperatorResponse<'a> {
        let tiles = band.map(photo, 1, |grey: PicturePatch| {
            let (one, second) = ([0.0, 1.0, 0.0], [1.0, -2.0, 1.0]);
            grey.separable(&second, &one).zip(&grey.separable(&one, &second), |a, b| a + b)
        });
        OperatorResponse::ZeroCrossing { signal: band.plane(tiles), least: self.threshold }
    }
}
