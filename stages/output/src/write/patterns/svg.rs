//! `PatternSvg`: the sewing pattern as a drawing.

use crate::file_names::check_name;
use crate::write::patterns::file::{SeamAllowances, files};
use toile_core::prelude::*;
use toile_pattern_files::svg;

/// Draws the pieces of the pattern at true scale, with grain, notches, inner lines and the numbers
/// of seams on both sides.
///
/// `SvgPattern()` reads it, with the `.seams.ron` that is written beside it.
#[stage(
    role = Writer,
    source = "SVG 1.1",
    example = "PatternSvg(name: \"mine\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct PatternSvg {
    /// The file's name without extension.
    #[param(default = "pattern".to_owned())]
    name: String,
    #[param(flatten)]
    around: SeamAllowances,
}

#[stage]
impl PatternSvg {
    pub(crate) fn run(&self, pattern: &Pattern, cx: &Context) -> Result<OutputFiles, StageError> {
        let options = self.around.options("");
        files(&self.name, ".svg", svg::to_svg(pattern, &options), cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        check_name(&self.name).err().into_iter().collect()
    }
}
