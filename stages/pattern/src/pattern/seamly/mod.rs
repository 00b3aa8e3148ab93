//! `SeamlyPattern`: pieces of a garment from a pattern of Seamly2D or Valentina and a file of
//! measurements.
//!
//! `toile-seamly` works out the draft; [`measured`] finds the measurements, [`pieces`] makes pieces
//! of what is drafted. A pattern has no seams: they come from a file beside it, or are proposed.
//! Cost: some milliseconds a piece.

mod allowance;
mod damage;
mod fold;
mod measured;
mod pieces;
mod strokes;
#[cfg(test)]
mod tests;

use super::unit::{By, DrawingUnit, Taken, worn};
use super::{faults, seams};
use damage::DraftDamage;
use toile_core::Remarks;
use toile_core::prelude::*;
use toile_seamly::{Grade, LengthUnit, PatternHead, drafted};

/// Reads the pieces of a garment from a pattern of Seamly2D or Valentina, drafted to measure.
///
/// Takes the place of photos, outlines and a style. The pattern's tools are carried out with the
/// measurements of a person or of a size; a piece is sewn along its seam line, without the seam
/// allowance. Half pieces are unfolded, pieces are turned so that the grain runs up, and cut as
/// often as their quantity says, the second of a pair mirrored. A pattern has no seams: give them
/// in a file, or take those that `seams.ron` proposes and you have looked through. Nothing is sewn
/// that nobody confirmed.
///
/// Edges are called by the points that they run between: `A_B`. A tool that is not supported is
/// refused where a piece needs it.
#[stage(
    role = Reader,
    version = 2,
    source = "Seamly2D 2022; Valentina 1.0",
    example = "SeamlyPattern(file: \"skirt.sm2d\", measurements: \"body.smis\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct SeamlyPattern {
    /// The pattern, relative to the pipeline: `sm2d` of Seamly2D or `val` of Valentina.
    #[param(default = String::new())]
    pub file: String,
    /// The measurements, relative to the pipeline: `smis`, `smms`, `vit` or `vst`; empty for the
    /// file that the pattern names.
    #[param(default = String::new())]
    pub measurements: String,
    /// The size to take from measurements of several sizes, in their unit; 0 for their own.
    #[param(default = 0.0, min = 0.0, max = 3000.0)]
    pub size: f64,
    /// The height of the body to take from measurements of several sizes, in their unit; 0 for
    /// their own.
    #[param(default = 0.0, min = 0.0, max = 3000.0)]
    pub height: f64,
    /// The unit of the pattern's numbers.
    #[param(default = DrawingUnit::Auto)]
    pub unit: DrawingUnit,
    /// The file with the seams, relative to the pipeline; empty where they are to be proposed.
    #[param(default = String::new())]
    pub seams: String,
}

#[stage]
impl SeamlyPattern {
    /// Runs the stage.
    pub fn run(&self, cx: &Context) -> Result<(Pattern, Set<Outline>, SewingPlan, OutputFiles), StageError> {
        self.named()?;
        let bytes = cx.read(&self.file).map_err(|e| e.at("file"))?;
        let mut told = Remarks::default();
        let refused =
            |all: Vec<DraftDamage>| faults::refused(&self.file, all.iter().map(DraftDamage::fault).collect());
        let head = PatternHead::read(&bytes).map_err(|f| refused(vec![DraftDamage::draft(f, None)]))?;
        let table = measured::table(self, &head, &mut told, cx)?;
        let named = head.measurements.as_deref();
        let of_draft = |all: Vec<_>| all.into_iter().map(|f| DraftDamage::draft(f, named)).collect();
        let drafted = drafted(&bytes, table).map_err(|all| refused(of_draft(all)))?;
        let taken = self.taken(drafted.unit, &mut told);
        told.notes.extend(drafted.notes.iter().cloned());
        told.warnings.extend(drafted.warnings.iter().cloned());
        let pieces = pieces::pieces(&drafted.pieces, taken.metres, &mut told).map_err(refused)?;
        worn(&pieces, &taken)
            .map_err(|m| refused(vec![DraftDamage::Size { what: m.what, remedy: m.remedy }]))?;
        let unsewable = |what: String, remedy: &str| {
            refused(vec![DraftDamage::Unsewable { what, remedy: remedy.to_owned() }])
        };
        seams::sewn((super::stem(&self.file), pieces), &self.seams, told, unsewable, cx)
    }

    fn named(&self) -> Result<(), StageError> {
        super::named(&self.file, "skirt.sm2d")
    }

    /// The size that is asked for, or else that the pattern was left at.
    fn grade(&self, head: &PatternHead) -> Grade {
        let asked = |value: f64| (value > 0.0).then_some(value);
        Grade { size: asked(self.size), height: asked(self.height), ..head.grade }
    }

    /// The unit of the pattern's numbers.
    fn taken(&self, own: LengthUnit, told: &mut Remarks) -> Taken {
        if let Some(metres) = self.unit.metres() {
            let fact = format!("`unit` says that the pattern's units are {}", self.unit.word());
            return Taken { metres, fact, by: By::Parameter };
        }
        let unit = match own {
            LengthUnit::Millimetre => DrawingUnit::Millimetres,
            LengthUnit::Centimetre => DrawingUnit::Centimetres,
            LengthUnit::Inch => DrawingUnit::Inches,
        };
        let fact = format!("the pattern says that its units are {}", unit.word());
        told.notes.push(fact.clone());
        Taken { metres: own.metres(), fact, by: By::File }
    }

    /// Whether the files are there.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let mut all = seams::looked(self.named(), &self.file, &self.seams, placed);
        if !self.measurements.is_empty() {
            all.extend(placed.cx.look(&self.measurements).map_err(|e| e.at("measurements")).err());
        }
        all
    }
}
