//! A threshold of its own for every pixel, from the window around it.
//!
//! `Mean`: the window's mean less an offset. `Sauvola`: `T = m (1 + k (s / 128 - 1))` with the
//! window's mean m and standard deviation s (Sauvola and Pietikainen, Adaptive document image
//! binarization, Pattern Recognition 33, 2000), for a dark garment; a light one is looked at as its
//! negative.
//!
//! Cost: tables of running sums, 12 bytes a pixel; 12 megapixels take about 0.12 s on two cores.
//! Limits: made for uneven light. The window must be wider than what it parts: inside a garment
//! that is wider than the window only its edge is found, and the inside is closed as a hole.

use super::finish::{CleanUp, mask_of};
use super::tone::{Polarity, histogram, luma, rim_share};
use image::GrayImage;
use rayon::prelude::*;
use toile_core::prelude::*;

/// How the window gives the threshold.
#[choice]
#[derive(Copy)]
pub enum LocalMethod {
    /// The window's mean less an offset, grey levels.
    Mean {
        /// Taken off the mean; keeps plain ground from being split by its noise.
        offset: f64,
    },
    /// By mean and deviation.
    Sauvola {
        /// How much a flat window lowers the threshold: 0 for the mean, 0.5 at most.
        k: f64,
    },
}

/// Splits the photo at a threshold that follows the light.
///
/// For a plain ground under uneven light. Transparent pixels are ground.
#[stage(
    role = Binariser,
    version = 2,
    source = "Sauvola and Pietikainen, 2000",
    example = "Local(method: Sauvola(k: 0.1), radius: 0.4)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Local {
    /// How the window gives the threshold.
    #[param(default = LocalMethod::Mean { offset: 8.0 }, min = -128.0, max = 128.0)]
    pub method: LocalMethod,
    /// Half the window's side as a share of the photo's shorter side; at most 2,000 px.
    #[param(default = 0.4, min = 0.005, max = 0.5)]
    pub radius: f64,
    /// Whether the garment is darker or lighter than the ground; `Auto` looks at the frame's rim.
    #[param(default = Polarity::Auto)]
    pub garment: Polarity,
    /// Holes up to this share of the garment's area are filled.
    #[param(default = 1.0, min = 0.0, max = 1.0)]
    pub holes: f64,
    /// The garment may touch the frame over this share of the photo's shorter side.
    #[param(default = 0.05, min = 0.0, max = 4.0)]
    pub touch: f64,
    /// Specks and hairs thinner than this radius are taken off.
    #[param(default = 0, min = 0, max = 100, unit = "px")]
    pub open: u32,
    /// Gaps narrower than this radius are closed.
    #[param(default = 2, min = 0, max = 100, unit = "px")]
    pub close: u32,
}

/// The widest window: its sums still fit 32 bits.
const MAX_RADIUS_PX: u32 = 2000;

#[stage]
impl Local {
    pub(crate) fn run(&self, photo: &Photo, cx: &Context) -> Result<Mask, StageError> {
        let settings = CleanUp {
            open: self.open,
            close: self.close,
            holes: self.holes,
            touch: self.touch,
            next: "`GraphCut()`",
        };
        mask_of(photo, settings, cx, || {
            let grey = luma(&photo.pixels);
            let dark = is_dark(&grey, photo, self.garment);
            let (w, h) = grey.dimensions();
            let radius = ((f64::from(w.min(h)) * self.radius).round() as u32).clamp(1, MAX_RADIUS_PX);
            let grey = if dark { grey } else { negative(grey) };
            local(&grey, self.method, radius as usize, cx)
        })
    }
}

/// Whether the garment is the darker one: by the rim's level against the whole photo's mean.
fn is_dark(grey: &GrayImage, photo: &Photo, garment: Polarity) -> bool {
    match garment {
        Polarity::Dark => true,
        Polarity::Light => false,
        Polarity::Auto => {
            let bins = histogram(grey, photo.alpha.as_deref());
            let threshold = super::otsu::otsu(&bins).map_or(128, |s| s.threshold);
            rim_share(grey, photo.alpha.as_deref(), |v| v <= threshold) < 0.5
        }
    }
}

fn negative(mut grey: GrayImage) -> GrayImage {
    grey.par_iter_mut().for_each(|v| *v = !*v);
    grey
}

/// Marks what is darker than its window (radius 1 to 2,000 px) asks for; past the frame the window
/// ends.
pub fn local(
    grey: &GrayImage,
    method: LocalMethod,
    radius: usize,
    cx: &Context,
) -> Result<GrayImage, StageError> {
    let (w, h) = (grey.width() as usize, grey.height() as usize);
    let needs_squares = matches!(method, LocalMethod::Sauvola { .. });
    let sums = Totals::<u32>::of(grey, u32::from);
    cx.check()?;
    let squares = needs_squares.then(|| Totals::<u64>::of(grey, |v| u64::from(v) * u64::from(v)));
    cx.check()?;
    let mut out = GrayImage::new(grey.width(), grey.height());
    out.par_chunks_mut(w.max(1)).enumerate().try_for_each(|(y, row)| {
        if y % 64 == 0 {
            cx.check()?;
        }
        let (top, bottom) = (y.saturating_sub(radius), (y + radius + 1).min(h));
        for (x, out) in row.iter_mut().enumerate() {
            let (left, right) = (x.saturating_sub(radius), (x + radius + 1).min(w));
            let count = ((bottom - top) * (right - left)) as f64;
            let mean = f64::from(sums.window(left, top, right, bottom)) / count;
            let threshold = match (method, &squares) {
                (LocalMethod::Sauvola { k }, Some(squares)) => {
                    let square = squares.window(left, top, right, bottom) as f64 / count;
                    mean * (1.0 + k * ((square - mean * mean).max(0.0).sqrt() / 128.0 - 1.0))
                }
                (LocalMethod::Mean { offset }, _) => mean - offset,
                (LocalMethod::Sauvola { .. }, None) => mean,
            };
            *out = if f64::from(grey.as_raw()[y * w + x]) < threshold { 255 } else { 0 };
        }
        Ok::<(), StageError>(())
    })?;
    Ok(out)
}

/// Whole numbers that wrap around: a difference of two sums is right as long as it fits itself.
trait Wrapping: Copy + Default + Send + Sync {
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
}

impl Wrapping for u32 {
    fn plus(self, other: Self) -> Self {
        self.wrapping_add(other)
    }
    fn minus(self, other: Self) -> Self {
        self.wrapping_sub(other)
    }
}

impl Wrapping for u64 {
    fn plus(self, other: Self) -> Self {
        self.wrapping_add(other)
    }
    fn minus(self, other: Self) -> Self {
        self.wrapping_sub(other)
    }
}

/// Sums over all rectangles from the top left corner (Crow, Summed-area tables, SIGGRAPH 1984).
struct Totals<T> {
    stride: usize,
    sums: Vec<T>,
}

impl<T: Wrapping> Totals<T> {
    fn of(grey: &GrayImage, value: impl Fn(u8) -> T + Sync) -> Self {
        let (w, h) = (grey.width() as usize, grey.height() as usize);
        let stride = w + 1;
        let mut sums = vec![T::default(); stride * (h + 1)];
        sums[stride..].par_chunks_mut(stride).zip(grey.par_chunks(w.max(1))).for_each(|(out, row)| {
            for (x, &v) in row.iter().enumerate() {
                out[x + 1] = out[x].plus(value(v));
            }
        });
        for y in 1..=h {
            let (above, row) = sums.split_at_mut(y * stride);
            let above = &above[(y - 1) * stride..];
            row[..stride].iter_mut().zip(above).for_each(|(s, &a)| *s = s.plus(a));
        }
        Totals { stride, sums }
    }

    fn window(&self, left: usize, top: usize, right: usize, bottom: usize) -> T {
        let at = |x: usize, y: usize| self.sums[y * self.stride + x];
        at(right, bottom).minus(at(left, bottom)).minus(at(right, top)).plus(at(left, top))
    }
}
