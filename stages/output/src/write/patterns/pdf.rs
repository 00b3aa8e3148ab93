//! `PatternPdf`: the sewing pattern to print.

use crate::file_names::check_name;
use crate::write::patterns::file::{SeamAllowances, files, refused};
use toile_core::prelude::*;
use toile_pattern_files::pdf::{Paper, to_pdf};

/// What a pattern is printed on.
#[choice]
#[derive(Copy)]
pub enum PatternPaper {
    /// Pages of 841 by 1189 mm.
    A0,
    /// Pages of 594 by 841 mm.
    A1,
    /// Pages of 420 by 594 mm.
    A2,
    /// Pages of 297 by 420 mm.
    A3,
    /// Pages of 210 by 297 mm.
    A4,
    /// Pages of 8.5 by 11 inches.
    Letter,
    /// Pages of 8.5 by 14 inches.
    Legal,
    /// Pages of 11 by 17 inches.
    Tabloid,
    /// Pages of that width and height.
    Custom(Length, Length),
    /// One sheet, as large as it must be.
    OneSheet,
}

impl PatternPaper {
    fn paper(self) -> Paper {
        match self {
            PatternPaper::A0 => Paper::A0,
            PatternPaper::A1 => Paper::A1,
            PatternPaper::A2 => Paper::A2,
            PatternPaper::A3 => Paper::A3,
            PatternPaper::A4 => Paper::A4,
            PatternPaper::Letter => Paper::Letter,
            PatternPaper::Legal => Paper::Legal,
            PatternPaper::Tabloid => Paper::Tabloid,
            PatternPaper::Custom(width, height) => Paper::Custom(width.metres(), height.metres()),
            PatternPaper::OneSheet => Paper::OnePiece,
        }
    }
}

/// Draws the pieces at true scale on pages to print and join, or on one sheet: cut line, sew line,
/// notches, grain, names, the numbers of seams on both sides, a test square, and a page with the
/// order of cutting and sewing.
///
/// Pages of any other size are `paper: Custom("60 cm", "90 cm")`, width and height; on its side a
/// page of A4 is `Custom("297 mm", "210 mm")`.
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
        files(&self.name, ".pdf", to_pdf(pattern, self.paper.paper(), &options), cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        let page = self.paper.paper().check().map_err(refused);
        [check_name(&self.name).err(), page.err()].into_iter().flatten().collect()
    }
}
