//! Where all photos lie around the camera, and whether they close a ring.

use super::align::ShiftFit;
use super::camera::CylinderCamera;
use super::pair::{HalvedPhoto, register};
use rayon::prelude::*;
use std::f64::consts::TAU;
use toile_core::prelude::*;

/// How far the camera turned.
#[choice]
#[derive(Copy, Eq)]
pub enum CameraTurn {
    /// Whole where the last photo fits onto the first one.
    Auto,
    /// All around: the panorama's right side goes on at its left.
    Whole,
    /// Less than all around.
    Part,
}

/// How far the sum of all shifts may be from a whole turn, as a share of it, for the last photo to
/// be tried on the first.
const NEAR_WHOLE: f64 = 0.12;

/// Photos around their camera.
#[derive(Debug, Clone)]
pub(super) struct PanoramaLayout {
    pub(super) camera: CylinderCamera,
    /// The place of each photo's centre on the cylinder, px; the first is at 0.
    pub(super) places: Vec<[f64; 2]>,
    /// How each photo fits to the next, and the last to the first of a ring.
    pub(super) pairs: Vec<ShiftFit>,
    pub(super) closed: bool,
    /// What was left between the last photo and the first of a ring, px.
    pub(super) gap: [f64; 2],
}

/// Registers each photo with the next.
///
/// # Errors
/// For the first pair that does not overlap, by `names`; when the run has been stopped.
pub(super) fn neighbours(
    photos: &[HalvedPhoto],
    names: &[&str],
    camera: CylinderCamera,
    cx: &Context,
) -> Result<Vec<ShiftFit>, StageError> {
    let pair = |k: usize| {
        let (a, b) = (photos.get(k), photos.get(k + 1));
        let fit = a.zip(b).map_or(Ok(None), |(a, b)| register(a, b, camera, cx))?;
        fit.ok_or_else(|| apart(names.get(k).unwrap_or(&""), names.get(k + 1).unwrap_or(&"")))
    };
    let fits: Vec<Result<ShiftFit, StageError>> =
        (0..photos.len().saturating_sub(1)).into_par_iter().map(pair).collect();
    // The first error in order, whichever came first in time.
    fits.into_iter().collect()
}

/// Lays the photos out, and closes the ring where there is one.
///
/// # Errors
/// Where a whole turn is asked for and the last photo does not fit onto the first; when the run has
/// been stopped.
pub(super) fn laid_out(
    photos: &[HalvedPhoto],
    mut pairs: Vec<ShiftFit>,
    camera: CylinderCamera,
    turn: CameraTurn,
    cx: &Context,
) -> Result<PanoramaLayout, StageError> {
    let whole = TAU * camera.focal;
    let total: f64 = pairs.iter().map(|f| f.shift[0]).sum();
    // From the last photo on to the first: how far it should be.
    let left = whole * total.signum() - total;
    let near = left.abs() < 2.0 * camera.reach() + NEAR_WHOLE * whole && photos.len() > 2;
    let closing = match (turn, photos) {
        (CameraTurn::Auto, [first, .., last]) if near => register(last, first, camera, cx)?,
        (CameraTurn::Whole, [first, .., last]) => register(last, first, camera, cx)?,
        _ => None,
    };
    let closing = closing.filter(|f| (f.shift[0] - left).abs() < NEAR_WHOLE * whole);
    if turn == CameraTurn::Whole && closing.is_none() {
        return Err(not_closed(total / camera.focal));
    }
    let gap = closing.map_or([0.0; 2], |f| {
        let down: f64 = pairs.iter().map(|f| f.shift[1]).sum();
        [left - f.shift[0], -(down + f.shift[1])]
    });
    pairs.extend(closing);
    // Each pair takes an equal part of what is left.
    let part = gap.map(|g| g / pairs.len().max(1) as f64);
    let mut at = [0.0; 2];
    let mut places = vec![at];
    for fit in pairs.iter().take(photos.len().saturating_sub(1)) {
        at = [at[0] + fit.shift[0] + part[0], at[1] + fit.shift[1] + part[1]];
        places.push(at);
    }
    Ok(PanoramaLayout { camera, places, pairs, closed: closing.is_some(), gap })
}

impl PanoramaLayout {
    /// The sum of all shifts of a ring, px: a whole turn where the focal length is right.
    pub(super) fn around(&self) -> f64 {
        self.pairs.iter().map(|f| f.shift[0]).sum()
    }

    /// The angle from the first photo's left side to the last one's right, at most all around,
    /// degrees.
    pub(super) fn turn_deg(&self) -> f64 {
        let [left, right] = self.sides();
        if self.closed { 360.0 } else { ((right - left) / self.camera.focal).to_degrees() }
    }

    /// The leftmost and the rightmost place that a photo shows, px.
    pub(super) fn sides(&self) -> [f64; 2] {
        let reach = self.camera.reach();
        let of = |f: fn(f64, f64) -> f64, start: f64| self.places.iter().map(|p| p[0]).fold(start, f);
        [of(f64::min, f64::INFINITY) - reach, of(f64::max, f64::NEG_INFINITY) + reach]
    }
}

fn apart(a: &str, b: &str) -> StageError {
    StageError::invalid(format!("photo \"{b}\" shows nothing that photo \"{a}\" shows")).hint(
        "photos follow each other in the order of their names: turn the camera by at most two thirds of what a photo shows, \
         and leave out photos without detail",
    )
}

fn not_closed(turned: f64) -> StageError {
    let degrees = turned.to_degrees().abs();
    let text = format!("the photos turn by {degrees:.0} degrees, and the last does not fit onto the first");
    StageError::invalid(text)
        .hint("photograph on until the first view comes back, or set `turn: Part`; a wrong `lens` gives a wrong turn")
        .at("turn")
}
