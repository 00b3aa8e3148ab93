//! HP-GL and HP-GL/2 of a pattern in true scale, for plotters and cutters that take a roll.
//!
//! x runs along the roll, y across it. A plot has the instructions that all machines know: `IN`,
//! `PA`, `SP`, `PU`, `PD`, `PG`. HP-GL/2 adds `ESC % -1 B`, by which machines of several languages
//! take it, `BP`, the plot's size (`PS`) and the widths of pens (`PW`). A unit is 0.025 mm, 40 of
//! them a millimetre or 1016 an inch, in both. Source: The HP-GL/2 Reference Guide, A Handbook for
//! Program Developers, Hewlett-Packard, Addison-Wesley 1990.
//!
//! Pieces lie in rows across the roll, the longest rows first. In each row all that is drawn comes
//! first, by one pen; then what is cut, by the other: of each piece cut-outs and slits, at last the
//! line around it. So the roll goes back by no more than a row, and no cloth moves that is still to
//! be drawn on. Curves are polylines within 0.04 mm, the rounding to units among it. [`roll`] lays
//! the pieces, [`plotter`] makes lines of what is drawn, [`letters`] has the letters,
//! [`instructions`] writes.
//!
//! Cost: some ten milliseconds a piece. Limits: pieces are turned by right angles alone, and are
//! not nested into each other; the origin is the lower left corner of a page, not its middle as
//! that of large pen plotters before HP-GL/2; machines that count with 16 bits take 819 mm along
//! and across, which is told; machines that lay x along the longer side of a page turn a plot that
//! is shorter than the roll is wide; Latin letters, others are question marks, which is told; one
//! size; every piece is cut once. Seams are numbers on edges, no program reads them back.

mod instructions;
mod letters;
mod plotter;
mod roll;

use crate::allowance::cut_lines;
use crate::drawing::{laid, unknown_letters};
use crate::error::{WriteError, writable};
use crate::options::DrawingOptions;
use crate::written::Written;
use instructions::Instructions;
use roll::PlotPage;
use toile_core::artifact::Pattern;

/// Units of a millimetre that are taken.
const UNITS: [f64; 2] = [1.0, 1000.0];
/// The greatest coordinate of HP-GL/2.
const FARTHEST_UNIT: f64 = 8_388_607.0;
/// That of plotters that count with 16 bits.
const FARTHEST_OLD: f64 = 32_767.0;

/// Which of the two languages is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlotCode {
    /// HP-GL, which cutters and all plotters take.
    Hpgl,
    /// HP-GL/2, with the plot's size and the widths of pens.
    Hpgl2,
}

/// What of a piece lies along the roll.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// Its longer side.
    LongSide,
    /// Its grain.
    Grain,
}

/// How a pattern is plotted.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// The language.
    pub code: PlotCode,
    /// How wide the roll is, metres.
    pub width: f64,
    /// How long the pages are at most, metres; none for one long plot.
    pub page_length: Option<f64>,
    /// What lies along the roll.
    pub along: Along,
    /// Units of the machine in a millimetre; 40 in the standard.
    pub units: f64,
    /// The number of the pen, or knife, for lines that are cut.
    pub cut_pen: u32,
    /// That of the pen for all others.
    pub draw_pen: u32,
}

/// A pattern as a plot. No program reads it back: its file of seams is empty.
///
/// Errors: a pattern that is not sound, that has no pieces, or with a piece beyond
/// [`FARTHEST`](crate::FARTHEST); a seam allowance that cannot be cut; a piece that is wider than
/// the roll or longer than a page; a plot that is longer than plotters count; a unit that no
/// plotter has.
pub fn to_plt(pattern: &Pattern, plot: &Plot, options: &DrawingOptions) -> Result<Written, WriteError> {
    writable(pattern)?;
    let [least, most] = UNITS;
    if !(least..=most).contains(&plot.units) {
        return Err(WriteError::PlotUnit { given: plot.units, least, most });
    }
    let cut = cut_lines(pattern, &options.allowances)?;
    let pages = roll::lay(&laid(pattern, &cut, options), plot)?;
    let longest = pages.iter().map(|p| p.length).fold(plot.width * 1e3, f64::max);
    if longest * plot.units > FARTHEST_UNIT {
        let most = FARTHEST_UNIT / plot.units / 1e3;
        return Err(WriteError::PlotLength { metres: longest / 1e3, most });
    }
    let mut warnings = cut.notes;
    let names = std::iter::once(&pattern.name).chain(pattern.pieces.iter().map(|p| &p.name));
    warnings.extend(unknown_letters(names, letters::holds));
    let bytes = written(pattern, plot, &pages, &mut warnings);
    let notes = std::iter::once(told(plot, &pages)).chain(beyond_old(plot, &pages)).collect();
    Ok(Written { bytes, seams: String::new(), notes, warnings })
}

/// The file; pieces that are too small to be cut are told.
fn written(pattern: &Pattern, plot: &Plot, pages: &[PlotPage], warnings: &mut Vec<String>) -> Vec<u8> {
    let length = pages.iter().map(|p| p.length).fold(0.0, f64::max);
    let mut out = Instructions::begin(plot, length);
    for page in pages {
        for row in &page.rows {
            let drawn = row.iter().flat_map(|p| &p.tracks).filter(|t| !t.cut);
            drawn.for_each(|t| _ = out.line(false, &t.points));
            for piece in row {
                let cut = piece.tracks.iter().filter(|t| t.cut);
                if cut.filter(|t| out.line(true, &t.points)).count() == 0 {
                    let name = &pattern.pieces[piece.piece].name;
                    warnings.push(format!(
                        "piece \"{name}\" is smaller than a unit of the plotter: it is not cut"
                    ));
                }
            }
        }
        out.end_page();
    }
    out.finish()
}

/// Tells coordinates that plotters of 16 bits do not count to; those of HP-GL/2 count farther.
fn beyond_old(plot: &Plot, pages: &[PlotPage]) -> Option<String> {
    let pieces = pages.iter().flat_map(|p| &p.rows).flatten();
    let points = pieces.flat_map(|p| &p.tracks).flat_map(|t| &t.points);
    let farthest = points.flatten().fold(0.0, |most: f64, mm| most.max(*mm)) * plot.units;
    (plot.code == PlotCode::Hpgl && farthest > FARTHEST_OLD).then(|| {
        let mm = (FARTHEST_OLD / plot.units).floor();
        format!(
            "coordinates go to {farthest:.0}: a plotter that counts to {FARTHEST_OLD} needs `page_length: \"{mm} mm\"` \
             and `width: \"{mm} mm\"`"
        )
    })
}

/// How long the plot is, in a sentence.
fn told(plot: &Plot, pages: &[PlotPage]) -> String {
    let metres = pages.iter().map(|p| p.length).sum::<f64>() / 1e3;
    let on = match (plot.page_length, pages.len()) {
        (None, _) => String::new(),
        (Some(_), 1) => ", 1 page".to_owned(),
        (Some(_), n) => format!(", {n} pages"),
    };
    format!("the plot needs {metres:.2} m of a roll of {:.2} m{on}", plot.width)
}
