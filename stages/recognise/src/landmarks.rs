//! Places of landmarks, finer than the network's cells.
//!
//! Each landmark has a heat map of logits. The place is the mean of the 5 x 5 cells around the
//! highest one on the photo, weighted by their share of the whole heat (soft-argmax: Nibali, He,
//! Morgan, Prendergast 2018, there over the whole map; around the peak a second, lower peak does
//! not draw the place aside).
//!
//! Cost: under 1 ms for twenty. Limits: of two equal peaks the upper or left one is taken; a place
//! is never outside the photo.

use crate::letterbox::Letterbox;
use crate::network::GRID;
use crate::words::Landmark;
use nalgebra::Point2;

/// How far around the highest cell the heat is averaged, cells.
const AROUND: usize = 2;

/// Where a landmark is, and how sure the network is of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenLandmark {
    /// Which one.
    pub landmark: Landmark,
    /// Where, pixels of the photo: whole numbers are centres of pixels, y down.
    pub place: Point2<f64>,
    /// The probability that the photo shows it, 0 to 1.
    pub presence: f64,
    /// The share of its heat that lies around that place, 0 to 1: low where several places or a
    /// wide stretch are likely.
    pub share: f64,
}

/// The landmark of a heat map, `GRID` x `GRID` logits row by row.
pub(crate) fn locate(landmark: Landmark, heat: &[f32], presence: f64, box_: &Letterbox) -> SeenLandmark {
    let ((left, right), (top, bottom)) = (box_.x().cells(), box_.y().cells());
    let on_photo = || (top..=bottom).flat_map(|row| (left..=right).map(move |column| (column, row)));
    let logit = |(column, row): (usize, usize)| f64::from(heat[row * GRID + column]);
    let peak = on_photo().fold((left, top), |best, cell| if logit(cell) > logit(best) { cell } else { best });
    let (mut near, mut all, mut u, mut v) = (0.0, 0.0, 0.0, 0.0);
    for cell in on_photo() {
        let weight = (logit(cell) - logit(peak)).exp();
        all += weight;
        if cell.0.abs_diff(peak.0) <= AROUND && cell.1.abs_diff(peak.1) <= AROUND {
            near += weight;
            u += weight * cell.0 as f64;
            v += weight * cell.1 as f64;
        }
    }
    // The peak itself weighs 1.
    SeenLandmark { landmark, place: box_.place((u / near, v / near)), presence, share: near / all }
}
