//! The length of the file's unit.
//!
//! A DXF of AAMA or ASTM says METRIC, which are millimetres, or ENGLISH, which are inches; else its
//! header may say a unit (`$INSUNITS`). Where neither does, the unit is taken with which the
//! largest piece has a garment's size; a remark says so.

use super::super::unit::{By, DrawingUnit, Taken};
use super::Drawn;
use super::damage::DxfDamage;
use super::entities::Block;
use super::tags::{Tag, short, variable};
use toile_core::Remarks;
use toile_core::prelude::*;

/// Units of which a drawing's size is tried.
const TRIED: [DrawingUnit; 4] =
    [DrawingUnit::Millimetres, DrawingUnit::Inches, DrawingUnit::Centimetres, DrawingUnit::Metres];

/// The unit of a file with these pieces.
pub(super) fn unit(
    tags: &[Tag],
    outside: &Block,
    pieces: &[&Drawn<'_>],
    asked: DrawingUnit,
    told: &mut Remarks,
) -> Result<Taken, DxfDamage> {
    let taken = |unit: DrawingUnit, fact: String, by: By| {
        unit.metres().map(|metres| Taken { metres, fact, by }).ok_or(DxfDamage::NoPieces)
    };
    if asked != DrawingUnit::Auto {
        return taken(
            asked,
            format!("`unit` says that the file's units are {}", asked.word()),
            By::Parameter,
        );
    }
    let word = outside.value("Units").or_else(|| pieces.iter().find_map(|d| d.block.value("Units")));
    let by_word = match word {
        Some(word) if word.eq_ignore_ascii_case("ENGLISH") => Some((DrawingUnit::Inches, "ENGLISH")),
        Some(word) if word.eq_ignore_ascii_case("METRIC") => Some((DrawingUnit::Millimetres, "METRIC")),
        Some(word) => return Err(DxfDamage::Units { word: short(word) }),
        None => None,
    };
    if let Some((unit, word)) = by_word {
        let fact = format!("the file says that its units are {word}, which are {}", unit.word());
        told.notes.push(fact.clone());
        return taken(unit, fact, By::File);
    }
    let by_header = match variable(tags, "$INSUNITS") {
        Some(1) => Some(DrawingUnit::Inches),
        Some(4) => Some(DrawingUnit::Millimetres),
        Some(5) => Some(DrawingUnit::Centimetres),
        Some(6) => Some(DrawingUnit::Metres),
        _ => None,
    };
    if let Some(unit) = by_header {
        let fact = format!("the file's header says that its units are {}", unit.word());
        told.notes.push(fact.clone());
        return taken(unit, fact, By::File);
    }
    let size = pieces.iter().map(|d| extent(d.block)).fold(0.0, f64::max);
    let unit = DrawingUnit::likeliest(size, &TRIED).unwrap_or(DrawingUnit::Millimetres);
    let metres = unit.metres().unwrap_or(1e-3);
    told.warnings.push(format!(
        "the file does not say its units: read as {}, with which its largest piece is {:.0} mm long; `--set pattern.unit={}` says another",
        unit.word(),
        size * metres * 1e3,
        if unit == DrawingUnit::Centimetres { "Inches" } else { "Centimetres" }
    ));
    taken(unit, format!("the file does not say its units, and {} come nearest", unit.word()), By::Guess)
}

/// The longer side of the box around a block's outline, in the file's unit.
fn extent(block: &Block) -> f64 {
    let layer = if block.lines(1).next().is_some() { 1 } else { 14 };
    let points = || block.lines(layer).flat_map(|(_, stroke)| stroke.corners());
    let span = |of: fn(&Point2) -> f64| {
        let all = || points().map(|p| of(&p));
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    span(|p| p.x).max(span(|p| p.y)).max(0.0)
}
