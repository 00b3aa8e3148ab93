//! The best of the methods' masks.

use super::super::graph_cut::{Coarse, GraphCut};
use super::super::small::Small;
use super::evidence::{Evidence, overlap};
use super::larger::larger;
use super::methods::Found;
use super::thin::without_lone_parts;
use toile_core::prelude::*;

/// The mask that is taken, with what speaks for it.
#[derive(Debug)]
pub(super) struct Choice {
    /// The mask at the small size, with the colours of both sides.
    pub coarse: Coarse,
    /// What speaks for it.
    pub evidence: Evidence,
    /// The area of what lies around it, as a multiple of its own, where it may be a print.
    pub larger: Option<f64>,
}

/// The mask with the most confidence, then the most agreement; the first of equals. `None` where no method found anything.
pub(super) fn choose(
    small: &Small,
    large: &Small,
    found: &[Found],
    cx: &Context,
) -> Result<Option<Choice>, StageError> {
    let evidence = |i: usize| {
        let others: Vec<&[bool]> =
            found.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, f)| &f.mask[..]).collect();
        // Contours are looked at where pixels are smaller.
        Evidence {
            agreement: Evidence::of(small, &found[i].mask, &others).agreement,
            ..at_large(small, large, &found[i].mask)
        }
    };
    let all: Vec<Evidence> = (0..found.len()).map(evidence).collect();
    let better = |a: &Evidence, b: &Evidence| {
        let by = a.confidence().total_cmp(&b.confidence());
        by.then(a.agreement.total_cmp(&b.agreement)).is_gt()
    };
    let best = (0..found.len()).reduce(|a, b| if better(&all[b], &all[a]) { b } else { a });
    let Some(best) = best else { return Ok(None) };
    let cut = GraphCut::default();
    let Some(first) = cut.of_mask(small.clone(), found[best].mask.clone()) else { return Ok(None) };
    let raw = cut.raw(&first, cx)?;
    let mask = without_lone_parts(&found[best].mask, &raw, small.w);
    let Some(coarse) = cut.of_mask(small.clone(), mask) else { return Ok(None) };
    if overlap(&coarse.mask, &found[best].mask) < 1.0 {
        let away = found[best].mask.iter().zip(&coarse.mask).filter(|(a, b)| a != b).count() as f64;
        cx.figure("taken off", 100.0 * away / small.lab.len() as f64, "% of the photo");
    }
    let larger = larger(small, &coarse.mask, cut.rim, cx)?;
    Ok(Some(Choice { coarse, evidence: all[best], larger }))
}

/// The evidence of a mask at a larger size of its photo, without that of other methods.
fn at_large(small: &Small, large: &Small, mask: &[bool]) -> Evidence {
    let at = |i: usize| (i / large.w * small.h / large.h) * small.w + i % large.w * small.w / large.w;
    let mask: Vec<bool> = (0..large.w * large.h).map(|i| mask[at(i)]).collect();
    Evidence::of(large, &mask, &[])
}
