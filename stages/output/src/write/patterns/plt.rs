//! `PatternPlt`: the sewing pattern for plotters and cutters.

use crate::file_names::check_name;
use crate::write::patterns::file::{SeamAllowances, files};
use toile_core::prelude::*;
use toile_pattern_files::plt::{Along, Plot, PlotCode, to_plt};

/// A language of plotters.
#[choice]
#[derive(Copy, Eq)]
pub enum HpglStandard {
    /// HP-GL, which cutters and all plotters take.
    Hpgl,
    /// HP-GL/2, which also tells the plot's size and the widths of pens.
    Hpgl2,
}

/// What of a piece lies along the roll.
#[choice]
#[derive(Copy, Eq)]
pub enum AlongRoll {
    /// The longer side, which takes less paper.
    LongSide,
    /// The grain, for cloth that is cut on the machine.
    Grain,
}

/// Plots the pieces at true scale on a roll: cut lines by one pen or knife, sew lines, notches,
/// grain, names and the numbers of seams on both sides by another.
///
/// What is drawn of a row of pieces comes before what is cut of it, cut-outs before the line around
/// a piece. Letters and dashes are single strokes: cutters have no fonts and no line types.
#[stage(
    role = Writer,
    source = "The HP-GL/2 Reference Guide, Hewlett-Packard 1990",
    example = "PatternPlt(width: \"90 cm\", standard: Hpgl2)",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct PatternPlt {
    /// The file's name without extension.
    #[param(default = "pattern".to_owned())]
    name: String,
    /// The language of the machine.
    #[param(default = HpglStandard::Hpgl)]
    standard: HpglStandard,
    /// How much of the roll's width the machine reaches; the pieces lie within it.
    #[param(default = Length::m(1.5), min = 0.05, max = 10.0)]
    width: Length,
    /// How long pages are at most; without it the plot is one page, as long as it must be.
    #[param(default = None, min = 0.05, max = 100.0)]
    page_length: Option<Length>,
    /// What of a piece lies along the roll.
    #[param(default = AlongRoll::LongSide)]
    along: AlongRoll,
    /// The pen, or knife, for lines that are cut.
    #[param(default = 1, min = 1, max = 255)]
    cut_pen: u32,
    /// The pen for all other lines.
    #[param(default = 2, min = 1, max = 255)]
    draw_pen: u32,
    /// Units of the machine in a millimetre; 40 is 1016 an inch.
    #[param(default = 40.0, min = 1.0, max = 1000.0)]
    units: f64,
    #[param(flatten)]
    around: SeamAllowances,
}

#[stage]
impl PatternPlt {
    pub(crate) fn run(&self, pattern: &Pattern, cx: &Context) -> Result<OutputFiles, StageError> {
        let plot = Plot {
            code: match self.standard {
                HpglStandard::Hpgl => PlotCode::Hpgl,
                HpglStandard::Hpgl2 => PlotCode::Hpgl2,
            },
            width: self.width.metres(),
            page_length: self.page_length.map(Length::metres),
            along: match self.along {
                AlongRoll::LongSide => Along::LongSide,
                AlongRoll::Grain => Along::Grain,
            },
            units: self.units,
            cut_pen: self.cut_pen,
            draw_pen: self.draw_pen,
        };
        files(&self.name, ".plt", to_plt(pattern, &plot, &self.around.options("")), cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        check_name(&self.name).err().into_iter().collect()
    }
}
