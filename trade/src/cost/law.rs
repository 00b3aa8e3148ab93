//! A stage's law with its uncertainty.

use super::fit::{Observation, fit};
use super::kinds::Kinds;
use super::seen::{Seen, median};
use super::terms::Term;
use std::collections::BTreeMap;
use toile_core::cost::{Estimate, Size};

/// Quantile of the normal distribution that leaves out one case of ten.
const NORMAL_90: f64 = 1.2816;
/// The least spread of a law, as a logarithm: runs of the same work differ by this much.
const LEAST_SPREAD: f64 = 0.05;
/// Growth of the spread for each power of e beyond what was measured.
const BEYOND: f64 = 0.25;
/// Prior for how far the same stage differs from pipeline to pipeline, as a logarithm.
const PRIOR_SPREAD: f64 = 0.15;
/// The number of pipelines that [`PRIOR_SPREAD`] counts for.
const PRIOR_PIPELINES: f64 = 3.0;
/// A single outlier among the errors counts as no more than this.
const CAP: f64 = 1.5;

/// A sum of terms with what is known of its errors.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CostLaw {
    terms: &'static [Term],
    factors: Vec<f64>,
    /// What kinds of garment add to the sum of terms.
    kinds: Kinds,
    /// Standard deviation of ln(measured / predicted).
    spread: f64,
    /// Degrees of freedom of the spread.
    free: f64,
    /// Standard deviation of the same from pipeline to pipeline, and its degrees of freedom.
    between: (f64, f64),
    /// Least and greatest prediction of the runs that it was fitted on.
    range: (f64, f64),
    floor: f64,
}

impl CostLaw {
    /// Fits a law; none where nothing was seen.
    pub(super) fn fit(terms: &'static [Term], seen: &[Seen<'_>], floor: f64) -> Option<Self> {
        let row = |s: &Seen<'_>| Observation {
            terms: terms.iter().map(|t| t.at(s.size)).collect(),
            fact: s.fact,
            weight: s.weight,
        };
        let rows: Vec<Observation> = seen.iter().map(row).collect();
        let factors = fit(&rows, terms.len())?;
        let (range, between) = ((0.0, f64::INFINITY), (0.0, 1.0));
        let kinds = Kinds::default();
        let mut law = CostLaw { terms, factors, kinds, spread: 0.0, free: 1.0, between, range, floor };
        let errors = |law: &CostLaw| -> Vec<f64> {
            seen.iter().map(|s| (s.fact / law.value(s.size, s.style)).ln()).collect()
        };
        // Least squares of relative errors lie low; the middle of the runs should be in the middle.
        let middle = median(&mut errors(&law));
        law.factors.iter_mut().for_each(|f| *f *= middle.exp());
        law.kinds = Kinds::learn(seen, &errors(&law));
        let values: Vec<f64> = seen.iter().map(|s| law.value(s.size, s.style)).collect();
        law.range = values.iter().fold((f64::INFINITY, 0.0), |r, v| (r.0.min(*v), r.1.max(*v)));
        let total: f64 = seen.iter().map(|s| s.weight).sum();
        let square = |(s, v): (&Seen<'_>, &f64)| s.weight * (s.fact / v).ln().clamp(-CAP, CAP).powi(2);
        let mean = seen.iter().zip(&values).map(square).sum::<f64>() / total;
        let used = law.factors.iter().filter(|f| **f > 0.0).count() as f64;
        let count = seen.len() as f64;
        law.free = (count - used).max(1.0);
        law.spread = (mean * count / law.free).sqrt().max(LEAST_SPREAD);
        law.between = between_pipelines(seen, &values);
        Some(law)
    }

    /// The middle, for a kind of garment.
    pub(super) fn value(&self, size: &Size, style: &str) -> f64 {
        let sum: f64 = self.terms.iter().zip(&self.factors).map(|(t, f)| t.at(size) * f).sum();
        (sum * self.kinds.factor(style)).max(self.floor)
    }

    /// The middle with the range that 80 of 100 runs lie in; `met` where this machine has run the
    /// pipeline before, `more` is spread from elsewhere, as a logarithm.
    pub(super) fn estimate(&self, size: &Size, style: &str, met: bool, more: f64) -> Estimate {
        let value = self.value(size, style);
        let beyond = (value / self.range.1).ln().max((self.range.0 / value).ln()).max(0.0);
        let between = if met { 0.0 } else { self.between.0 * student(self.between.1) };
        let other = NORMAL_90 * more.hypot(BEYOND * beyond);
        let width = (self.spread * student(self.free)).hypot(between).hypot(other);
        let factor = width.min(20.0).exp();
        Estimate { value, low: value / factor, high: value * factor }
    }
}

/// Student's quantile that leaves out one case of ten, to 5 % (Hill 1970 has it exactly).
fn student(free: f64) -> f64 {
    NORMAL_90 * (1.0 + 0.9 / free + 0.5 / (free * free))
}

/// How far pipelines lie from the law, each by the mean of its runs, drawn towards
/// [`PRIOR_SPREAD`] while they are few.
fn between_pipelines(seen: &[Seen<'_>], values: &[f64]) -> (f64, f64) {
    let mut means: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    for (s, v) in seen.iter().zip(values) {
        let (sum, count) = means.entry(s.pipeline).or_default();
        *sum += (s.fact / v).ln().clamp(-CAP, CAP);
        *count += 1.0;
    }
    let count = means.len() as f64;
    let squares: f64 = means.values().map(|(sum, n)| (sum / n).powi(2)).sum();
    // The law was fitted to them: of two pipelines each lies half as far off as it would when left
    // out.
    let own = if count > 1.0 { squares * (count / (count - 1.0)).powi(2) } else { 0.0 };
    let free = count - 1.0 + PRIOR_PIPELINES;
    (((own + PRIOR_SPREAD * PRIOR_SPREAD * PRIOR_PIPELINES) / free).sqrt(), free)
}
