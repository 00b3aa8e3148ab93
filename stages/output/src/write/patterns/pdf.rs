//! `PatternPdf`: the sewing pattern to print.

use crate::file_names::check_name;
use crate::write::patterns::file::{SeamAllowances, files};
use toile_core::prelude::*;
use toile_pattern_files::pdf::{Paper, to_pdf};

/// What a pattern is printed on.
#[choice]
#[derive(Copy, Eq)]
pub enum PatternPaper {
    /// Pages of 210 by 297 mm.
    A4,
    /// Pages of 8.5 by 11 inches.
    Letter,
    /// One sheet, as large as it must be.
    OneSheet,
}

/// Draws the pieces at true scale on pages to print and join, or on one sheet: cut line, sew line,
/// notches, grain, names, the numbers of seams on both sides, a test square, and a page with the
/// order of cutting and sewing.
#[stage(
    role = Writer,
    source = "PDF 1.7",
    example = "PatternPdf(paper: Letter, seam_allowance: \"15 mm\")",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct PatternPdf {
    /// The file's name without extension.
    #[param(default = "pattern".to_owned())]
    name: String,
    /// What it is printed on.
    #[param(default = PatternPaper::A4)]
    paper: PatternPaper,
    #[param(flatten)]
    around: SeamAllowances,
}

#[stage]
impl PatternPdf {
    pub(crate) fn run(&self, pattern: &Pattern, cx: &Context) -> Result<OutputFiles, StageError> {
        let options = self.around.options("");
        let paper = match self.paper {
            PatternPaper::A4 => Paper::A4,
            PatternPaper::Letter => Paper::Letter,
            PatternPaper::OneSheet => Paper::OnePiece,
        };
        files(&self.name, ".pdf", to_pdf(pattern, paper, &options), cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        check_name(&self.name).err().into_iter().collect()
    }
}
