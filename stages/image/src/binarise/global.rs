//! A fixed threshold: `F = 255 if f > T else 0`.
//!
//! Cost: two looks at every pixel, about 10 ms for 12 megapixels on two cores. Limits: the
//! threshold holds for one light and one ground; `Otsu` finds it by itself.

use super::finish::{CleanUp, mask_of};
use super::tone::{Polarity, by_polarity, luma, mark};
use image::GrayImage;
use toile_core::prelude::*;

/// Splits the photo at a fixed grey level.
///
/// For a studio whose light and ground never change. Transparent pixels are ground.
#[stage(
    role = Binariser,
    version = 2,
    source = "Prewitt and Mendelsohn, 1966",
    example = "Global(threshold: 140)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Global {
    /// Levels above it are light.
    #[param(default = 128, min = 0, max = 254, unit = "grey levels")]
    pub threshold: u8,
    /// Whether the garment is darker or lighter than the ground; `Auto` looks at the frame's rim.
    #[param(default = Polarity::Auto)]
    pub garment: Polarity,
    /// Holes up to this share of the garment's area are filled.
    #[param(default = 0.2, min = 0.0, max = 1.0)]
    pub holes: f64,
    /// The garment may touch the frame over this share of the photo's shorter side.
    #[param(default = 0.05, min = 0.0, max = 4.0)]
    pub touch: f64,
    /// Specks and hairs thinner than this radius are taken off.
    #[param(default = 0, min = 0, max = 100, unit = "px")]
    pub open: u32,
    /// Gaps narrower than this radius are closed.
    #[param(default = 0, min = 0, max = 100, unit = "px")]
    pub close: u32,
}

#[stage]
impl Global {
    pub(crate) fn run(&self, photo: &Photo, cx: &Context) -> Result<Mask, StageError> {
        let settings = CleanUp {
            open: self.open,
            close: self.close,
            holes: self.holes,
            touch: self.touch,
            next: "`GraphCut()`",
        };
        mask_of(photo, settings, cx, || Ok(global(&luma(&photo.pixels), photo, self.threshold, self.garment)))
    }
}

/// The raw mask of a grey picture of `photo` at a threshold.
pub fn global(grey: &GrayImage, photo: &Photo, threshold: u8, garment: Polarity) -> GrayImage {
    by_polarity(mark(grey, |_, v| v <= threshold), photo, garment)
}
