//! The focal length, from the photos.
//!
//! On the cylinder of the right radius the overlap of two photos is the same picture; on another it
//! is stretched. The radius with the least difference over the pairs is sought among angles of view
//! (golden section around the best of a row of them). Where the photos go all around, the sum of
//! their shifts is `2 pi f`, which is far more exact (Szeliski, Shum 1997); `cylinder` does that.
//! Limit: of photos that overlap by less than a fifth, or of far things without detail, the least
//! difference is flat.

use super::camera::CylinderCamera;
use super::lens::view_of;
use super::pair::{HalvedPhoto, register};
use rayon::prelude::*;
use toile_core::prelude::*;

/// Photos are this long where only the focal length is sought, px.
pub(super) const ROUGH_PX: usize = 256;
/// Angles of view that are tried, degrees across.
const FIRST_DEG: f64 = 20.0;
const LAST_DEG: f64 = 110.0;
const STEP_DEG: f64 = 10.0;
/// The golden section ends at this width, degrees.
const EXACT_DEG: f64 = 0.4;
/// Pairs that are looked at, evenly among all.
const PAIRS: usize = 8;
/// The golden section's share.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The focal length for photos of that size, px; none where no pair overlaps with any.
///
/// # Errors
/// When the run has been stopped.
pub(super) fn estimated(
    photos: &[HalvedPhoto],
    size: [u32; 2],
    cx: &Context,
) -> Result<Option<f64>, StageError> {
    let focal = |view: f64| f64::from(size[0]) / 2.0 / (view.to_radians() / 2.0).tan();
    let cost = |view: f64| misfit(photos, CylinderCamera::new(focal(view), size), cx);
    let steps = ((LAST_DEG - FIRST_DEG) / STEP_DEG).round() as usize;
    let mut tried = Vec::new();
    for k in 0..=steps {
        let view = FIRST_DEG + STEP_DEG * k as f64;
        cx.progress(0.5 * k as f64 / steps as f64, format!("focal length: {view:.0} degrees across"));
        tried.push((cost(view)?, view));
    }
    let Some(best) = tried.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0)) else { return Ok(None) };
    if best.0 >= UNLIKE {
        return Ok(None);
    }
    let (mut low, mut high) = (best.1 - STEP_DEG, best.1 + STEP_DEG);
    let inner = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let [mut a, mut b] = inner(low, high);
    let (mut at_a, mut at_b) = (cost(a)?, cost(b)?);
    while high - low > EXACT_DEG {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = inner(low, high)[0];
            at_a = cost(a)?;
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = inner(low, high)[1];
            at_b = cost(b)?;
        }
    }
    let view = (low + high) / 2.0;
    if best.1 <= FIRST_DEG || best.1 >= LAST_DEG {
        cx.warn(format!(
            "the photos do not tell the focal length: {view:.0} degrees across fit best; give `lens` what the camera's data sheet says"
        ));
    }
    Ok(Some(focal(view)))
}

/// The misfit of a pair that does not overlap.
const UNLIKE: f64 = 1.0;

/// The mean over the pairs of one less their likeness.
fn misfit(photos: &[HalvedPhoto], camera: CylinderCamera, cx: &Context) -> Result<f64, StageError> {
    let pair = |k: usize| match (photos.get(k), photos.get(k + 1)) {
        (Some(a), Some(b)) => Ok(register(a, b, camera, cx)?.map_or(UNLIKE, |f| 1.0 - f.likeness)),
        _ => Ok(UNLIKE),
    };
    let count = photos.len().saturating_sub(1);
    let step = count.div_ceil(PAIRS).max(1);
    let all: Vec<Result<f64, StageError>> =
        (0..count.div_ceil(step)).into_par_iter().map(|k| pair(k * step)).collect();
    let all: Vec<f64> = all.into_iter().collect::<Result<_, _>>()?;
    Ok(all.iter().sum::<f64>() / all.len().max(1) as f64)
}

/// The angle across of a focal length, degrees.
pub(super) fn degrees(focal: f64, size: [u32; 2]) -> f64 {
    view_of(focal, f64::from(size[0]))
}
