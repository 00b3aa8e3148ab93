//! What the network sees in a photo, as probabilities.
//!
//! Logits become probabilities that sum to 1: over parts in each cell, over kinds, and over the
//! ways in which each limb lies (softmax). Presence of a landmark and the three flags are
//! probabilities of their own (logistic function).
//!
//! Cost: 1 ms. Limits: the probabilities are as sure as training made them; they are not fitted to
//! how often the network is right.

use crate::landmarks::{SeenLandmark, locate};
use crate::letterbox::Letterbox;
use crate::maps;
use crate::network::{GRID, Logits};
use crate::words::{GarmentKind, Landmark, Lie, Limb, Part};
use std::fmt;

/// How many parts there are.
const PARTS: usize = Part::ALL.len();
/// How many ways there are in which a limb lies.
const LIES: usize = Lie::ALL.len();
/// How likely the photo must show a landmark for [`SeenGarment::landmark`] to give it.
const LEAST_PRESENCE: f64 = 0.5;

/// What the network sees in a photo.
#[derive(Clone, PartialEq)]
pub struct SeenGarment {
    letterbox: Letterbox,
    /// Probabilities of the parts in each cell, cells row by row.
    parts: Vec<[f32; PARTS]>,
    landmarks: Vec<SeenLandmark>,
    kinds: Vec<(GarmentKind, f64)>,
    limbs: Vec<[(Lie, f64); LIES]>,
    flags: [f64; 3],
}

impl SeenGarment {
    /// What the network's values mean for a photo that lay like that in the square.
    pub(crate) fn of(logits: &Logits, letterbox: Letterbox) -> SeenGarment {
        let cell = |cell: usize| {
            let shares = softmax(&std::array::from_fn(|part| logits.parts[part * GRID * GRID + cell]));
            shares.map(|share: f64| share as f32)
        };
        let landmark = |(landmark, (heat, presence)): (&Landmark, (&[f32], &f32))| {
            locate(*landmark, heat, logistic(*presence), &letterbox)
        };
        let heats = logits.landmarks.chunks(GRID * GRID).zip(&logits.presence);
        let lies = logits.lies.chunks(LIES).map(|lies| likeliest(Lie::ALL, softmax(&list(lies))));
        SeenGarment {
            letterbox,
            parts: (0..GRID * GRID).map(cell).collect(),
            landmarks: Landmark::ALL.iter().zip(heats).map(landmark).collect(),
            kinds: likeliest(GarmentKind::ALL, softmax(&list(&logits.kinds))).to_vec(),
            limbs: lies.collect(),
            flags: list(&logits.flags).map(logistic),
        }
    }

    /// The probability that a place of the photo shows a part, 0 to 1.
    ///
    /// The place is in pixels of the photo, whole numbers are centres of pixels. Outside of the
    /// photo it is that of the nearest place on it.
    pub fn probability(&self, part: Part, x: f64, y: f64) -> f64 {
        f64::from(maps::at(&self.parts, &self.letterbox, (x, y))[part as usize])
    }

    /// The probabilities of a part in the network's own cells, 0 to 1: [`GRID`] x [`GRID`], row by
    /// row, those beside the photo included.
    pub fn map(&self, part: Part) -> Vec<f32> {
        self.parts.iter().map(|cell| cell[part as usize]).collect()
    }

    /// The probability that each pixel is garment, 0 to 1, as a picture of `width` x `height`
    /// pixels over the whole photo, row by row.
    pub fn mask(&self, width: usize, height: usize) -> Vec<f32> {
        let garment = |cell: &[f32; PARTS]| {
            let of = Part::ALL.iter().filter(|part| part.is_garment()).map(|part| cell[*part as usize]);
            [of.sum::<f32>().min(1.0)]
        };
        let cells: Vec<[f32; 1]> = self.parts.iter().map(garment).collect();
        maps::picture(&cells, &self.letterbox, (width, height), |[garment]| *garment)
    }

    /// The likeliest part of each pixel, as a picture of `width` x `height` pixels over the whole
    /// photo, row by row. Of equally likely parts it is the first in order.
    pub fn part_map(&self, width: usize, height: usize) -> Vec<Part> {
        maps::picture(&self.parts, &self.letterbox, (width, height), |shares| {
            let mut best = 0;
            for (part, share) in shares.iter().enumerate() {
                if *share > shares[best] {
                    best = part;
                }
            }
            Part::ALL[best]
        })
    }

    /// The kinds of garment with their probabilities, which sum to 1; the likeliest first.
    pub fn kinds(&self) -> &[(GarmentKind, f64)] {
        &self.kinds
    }

    /// Where a landmark is; none where it is likelier that the photo does not show it.
    pub fn landmark(&self, landmark: Landmark) -> Option<SeenLandmark> {
        Some(self.landmarks[landmark as usize]).filter(|seen| seen.presence >= LEAST_PRESENCE)
    }

    /// All landmarks in their order, those included that the photo does not show.
    pub fn landmarks(&self) -> &[SeenLandmark] {
        &self.landmarks
    }

    /// The ways in which a limb may lie with their probabilities, which sum to 1; the likeliest
    /// first.
    pub fn limb(&self, limb: Limb) -> [(Lie, f64); LIES] {
        self.limbs[limb as usize]
    }

    /// The probability that the garment hangs on a hanger, 0 to 1.
    pub fn hanger(&self) -> f64 {
        self.flags[0]
    }

    /// The probability that the garment lies flat or hangs straight, 0 to 1.
    pub fn flat(&self) -> f64 {
        self.flags[1]
    }

    /// The probability that the photo shows the whole garment, 0 to 1.
    pub fn whole(&self) -> f64 {
        self.flags[2]
    }
}

/// All but the cells, of which there are thousands.
impl fmt::Debug for SeenGarment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut told = f.debug_struct("SeenGarment");
        told.field("letterbox", &self.letterbox).field("landmarks", &self.landmarks);
        told.field("kinds", &self.kinds).field("limbs", &self.limbs).field("flags", &self.flags);
        told.finish_non_exhaustive()
    }
}

/// The first `N` values of a list that has so many.
fn list<const N: usize>(values: &[f32]) -> [f32; N] {
    std::array::from_fn(|i| values[i])
}

/// Shares that sum to 1 and whose logarithms differ as the logits do.
fn softmax<const N: usize>(logits: &[f32; N]) -> [f64; N] {
    let highest = logits.iter().copied().fold(f32::MIN, f32::max);
    let weights = logits.map(|logit| (f64::from(logit) - f64::from(highest)).exp());
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

fn logistic(logit: f32) -> f64 {
    1.0 / (1.0 + (-f64::from(logit)).exp())
}

/// The words with their shares, the greatest share first; equal ones keep their order.
fn likeliest<T: Copy, const N: usize>(words: [T; N], shares: [f64; N]) -> [(T, f64); N] {
    let mut both = std::array::from_fn(|i| (words[i], shares[i]));
    both.sort_by(|a, b| b.1.total_cmp(&a.1));
    both
}
