//! `PatternJson`: the sewing pattern as GarmentCode writes it.

use crate::file_names::check_name;
use crate::write::patterns::file::files;
use toile_core::prelude::*;
use toile_pattern_files::garment_code;

/// Writes the pattern as a `_specification.json`, which GarmentCode and `GarmentCode()` read.
///
/// What the format cannot hold (inner lines, notches, seams of more than two sides and kinds of
/// seams) is reported; all seams are in a `.seams.ron` beside it.
#[stage(
    role = Writer,
    source = "pygarment 2.0 (Korosteleva and Sorkine-Hornung 2023)",
    version = 2,
    example = "PatternJson(name: \"mine\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct PatternJson {
    /// The file's name without extension.
    #[param(default = "pattern".to_owned())]
    name: String,
}

#[stage]
impl PatternJson {
    pub(crate) fn run(&self, pattern: &Pattern, cx: &Context) -> Result<OutputFiles, StageError> {
        files(&self.name, "_specification.json", garment_code::to_json(pattern), cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        check_name(&self.name).err().into_iter().collect()
    }
}
