//! The best of the methods' masks.

use super::super::graph_cut::{Coarse, GraphCut};
use super::super::small::SmallPhoto;
use super::evidence::{MaskEvidence, overlap};
use super::larger::larger;
use super::methods::MethodMask;
use super::thin::{with_pairs, without_lone_parts};
use super::wedge::with_wedges;
use toile_core::prelude::*;

/// A larger mask has this share of the best one's confidence.
const ALSO: f64 = 0.6;
/// A larger mask must contain this share of the best one.
const HELD: f64 = 0.97;
/// A larger mask must be at least so many times as large.
const MORE: f64 = 1.15;

/// The mask that is taken, with the evidence for it.
#[derive(Debug)]
pub(super) struct ChosenMask {
    /// The mask at the small size, with the colours of both sides.
    pub coarse: Coarse,
    /// The evidence for it.
    pub evidence: MaskEvidence,
    /// The area of what lies around it, as a multiple of its own, where it may be a print.
    pub larger: Option<f64>,
}

/// The mask with the most confidence, then the most agreement; the first of equals. `None` where no
/// method found anything. `seen` is the garment that a network sees.
pub(super) fn choose(
    small: &SmallPhoto,
    large: &SmallPhoto,
    found: &[MethodMask],
    seen: Option<&[bool]>,
    cx: &Context,
) -> Result<Option<ChosenMask>, StageError> {
    let evidence = |i: usize| {
        let others: Vec<&[bool]> =
            found.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, f)| &f.mask[..]).collect();
        // Contours are looked at where pixels are smaller.
        MaskEvidence {
            agreement: MaskEvidence::of(small, &found[i].mask, &others).agreement,
            seen: seen.map_or(0.0, |seen| overlap(&found[i].mask, seen)),
            ..at_large(small, large, &found[i].mask)
        }
    };
    let all: Vec<MaskEvidence> = (0..found.len()).map(evidence).collect();
    let better = |a: &MaskEvidence, b: &MaskEvidence| {
        let by = a.confidence().total_cmp(&b.confidence());
        by.then(a.agreement.total_cmp(&b.agreement)).is_gt()
    };
    let best = (0..found.len()).reduce(|a, b| if better(&all[b], &all[a]) { b } else { a });
    let Some(best) = best else { return Ok(None) };
    let best = whole(found, &all, best);
    let cut = GraphCut::default();
    let Some(first) = cut.of_mask(small.clone(), found[best].mask.clone()) else { return Ok(None) };
    let raw = cut.raw(&first, cx)?;
    let mask = with_pairs(&without_lone_parts(&found[best].mask, &raw, small.w), &raw, small.w);
    let mask = with_wedges(&mask, &raw, small.w);
    let Some(coarse) = cut.of_mask(small.clone(), mask) else { return Ok(None) };
    if overlap(&coarse.mask, &found[best].mask) < 1.0 {
        let away = found[best].mask.iter().zip(&coarse.mask).filter(|(a, b)| a != b).count() as f64;
        cx.figure("taken off", 100.0 * away / small.lab.len() as f64, "% of the photo");
    }
    let larger = larger(small, &coarse.mask, cut.rim, cx)?;
    Ok(Some(ChosenMask { coarse, evidence: all[best], larger }))
}

/// The mask that contains the best one and much more, if there is evidence for it too: methods
/// agree about one part of a garment of two colours as well as about all of it.
fn whole(found: &[MethodMask], all: &[MaskEvidence], best: usize) -> usize {
    let count = |i: usize| found[i].mask.iter().filter(|on| **on).count() as f64;
    let held =
        |i: usize| found[i].mask.iter().zip(&found[best].mask).filter(|(a, b)| **a && **b).count() as f64;
    let own = count(best);
    let holds = |i: &usize| {
        all[*i].confidence() >= ALSO * all[best].confidence()
            && held(*i) >= HELD * own
            && count(*i) >= MORE * own
    };
    (0..found.len())
        .filter(holds)
        .max_by(|a, b| all[*a].confidence().total_cmp(&all[*b].confidence()))
        .unwrap_or(best)
}

/// The evidence of a mask at a larger size of its photo, without that of other methods.
fn at_large(small: &SmallPhoto, large: &SmallPhoto, mask: &[bool]) -> MaskEvidence {
    let at = |i: usize| (i / large.w * small.h / large.h) * small.w + i % large.w * small.w / large.w;
    let mask: Vec<bool> = (0..large.w * large.h).map(|i| mask[at(i)]).collect();
    MaskEvidence::of(large, &mask, &[])
}
