//! The first page: a square to measure, what the lines mean, how the pages are joined. And the
//! sheet in one piece.

use super::canvas::{Canvas, SHEET};
use super::sheet::PatternSheet;
use super::tiles::{OVERLAP, Tiles};
use super::{Paper, PdfPage};
use crate::drawing::{CUT, DOTTED, DrawingSurface, FOLD, SEW, Style, THIN, TextAnchor, Type};
use crate::font::{shortened, wrapped};
use crate::options::DrawingOptions;
use toile_core::artifact::Pattern;

/// Around what is written, mm.
pub(super) const MARGIN: f64 = 15.0;
/// The side of the square, mm.
const SQUARE: f64 = 100.0;
/// Around the pieces of a sheet in one piece, mm.
pub(super) const BORDER: f64 = 15.0;
/// Above its pieces stand the square and a title, mm.
pub(super) const HEAD: f64 = SQUARE + 30.0;
/// No sheet in one piece is narrower, mm.
pub(super) const LEAST_WIDTH: f64 = SQUARE + 160.0;

/// The first page.
pub(super) fn page(
    pattern: &Pattern,
    sheet: &PatternSheet<'_>,
    tiles: Option<&Tiles>,
    paper: Paper,
    options: &DrawingOptions,
) -> Canvas {
    let [w, h] = paper.size();
    let mut canvas = Canvas::page();
    let name = shortened(&pattern.name, 9.0, true, w - 2.0 * MARGIN);
    canvas.text([MARGIN, h - MARGIN - 8.0], Type::bold(9.0), &name);
    canvas.text([MARGIN, h - MARGIN - 15.0], Type::plain(4.0).grey(0.3), &subtitle(pattern, options));
    canvas.line(&[[MARGIN, h - MARGIN - 19.0], [w - MARGIN, h - MARGIN - 19.0]], Style::solid(0.4));
    let top = h - MARGIN - 26.0;
    square(&mut canvas, [MARGIN, top - SQUARE]);
    legend(&mut canvas, [MARGIN + SQUARE + 9.0, top], w - MARGIN);
    let below = top - SQUARE - 10.0;
    let used = advice(&mut canvas, [MARGIN, below], w - 2.0 * MARGIN, tiles.is_some());
    if let Some(tiles) = tiles {
        let room = [w - 2.0 * MARGIN, below - used - 6.0 - MARGIN];
        map(&mut canvas, sheet, tiles, [MARGIN, MARGIN], room);
    }
    canvas
}

/// How many pieces and seams, the size and the day.
fn subtitle(pattern: &Pattern, options: &DrawingOptions) -> String {
    let many = |n: usize, one: &str| if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") };
    let mut out = format!("{}, {}", many(pattern.pieces.len(), "piece"), many(pattern.seams.len(), "seam"));
    for (before, value) in [("size ", &options.size), ("", &options.date)] {
        if !value.is_empty() {
            out += &format!(", {before}{value}");
        }
    }
    out
}

/// A square to measure, its lower left corner there: the middles of its lines are 100 mm apart, and
/// the lines so thin that their edges are within a tenth of a millimetre.
fn square(canvas: &mut Canvas, [x, y]: [f64; 2]) {
    let (right, top) = (x + SQUARE, y + SQUARE);
    canvas.closed(&[[x, y], [right, y], [right, top], [x, top]], Style::solid(0.1));
    let middle = x + SQUARE / 2.0;
    canvas.text([middle, y + 54.0], Type::bold(5.0).held(TextAnchor::Middle), "100 mm × 100 mm");
    let lines = [
        "Print at 100 % (\"actual size\"), not fitted to the page.",
        "Measure this square before anything is cut.",
    ];
    for (k, line) in lines.iter().enumerate() {
        canvas.text([middle, y + 46.0 - 5.0 * k as f64], Type::plain(3.4).held(TextAnchor::Middle), line);
    }
}

/// What the lines mean.
fn legend(canvas: &mut Canvas, [x, top]: [f64; 2], right: f64) {
    canvas.text([x, top - 4.0], Type::bold(4.2), "Lines and marks");
    let lines: [(&str, Style); 6] = [
        ("cut here", CUT),
        ("sew here", SEW),
        ("fold or pleat", FOLD),
        ("where a part is placed", THIN),
        ("other marks", DOTTED),
        ("pages are joined here", Style::dashed(0.2, &[2.0, 2.0]).grey(0.5)),
    ];
    let mut y = top - 12.0;
    let words = x + 22.0;
    for (text, style) in lines {
        canvas.line(&[[x, y + 1.1], [x + 18.0, y + 1.1]], style);
        canvas.text([words, y], Type::plain(3.2), &shortened(text, 3.2, false, right - words));
        y -= 7.0;
    }
    // A grain line, a notch, a number, a joint.
    canvas.line(&[[x, y + 1.1], [x + 18.0, y + 1.1]], THIN);
    canvas.filled(&[[x, y + 1.1], [x + 4.0, y + 2.4], [x + 4.0, y - 0.2]], 0.0);
    canvas.filled(&[[x + 18.0, y + 1.1], [x + 14.0, y + 2.4], [x + 14.0, y - 0.2]], 0.0);
    canvas.text([words, y], Type::plain(3.2), "grain of the cloth");
    y -= 7.0;
    canvas.line(&[[x, y], [x + 18.0, y]], CUT);
    canvas.filled(&[[x + 7.0, y], [x + 11.0, y], [x + 9.0, y + 3.2]], 0.0);
    canvas.text([words, y], Type::plain(3.2), "notch");
    y -= 8.0;
    canvas.circle([x + 9.0, y + 1.1], 2.8, Style::solid(0.2));
    canvas.text([x + 9.0, y - 0.15], Type::bold(3.5).held(TextAnchor::Middle), "3");
    let told = ["number of a seam: edges", "with the same number", "are sewn together"];
    for (k, line) in told.iter().enumerate() {
        canvas.text([words, y + 1.0 - 4.2 * k as f64], Type::plain(3.2), line);
    }
}

/// How it is printed and joined; how high the words are, mm.
fn advice(canvas: &mut Canvas, [x, y]: [f64; 2], width: f64, joined: bool) -> f64 {
    let text = match joined {
        true => format!(
            "Cut or fold each page along the dashed line at its left and its upper edge, and glue it on the margin of {OVERLAP} mm of the page \
             before and of the page above. Diamonds with the same number lie on each other. The pages are laid as drawn here:"
        ),
        false => "The last page is the whole pattern in one piece, for a wide printer.".to_owned(),
    };
    let lines = wrapped(&text, 3.4, width);
    for (k, line) in lines.iter().enumerate() {
        canvas.text([x, y - 4.0 - 5.0 * k as f64], Type::plain(3.4), line);
    }
    5.0 * lines.len() as f64
}

/// The sheet in small with its pages, in that room from its lower left corner.
fn map(canvas: &mut Canvas, sheet: &PatternSheet<'_>, tiles: &Tiles, [x, y]: [f64; 2], [w, h]: [f64; 2]) {
    let whole = [tiles.columns as f64 * tiles.step[0], tiles.rows as f64 * tiles.step[1]];
    let scale = (w / whole[0]).min(h / whole[1]);
    let (left, low) = (x + (w - whole[0] * scale) / 2.0, y + h - whole[1] * scale);
    let to = |[px, py]: [f64; 2]| [left + px * scale, low + py * scale];
    for page in &tiles.pages {
        let (lo, hi) = tiles.part(*page);
        canvas.closed(
            &[[lo.x, lo.y], [hi.x, lo.y], [hi.x, hi.y], [lo.x, hi.y]].map(to),
            Style::solid(0.15).grey(0.5),
        );
    }
    for p in &sheet.pieces {
        let line: Vec<[f64; 2]> = p.cut.iter().map(|q| to(p.at(*q))).collect();
        canvas.closed(&line, Style::solid(0.25));
    }
    let size = (tiles.step[1] * scale / 5.0).clamp(1.5, 4.0);
    for (row, column) in &tiles.pages {
        let (lo, hi) = tiles.part((*row, *column));
        let at = to([f64::midpoint(lo.x, hi.x), f64::midpoint(lo.y, hi.y)]);
        let text = format!("{} / {}", row + 1, column + 1);
        canvas.text(
            [at[0], at[1] - size * 0.35],
            Type::bold(size).held(TextAnchor::Middle).grey(0.45),
            &text,
        );
    }
}

/// The whole sheet as one page, a square and the name above the pieces.
pub(super) fn whole(pattern: &Pattern, sheet: &PatternSheet<'_>) -> PdfPage {
    let [w, h] = sheet.size;
    let size = [w, h + HEAD];
    let mut canvas = Canvas::page();
    canvas.0.x_object(SHEET);
    let corner = [BORDER, size[1] - BORDER - SQUARE];
    square(&mut canvas, corner);
    let words = corner[0] + SQUARE + 12.0;
    let name = shortened(&pattern.name, 14.0, true, w - BORDER - words);
    canvas.text([words, corner[1] + SQUARE - 14.0], Type::bold(14.0), &name);
    canvas.text(
        [words, corner[1] + SQUARE - 24.0],
        Type::plain(5.0).grey(0.3),
        &format!("{} pieces", pattern.pieces.len()),
    );
    PdfPage { size, canvas }
}
