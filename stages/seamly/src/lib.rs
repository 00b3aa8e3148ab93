//! Patterns of Seamly2D and Valentina, worked out to pieces.
//!
//! ```text
//! pattern (sm2d, val) --head--> unit, file of measurements
//! measurements (smis, smms, vit, vst) --measure--> table
//! pattern + table --draft--> points and curves --outline--> pieces
//! ```
//!
//! A pattern is a list of tools, each with formulas of measurements and of what is drawn before it.
//! Everything is kept in the unit of the file, y up. Written from the published schemas and from
//! files; no code of either program is in it. Cost: milliseconds a file.

mod draft;
mod fault;
pub mod formula;
mod head;
mod measure;
mod outline;
mod plane;
mod source;
#[cfg(test)]
mod spoilt;
mod unit;

pub use fault::{SeamlyFault, ToolPlace};
pub use head::PatternHead;
pub use measure::{Grade, MeasurementTable};
pub use outline::{DraftedPath, DraftedPiece, InnerPath, NodeAllowance, OutlinePart, PieceFold};
pub use plane::{DraftArc, DraftStroke};
pub use unit::LengthUnit;

use draft::DraftValues;

/// Steps of a construction that are told one by one.
const MOST_TOLD: usize = 6;

/// A pattern that is worked out.
#[derive(Debug, Clone, PartialEq)]
pub struct Drafted {
    /// The unit of its numbers.
    pub unit: LengthUnit,
    /// Its pieces, in the order of the file.
    pub pieces: Vec<DraftedPiece>,
    /// What is told of it.
    pub notes: Vec<String>,
    /// What is told of it and may be a mistake.
    pub warnings: Vec<String>,
}

/// Works out a pattern.
///
/// Errors: all that is wrong with what its pieces need.
pub fn drafted(bytes: &[u8], measurements: Option<MeasurementTable>) -> Result<Drafted, Vec<SeamlyFault>> {
    let one = |fault| vec![fault];
    let tree = source::tree(source::text(bytes).map_err(one)?).map_err(one)?;
    let root = tree.root_element();
    let head = PatternHead::of(root).map_err(one)?;
    let mut notes = measurements.as_ref().map_or_else(Vec::new, |m| m.notes.clone());
    let mut values = DraftValues::of(measurements);
    head::increments(root, &mut values);
    let mut draft = draft::drawn(root, values).map_err(one)?;
    let pieces = outline::pieces(root, &mut draft, head.unit.metres(), &mut notes)?;
    let mut warnings = std::mem::take(&mut draft.warnings);
    if !draft.values.faults.is_empty() {
        let faults: Vec<String> = draft.values.faults.iter().map(ToString::to_string).collect();
        warnings.push(format!("tools that no piece needs could not be worked out: {}", some(&faults)));
    }
    Ok(Drafted { unit: head.unit, pieces, notes, warnings })
}

/// The first of some sentences, and how many there are beside.
fn some(all: &[String]) -> String {
    let more = all.len().saturating_sub(MOST_TOLD);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    all[..all.len().min(MOST_TOLD)].join("; ") + &more
}
