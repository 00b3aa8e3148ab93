//! Instructions of HP-GL as text.

use super::{Plot, PlotCode};
use std::fmt::Write;

/// Pairs of coordinates in one instruction: older plotters hold no more.
const PAIRS: usize = 60;
/// Widths of the lines that are cut and of others, mm, where the language has them.
const CUT_WIDTH: f64 = 0.5;
const DRAW_WIDTH: f64 = 0.3;

/// A plot as it is written.
pub(super) struct Instructions<'a> {
    plot: &'a Plot,
    text: String,
    pen: Option<u32>,
}

impl<'a> Instructions<'a> {
    /// The beginning of a plot; the longest of its pages is that long, mm.
    pub(super) fn begin(plot: &'a Plot, length: f64) -> Self {
        let mut text = String::new();
        match plot.code {
            PlotCode::Hpgl => text.push_str("IN;PA;\n"),
            PlotCode::Hpgl2 => {
                let [x, y] = [length, plot.width * 1e3].map(|mm| (mm * plot.units).ceil() as i64);
                text.push_str("\x1bE\x1b%-1BBP;IN;PA;");
                let _ = write!(text, "PS{x},{y};PW{CUT_WIDTH},{};", plot.cut_pen);
                if plot.draw_pen != plot.cut_pen {
                    let _ = write!(text, "PW{DRAW_WIDTH},{};", plot.draw_pen);
                }
                text.push('\n');
            }
        }
        Instructions { plot, text, pen: None }
    }

    /// A line; false where it is shorter than a unit, and left out.
    pub(super) fn line(&mut self, cut: bool, points: &[[f64; 2]]) -> bool {
        let units = |mm: f64| (mm * self.plot.units).round() as i64;
        let mut points: Vec<[i64; 2]> = points.iter().map(|p| p.map(units)).collect();
        points.dedup();
        let [[x, y], rest @ ..] = points.as_slice() else { return false };
        if rest.is_empty() {
            return false;
        }
        let pen = if cut { self.plot.cut_pen } else { self.plot.draw_pen };
        if self.pen.replace(pen) != Some(pen) {
            let _ = writeln!(self.text, "SP{pen};");
        }
        let _ = write!(self.text, "PU{x},{y};");
        for part in rest.chunks(PAIRS) {
            let pairs: Vec<String> = part.iter().map(|[x, y]| format!("{x},{y}")).collect();
            let _ = writeln!(self.text, "PD{};", pairs.join(","));
        }
        true
    }

    /// The end of a page: the pen is lifted, and the roll goes on.
    pub(super) fn end_page(&mut self) {
        self.text.push_str("PU;PG;\n");
        self.pen = None;
    }

    pub(super) fn finish(mut self) -> Vec<u8> {
        self.text.push_str(match self.plot.code {
            PlotCode::Hpgl => "SP0;\n",
            PlotCode::Hpgl2 => "SP0;\x1b%0A\x1bE",
        });
        self.text.into_bytes()
    }
}
