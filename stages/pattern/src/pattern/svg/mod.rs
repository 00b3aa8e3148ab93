//! `SvgPattern`: pieces of a garment from an SVG, as FreeSewing drafts them or a drawing program
//! saves them.
//!
//! [`source`] reads the text, [`units`] finds the length of its unit, [`drawing`] walks what is
//! drawn ([`path`] its lines, [`role`] what they are for), [`pieces`] makes pieces of it. Cost:
//! some milliseconds per piece.

mod damage;
mod drawing;
mod nested;
mod outlined;
mod path;
mod pieces;
mod role;
mod sized;
mod source;
#[cfg(test)]
mod tests;
mod units;

use super::unit::{By, DrawingUnit, longest, worn};
use super::{faults, seams};
use damage::SvgDamage;
use toile_core::Remarks;
use toile_core::prelude::*;

/// Reads the pieces of a garment from an SVG: of FreeSewing, Inkscape, Illustrator.
///
/// Takes the place of photos, outlines and a style. A piece is a closed line in a group of its own,
/// or lines that meet end to end; lines called `grain`, `fold`, `notch`, `drill`, `hole` and
/// `seam allowance` are what they say. Half pieces are unfolded at their fold, and cut as often as
/// a text in them says (`cut 2` is a pair, the second mirrored). SVG knows no seams: give them in a
/// file, or take those that `seams.ron` proposes and you have looked through. Nothing is sewn that
/// nobody confirmed.
///
/// Edges run counter-clockwise around their piece, whichever way it is drawn; the pictures of
/// `--keep` show them with arrows. A garment of a size that no one wears is refused with the `unit`
/// that fits.
#[stage(
    role = Reader,
    source = "SVG 1.1; FreeSewing 4",
    version = 4,
    example = "SvgPattern(file: \"teagan.svg\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct SvgPattern {
    /// The file, relative to the pipeline.
    #[param(default = String::new())]
    pub file: String,
    /// The unit of the drawing's numbers, those of its viewBox.
    #[param(default = DrawingUnit::Auto)]
    pub unit: DrawingUnit,
    /// The layer or group to read of a drawing that has one for each size; empty to read all.
    #[param(default = String::new())]
    pub size: String,
    /// The encoding of the file, such as `windows-1252`; empty for the one that the file says, or
    /// UTF-8.
    #[param(default = String::new())]
    pub encoding: String,
    /// The file with the seams, relative to the pipeline; empty where they are to be proposed.
    #[param(default = String::new())]
    pub seams: String,
}

#[stage]
impl SvgPattern {
    /// Runs the stage.
    pub fn run(&self, cx: &Context) -> Result<(Pattern, Set<Outline>, SewingPlan, OutputFiles), StageError> {
        self.named()?;
        let bytes = cx.read(&self.file).map_err(|e| e.at("file"))?;
        let mut told = Remarks::default();
        let refused =
            |all: Vec<SvgDamage>| faults::refused(&self.file, all.iter().map(SvgDamage::fault).collect());
        let pieces = pieces_of(&bytes, self, &mut told).map_err(refused)?;
        let unsewable = |what: String, remedy: &str| {
            refused(vec![SvgDamage::Unsewable { what, remedy: remedy.to_owned() }])
        };
        seams::sewn((super::stem(&self.file), pieces), &self.seams, told, unsewable, cx)
    }

    fn named(&self) -> Result<(), StageError> {
        super::named(&self.file, "teagan.svg")
    }

    /// Whether the files are there.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        seams::looked(self.named(), &self.file, &self.seams, placed)
    }
}

/// The pieces of a file, each as often as it is cut.
///
/// Errors: all that is wrong with them.
fn pieces_of(bytes: &[u8], asked: &SvgPattern, told: &mut Remarks) -> Result<Vec<Piece>, Vec<SvgDamage>> {
    let one = |damage| vec![damage];
    let text = source::text(bytes, &asked.encoding).map_err(one)?;
    let tree = source::tree(&text).map_err(one)?;
    let root = tree.root_element();
    let taken = units::unit(root, &text, asked.unit).map_err(one)?;
    let others = sized::others(root, &asked.size, told).map_err(one)?;
    let drawing = drawing::drawing(root, taken.metres, &others).map_err(one)?;
    if drawing.dimensions > 0 {
        told.notes.push(format!("{} dimension lines are left out", drawing.dimensions));
    }
    // FreeSewing says which pairs are mirrored; a person who writes "cut 2" means a pair.
    let by_word = root.has_attribute("freesewing");
    let pieces = pieces::pieces(&drawing, by_word, told)?;
    worn(&pieces, &taken).map_err(|m| one(SvgDamage::Size { what: m.what, remedy: m.remedy }))?;
    match taken.by {
        By::Guess => told.warnings.push(format!(
            "{}, and the largest piece {} long; say the drawing's unit where that is wrong, such as `--set pattern.unit=Millimetres`",
            taken.fact,
            longest(&pieces)
        )),
        By::Parameter | By::File => told.notes.push(taken.fact),
    }
    Ok(pieces)
}
