//! Golden sheets: the measures of every edge of a pipeline as text, so that a change is seen at
//! the **first stage that differs** and not in the picture at the end.
//!
//! A sheet holds a section for each artifact, in the order in which the stages ran:
//!
//! ```text
//! [GridMesher panel front]
//! area = 2412.31 cm2 +- 1
//! digest = 5f2a90c4d1e8b377
//! ```
//!
//! The tolerance that counts is the one that stands in the sheet, so whoever keeps the golden may
//! widen or narrow it there. The digest tells whether any bit moved: within tolerance that is a
//! remark, not a failure.

mod compare;
mod text;

pub use compare::{Comparison, Difference, compare};
pub use text::{SheetError, parse};

use crate::artifact::{Digester, Measure, OutputFiles, RunLog};
use crate::{ArtifactType, PortValue};

/// The measures of one artifact.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// The stage's id.
    pub stage: String,
    /// The artifact's kind.
    pub kind: String,
    /// Its name in a set; empty for a single artifact.
    pub entry: String,
    /// Its measures.
    pub measures: Vec<SheetMeasure>,
    /// The start of its content's digest.
    pub digest: String,
}

impl Section {
    /// The heading without its brackets.
    pub fn title(&self) -> String {
        let title = format!("{} {} {}", self.stage, self.kind.replace(' ', "_"), self.entry);
        title.trim_end().to_owned()
    }
}

/// A measure as it stands in a sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetMeasure {
    /// What is measured.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit, empty for counts and ratios.
    pub unit: String,
    /// The difference that is accepted.
    pub tolerance: f64,
}

impl From<Measure> for SheetMeasure {
    fn from(m: Measure) -> Self {
        SheetMeasure { name: m.name, value: m.value, unit: m.unit.to_owned(), tolerance: m.tolerance }
    }
}

/// The measures of a whole run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sheet(pub Vec<Section>);

impl Sheet {
    /// The sheet of a run. Written files are left out: they hold times.
    pub fn of(log: &RunLog) -> Self {
        let sections = log.stages.iter().flat_map(|r| {
            let values = r.outputs.iter().filter(|v| v.kind() != OutputFiles::KIND);
            values.flat_map(|v| sections(&r.id, v))
        });
        Sheet(sections.collect())
    }
}

fn sections(stage: &str, value: &PortValue) -> Vec<Section> {
    let section = |(entry, artifact): (&str, &std::sync::Arc<dyn crate::Artifact>)| {
        let mut digester = Digester::new();
        artifact.digest(&mut digester);
        Section {
            stage: stage.to_owned(),
            kind: value.kind().0.to_owned(),
            entry: entry.to_owned(),
            measures: artifact.measures().0.into_iter().map(SheetMeasure::from).collect(),
            digest: digester.finish().short(),
        }
    };
    value.entries().into_iter().map(section).collect()
}
