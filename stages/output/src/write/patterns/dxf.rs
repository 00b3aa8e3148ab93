//! `PatternDxf`: the sewing pattern for programs of the trade.

use crate::file_names::check_name;
use crate::write::patterns::file::{SeamAllowances, files};
use toile_core::prelude::*;
use toile_pattern_files::dxf::{Standard, to_dxf};

/// A standard for patterns in DXF.
#[choice]
#[derive(Copy, Eq)]
pub enum DxfStandard {
    /// AAMA, the older.
    Aama,
    /// ASTM D6673.
    Astm,
}

/// Writes the pieces as DXF-AAMA or ASTM D6673, with the line of cut and that of the seam, notches,
/// grain and texts, in millimetres.
///
/// `DxfPattern()` reads it, with the `.seams.ron` that is written beside it.
#[stage(
    role = Writer,
    source = "DXF-AAMA; ASTM D6673",
    version = 2,
    example = "PatternDxf(standard: Astm, size: \"M\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct PatternDxf {
    /// The file's name without extension.
    #[param(default = "pattern".to_owned())]
    name: String,
    /// Which standard's layers.
    #[param(default = DxfStandard::Aama)]
    standard: DxfStandard,
    #[param(flatten)]
    around: SeamAllowances,
    /// The size that the pattern is for, such as `M`.
    #[param(default = String::new())]
    size: String,
}

#[stage]
impl PatternDxf {
    pub(crate) fn run(&self, pattern: &Pattern, cx: &Context) -> Result<OutputFiles, StageError> {
        let options = self.around.options(&self.size);
        let standard = match self.standard {
            DxfStandard::Aama => Standard::Aama,
            DxfStandard::Astm => Standard::Astm,
        };
        files(&self.name, ".dxf", to_dxf(pattern, standard, &options), cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        check_name(&self.name).err().into_iter().collect()
    }
}
