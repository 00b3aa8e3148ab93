//! Evidence for a mask: other methods that find the same, and what a garment laid flat looks like.
//!
//! Each kind of evidence is scaled to 0 to 1, from the value that is evidence against a mask to the
//! one that leaves no doubt; the confidence is their product, so that no kind makes up for another.
//! Methods that agree to 0.96 differ by the width of a contour; a garment laid flat is its own
//! mirror image to 0.85 with a fold or a sleeve aside, and less than 0.65 is half a garment; a
//! contour follows edges but for a stretch in shade. The bounds were chosen by looking at 23 photos
//! with masks drawn by hand (docs/log/README.md#masks).

use super::super::small::SmallPhoto;
use super::contour::support;
use super::symmetry::symmetry;

/// Agreement that is evidence against a mask, and agreement that leaves no doubt.
const AGREE: [f64; 2] = [0.88, 0.96];
/// The weight of the method that agrees best, beside the second best: two that agree almost exactly
/// while all others miss a stripe are right more often than three that agree roughly.
const FIRST: f64 = 0.7;
/// The same of what a network sees, at a hundredth of the photo's width, and which shares no colour
/// with the other methods: with masks drawn by hand it agrees to 0.946 in the mean.
const SEEN: [f64; 2] = [0.88, 0.95];
/// Mirror images alike.
const ALIKE: [f64; 2] = [0.65, 0.85];
/// Share of the contour on edges of the photo.
const ON_EDGES: [f64; 2] = [0.7, 0.9];

/// The evidence for a mask.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MaskEvidence {
    /// Weighted intersection over union with the two methods that agree best, 0 to 1.
    pub agreement: f64,
    /// Intersection over union with its mirror image, 0 to 1.
    pub symmetry: f64,
    /// Share of its contour on an edge of the photo, 0 to 1.
    pub support: f64,
    /// Intersection over union with what a network sees, 0 to 1; 0 without a network.
    pub seen: f64,
}

impl MaskEvidence {
    /// The evidence for `mask` of `small`'s size, given what other methods found at the same size.
    pub(super) fn of(small: &SmallPhoto, mask: &[bool], others: &[&[bool]]) -> MaskEvidence {
        let mut agree: Vec<f64> = others.iter().map(|o| overlap(mask, o)).collect();
        agree.sort_by(|a, b| b.total_cmp(a));
        agree.resize(2, 0.0);
        let [first, second] = [agree[0], agree[1]];
        MaskEvidence {
            agreement: FIRST * first + (1.0 - FIRST) * second,
            symmetry: symmetry(mask, small.w).map_or(0.0, |s| s.share),
            support: support(small, mask),
            seen: 0.0,
        }
    }

    /// The confidence in the mask, 0 to 1.
    pub(super) fn confidence(&self) -> f64 {
        self.parts().iter().product()
    }

    /// Agreement, edges and mirror image, each 0 to 1.
    pub(super) fn parts(&self) -> [f64; 3] {
        let agree = ramp(self.agreement, AGREE).max(ramp(self.seen, SEEN));
        [agree, ramp(self.support, ON_EDGES), ramp(self.symmetry, ALIKE)]
    }
}

fn ramp(value: f64, [none, full]: [f64; 2]) -> f64 {
    ((value - none) / (full - none)).clamp(0.0, 1.0)
}

/// Intersection over union of two masks; 0 for two empty ones.
pub(super) fn overlap(a: &[bool], b: &[bool]) -> f64 {
    let both = a.iter().zip(b).filter(|(a, b)| **a && **b).count();
    let either = a.iter().zip(b).filter(|(a, b)| **a || **b).count();
    both as f64 / either.max(1) as f64
}
