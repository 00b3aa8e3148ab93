//! A sheet cut into pages that are joined again.
//!
//! A page shows its part of the sheet and, to the right and below, a margin of [`OVERLAP`] of the
//! next ones, on which those are glued. Pages are laid from left to right and from above; rows and
//! columns are counted from 1. Marks on the joints carry the same number on both pages. A page with
//! nothing on it is left out.

use super::Paper;
use super::canvas::{Canvas, SHEET};
use super::sheet::PatternSheet;
use crate::drawing::{DrawingSurface, Style, TextAnchor, Type};
use toile_core::artifact::Point2;

/// What printers leave white around a page, mm.
const MARGIN: f64 = 10.0;
/// How far pages overlap, mm.
pub(super) const OVERLAP: f64 = 10.0;
/// Of so many times the most pages, those with nothing on them among them, it is looked which are
/// needed.
const EMPTY: usize = 4;
/// Columns that are tried.
const COLUMNS: usize = 12;
/// Between the pieces and the edge of the sheet, mm.
const AROUND: f64 = 4.0;
/// Half the height of a mark on a joint, mm.
const MARK: f64 = 3.5;
/// The line along which pages are joined.
const JOINT: Style = Style::dashed(0.2, &[2.0, 2.0]).grey(0.5);

/// The pages of a sheet.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tiles {
    paper: Paper,
    /// What of the sheet a page shows beside the overlap, mm.
    pub step: [f64; 2],
    pub columns: usize,
    pub rows: usize,
    /// Row and column of each page, from 0, the uppermost row first.
    pub pages: Vec<(usize, usize)>,
}

impl Tiles {
    /// Lays the pieces so that they need few pages of that paper; how many there would be comes
    /// with it.
    pub(super) fn lay(sheet: &mut PatternSheet<'_>, paper: Paper, most: usize) -> Result<Self, usize> {
        let [w, h] = paper.size();
        let step = [w - 2.0 * MARGIN - OVERLAP, h - 2.0 * MARGIN - OVERLAP];
        let mut best: Option<(usize, f64)> = None;
        let mut least = usize::MAX;
        for columns in 1..=COLUMNS {
            let width = columns as f64 * step[0];
            sheet.lay(width, AROUND);
            match Tiles::of(sheet, paper, step, most) {
                Ok(tiles) if best.is_none_or(|(pages, _)| tiles.pages.len() < pages) => {
                    best = Some((tiles.pages.len(), width));
                }
                Ok(_) => {}
                Err(pages) => least = least.min(pages),
            }
        }
        let (_, width) = best.ok_or(least)?;
        sheet.lay(width, AROUND);
        let tiles = Tiles::of(sheet, paper, step, most)?;
        // The upper edge of the sheet is that of the first row.
        let up = tiles.rows as f64 * step[1] - sheet.size[1];
        sheet.pieces.iter_mut().for_each(|p| p.corner[1] += up);
        Ok(tiles)
    }

    /// The pages of a sheet that is laid; how many there would be where they are too many.
    fn of(sheet: &PatternSheet<'_>, paper: Paper, step: [f64; 2], most: usize) -> Result<Self, usize> {
        let [columns, rows] = [0, 1].map(|k| (sheet.size[k] / step[k]).ceil().max(1.0));
        if columns * rows > (EMPTY * most) as f64 {
            return Err((columns * rows).min(1e9) as usize);
        }
        let mut tiles =
            Tiles { paper, step, columns: columns as usize, rows: rows as usize, pages: Vec::new() };
        let low = [0.0, sheet.size[1] - rows * step[1]];
        let reached = sheet.reached(low, step, tiles.columns, tiles.rows);
        let has = |(r, c): &(usize, usize)| reached[(tiles.rows - r - 1) * tiles.columns + c];
        let all = (0..tiles.rows).flat_map(|r| (0..tiles.columns).map(move |c| (r, c)));
        tiles.pages = all.filter(has).collect();
        if tiles.pages.len() > most { Err(tiles.pages.len()) } else { Ok(tiles) }
    }

    /// The part of the sheet that a page shows beside the overlap. The sheet's upper left corner is
    /// that of the first page.
    pub(super) fn part(&self, (row, column): (usize, usize)) -> (Point2, Point2) {
        let [w, h] = self.step;
        let (x, y) = (column as f64 * w, (self.rows - row - 1) as f64 * h);
        (Point2::new(x, y), Point2::new(x + w, y + h))
    }

    fn printed(&self, row: usize, column: usize) -> bool {
        self.pages.contains(&(row, column))
    }

    /// A page with its part of the sheet.
    pub(super) fn draw(&self, page: (usize, usize), name: &str) -> Canvas {
        let [w, h] = self.paper.size();
        let mut canvas = Canvas::page();
        let (lo, _) = self.part(page);
        let content = &mut canvas.0;
        content.save_state();
        let frame = [MARGIN, MARGIN, w - 2.0 * MARGIN, h - 2.0 * MARGIN].map(|n| n as f32);
        content.rect(frame[0], frame[1], frame[2], frame[3]).clip_nonzero().end_path();
        let to = [MARGIN - lo.x, MARGIN + OVERLAP - lo.y].map(|n| n as f32);
        content.transform([1.0, 0.0, 0.0, 1.0, to[0], to[1]]);
        content.x_object(SHEET);
        self.joints(&mut canvas, page);
        canvas.0.restore_state();
        self.words(&mut canvas, page, name);
        canvas
    }

    /// The lines and marks of the four joints around a page, in the sheet's coordinates.
    fn joints(&self, canvas: &mut Canvas, (row, column): (usize, usize)) {
        let (lo, hi) = self.part((row, column));
        let (far, deep) = (hi.x + OVERLAP, lo.y - OVERLAP);
        canvas.line(&[[lo.x, deep], [lo.x, hi.y]], JOINT);
        canvas.line(&[[lo.x, hi.y], [far, hi.y]], JOINT);
        canvas.line(&[[hi.x, deep], [hi.x, hi.y]], JOINT);
        canvas.line(&[[lo.x, lo.y], [far, lo.y]], JOINT);
        let (middle, centre) = (f64::midpoint(lo.y, hi.y), f64::midpoint(lo.x, hi.x));
        if column > 0 && self.printed(row, column - 1) {
            mark(canvas, [lo.x, middle], self.beside(row, column - 1), false);
        }
        if self.printed(row, column + 1) {
            mark(canvas, [hi.x, middle], self.beside(row, column), false);
        }
        if row > 0 && self.printed(row - 1, column) {
            mark(canvas, [centre, hi.y], self.below(row - 1, column), true);
        }
        if self.printed(row + 1, column) {
            mark(canvas, [centre, lo.y], self.below(row, column), true);
        }
    }

    /// The number of the joint between a page and the next of its row.
    fn beside(&self, row: usize, column: usize) -> usize {
        row * (2 * self.columns - 1) + column + 1
    }

    /// The number of the joint between a page and the one below.
    fn below(&self, row: usize, column: usize) -> usize {
        row * (2 * self.columns - 1) + self.columns + column
    }

    /// Which page it is, and which ones go where.
    fn words(&self, canvas: &mut Canvas, (row, column): (usize, usize), name: &str) {
        let [w, h] = self.paper.size();
        let label = format!("row {}, column {}", row + 1, column + 1);
        let at = [MARGIN + 3.0, h - MARGIN - 6.5];
        canvas.text(at, Type::bold(4.0).grey(0.4), &label);
        let name = crate::font::shortened(name, 2.6, false, w / 2.0);
        canvas.text([at[0], at[1] - 4.0], Type::plain(2.6).grey(0.4), &name);
        let small = Type::plain(2.4).grey(0.4);
        if self.printed(row, column + 1) {
            let text = format!("row {}, column {} is glued on here", row + 1, column + 2);
            canvas.text([w - MARGIN - 3.5, h * 0.25], small.upright(true).held(TextAnchor::Middle), &text);
        }
        if self.printed(row + 1, column) {
            let text = format!("row {}, column {} is glued on here", row + 2, column + 1);
            canvas.text([w * 0.25, MARGIN + 3.5], small.held(TextAnchor::Middle), &text);
        }
    }
}

/// A diamond on a joint, its number on both sides of it.
fn mark(canvas: &mut Canvas, [x, y]: [f64; 2], number: usize, level: bool) {
    canvas.filled(&[[x - MARK, y], [x, y - MARK], [x + MARK, y], [x, y + MARK]], 0.75);
    canvas.line(&[[x - MARK, y], [x + MARK, y]], Style::solid(0.2));
    canvas.line(&[[x, y - MARK], [x, y + MARK]], Style::solid(0.2));
    let (text, kind) = (number.to_string(), Type::bold(3.0).held(TextAnchor::Middle).grey(0.3));
    let both = if level { [[x, y + 4.5], [x, y - 6.7]] } else { [[x - 6.0, y - 1.1], [x + 6.0, y - 1.1]] };
    both.into_iter().for_each(|at| canvas.text(at, kind, &text));
}
