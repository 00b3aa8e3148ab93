//! Roberts's edge detector.
//!
//! Method: the two diagonal differences of 2 x 2 pixels (L. Roberts, *Machine perception of
//! three-dimensional solids*, 1963); an edge is a ridge of their root sum of squares over a
//! threshold. The operator is centred between four pixels, which is taken into account. Cost: about
//! 8 ns per pixel of the band. Limits: the smallest operator, and so the one that noise misleads
//! most.

use super::band::{PicturePatch, TileBand};
use super::operator::{Accept, Operator, OperatorResponse};
use super::outline::detect;
use image::RgbImage;
use toile_core::prelude::*;

/// Finds the outline at the ridges of Roberts's cross.
#[stage(
    role = EdgeDetector,
    source = "L. Roberts, 1963",
    example = "Roberts(threshold: 12)",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, ScaleEquivariant, RefusesEmpty)
)]
pub struct Roberts {
    /// Gradient that counts as an edge.
    #[param(default = 12.0, min = 0.0, max = 400.0, unit = "1.4 × grey levels a pixel")]
    threshold: f64,
}

#[stage]
impl Roberts {
    pub(crate) fn run(&self, photo: &Photo, mask: &Mask, cx: &Context) -> Result<Outline, StageError> {
        detect(self, photo, mask, cx)
    }
}

impl Operator for Roberts {
    fn respond<'a>(&self, photo: &RgbImage, band: &'a TileBand) -> OperatorResponse<'a> {
        let tiles = band.map(photo, 1, |grey| cross(&grey));
        OperatorResponse::Ridge {
            signal: band.plane(tiles),
            accept: Accept::Above(self.threshold),
            centre: 0.5,
        }
    }
}

/// The cross of a patch; the result is smaller by one pixel on each side.
fn cross(grey: &PicturePatch) -> PicturePatch {
    let (n, side) = (grey.side, grey.side - 2);
    let at = |k: usize| {
        let i = (k / side + 1) * n + k % side + 1;
        let [a, b, c, d] = [i, i + 1, i + n, i + n + 1].map(|i| grey.data[i]);
        (a - d).hypot(b - c)
    };
    PicturePatch { side, data: (0..side * side).map(at).collect() }
}
