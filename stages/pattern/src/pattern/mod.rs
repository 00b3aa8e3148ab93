//! Sewing patterns from files: what takes the place of photos, outlines and a style.

mod chain;
pub(crate) mod copies;
mod dxf;
mod faults;
mod follow;
mod garment_code;
mod letters;
mod marks;
mod outfit;
mod propose;
mod seamly;
mod seams;
mod side;
mod sidecar;
mod svg;
mod unfold;
mod unit;

pub use dxf::DxfPattern;
pub use garment_code::GarmentCode;
pub use outfit::Outfit;
pub use propose::{ProposedSeam, proposed_seams};
pub use seamly::SeamlyPattern;
pub use sidecar::seams_file;
pub use svg::SvgPattern;
pub use unit::DrawingUnit;

use std::path::Path;
use toile_core::{Context, ErrorCode, Registry, Remarks, StageError};

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<GarmentCode>();
    registry.add::<Outfit>();
    registry.add::<DxfPattern>();
    registry.add::<SeamlyPattern>();
    registry.add::<SvgPattern>();
}

/// Refuses a reader whose file is not named; `example` is such a file.
fn named(file: &str, example: &str) -> Result<(), StageError> {
    if file.is_empty() {
        let e = StageError::new(ErrorCode::InvalidParameter, "no file is named to read the pattern from");
        return Err(e.hint(format!("write `file: \"{example}\"`")).at("file"));
    }
    Ok(())
}

/// The file's name without folder, extension and the word that GarmentCode adds.
fn stem(file: &str) -> String {
    let stem = Path::new(file).file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    stem.strip_suffix("_specification").unwrap_or(&stem).to_owned()
}

/// Reports the remarks of a reader.
fn tell(told: Remarks, cx: &Context) {
    told.notes.into_iter().for_each(|what| cx.note(what));
    told.warnings.into_iter().for_each(|what| cx.warn(what));
}
