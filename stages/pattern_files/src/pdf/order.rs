//! The pages with what is cut and in what order it is sewn.

use super::canvas::Canvas;
use super::front::MARGIN;
use super::sheet::PatternSheet;
use crate::drawing::{DrawingSurface, Style, TextAnchor, Type, allowance};
use crate::font::wrapped;
use toile_core::artifact::{EdgeUse, Pattern, PatternSeam, SeamKind};

/// The size of words in tables, and from line to line, mm.
const SIZE: f64 = 3.0;
const LINE: f64 = 4.2;
/// Between columns, mm.
const GAP: f64 = 3.0;

/// A table: heads of columns with their widths as shares of the page, and rows.
struct Table {
    title: &'static str,
    columns: Vec<(&'static str, f64)>,
    rows: Vec<Vec<String>>,
}

/// The pages, of that size, mm.
pub(super) fn pages(
    pattern: &Pattern,
    sheet: &PatternSheet<'_>,
    widths: &[Vec<f64>],
    size: [f64; 2],
) -> Vec<Canvas> {
    let mut out = Pages { size, done: Vec::new(), canvas: Canvas::page(), y: size[1] - MARGIN };
    out.table(&cutting(pattern, sheet, widths));
    if !pattern.seams.is_empty() {
        out.table(&sewing(pattern));
    }
    out.done.push(out.canvas);
    out.done
}

fn cutting(pattern: &Pattern, sheet: &PatternSheet<'_>, widths: &[Vec<f64>]) -> Table {
    let row = |(k, [w, h]): (usize, [f64; 2])| {
        let p = &pattern.pieces[k];
        let allowance = allowance(&widths[k]).replace("seam allowance ", "");
        vec![p.name.clone(), "1".to_owned(), format!("{w:.0} × {h:.0}"), allowance]
    };
    Table {
        title: "Cutting",
        columns: vec![("piece", 0.44), ("cut", 0.08), ("mm, with allowance", 0.2), ("allowance", 0.28)],
        rows: sheet.sizes().into_iter().enumerate().map(row).collect(),
    }
}

fn sewing(pattern: &Pattern) -> Table {
    let row = |(k, s): (usize, &PatternSeam)| {
        let lengths: Vec<String> =
            s.sides.iter().map(|side| format!("{:.1}", pattern.side_length(side) * 1e3)).collect();
        let others: Vec<String> = s.sides[1..].iter().map(|side| words(side)).collect();
        vec![
            (k + 1).to_string(),
            words(&s.sides[0]),
            others.join(" and "),
            lengths.join(" / "),
            kind(pattern, s),
        ]
    };
    Table {
        title: "Sewing, in this order",
        columns: vec![("seam", 0.07), ("sew", 0.31), ("to", 0.31), ("mm", 0.15), ("how", 0.16)],
        rows: pattern.seams.iter().enumerate().map(row).collect(),
    }
}

/// A side in words: edges of one piece under its name once.
fn words(side: &[EdgeUse]) -> String {
    let mut out = String::new();
    let mut before = "";
    for u in side {
        if u.edge.panel == before {
            out += &format!(" + {}", u.edge.edge);
        } else {
            let and = if out.is_empty() { "" } else { " + " };
            out += &format!("{and}{}: {}", u.edge.panel, u.edge.edge);
            before = &u.edge.panel;
        }
    }
    out
}

/// How a seam is sewn.
fn kind(pattern: &Pattern, s: &PatternSeam) -> String {
    let lengths = || s.sides.iter().map(|side| pattern.side_length(side));
    let (long, short) = (lengths().fold(0.0, f64::max), lengths().fold(f64::INFINITY, f64::min));
    match s.kind {
        SeamKind::Matched | SeamKind::Gathered if long > short * 1.03 => {
            format!("gather, {:.2} to 1", long / short)
        }
        SeamKind::Matched | SeamKind::Gathered if (long - short).abs() > 1e-3 => {
            format!("ease in {:.1} mm", (long - short) * 1e3)
        }
        SeamKind::Matched => "plain".to_owned(),
        SeamKind::Elastic { ratio, .. } => format!("elastic, {:.0} % of the edge", ratio * 100.0),
        SeamKind::Folded { angle } => format!("pressed to {:.0}°", angle.to_degrees()),
        SeamKind::Gathered | SeamKind::Dart | SeamKind::Pleat(_) | SeamKind::Patch => {
            s.kind.word().to_owned()
        }
    }
}

/// Pages that are filled from above.
struct Pages {
    size: [f64; 2],
    done: Vec<Canvas>,
    canvas: Canvas,
    y: f64,
}

impl Pages {
    fn room(&mut self, height: f64) -> bool {
        if self.y - height >= MARGIN {
            return true;
        }
        self.done.push(std::mem::replace(&mut self.canvas, Canvas::page()));
        self.y = self.size[1] - MARGIN;
        false
    }

    fn table(&mut self, t: &Table) {
        let _ = self.room(40.0);
        self.canvas.text([MARGIN, self.y - 6.0], Type::bold(6.0), t.title);
        self.y -= 11.0;
        self.head(t);
        for row in &t.rows {
            self.row(t, row);
        }
        self.y -= 10.0;
    }

    fn head(&mut self, t: &Table) {
        let (y, right) = (self.y, self.size[0] - MARGIN);
        for (x, _, (head, _)) in self.columns(t) {
            self.canvas.text([x, y - SIZE], Type::bold(SIZE), head);
        }
        self.canvas.line(&[[MARGIN, y - LINE - 1.0], [right, y - LINE - 1.0]], Style::solid(0.3));
        self.y -= LINE + 2.0;
    }

    /// Where each column begins and how wide it is.
    fn columns(&self, t: &Table) -> Vec<(f64, f64, (&'static str, f64))> {
        let whole = self.size[0] - 2.0 * MARGIN;
        let mut x = MARGIN;
        let one = |column: &(&'static str, f64)| {
            let at = x;
            x += column.1 * whole;
            (at, column.1 * whole - GAP, *column)
        };
        t.columns.iter().map(one).collect()
    }

    fn row(&mut self, t: &Table, row: &[String]) {
        let columns = self.columns(t);
        let cells: Vec<Vec<String>> =
            row.iter().zip(&columns).map(|(text, (_, width, _))| wrapped(text, SIZE, *width)).collect();
        let lines = cells.iter().map(Vec::len).max().unwrap_or(1);
        // A row that is higher than a page is cut off at its end.
        let height = (lines as f64 * LINE + 1.4).min(self.size[1] - 4.0 * MARGIN);
        if !self.room(height) {
            self.head(t);
        }
        for (cell, (x, _, _)) in cells.iter().zip(&columns) {
            let fits = ((height - 1.4) / LINE).round() as usize;
            for (k, line) in cell.iter().take(fits).enumerate() {
                let at = [*x, self.y - SIZE - LINE * k as f64];
                self.canvas.text(at, Type::plain(SIZE).held(TextAnchor::Start), line);
            }
        }
        self.y -= height;
        let (y, right) = (self.y, self.size[0] - MARGIN);
        self.canvas.line(&[[MARGIN, y], [right, y]], Style::solid(0.1).grey(0.6));
        self.y -= 1.0;
    }
}
