//! Otsu's threshold: the one that splits the grey levels into two classes furthest apart.
//!
//! It maximises the variance between the classes (Otsu, A threshold selection method from
//! gray-level histograms, IEEE SMC 9(1), 1979). At the maximum the threshold lies half-way between
//! the classes' means, where also the boundary of a blurred edge lies, so that the mask is not
//! biased outwards or inwards. Where an empty valley gives many thresholds of the same variance,
//! its middle is taken.
//!
//! Cost: three looks at every pixel; 12 megapixels take about 50 ms on two cores. Limits: one
//! threshold for the whole photo, on grey levels alone: fails on patterned grounds, strong shadows
//! and garments of the ground's tone. `Background` and `GraphCut` look at colour.

use super::finish::{CleanUp, mask_of, no_garment};
use super::global::global;
use super::tone::{Polarity, histogram, luma};
use image::GrayImage;
use toile_core::prelude::*;

/// Splits the photo at the grey level that parts garment and ground best.
///
/// For a garment on a plain ground that is clearly lighter or darker. Transparent pixels are
/// ground.
#[stage(
    role = Binariser,
    version = 2,
    source = "Otsu, 1979",
    example = "Otsu(bias: 3)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Otsu {
    /// Added to the threshold that was found.
    #[param(default = 0.0, min = -128.0, max = 128.0, unit = "grey levels")]
    pub bias: f64,
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

/// Classes nearer than this, in grey levels, are one tone with noise.
const LEAST_CONTRAST: f64 = 10.0;

#[stage]
impl Otsu {
    pub(crate) fn run(&self, photo: &Photo, cx: &Context) -> Result<Mask, StageError> {
        let settings = CleanUp {
            open: self.open,
            close: self.close,
            holes: self.holes,
            touch: self.touch,
            next: "`GraphCut()`",
        };
        mask_of(photo, settings, cx, || self.raw(photo, cx))
    }

    /// What lies on the garment's side of the threshold.
    fn raw(&self, photo: &Photo, cx: &Context) -> Result<GrayImage, StageError> {
        let grey = luma(&photo.pixels);
        cx.check()?;
        let split = otsu(&histogram(&grey, photo.alpha.as_deref()));
        let Some(split) = split.filter(|s| s.contrast >= LEAST_CONTRAST) else {
            let contrast = split.map_or(0.0, |s| s.contrast);
            return Err(no_garment(
                photo,
                &format!("its two tones differ by {contrast:.0} grey levels only"),
                "`GraphCut()`",
            ));
        };
        let threshold = (f64::from(split.threshold) + self.bias).round().clamp(0.0, 254.0);
        cx.figure("threshold", threshold, "grey levels");
        cx.figure("contrast", split.contrast, "grey levels");
        cx.figure("separability", split.separability, "");
        Ok(global(&grey, photo, threshold as u8, self.garment))
    }
}

/// A histogram parted in two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Split {
    /// The last level of the dark class.
    pub threshold: u8,
    /// Distance of the classes' means, levels.
    pub contrast: f64,
    /// Variance between the classes over the whole variance: 1 for two pure tones.
    pub separability: f64,
}

/// Otsu's split of a histogram; `None` where fewer than two levels occur.
pub fn otsu(bins: &[u64; 256]) -> Option<Split> {
    let total = bins.iter().sum::<u64>() as f64;
    let sum = bins.iter().zip(0u64..).map(|(&n, v)| (n * v) as f64).sum::<f64>();
    let (mut below, mut below_sum) = (0.0, 0.0);
    let mut best: Option<(f64, f64, usize, usize)> = None;
    for (t, &n) in bins[..255].iter().enumerate() {
        below += n as f64;
        below_sum += (n * t as u64) as f64;
        let above = total - below;
        if below == 0.0 || above == 0.0 {
            continue;
        }
        let contrast = (sum - below_sum) / above - below_sum / below;
        let between = below * above * contrast * contrast;
        best = match best {
            // An empty level leaves the variance as it was, to the bit.
            Some((b, c, first, _)) if between == b => Some((b, c, first, t)),
            Some(old) if between < old.0 => Some(old),
            _ => Some((between, contrast, t, t)),
        };
    }
    let (between, contrast, first, last) = best?;
    let mean = sum / total;
    let spread = bins.iter().enumerate().map(|(v, &n)| n as f64 * (v as f64 - mean).powi(2)).sum::<f64>();
    let separability = between / total / spread;
    Some(Split { threshold: ((first + last) / 2) as u8, contrast, separability })
}
