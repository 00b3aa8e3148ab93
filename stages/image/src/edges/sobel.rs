//! Sobel's edge detector.
//!
//! Method: gradient by central differences, smoothed (1, 2, 1) across (I. Sobel and G. Feldman,
//! 1968); an edge is a ridge of its magnitude over a threshold. Cost: about 15 ns per pixel of the
//! band. Limits: no smoothing along the gradient, so weave and grain answer as well.

use super::band::TileBand;
use super::operator::{Operator, OperatorResponse, plain_ridge};
use super::outline::detect;
use image::RgbImage;
use toile_core::prelude::*;

/// Finds the outline at the ridges of Sobel's gradient.
///
/// Quicker than Canny and more easily misled by weave and grain: use it after a denoiser.
#[stage(
    role = EdgeDetector,
    source = "I. Sobel and G. Feldman, 1968",
    example = "Sobel(threshold: 60)",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, ScaleEquivariant, RefusesEmpty)
)]
pub struct Sobel {
    /// Gradient that counts as an edge.
    #[param(default = 60.0, min = 0.0, max = 2000.0, unit = "8 × grey levels a pixel")]
    threshold: f64,
}

#[stage]
impl Sobel {
    pub(crate) fn run(&self, photo: &Photo, mask: &Mask, cx: &Context) -> Result<Outline, StageError> {
        detect(self, photo, mask, cx)
    }
}

impl Operator for Sobel {
    fn respond<'a>(&self, photo: &RgbImage, band: &'a TileBand) -> OperatorResponse<'a> {
        plain_ridge(photo, band, [1.0, 2.0, 1.0], self.threshold)
    }
}
