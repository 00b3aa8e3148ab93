//! What a kind of garment adds to a law of sizes.
//!
//! A vest's outline is curved at neck and armholes where a T-shirt's runs straight: at the same
//! sizes its mesh takes more mending. No size says so, but other garments of the kind do. For each
//! kind the median of measured / predicted is kept, by pipelines and shrunk towards 1 while these
//! are few (the mean of a random effect: Robinson, That BLUP is a good thing, 1991).

use super::seen::{Seen, median};
use std::collections::BTreeMap;

/// Pipelines of a kind that are needed for half of its own factor, as a logarithm, to count: kinds
/// differ by about as much as pipelines of a kind do.
const HALF: f64 = 0.6;

/// Logarithms of factors, by the kind of garment.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Kinds(BTreeMap<String, f64>);

impl Kinds {
    /// Learns from runs and their errors, ln(measured / predicted).
    pub(super) fn learn(seen: &[Seen<'_>], errors: &[f64]) -> Self {
        let mut runs: BTreeMap<(&str, &str), Vec<f64>> = BTreeMap::new();
        for (s, error) in seen.iter().zip(errors) {
            runs.entry((s.style, s.pipeline)).or_default().push(*error);
        }
        let mut kinds: BTreeMap<String, (f64, f64)> = BTreeMap::new();
        for ((style, _), mut errors) in runs {
            let (sum, count) = kinds.entry(style.to_owned()).or_default();
            *sum += median(&mut errors);
            *count += 1.0;
        }
        Kinds(kinds.into_iter().map(|(style, (sum, count))| (style, sum / (count + HALF))).collect())
    }

    /// The factor of a kind; 1 for one that is not known.
    pub(super) fn factor(&self, style: &str) -> f64 {
        self.0.get(style).map_or(1.0, |f| f.exp())
    }
}
