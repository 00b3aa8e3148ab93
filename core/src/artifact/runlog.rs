//! What has happened in a run so far, for stages that report on it.

use super::{Artifact, ArtifactType, Digester, Kind, Measure, Measures};
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
    /// What it made; of a run that a stage reports on, without services such as a collider.
    pub outputs: Vec<PortValue>,
    /// Figures that the stage gave through its context.
    pub figures: Vec<Measure>,
    /// Warnings that the stage gave through its context.
    pub warnings: Vec<String>,
    /// What its own work took, where it ran whole and somebody measured.
    pub used: Option<Used>,
    /// What it was expected to take, where that was asked.
    pub predicted: Option<Predicted>,
}

/// The record of a run up to the stage that asks.
#[derive(Debug, Clone, Default)]
pub struct RunLog {
    /// The pipeline's name.
    pub pipeline: String,
    /// The named quality that it was run at, for people; none where nobody asked for one.
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
        // Times differ from run to run, so only what was run counts.
        d.text("run log").text(&self.pipeline);
        if let Some(quality) = &self.quality {
            d.text("quality").text(quality);
        }
        for s in &self.stages {
            d.text(&s.id).text(&s.params);
        }
        if let Some(failure) = &self.failure {
            d.text("failure").text(&failure.stage).text(&failure.message);
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
