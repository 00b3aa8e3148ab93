//! The laws of all stages, from what this machine's runs took and from what is shipped.

use super::bias::Bias;
use super::law::CostLaw;
use super::record::{CostFigure, CostRecord};
use super::seen::{Seen, median};
use super::terms::terms;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Mutex, OnceLock, PoisonError};
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

/// Laws of stages, each fitted when it is first asked for: a run asks for those of the stages that
/// it had to run.
#[derive(Debug, Default)]
pub struct Costs {
    /// This machine's records of so many threads.
    own: Vec<CostRecord>,
    /// Those of another machine.
    shipped: Vec<CostRecord>,
    /// What stages made of what they were to be given.
    made: BTreeMap<String, Size>,
    /// Pipelines that this machine has run.
    met: BTreeSet<String>,
    bias: OnceLock<Bias>,
    /// The laws that were fitted; none where there is no record.
    laws: Mutex<BTreeMap<(RecordGroup, String, CostFigure), Option<CostLaw>>>,
    /// How much longer this machine takes; none while that is not known.
    speeds: Mutex<BTreeMap<CostFigure, Option<f64>>>,
}

/// Whose records a law is fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum RecordGroup {
    /// A stage's.
    Stage,
    /// Those of all stages of a role, for stages without record.
    Role,
    /// A stage's on the machine of the shipped records.
    Shipped,
}

impl RecordGroup {
    fn name(self, record: &CostRecord) -> &str {
        match self {
            RecordGroup::Stage | RecordGroup::Shipped => &record.stage,
            RecordGroup::Role => &record.role,
        }
    }
}

/// A stage in its pipeline, by names.
#[derive(Debug, Clone, Copy)]
pub struct StagePlace<'a> {
    /// The pipeline's name.
    pub pipeline: &'a str,
    /// The stage's name, as in the records.
    pub stage: &'a str,
    /// Its role.
    pub role: &'a str,
    /// The kind of garment, as in the records.
    pub style: &'a str,
}

impl Costs {
    /// Laws fitted to this machine's records of so many threads, and to those of another machine,
    /// which are brought to this one's speed where that is known.
    pub fn fit(own: &[CostRecord], shipped: &[CostRecord], threads: usize) -> Self {
        let made = own.iter().map(|r| (r.key.clone(), r.made.clone())).collect();
        let own: Vec<CostRecord> = own.iter().filter(|r| r.threads == threads).cloned().collect();
        let met = own.iter().map(|r| r.pipeline.clone()).collect();
        Costs { own, shipped: shipped.to_vec(), made, met, ..Costs::default() }
    }

    /// Runs of stages on this machine that the laws rest on.
    pub fn own_runs(&self) -> usize {
        self.own.len()
    }

    /// What a stage made last time of the same.
    pub fn made(&self, key: &str) -> Option<&Size> {
        self.made.get(key)
    }

    /// What the rules foresee at a stage, corrected by how far they were off in earlier runs;
    /// `style` as in the records.
    pub fn corrected(&self, stage: &str, style: &str, foreseen: &Size) -> Size {
        let bias = self.bias.get_or_init(|| Bias::learn(self.own.iter().chain(&self.shipped)));
        bias.corrected(stage, style, foreseen)
    }

    /// One figure of a stage of a pipeline; none where no stage of its role was ever seen.
    pub fn estimate(&self, at: &StagePlace<'_>, size: &Size, figure: CostFigure) -> Option<Estimate> {
        let elsewhere = self.elsewhere(figure);
        let (law, more) = match self.law(RecordGroup::Stage, at.stage, figure) {
            Some(law) => (law, elsewhere),
            None => (self.law(RecordGroup::Role, at.role, figure)?, elsewhere + OTHER_STAGE),
        };
        Some(law.estimate(size, at.style, self.met.contains(at.pipeline), more))
    }

    /// How far this machine may lie from what the laws rest on, as a logarithm.
    fn elsewhere(&self, figure: CostFigure) -> f64 {
        let is_told = self.shipped.is_empty() || !figure.is_time() || self.speed(figure).is_some();
        if is_told { 0.0 } else { OTHER_MACHINE }
    }

    /// All figures of a stage.
    pub fn predicted(&self, at: &StagePlace<'_>, size: &Size) -> Predicted {
        let of = |figure| self.estimate(at, size, figure);
        Predicted {
            wall_s: of(CostFigure::Wall),
            cpu_s: of(CostFigure::Cpu),
            peak_bytes: of(CostFigure::Peak),
            kept_bytes: of(CostFigure::Kept),
        }
    }

    /// True where the stage has records of its own.
    pub fn knows(&self, stage: &str) -> bool {
        self.law(RecordGroup::Stage, stage, CostFigure::Wall).is_some()
    }

    /// True where the stage has run on this machine.
    pub fn measured_here(&self, stage: &str) -> bool {
        self.own.iter().any(|r| r.stage == stage)
    }

    /// The law of a name; none where nothing was seen of it.
    fn law(&self, group: RecordGroup, name: &str, figure: CostFigure) -> Option<CostLaw> {
        let key = (group, name.to_owned(), figure);
        if let Some(law) = self.laws.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return law.clone();
        }
        let law = self.fitted(group, name, figure);
        self.laws.lock().unwrap_or_else(PoisonError::into_inner).insert(key, law.clone());
        law
    }

    fn fitted(&self, group: RecordGroup, name: &str, figure: CostFigure) -> Option<CostLaw> {
        let of_name = |r: &&CostRecord| group.name(r) == name;
        let shipped: Vec<&CostRecord> = self.shipped.iter().filter(of_name).collect();
        let (own, weight, factor) = match group {
            RecordGroup::Shipped => (Vec::new(), 1.0, 1.0),
            RecordGroup::Stage | RecordGroup::Role => {
                let factor = if figure.is_time() { self.speed(figure).unwrap_or(1.0) } else { 1.0 };
                (self.own.iter().filter(of_name).collect(), SHIPPED_RUNS / shipped.len() as f64, factor)
            }
        };
        let own = own.into_iter().map(|r| (r, 1.0, 1.0));
        let all = own.chain(shipped.into_iter().map(|r| (r, weight, factor)));
        let all: Vec<(&CostRecord, f64, f64)> =
            all.filter_map(|(r, weight, factor)| Some((r, weight, figure.of(&r.used)? * factor))).collect();
        let role = all.first()?.0.role.as_str();
        let seen: Vec<Seen<'_>> = all
            .iter()
            .map(|(CostRecord { pipeline, style, size, .. }, weight, fact)| Seen {
                pipeline,
                style,
                size,
                fact: *fact,
                weight: *weight,
            })
            .collect();
        CostLaw::fit(terms(role), &seen, figure.floor())
    }

    /// How much longer this machine takes than the one of the shipped records; none while that is
    /// not known.
    fn speed(&self, figure: CostFigure) -> Option<f64> {
        if let Some(speed) = self.speeds.lock().unwrap_or_else(PoisonError::into_inner).get(&figure) {
            return *speed;
        }
        let ratio = |r: &CostRecord| {
            let fact = figure.of(&r.used).filter(|f| *f >= TELLING_S)?;
            Some((fact / self.law(RecordGroup::Shipped, &r.stage, figure)?.value(&r.size, &r.style)).ln())
        };
        let mut ratios: Vec<f64> = self.own.iter().filter_map(ratio).collect();
        let speed = (ratios.len() >= TELLING_RUNS).then(|| median(&mut ratios).exp());
        self.speeds.lock().unwrap_or_else(PoisonError::into_inner).insert(figure, speed);
        speed
    }
}
