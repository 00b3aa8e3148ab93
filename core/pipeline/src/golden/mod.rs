//! Golden sheets: the measures of every edge of a pipeline as text, so that a change is seen at
//! the **first stage that differs** and not in the picture at the end.
//!
//! A sheet holds a section for each artifact, in the order in which the stages ran:
//!
//! ```text
//! arithmetic = 8d77aa01c2f35be4
//! stage GridMesher = GridMesher 2 (edge:"16 mm")
//!
//! [GridMesher panel front]
//! area = 2412.31 cm2 +- 1
//! digest = 5f2a90c4d1e8b377
//!
//! [StaticEquilibrium garment]
//! vertices = 2628 +- 26.28
//! surface = 240 places +- 0.2 mm at 95 %, 1 mm at most; elsewhere 3 mm at 95 %, 20 mm at most
//! panel front
//! -12.3 45.6 -20.11 1204.5 133.87
//! ...
//! digest = 5e9e287eccb0cdad
//! ```
//!
//! A line of a panel is a place of the flat pattern and where it lies in space, mm (see `surface`).
//! The tolerance that counts is the one that stands in the sheet, so whoever keeps the golden may
//! widen or narrow it there. The digest tells whether any bit moved: within tolerance that is a
//! remark, not a failure. `stage` says what the artifacts were made by (see `made_by`).
//! `arithmetic` stands for the processor and the C library that the golden was recorded on, so that
//! bits that moved can be told to be another program's.

mod compare;
mod made_by;
mod surface;
mod text;

pub use compare::{Arithmetic, Comparison, GoldenDifference, compare};
pub use made_by::MadeBy;
pub use surface::{ClothPlace, GoldenSurface, PanelPlaces, PlaceTolerance};
pub use text::{SheetError, parse};

use crate::run::typed;
use std::sync::Arc;
use toile_core::RunLog;
use toile_core::artifact::{Artifact, Digester, Garment, Measure, OutputFiles};
use toile_core::{ArtifactType, PortValue};

/// The measures of one artifact.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetSection {
    /// The stage's id.
    pub stage: String,
    /// The artifact's kind.
    pub kind: String,
    /// Its name in a set; empty for a single artifact.
    pub entry: String,
    /// Its measures.
    pub measures: Vec<SheetMeasure>,
    /// Places of its surface; none but for a garment.
    pub surface: Option<GoldenSurface>,
    /// The start of its content's digest.
    pub digest: String,
}

impl SheetSection {
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
pub struct GoldenSheet {
    /// What stands for the arithmetic of the machine; empty where nothing is known of it.
    pub arithmetic: String,
    /// What its artifacts were made by, in the order of the pipeline; empty where nothing is known
    /// of it.
    pub stages: Vec<MadeBy>,
    /// Artifact by artifact, in the order in which they were made.
    pub sections: Vec<SheetSection>,
}

impl GoldenSheet {
    /// The sheet of a run. Written files are left out: they hold times.
    pub fn of(log: &RunLog, arithmetic: &str) -> Self {
        Self::made(log, arithmetic, &|_, garment| GoldenSurface::of(garment))
    }

    /// The sheet of a run with the places of the golden that it is held against.
    pub fn against(golden: &GoldenSheet, log: &RunLog, arithmetic: &str) -> Self {
        Self::made(log, arithmetic, &|title, garment| {
            let known = golden.sections.iter().find(|s| s.title() == title).and_then(|s| s.surface.as_ref());
            known.map_or_else(|| GoldenSurface::of(garment), |surface| surface.again(garment))
        })
    }

    fn made(log: &RunLog, arithmetic: &str, places: PlacesOfGarment<'_>) -> Self {
        let sections = log.stages.iter().flat_map(|r| {
            let values = r.outputs.iter().filter(|v| v.kind() != OutputFiles::KIND);
            values.flat_map(|v| sections(&r.id, v, places))
        });
        GoldenSheet { arithmetic: arithmetic.to_owned(), stages: Vec::new(), sections: sections.collect() }
    }

    /// The first measure that is no finite number, by the title of its section and its name: no
    /// tolerance holds it.
    pub fn endless(&self) -> Option<(String, &str)> {
        let mut all = self.sections.iter().flat_map(|s| s.measures.iter().map(move |m| (s, m)));
        all.find(|(_, m)| !m.value.is_finite()).map(|(s, m)| (s.title(), m.name.as_str()))
    }
}

/// Gives the places of a garment, by the title of its section.
type PlacesOfGarment<'a> = &'a dyn Fn(&str, &Garment) -> GoldenSurface;

fn sections(stage: &str, value: &PortValue, places: PlacesOfGarment<'_>) -> Vec<SheetSection> {
    let section = |(entry, artifact): (&str, &Arc<dyn Artifact>)| {
        let mut digester = Digester::new();
        artifact.digest(&mut digester);
        let mut section = SheetSection {
            stage: stage.to_owned(),
            kind: value.kind().0.to_owned(),
            entry: entry.to_owned(),
            measures: artifact.measures().0.into_iter().map(SheetMeasure::from).collect(),
            surface: None,
            digest: digester.finish().short(),
        };
        section.surface = typed::<Garment>(artifact).map(|g| places(&section.title(), g));
        section
    };
    value.entries().into_iter().map(section).collect()
}
