//! How far the rules of sizes lie beside the facts, learnt from runs.
//!
//! A T-shirt fills its photo's frame less than a vest does, and its outline takes fewer triangles:
//! the rules know neither. Of each stage and quantity the middle of fact / rule is kept, by kind of
//! garment and for all kinds together, and the same of all stages together: what a T-shirt's mesh
//! has in one stage it has in the next as well.

use super::record::CostRecord;
use super::seen::median;
use std::collections::BTreeMap;
use toile_core::cost::{Quantity, Size};

/// A stage and a kind of garment (none for all of them), and a quantity.
type BiasPlace = (Option<String>, Option<String>, Quantity);

/// Factors on what the rules foresee.
#[derive(Debug, Clone, Default)]
pub(super) struct Bias(BTreeMap<BiasPlace, f64>);

impl Bias {
    /// Learns from runs whose sizes were foreseen.
    pub(super) fn learn<'a>(records: impl Iterator<Item = &'a CostRecord>) -> Self {
        let mut ratios: BTreeMap<BiasPlace, Vec<f64>> = BTreeMap::new();
        for r in records {
            for (quantity, foreseen) in r.foreseen.iter().filter(|(_, f)| *f > 0.0) {
                let Some(fact) = r.size.get(quantity).filter(|f| *f > 0.0) else { continue };
                for (stage, style) in places(&r.stage, &r.style) {
                    ratios.entry((stage, style, quantity)).or_default().push((fact / foreseen).ln());
                }
            }
        }
        Bias(ratios.into_iter().map(|(place, mut all)| (place, median(&mut all).exp())).collect())
    }

    /// What the rules foresee, brought to what they should have.
    pub(super) fn corrected(&self, stage: &str, style: &str, foreseen: &Size) -> Size {
        let places = places(stage, style);
        let factor = |q| {
            let mut known = places.iter().filter_map(|(s, k)| self.0.get(&(s.clone(), k.clone(), q)));
            known.next().copied().unwrap_or(1.0)
        };
        foreseen.iter().fold(Size::new(), |all, (q, a)| all.with(q, a * factor(q)))
    }
}

/// Where what holds for a stage and a kind of garment is looked up, the nearest first.
fn places(stage: &str, style: &str) -> [(Option<String>, Option<String>); 4] {
    let (stage, style) = (Some(stage.to_owned()), Some(style.to_owned()));
    [(stage.clone(), style.clone()), (None, style), (stage, None), (None, None)]
}
