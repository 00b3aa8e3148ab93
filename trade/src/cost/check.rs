//! How well stages are predicted on pipelines that the laws were not fitted on.

use super::record::{CostFigure, CostRecord};
use super::{Costs, StagePlace};
use std::collections::{BTreeMap, BTreeSet};

/// A prediction is right where it differs from the measured value by at most this share of that
/// value.
const RIGHT: f64 = 0.3;
/// Times below this, seconds, are noise of timer and cache.
const TELLING_TIME: f64 = 1e-3;
/// Memory below this, bytes, is noise of timer and cache.
const TELLING_MEMORY: f64 = 1e6;

/// Whether a prediction is near enough to the measured value.
pub(super) fn is_right(prediction: f64, fact: f64) -> bool {
    (prediction / fact - 1.0).abs() <= RIGHT
}

/// How many predictions are right.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Predictions.
    pub count: usize,
    /// Predictions within 30 % of the measured value.
    pub right: usize,
    /// Predictions whose 80 % range contains the measured value.
    pub in_range: usize,
}

impl Tally {
    pub(super) fn add(&mut self, right: bool, in_range: bool) {
        self.count += 1;
        self.right += usize::from(right);
        self.in_range += usize::from(in_range);
    }

    /// Share of right ones, 0 to 1.
    pub fn share(&self) -> f64 {
        self.right as f64 / self.count.max(1) as f64
    }
}

/// A stage of a pipeline that was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct StageVerdict {
    /// The pipeline's name.
    pub pipeline: String,
    /// The stage's name.
    pub stage: String,
    /// True where no other pipeline has this stage, and others of its role stood in.
    pub stand_in: bool,
    /// Predicted / measured of each run, ascending.
    pub ratios: Vec<f64>,
    /// The median of the measured values.
    pub fact: f64,
    /// How many are right.
    pub tally: Tally,
}

/// The whole of it, for one figure.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictionCheck {
    /// What was predicted.
    pub figure: CostFigure,
    /// By pipeline and stage.
    pub stages: Vec<StageVerdict>,
    /// Every prediction; stages without any law count as wrong.
    pub all: Tally,
    /// Those of measured values above the noise: 1 ms and longer, 1 MB and more.
    pub telling: Tally,
    /// Those of `telling` whose stage other pipelines have, too.
    pub met: Tally,
}

/// Leaves out each of the pipelines in turn, fits to the others and predicts it from its photos'
/// headers and its settings alone. Without names all are left out in turn.
pub fn check(records: &[CostRecord], names: &[String], figure: CostFigure) -> PredictionCheck {
    let known: BTreeSet<&str> = records.iter().map(|r| r.pipeline.as_str()).collect();
    let chosen = known.into_iter().filter(|k| names.is_empty() || names.iter().any(|n| n == k));
    let mut check = PredictionCheck {
        figure,
        stages: Vec::new(),
        all: Tally::default(),
        telling: Tally::default(),
        met: Tally::default(),
    };
    for name in chosen {
        let (left_out, others): (Vec<CostRecord>, Vec<CostRecord>) =
            records.iter().cloned().partition(|r| r.pipeline == name);
        let threads = left_out.first().map_or(1, |r| r.threads);
        judge(&mut check, name, &left_out, &Costs::fit(&others, &[], threads));
    }
    check
}

fn judge(check: &mut PredictionCheck, pipeline: &str, left_out: &[CostRecord], costs: &Costs) {
    let mut by_stage: BTreeMap<&str, Vec<&CostRecord>> = BTreeMap::new();
    left_out.iter().for_each(|r| by_stage.entry(&r.stage).or_default().push(r));
    let least = if check.figure.is_time() { TELLING_TIME } else { TELLING_MEMORY };
    for (stage, runs) in by_stage {
        let (mut tally, mut ratios, mut facts) = (Tally::default(), Vec::new(), Vec::new());
        for run in runs {
            let Some(fact) = check.figure.of(&run.used) else { continue };
            let size = costs.corrected(stage, &run.style, &run.foreseen);
            let estimate = costs.estimate(
                &StagePlace { pipeline, stage, role: &run.role, style: &run.style },
                &size,
                check.figure,
            );
            let right = estimate.is_some_and(|e| is_right(e.value, fact));
            let in_range = estimate.is_some_and(|e| e.holds(fact));
            tally.add(right, in_range);
            check.all.add(right, in_range);
            if fact >= least {
                check.telling.add(right, in_range);
                if costs.knows(stage) {
                    check.met.add(right, in_range);
                }
            }
            ratios.extend(estimate.map(|e| e.value / fact));
            facts.push(fact);
        }
        ratios.sort_by(f64::total_cmp);
        let (pipeline, stage) = (pipeline.to_owned(), stage.to_owned());
        let (stand_in, fact) = (!costs.knows(&stage), super::seen::median(&mut facts));
        check.stages.push(StageVerdict { pipeline, stage, stand_in, ratios, fact, tally });
    }
}
