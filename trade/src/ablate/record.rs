//! What an ablation found, as it is written to `ablation.json`.

use crate::digest::{changed, digest};
use crate::errors::Millimetres;
use crate::record::Machine;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toile_core::decide::Tolerance;
use toile_pipeline::Pipeline;
use toile_pipeline::decide::StageDecision;

/// The version of this form.
pub const SCHEME: u32 = 1;

/// All decisions of a pipeline, each turned round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ablation {
    /// [`SCHEME`].
    pub scheme: u32,
    /// The program's version.
    pub toile: String,
    /// The pipeline's name.
    pub pipeline: String,
    /// Its file.
    pub file: String,
    /// Digest of its stages, versions and parameters: by it an old measurement is told from one of
    /// the pipeline as it is.
    #[serde(default)]
    pub base: String,
    /// Day of the last run.
    pub date: String,
    /// Where.
    pub machine: Machine,
    /// The stage that runs ended at; none for the whole pipeline.
    pub until: Option<String>,
    /// Files that the pipeline read, with the digests of their contents.
    #[serde(default)]
    pub reads: BTreeMap<String, Option<String>>,
    /// Processor time of each run as decided, seconds.
    pub cpu_s: Vec<f64>,
    /// A row a decision that was turned round.
    pub rows: Vec<DecisionRow>,
    /// What is missing where the budget ended before all runs were done.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cut: Option<EndedBudget>,
}

/// A budget that ended before all runs were done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EndedBudget {
    /// Runs that are done.
    pub done: usize,
    /// Runs that were asked for.
    pub all: usize,
    /// Decisions that were not turned round at all.
    pub not_measured: Vec<Unmeasured>,
}

/// A decision that was not turned round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Unmeasured {
    /// The decision.
    #[serde(flatten)]
    pub decided: StageDecision,
    /// The option that turns it round.
    pub turned: String,
}

impl Ablation {
    /// Whether it is of that very pipeline: the same stages, versions and parameters, and the same
    /// files.
    pub fn is_of(&self, pipeline: &Pipeline) -> bool {
        self.scheme == SCHEME && self.base == digest(pipeline, &[]) && changed(&self.reads).is_none()
    }
}

/// One decision turned round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DecisionRow {
    /// The decision.
    #[serde(flatten)]
    pub decided: StageDecision,
    /// The option that turns it round.
    pub turned: String,
    /// Processor time of each run with it turned round, seconds.
    pub cpu_s: Vec<f64>,
    /// What the decision saved in each round, seconds of processor time.
    pub saved_s: Vec<f64>,
    /// What turning it round changed; none where that run failed.
    pub change: Option<GarmentChange>,
    /// Why the run with it turned round failed.
    pub failed: Option<String>,
    /// Whether the rule is borne out.
    pub verdict: RuleVerdict,
}

impl DecisionRow {
    /// What was saved in the mean, seconds, and how far chance may have moved that; none where the
    /// run failed.
    pub fn saved(&self) -> Option<Saved> {
        Saved::of(&self.saved_s)
    }
}

/// What a decision saved, seconds of processor time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saved {
    /// Mean over the rounds.
    pub mean: f64,
    /// Twice the standard error of the mean: 95 of 100 cases lie within. Infinite for a single
    /// round.
    pub noise: f64,
}

impl Saved {
    /// Of the differences within each round; none without rounds.
    pub fn of(rounds: &[f64]) -> Option<Saved> {
        let n = rounds.len() as f64;
        let mean = rounds.iter().sum::<f64>() / n;
        let squares: f64 = rounds.iter().map(|s| (s - mean).powi(2)).sum();
        let noise = if rounds.len() > 1 { 2.0 * (squares / (n - 1.0) / n).sqrt() } else { f64::INFINITY };
        (!rounds.is_empty()).then_some(Saved { mean, noise })
    }

    /// Whether it is more than chance.
    pub fn is_measured(&self) -> bool {
        self.mean > self.noise
    }
}

/// What turning a decision round changes in the garment.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GarmentChange {
    /// True where no bit of the garment changed.
    pub same_bits: bool,
    /// Between the draped surfaces.
    pub distance_mm: Millimetres,
    /// Between the outlines of the flat panels.
    pub outline_mm: Millimetres,
    /// Root mean square difference of the textures, grey levels; none without textures.
    pub texture_levels: Option<f64>,
    /// Pairs of triangles that cross, as decided and turned round; none where nobody counts.
    pub crossings: [Option<usize>; 2],
}

impl GarmentChange {
    /// Whether it stays within a tolerance.
    pub fn is_within(&self, tolerance: Tolerance) -> bool {
        let texture = |most: f64| self.texture_levels.is_none_or(|t| t <= most);
        match tolerance {
            Tolerance::SameBits => self.same_bits && texture(0.0),
            Tolerance::Outline(m) => self.outline_mm.p95 <= m * 1e3,
            Tolerance::Texture(levels) => self.same_bits && texture(levels),
            Tolerance::Distance(m) => self.distance_mm.p95 <= m * 1e3,
        }
    }
}

/// What an ablation says of a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RuleVerdict {
    /// It saves more time than chance may move, and stays within its tolerance.
    Holds,
    /// Turning it round changes more than its tolerance.
    ChangesMore,
    /// What it saved in the mean is no more than chance may make.
    SavesNothing,
    /// Turned round, the pipeline fails.
    Needed,
    /// Turned round, it was stopped at the limit.
    Cut,
}

impl RuleVerdict {
    /// By the change and what was saved in each round.
    pub fn of(change: Option<&GarmentChange>, tolerance: Tolerance, saved_s: &[f64]) -> RuleVerdict {
        match change {
            None => RuleVerdict::Needed,
            Some(c) if !c.is_within(tolerance) => RuleVerdict::ChangesMore,
            Some(_) if Saved::of(saved_s).is_some_and(|s| s.is_measured()) => RuleVerdict::Holds,
            Some(_) => RuleVerdict::SavesNothing,
        }
    }

    /// In words.
    pub fn as_str(self) -> &'static str {
        match self {
            RuleVerdict::Holds => "borne out",
            RuleVerdict::ChangesMore => "NOT borne out: changes more than its tolerance",
            RuleVerdict::SavesNothing => "NOT borne out: saves nothing that can be measured",
            RuleVerdict::Needed => "borne out: turned round, the pipeline fails",
            RuleVerdict::Cut => "not decided: turned round, the run was stopped at the limit",
        }
    }
}
