//! One photo registered with the next.
//!
//! What is compared is detail: the level less the mean of a window around it, so that neither
//! exposure nor a lens that is darker at its corners, nor a slow change of light passes for a
//! match. Phase correlation on halved pictures gives candidates; those that fit best are refined
//! there, the best of them on the halved pictures up to the photos themselves. The last refinement
//! is by the levels: at the border of a photo the window is one-sided, and detail is biased.

use super::align::{ShiftFit, fits, refined};
use super::camera::CylinderCamera;
use super::phase::candidates;
use crate::picture::GreyPlane;
use toile_core::{Context, StageError};

/// Photos are registered at most this long, px: a tenth of a pixel there is half a pixel of a photo
/// of 12 megapixels.
pub(super) const LONGEST_PX: usize = 2048;
/// Candidates are sought on pictures at most this long, and half as long as the photos, px.
const SEARCH_PX: usize = 256;
/// The window of the mean: its half side is the longer side divided by this.
const WINDOW: usize = 12;
/// Candidates that are refined, those first that fit best as they are.
const REFINED: usize = 3;
/// How far the refinement by levels may move a shift, px.
const NEAR_PX: f64 = 2.0;
/// The least share of a photo that the next one shows too.
const LEAST_OVERLAP: f64 = 0.08;
/// The least correlation of two photos that overlap.
const LEAST_LIKENESS: f64 = 0.5;

/// A photo as it is registered: halved until it is short enough.
#[derive(Debug)]
pub(super) struct HalvedPhoto {
    /// How often it was halved.
    pub(super) halvings: u32,
    /// Candidates are sought on a picture at most so long, px.
    search: usize,
    plane: GreyPlane,
}

impl HalvedPhoto {
    /// Of a photo, at most `longest` px long.
    ///
    /// # Errors
    /// When the run has been stopped.
    pub(super) fn new(
        photo: &image::RgbImage,
        longest: usize,
        cx: &Context,
    ) -> Result<HalvedPhoto, StageError> {
        let search = SEARCH_PX.min(longest.div_ceil(2));
        let (mut plane, mut halvings) = (GreyPlane::of(photo, cx)?, 0);
        while plane.width.max(plane.height) > longest {
            cx.check()?;
            (plane, halvings) = (plane.half(), halvings + 1);
        }
        Ok(HalvedPhoto { halvings, search, plane })
    }

    /// Its detail on the cylinder, from the finest picture to the coarsest.
    fn unrolled(&self, camera: CylinderCamera, cx: &Context) -> Result<UnrolledPhoto, StageError> {
        let raw = camera.halved(self.halvings).unrolled(&self.plane);
        cx.check()?;
        let mut levels = vec![detail(&raw)];
        while let Some(last) = levels.last().filter(|l| l.width.max(l.height) > self.search) {
            cx.check()?;
            levels.push(last.half());
        }
        Ok(UnrolledPhoto { raw, levels })
    }
}

/// A photo on the cylinder.
struct UnrolledPhoto {
    /// Its levels.
    raw: GreyPlane,
    /// Its detail, halved again and again.
    levels: Vec<GreyPlane>,
}

/// Where the second photo lies from the first on the cylinder, px of the photos; none where they do
/// not overlap.
///
/// # Errors
/// When the run has been stopped.
pub(super) fn register(
    a: &HalvedPhoto,
    b: &HalvedPhoto,
    camera: CylinderCamera,
    cx: &Context,
) -> Result<Option<ShiftFit>, StageError> {
    let (a_levels, b_levels) = (a.unrolled(camera, cx)?, b.unrolled(camera, cx)?);
    cx.check()?;
    let (Some(coarse_a), Some(coarse_b)) = (a_levels.levels.last(), b_levels.levels.last()) else {
        return Ok(None);
    };
    let found = candidates(coarse_a, coarse_b);
    cx.check()?;
    let starts = found.into_iter().map(|s| s.map(f64::from));
    let mut starts: Vec<ShiftFit> =
        starts.filter_map(|s| fits(coarse_a, coarse_b, s)).filter(|f| f.overlap >= LEAST_OVERLAP).collect();
    starts.sort_by(|a, b| evidence(b).total_cmp(&evidence(a)));
    let mut best: Option<ShiftFit> = None;
    for start in starts.iter().take(REFINED) {
        let Some(fit) = refined(coarse_a, coarse_b, start.shift, LEAST_OVERLAP, cx)? else { continue };
        if best.is_none_or(|b| evidence(&fit) > evidence(&b)) {
            best = Some(fit);
        }
    }
    for (a, b) in a_levels.levels.iter().zip(&b_levels.levels).rev().skip(1) {
        let Some(fit) = best else { return Ok(None) };
        best = refined(a, b, fit.shift.map(|s| 2.0 * s), LEAST_OVERLAP, cx)?;
    }
    let Some(fit) = best.filter(|f| f.likeness >= LEAST_LIKENESS) else { return Ok(None) };
    let by_level = refined(&a_levels.raw, &b_levels.raw, fit.shift, LEAST_OVERLAP, cx)?;
    // What moves the shift by more than pixels is no refinement: a slow change of light.
    let near = |f: &ShiftFit| (f.shift[0] - fit.shift[0]).hypot(f.shift[1] - fit.shift[1]) < NEAR_PX;
    let ShiftFit { shift, residual, .. } = by_level.filter(near).unwrap_or(fit);
    let factor = f64::from(2u32.pow(a.halvings));
    Ok(Some(ShiftFit { shift: shift.map(|s| s * factor), residual, ..fit }))
}

/// How unlikely a likeness over so many pixels is by chance (Fisher's z).
fn evidence(fit: &ShiftFit) -> f64 {
    fit.likeness.clamp(-0.999_99, 0.999_99).atanh() * fit.overlap.sqrt()
}

/// The level less the mean of the seen pixels in a window around.
fn detail(plane: &GreyPlane) -> GreyPlane {
    let radius = (plane.width.max(plane.height) / WINDOW).max(2);
    let (w, h) = (plane.width, plane.height);
    // Sums of levels and counts above and left of each pixel's corner.
    let mut sums = vec![[0f64; 2]; (w + 1) * (h + 1)];
    for y in 0..h {
        let mut line = [0f64; 2];
        for x in 0..w {
            let k = y * w + x;
            if plane.seen[k] {
                line = [line[0] + f64::from(plane.levels[k]), line[1] + 1.0];
            }
            let above = sums[y * (w + 1) + x + 1];
            sums[(y + 1) * (w + 1) + x + 1] = [above[0] + line[0], above[1] + line[1]];
        }
    }
    let mean = |x: usize, y: usize| {
        let (x0, x1) = (x.saturating_sub(radius), (x + radius + 1).min(w));
        let (y0, y1) = (y.saturating_sub(radius), (y + radius + 1).min(h));
        let at = |x: usize, y: usize| sums[y * (w + 1) + x];
        let of = |c: usize| at(x1, y1)[c] - at(x0, y1)[c] - at(x1, y0)[c] + at(x0, y0)[c];
        of(0) / of(1).max(1.0)
    };
    let level = |k: usize| if plane.seen[k] { plane.levels[k] - mean(k % w, k / w) as f32 } else { 0.0 };
    GreyPlane { width: w, height: h, levels: (0..w * h).map(level).collect(), seen: plane.seen.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_change_of_light_is_no_detail() {
        let levels = (0..100 * 80).map(|k| (k % 100) as f32 + 0.5 * (k / 100) as f32);
        let plane = GreyPlane { width: 100, height: 80, levels: levels.collect(), seen: vec![true; 8000] };
        let detail = detail(&plane);
        assert!(detail.levels[40 * 100 + 50].abs() < 1e-3, "{}", detail.levels[4050]);
        assert!(detail.levels.iter().all(|l| l.abs() < 7.0));
    }
}
