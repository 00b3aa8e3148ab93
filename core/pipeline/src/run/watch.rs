//! Looking on while a run goes on.

use toile_core::artifact::{
    ArtifactType, Body, Figures, Garment, Kind, Mask, Measure, Outline, Pattern, Photo,
};
use toile_core::{PortValue, Remarks};

/// The kinds that a watcher is given unless it names others: those that can be shown.
pub const WATCHED: [Kind; 7] =
    [Photo::KIND, Mask::KIND, Outline::KIND, Pattern::KIND, Garment::KIND, Body::KIND, Figures::KIND];

/// Is told of every stage of a run as soon as it is done.
///
/// A stage whose result is given up later, because it only improves on another and failed in that,
/// is told of once more with what it passes on.
pub trait RunWatch: std::fmt::Debug + Send + Sync {
    /// Kinds that are brought into memory for it; of others it is given what is there anyway.
    fn kinds(&self) -> &[Kind] {
        &WATCHED
    }

    /// Takes note of a stage. The run waits for it.
    fn done(&self, stage: &WatchedStage<'_>);
}

/// What became of a stage.
#[derive(Debug)]
pub struct WatchedStage<'a> {
    /// Its id.
    pub id: &'a str,
    /// Its index among the pipeline's stages.
    pub index: usize,
    /// Why it was left out, where it was.
    pub skipped: Option<&'a str>,
    /// Wall time, seconds; 0 where it was left out.
    pub wall_s: f64,
    /// True where its result came from the cache.
    pub cached: bool,
    /// Its figures.
    pub figures: &'a [Measure],
    /// What it said.
    pub remarks: &'a Remarks,
    /// What it made, as far as that is in memory.
    pub outputs: Vec<PortValue>,
}
