//! `GarmentCode`: a pattern file of GarmentCode (`*_specification.json`) and of its forerunner's
//! templates.
//!
//! The format has no schema; pygarment 2.0 (Korosteleva and Sorkine-Hornung 2023) is its
//! specification. [`read`] takes the fields, [`units`] finds the scale, [`panel`] makes pieces,
//! [`stitches`] seams; what is beyond repair is a [`damage`]. Cost: some milliseconds per panel.

mod damage;
mod inside_out;
mod json;
mod panel;
mod read;
mod stitch;
mod stitches;
#[cfg(test)]
mod tests;
mod units;

use super::faults;
use damage::SpecificationDamage;
use json::Json;
use panel::{Scale, made};
use read::RawFile;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_core::Remarks;
use toile_core::artifact::Artifact;
use toile_core::prelude::*;

/// Reads a sewing pattern of GarmentCode: panels, stitches, and where the panels stand around the
/// body.
///
/// Takes the place of photos, outlines and a style. Every panel becomes a piece as seen from
/// outside the wearer; edges are called by the file's labels, or `edge_0`, `edge_1`, ... by their
/// place in the file. Small damage is repaired where the intent is certain, and every repair is
/// reported: a loop with a tiny gap, a stitch that runs the wrong way or is listed twice,
/// impossible units. Other damage is refused by panel, edge and place, all of it at once.
#[stage(
    role = Reader,
    version = 3,
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
        let pattern = self.read(cx)?;
        cx.check()?;
        let (outlines, plan) = self.lowered(&pattern, cx)?;
        Ok((pattern, outlines, plan))
    }

    /// The pattern of the file.
    pub(super) fn read(&self, cx: &Context) -> Result<Pattern, StageError> {
        self.named()?;
        let bytes = cx.read(&self.file).map_err(|e| e.at("file"))?;
        let (pattern, told) = pattern(&bytes, &super::stem(&self.file)).map_err(|all| self.refused(&all))?;
        super::tell(told, cx);
        Ok(pattern)
    }

    /// What is cut and sewn of a pattern.
    fn lowered(&self, pattern: &Pattern, cx: &Context) -> Result<(Set<Outline>, SewingPlan), StageError> {
        let lowered = pattern.lower().map_err(|e| {
            self.refused(&[SpecificationDamage::Unsewable { what: e.to_string(), remedy: e.remedy() }])
        })?;
        super::tell(Remarks { notes: lowered.notes, warnings: lowered.warnings }, cx);
        let outlines = lowered.outlines.into_iter().map(|(name, o)| (name, Arc::new(o))).collect();
        Ok((Set(outlines), lowered.plan))
    }

    fn refused(&self, all: &[SpecificationDamage]) -> StageError {
        faults::refused(&self.file, all.iter().map(SpecificationDamage::fault).collect())
    }

    fn named(&self) -> Result<(), StageError> {
        super::named(&self.file, "shirt_specification.json")
    }

    /// Whether the file is there; what stands in it is read by the run, at once: patterns come
    /// first.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let there = self.named().and_then(|()| placed.cx.look(&self.file));
        there.map_err(|e| e.at("file")).err().into_iter().collect()
    }
}

/// Of a file whose panels have no places.
const ONE_PLACE: &str = "all panels stand at the same place, so the file says nothing of where they are worn: they are placed by their names and seams";

/// The pattern of a file's bytes, and what was repaired.
///
/// Errors: all that is wrong with the file, in its order.
fn pattern(bytes: &[u8], name: &str) -> Result<(Pattern, Remarks), Vec<SpecificationDamage>> {
    let one = |damage| vec![damage];
    let json = Json::parse(bytes).map_err(one)?;
    let mut file = RawFile::of(&json).map_err(one)?;
    let mut faults = std::mem::take(&mut file.faults);
    let mut told = Remarks::default();
    // Without its unit the lengths of a file mean nothing.
    if faults.iter().any(|f| matches!(f, SpecificationDamage::Units { .. })) || file.panels.is_empty() {
        return Err(faults);
    }
    let unit = match units::metres(&file, &mut told) {
        Ok(unit) => unit,
        Err(damage) => {
            faults.push(damage);
            return Err(faults);
        }
    };
    let scale = Scale { unit, absolute: file.absolute };
    let mut pieces = Vec::with_capacity(file.panels.len());
    for (i, raw) in file.panels.iter().enumerate() {
        let sides = file.stitches.iter().flat_map(|s| s.sides).filter(|(p, _)| *p == i);
        let stitched: BTreeSet<usize> = sides.map(|(_, e)| e).collect();
        match made(raw, &stitched, scale, &mut told) {
            Ok(made) => pieces.push(made),
            Err(mut of_panel) => faults.append(&mut of_panel),
        }
    }
    faults.append(&mut stitches::doubled(&file.stitches, &file.panels));
    if !faults.is_empty() {
        return Err(faults);
    }
    let seams = stitches::seams(&file.stitches, &file.panels, &mut pieces, &mut told).map_err(one)?;
    if panel::at_one_place(&file.panels) {
        told.notes.push(ONE_PLACE.to_owned());
        pieces.iter_mut().for_each(|m| m.piece.pose = None);
    }
    let pattern =
        Pattern { name: name.to_owned(), pieces: pieces.into_iter().map(|m| m.piece).collect(), seams };
    let remedy = "draw the panel again; each edge needs length, and each loop area";
    pattern.check().map_err(|what| one(SpecificationDamage::Unsewable { what, remedy }))?;
    Ok((pattern, told))
}

/// The pattern of a file with its seams, to measure proposals by; none where it is damaged.
#[cfg(test)]
pub(super) fn sewn(bytes: &[u8], name: &str) -> Option<Pattern> {
    pattern(bytes, name).ok().map(|(p, _)| p)
}
