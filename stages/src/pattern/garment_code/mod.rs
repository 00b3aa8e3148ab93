//! `GarmentCode`: a pattern file of GarmentCode (`*_specification.json`) and of its forerunner's templates.
//!
//! The format has no schema; pygarment 2.0 (Korosteleva and Sorkine-Hornung 2023) is its specification. [`read`] takes the
//! fields, [`units`] finds the scale, [`panel`] makes pieces, [`stitches`] seams; what is beyond repair is a [`damage`].
//! Cost: some milliseconds a panel.

mod damage;
mod json;
mod panel;
mod read;
mod stitches;
#[cfg(test)]
mod tests;
mod units;

use damage::Damage;
use json::Json;
use panel::{Scale, made};
use read::RawFile;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_core::artifact::Artifact;
use toile_core::prelude::*;

/// Reads a sewing pattern of GarmentCode: panels, stitches, and where the panels stand around the body.
///
/// Takes the place of photos, outlines and a style. Every panel becomes a piece as seen from outside the wearer; edges are
/// called by the file's labels, or `edge_0`, `edge_1`, ... by their place in the file. Small damage is repaired where the
/// intent is certain, and every repair is told: a loop open by a hair, a stitch that runs the wrong way or stands twice, units
/// that cannot be. Other damage is refused by panel, edge and place.
#[stage(
    role = Reader,
    source = "Korosteleva and Sorkine-Hornung 2023, pygarment 2.0",
    example = "GarmentCode(file: \"shirt_specification.json\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct GarmentCode {
    /// The file, relative to the pipeline.
    #[param(default = String::new())]
    pub file: String,
}

#[stage]
impl GarmentCode {
    /// Runs the stage.
    pub fn run(&self, cx: &Context) -> Result<(Pattern, Set<Outline>, SewingPlan), StageError> {
        self.named()?;
        let bytes = cx.read(&self.file).map_err(|e| e.at("file"))?;
        let (pattern, told) = pattern(&bytes, &super::stem(&self.file)).map_err(|d| d.error(&self.file))?;
        told.into_iter().for_each(|what| cx.warn(what));
        cx.check()?;
        let lowered = pattern
            .lower()
            .map_err(|e| Damage::Unsewable { what: e.to_string(), remedy: e.remedy() }.error(&self.file))?;
        lowered.notes.into_iter().for_each(|what| cx.warn(what));
        let outlines = lowered.outlines.into_iter().map(|(name, o)| (name, Arc::new(o))).collect();
        Ok((pattern, Set(outlines), lowered.plan))
    }

    fn named(&self) -> Result<(), StageError> {
        super::named(&self.file, "shirt_specification.json")
    }

    /// Whether the file is there; what stands in it is read by the run, at once: patterns come first.
    fn precheck(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let there = self.named().and_then(|()| placed.cx.look(&self.file));
        there.map_err(|e| e.at("file")).err().into_iter().collect()
    }
}

/// The pattern of a file's bytes, and what was repaired.
fn pattern(bytes: &[u8], name: &str) -> Result<(Pattern, Vec<String>), Damage> {
    let file = RawFile::of(&Json::parse(bytes)?)?;
    let mut told = Vec::new();
    let scale = Scale { unit: units::metres(&file, &mut told)?, absolute: file.absolute };
    let mut pieces = Vec::with_capacity(file.panels.len());
    for (i, raw) in file.panels.iter().enumerate() {
        let sides = file.stitches.iter().flat_map(|s| s.sides).filter(|(p, _)| *p == i);
        let stitched: BTreeSet<usize> = sides.map(|(_, e)| e).collect();
        pieces.push(made(raw, &stitched, scale, &mut told)?);
    }
    let seams = stitches::seams(&file.stitches, &file.panels, &pieces, &mut told)?;
    let pattern =
        Pattern { name: name.to_owned(), pieces: pieces.into_iter().map(|m| m.piece).collect(), seams };
    let remedy = "draw the panel again; each edge needs length, and each loop area";
    pattern.check().map_err(|what| Damage::Unsewable { what, remedy })?;
    Ok((pattern, told))
}
