//! What an ablation found, as it is written to `ablation.json`.

use crate::errors::Millimetres;
use crate::record::{Machine, median};
use serde::{Deserialize, Serialize};
use toile_core::decide::{Decided, Tolerance};

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
    /// Day of the measurement.
    pub date: String,
    /// Where.
    pub machine: Machine,
    /// The stage that runs ended at; none for the whole pipeline.
    pub until: Option<String>,
    /// Processor time of each run as decided, seconds.
    pub cpu_s: Vec<f64>,
    /// A row a decision.
    pub rows: Vec<Row>,
}

/// One decision turned round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The decision.
    #[serde(flatten)]
    pub decided: Decided,
    /// The option that turns it round.
    pub turned: String,
    /// Processor time of each run with it turned round, seconds.
    pub cpu_s: Vec<f64>,
    /// What the decision saved in each round, seconds of processor time.
    pub saved_s: Vec<f64>,
    /// What turning it round changed; none where that run failed.
    pub change: Option<Change>,
    /// Why the run with it turned round failed.
    pub failed: Option<String>,
    /// Whether the rule is borne out.
    pub verdict: Verdict,
}

impl Row {
    /// The middle of what was saved, seconds; none where the run failed.
    pub fn saved(&self) -> Option<f64> {
        (!self.saved_s.is_empty()).then(|| median(&self.saved_s))
    }
}

/// What turning a decision round changes in the garment.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Change {
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

impl Change {
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
pub enum Verdict {
    /// It saves time in every round and stays within its tolerance.
    Holds,
    /// Turning it round changes more than its tolerance.
    ChangesMore,
    /// In some round it saved nothing.
    SavesNothing,
    /// Turned round, the pipeline fails.
    Needed,
}

impl Verdict {
    /// By the change and what was saved in each round.
    pub fn of(change: Option<&Change>, tolerance: Tolerance, saved_s: &[f64]) -> Verdict {
        match change {
            None => Verdict::Needed,
            Some(c) if !c.is_within(tolerance) => Verdict::ChangesMore,
            Some(_) if saved_s.iter().all(|s| *s > 0.0) => Verdict::Holds,
            Some(_) => Verdict::SavesNothing,
        }
    }

    /// In words.
    pub fn as_str(self) -> &'static str {
        match self {
            Verdict::Holds => "borne out",
            Verdict::ChangesMore => "NOT borne out: changes more than its tolerance",
            Verdict::SavesNothing => "NOT borne out: saves nothing that can be measured",
            Verdict::Needed => "borne out: turned round, the pipeline fails",
        }
    }
}
