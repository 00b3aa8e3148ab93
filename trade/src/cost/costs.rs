//! The laws of all stages, from what this machine's runs took and from what is shipped.

use super::bias::Bias;
use super::law::{Law, Seen, median};
use super::record::{CostRecord, Figure};
use super::terms::terms;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::cost::{Estimate, Predicted, Size};

/// How many runs all shipped ones of a stage count for, beside this machine's own.
const SHIPPED_RUNS: f64 = 2.0;
/// How far machines differ beyond what is known of them, as a logarithm.
const OTHER_MACHINE: f64 = 0.35;
/// How far stages of a role differ, where a stage has no record of its own.
const OTHER_STAGE: f64 = 0.7;
/// Shorter work says nothing of a machine's speed, seconds.
const TELLING_S: f64 = 1e-3;
/// Runs of stages by which a machine's speed is known.
const TELLING_RUNS: usize = 5;

/// Laws of stages.
#[derive(Debug, Clone, Default)]
pub struct Costs {
    /// By the stage's name and figure.
    stages: BTreeMap<(String, Figure), Entry>,
    /// By the role and figure, for stages without record.
    roles: BTreeMap<(String, Figure), Entry>,
    /// What stages made of what they were to be given.
    made: BTreeMap<String, Size>,
    bias: Bias,
    /// Pipelines that this machine has run.
    met: BTreeSet<String>,
    /// Runs of stages on this machine.
    own: usize,
}

/// A stage in its pipeline, by names.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    /// The pipeline's name.
    pub pipeline: &'a str,
    /// The stage's name, as in the records.
    pub stage: &'a str,
    /// Its role.
    pub role: &'a str,
    /// The kind of garment, as in the records.
    pub style: &'a str,
}

#[derive(Debug, Clone)]
struct Entry {
    law: Law,
    /// More spread, from elsewhere.
    more: f64,
}

impl Costs {
    /// Fits laws to this machine's records of so many threads, and to those of another machine, which are brought to
    /// this one's speed where that is known.
    pub fn fit(own: &[CostRecord], shipped: &[CostRecord], threads: usize) -> Self {
        let made = own.iter().map(|r| (r.key.clone(), r.made.clone())).collect();
        let own: Vec<&CostRecord> = own.iter().filter(|r| r.threads == threads).collect();
        let shipped: Vec<&CostRecord> = shipped.iter().collect();
        let met = own.iter().map(|r| r.pipeline.clone()).collect();
        let bias = Bias::learn(own.iter().chain(&shipped).copied());
        let mut costs = Costs { made, bias, met, own: own.len(), ..Costs::default() };
        for figure in Figure::ALL {
            let prior = laws(&shipped, &[], figure, 1.0, |r| r.stage.clone());
            let speed = speed(&own, &prior, figure);
            let (factor, more) = match (speed, shipped.is_empty() || !figure.is_time()) {
                (_, true) => (1.0, 0.0),
                (Some(speed), _) => (speed, 0.0),
                (None, _) => (1.0, OTHER_MACHINE),
            };
            let mut add = |to: fn(&mut Costs) -> &mut BTreeMap<(String, Figure), Entry>,
                           fitted: Laws,
                           more: f64| {
                to(&mut costs).extend(fitted.into_iter().map(|(n, law)| ((n, figure), Entry { law, more })));
            };
            add(|c| &mut c.stages, laws(&own, &shipped, figure, factor, |r| r.stage.clone()), more);
            add(
                |c| &mut c.roles,
                laws(&own, &shipped, figure, factor, |r| r.role.clone()),
                more + OTHER_STAGE,
            );
        }
        costs
    }

    /// Runs of stages on this machine that the laws rest on.
    pub fn own_runs(&self) -> usize {
        self.own
    }

    /// What a stage made last time of the same.
    pub fn made(&self, key: &str) -> Option<&Size> {
        self.made.get(key)
    }

    /// What the rules foresee at a stage, corrected by how far they were off in earlier runs; `style` as in the records.
    pub fn corrected(&self, stage: &str, style: &str, foreseen: &Size) -> Size {
        self.bias.corrected(stage, style, foreseen)
    }

    /// One figure of a stage of a pipeline; none where no stage of its role was ever seen.
    pub fn estimate(&self, at: &Place<'_>, size: &Size, figure: Figure) -> Option<Estimate> {
        let own = self.stages.get(&(at.stage.to_owned(), figure));
        let entry = own.or_else(|| self.roles.get(&(at.role.to_owned(), figure)))?;
        Some(entry.law.estimate(size, at.style, self.met.contains(at.pipeline), entry.more))
    }

    /// All figures of a stage.
    pub fn predicted(&self, at: &Place<'_>, size: &Size) -> Predicted {
        let of = |figure| self.estimate(at, size, figure);
        Predicted {
            wall_s: of(Figure::Wall),
            cpu_s: of(Figure::Cpu),
            peak_bytes: of(Figure::Peak),
            kept_bytes: of(Figure::Kept),
        }
    }

    /// True where the stage has records of its own.
    pub fn knows(&self, stage: &str) -> bool {
        self.stages.contains_key(&(stage.to_owned(), Figure::Wall))
    }
}

type Laws = BTreeMap<String, Law>;

/// A law for each name; shipped records are brought to this machine by a factor.
fn laws(
    own: &[&CostRecord],
    shipped: &[&CostRecord],
    figure: Figure,
    factor: f64,
    name: impl Fn(&CostRecord) -> String,
) -> Laws {
    let mut seen: BTreeMap<String, (&str, Vec<Seen<'_>>)> = BTreeMap::new();
    let mut count: BTreeMap<String, f64> = BTreeMap::new();
    shipped.iter().for_each(|r| *count.entry(name(r)).or_default() += 1.0);
    let weighed = |r: &CostRecord| SHIPPED_RUNS / count.get(&name(r)).copied().unwrap_or(1.0);
    let all = own.iter().map(|r| (r, 1.0, 1.0)).chain(shipped.iter().map(|r| (r, weighed(r), factor)));
    for (record, weight, factor) in all {
        let Some(fact) = figure.of(&record.used) else { continue };
        let entry = seen.entry(name(record)).or_insert((record.role.as_str(), Vec::new()));
        let CostRecord { pipeline, style, size, .. } = record;
        entry.1.push(Seen { pipeline, style, size, fact: fact * factor, weight });
    }
    let law = |(name, (role, seen)): (String, (&str, Vec<Seen<'_>>))| {
        Some((name, Law::fit(terms(role), &seen, figure.floor())?))
    };
    seen.into_iter().filter_map(law).collect()
}

/// How much longer this machine takes than the one of the shipped records; none while that is not known.
fn speed(own: &[&CostRecord], prior: &Laws, figure: Figure) -> Option<f64> {
    let ratio = |r: &&CostRecord| {
        let fact = figure.of(&r.used).filter(|f| *f >= TELLING_S)?;
        Some((fact / prior.get(&r.stage)?.value(&r.size, &r.style)).ln())
    };
    let mut ratios: Vec<f64> = own.iter().filter_map(ratio).collect();
    (ratios.len() >= TELLING_RUNS).then(|| median(&mut ratios).exp())
}
