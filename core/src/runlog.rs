//! What has happened in a run so far, for stages that report on it.

use crate::Remarks;
use crate::artifact::{Artifact, ArtifactType, Digester, Kind, Measure, Measures};
use crate::cost::{Predicted, Used};
use crate::stage::PortValue;

/// One stage as it ran.
#[derive(Debug, Clone)]
pub struct StageRecord {
    /// Its id in the pipeline: its name, or the name with a number where it stands twice.
    pub id: String,
    /// The stage's name.
    pub name: String,
    /// Its role.
    pub role: crate::Role,
    /// Its parameters as RON.
    pub params: String,
    /// Wall time, seconds.
    pub wall_s: f64,
    /// What it made. In the log that a reporting stage reads, services such as a collider are left
    /// out.
    pub outputs: Vec<PortValue>,
    /// Figures that the stage gave through its context.
    pub figures: Vec<Measure>,
    /// Notes and warnings that the stage gave through its context.
    pub remarks: Remarks,
    /// What its own work took; none where it did not run to its end or nothing measured it.
    pub used: Option<Used>,
    /// What it was expected to take; none where no prediction was requested.
    pub predicted: Option<Predicted>,
}

/// The record of a run up to the stage that asks.
#[derive(Debug, Clone, Default)]
pub struct RunLog {
    /// The pipeline's name.
    pub pipeline: String,
    /// The named quality that it was run at, for people; none where none was requested.
    pub quality: Option<String>,
    /// Stages in the order in which they ran.
    pub stages: Vec<StageRecord>,
    /// Names of stages that were not needed, with the reason.
    pub skipped: Vec<(String, String)>,
    /// Why the run ended early; none while it goes on.
    pub failure: Option<Failure>,
}

/// Why a run ended early.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// The stage's id, and the entry of its set at work.
    pub stage: String,
    /// What went wrong.
    pub message: String,
    /// What the user may do about it.
    pub hint: Option<String>,
    /// What lies behind it, for those who need them.
    pub detail: Option<String>,
}

impl StageRecord {
    /// Feeds what the stage was and made. What it took differs from run to run and does not count.
    fn digest(&self, d: &mut Digester) {
        let StageRecord {
            id,
            name,
            role,
            params,
            outputs,
            figures,
            remarks,
            wall_s: _,
            used: _,
            predicted: _,
        } = self;
        d.text(id).text(name).text(role.as_str()).text(params).count(outputs.len());
        for (entry, artifact) in outputs.iter().flat_map(PortValue::entries) {
            artifact.digest(d.text(entry));
        }
        d.count(figures.len());
        for Measure { name, value, unit, tolerance } in figures {
            d.text(name).text(unit).floats([*value, *tolerance]);
        }
        for texts in [&remarks.notes, &remarks.warnings] {
            d.count(texts.len());
            texts.iter().for_each(|text| {
                d.text(text);
            });
        }
    }
}

/// A text that may be missing.
fn maybe(d: &mut Digester, text: Option<&str>) {
    d.count(usize::from(text.is_some())).text(text.unwrap_or(""));
}

impl ArtifactType for RunLog {
    const KIND: Kind = Kind("run log");
    const IN_SETS: bool = false;
}

impl Artifact for RunLog {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn digest(&self, d: &mut Digester) {
        let RunLog { pipeline, quality, stages, skipped, failure } = self;
        d.text(Self::KIND.0).text(pipeline);
        maybe(d, quality.as_deref());
        d.count(stages.len());
        stages.iter().for_each(|s| s.digest(d));
        d.count(skipped.len());
        skipped.iter().for_each(|(stage, reason)| {
            d.text(stage).text(reason);
        });
        d.count(usize::from(failure.is_some()));
        if let Some(Failure { stage, message, hint, detail }) = failure {
            maybe(d.text(stage).text(message), hint.as_deref());
            maybe(d, detail.as_deref());
        }
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.count("stages", self.stages.len());
        m
    }

    fn check(&self) -> Result<(), String> {
        Ok(())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}
