//! How many of the file's units make a metre.
//!
//! Method: the largest panel of a garment for people is between 15 cm and 8 m. A unit in the file
//! that gives such a size is used. Where the file has none, or one that gives no panel of that
//! size, the first usual unit that gives such a panel is taken, with a warning. Limit: the right
//! unit of a file for a doll is taken for a wrong one.

use super::super::unit::{LIKELY, WORN};
use super::damage::SpecificationDamage;
use super::read::RawFile;
use toile_core::Remarks;
use toile_core::artifact::Point2;

/// Units in a metre: centimetres as GarmentCode writes, a third of that as some of its forerunner's
/// templates, millimetres, inches, metres.
const USUAL: [f64; 5] = [100.0, 300.0, 1000.0, 1000.0 / 25.4, 1.0];
/// What GarmentCode writes.
const DEFAULT: f64 = 100.0;

/// Metres in a unit.
pub(super) fn metres(file: &RawFile, told: &mut Remarks) -> Result<f64, SpecificationDamage> {
    let size = file.panels.iter().map(|p| extent(&p.vertices)).fold(0.0, f64::max);
    let fits = |units: f64| WORN.contains(&(size / units));
    let said = file.units.unwrap_or(DEFAULT);
    if file.units.is_none() {
        told.notes.push("the file does not say its units: read as centimetres".to_owned());
    }
    if fits(said) {
        return Ok(1.0 / said);
    }
    stray(file, said)?;
    let likely = |units: &f64| LIKELY.contains(&(size / units));
    match USUAL.into_iter().find(likely) {
        Some(units) => {
            told.warnings.push(format!(
                "with {said} units in a metre the largest panel is {:.3} m long: read with {units:.4} units in a metre, {:.3} m",
                size / said,
                size / units
            ));
            Ok(1.0 / units)
        }
        None => Err(SpecificationDamage::Unsewable {
            what: format!("the largest panel is {size} units long, which is no garment in any usual unit"),
            remedy: "write 100 as `units_in_meter` for centimetres",
        }),
    }
}

/// One panel alone is far too long: a vertex of it stands wrong, not the unit.
fn stray(file: &RawFile, units: f64) -> Result<(), SpecificationDamage> {
    let mut sizes: Vec<(f64, &str)> =
        file.panels.iter().map(|p| (extent(&p.vertices) / units, p.name.as_str())).collect();
    sizes.sort_by(|a, b| b.0.total_cmp(&a.0));
    let [(largest, panel), (next, _), ..] = sizes[..] else { return Ok(()) };
    if largest > *WORN.end() && LIKELY.contains(&next) {
        return Err(SpecificationDamage::Unsewable {
            what: format!("panel \"{panel}\" is {largest:.2} m long, the others at most {next:.2} m"),
            remedy: "correct its vertices",
        });
    }
    Ok(())
}

/// The longer side of the box around the points.
fn extent(points: &[Point2]) -> f64 {
    let span = |of: fn(&Point2) -> f64| {
        let all = || points.iter().map(of);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    if points.is_empty() { 0.0 } else { span(|p| p.x).max(span(|p| p.y)) }
}
