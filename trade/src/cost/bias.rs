//! How far the rules of sizes lie beside the facts, learnt from runs.
//!
//! A T-shirt fills its photo's frame less than a vest does, and its outline takes fewer triangles: the rules know neither.
//! Of each stage and quantity the middle of fact / rule is kept, by kind of garment and for all kinds together.

use super::law::median;
use super::record::CostRecord;
use std::collections::BTreeMap;
use toile_core::cost::{Quantity, Size};

/// A stage, a kind of garment (none for all kinds) and a quantity.
type Place = (String, Option<String>, Quantity);

/// Factors on what the rules foresee.
#[derive(Debug, Clone, Default)]
pub(super) struct Bias(BTreeMap<Place, f64>);

impl Bias {
    /// Learns from runs whose sizes were foreseen.
    pub(super) fn learn<'a>(records: impl Iterator<Item = &'a CostRecord>) -> Self {
        let mut ratios: BTreeMap<Place, Vec<f64>> = BTreeMap::new();
        for r in records {
            for (quantity, foreseen) in r.foreseen.iter().filter(|(_, f)| *f > 0.0) {
                let Some(fact) = r.size.get(quantity).filter(|f| *f > 0.0) else { continue };
                for style in [None, Some(r.style.clone())] {
                    ratios
                        .entry((r.stage.clone(), style, quantity))
                        .or_default()
                        .push((fact / foreseen).ln());
                }
            }
        }
        Bias(ratios.into_iter().map(|(place, mut all)| (place, median(&mut all).exp())).collect())
    }

    /// What the rules foresee, brought to what they should have.
    pub(super) fn corrected(&self, stage: &str, style: &str, foreseen: &Size) -> Size {
        let factor = |q| {
            let own = self.0.get(&(stage.to_owned(), Some(style.to_owned()), q));
            own.or_else(|| self.0.get(&(stage.to_owned(), None, q))).copied().unwrap_or(1.0)
        };
        foreseen.iter().fold(Size::new(), |all, (q, a)| all.with(q, a * factor(q)))
    }
}
