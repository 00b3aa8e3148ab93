//! PDF of a pattern in true scale, on pages that are joined, or in one piece.
//!
//! The first page has a square of 100 mm to measure, what the lines mean and how the pages are
//! joined; then come what is cut and in what order it is sewn; then the pieces. On these: the cut
//! line solid, the line that is sewn along dashed, grain line, fold lines, notches, drill holes,
//! names, and the number of each seam at all its edges. [`paper`] knows the sizes of pages,
//! [`sheet`] lays the pieces, [`tiles`] cuts the sheet into pages, [`front`] and [`order`] are the
//! pages with words, [`canvas`] draws.
//!
//! Cost: some ten milliseconds a piece. Limits: letters of Western Europe, others are question
//! marks, which is told; one size; every piece is cut once, no pieces are folded.

mod canvas;
mod front;
mod order;
mod paper;
mod sheet;
mod tiles;

use crate::allowance::cut_lines;
use crate::drawing::unknown_letters;
use crate::error::{WriteError, writable};
use crate::font;
use crate::options::DrawingOptions;
use crate::written::Written;
use canvas::{Canvas, POINTS};
pub use paper::Paper;
use pdf_writer::{Chunk, Finish, Name, Pdf, Rect, Ref, TextStr};
use sheet::PatternSheet;
use tiles::Tiles;
use toile_core::artifact::Pattern;

/// Pages of one file.
pub const MOST_PAGES: usize = 500;
/// The longest side of a page that readers of PDF take, mm.
const LONGEST: f64 = 14_400.0 / POINTS;
/// How wide a sheet in one piece is where no piece is wider, mm: a roll of 36 inches less its
/// margins, then wider ones.
const WIDTHS: [f64; 5] = [890.0, 1500.0, 2500.0, 4000.0, LONGEST];

/// A page: its size, mm, and what is drawn on it.
struct PdfPage {
    size: [f64; 2],
    canvas: Canvas,
}

/// A pattern as pages to print. No program reads it back: its file of seams is empty.
///
/// Errors: a pattern that is not sound, that has no pieces, or with a piece beyond
/// [`FARTHEST`](crate::FARTHEST); a seam allowance that cannot be cut; more than [`MOST_PAGES`]
/// pages; a page, or a sheet in one piece, that is longer than 5.08 m; a page that is too small for
/// its margins and the test square.
pub fn to_pdf(pattern: &Pattern, paper: Paper, options: &DrawingOptions) -> Result<Written, WriteError> {
    writable(pattern)?;
    paper.check()?;
    let cut = cut_lines(pattern, &options.allowances)?;
    let mut sheet = PatternSheet::new(pattern, &cut, options);
    let tiles = match paper {
        Paper::OnePiece => {
            one_piece(&mut sheet)?;
            None
        }
        _ => {
            let tiles = Tiles::lay(&mut sheet, paper, MOST_PAGES);
            Some(tiles.map_err(|pages| WriteError::Pages { pages, most: MOST_PAGES })?)
        }
    };
    let mut drawing = Canvas::drawing();
    sheet.draw(&mut drawing);
    let size = paper.size();
    let mut pages =
        vec![PdfPage { size, canvas: front::page(pattern, &sheet, tiles.as_ref(), paper, options) }];
    let order = order::pages(pattern, &sheet, &cut.widths, size);
    pages.extend(order.into_iter().map(|canvas| PdfPage { size, canvas }));
    match &tiles {
        Some(tiles) => {
            let page = |at: &(usize, usize)| PdfPage { size, canvas: tiles.draw(*at, &pattern.name) };
            pages.extend(tiles.pages.iter().map(page));
        }
        None => pages.push(front::whole(pattern, &sheet)),
    }
    let mut warnings = cut.notes;
    warnings.extend(unknown_letters(names(pattern), font::holds));
    let bytes = document(&pattern.name, pages, drawing, sheet.size);
    Ok(Written { bytes, seams: String::new(), notes: Vec::new(), warnings })
}

/// Lays the pieces on one sheet, the narrowest that is short enough.
fn one_piece(sheet: &mut PatternSheet<'_>) -> Result<(), WriteError> {
    let mut fault = WriteError::NoPieces;
    for width in WIDTHS {
        sheet.lay(width, front::BORDER);
        sheet.size[0] = sheet.size[0].max(front::LEAST_WIDTH);
        let [w, h] = [sheet.size[0], sheet.size[1] + front::HEAD];
        if w <= LONGEST && h <= LONGEST {
            return Ok(());
        }
        fault = WriteError::Sheet { width: w / 1e3, height: h / 1e3, most: LONGEST / 1e3 };
    }
    Err(fault)
}

/// The pattern's name, and those of its pieces and edges.
fn names(pattern: &Pattern) -> impl Iterator<Item = &String> {
    let pieces = pattern.pieces.iter().map(|p| &p.name);
    let edges = pattern.pieces.iter().flat_map(|p| p.outer.edges.iter().map(|e| &e.name));
    std::iter::once(&pattern.name).chain(pieces).chain(edges)
}

/// The file: both fonts, the sheet as a drawing that pages share, and the pages.
fn document(name: &str, pages: Vec<PdfPage>, drawing: Canvas, size: [f64; 2]) -> Vec<u8> {
    let [catalog, tree, plain, bold, sheet, info] = [1, 2, 3, 4, 5, 6].map(Ref::new);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(tree);
    pdf.document_info(info).title(TextStr(name)).creator(TextStr("Toile"));
    let ids: Vec<[Ref; 2]> = (0..pages.len() as i32).map(|k| [7 + 2 * k, 8 + 2 * k].map(Ref::new)).collect();
    pdf.pages(tree).kids(ids.iter().map(|[page, _]| *page)).count(pages.len() as i32);
    for (id, family) in [(plain, "Helvetica"), (bold, "Helvetica-Bold")] {
        let mut font = pdf.type1_font(id);
        font.base_font(Name(family.as_bytes())).encoding_predefined(Name(b"WinAnsiEncoding"));
    }
    let content = drawing.bytes();
    let mut form = pdf.form_xobject(sheet, &content);
    let [w, h] = size.map(|s| s as f32);
    form.bbox(Rect::new(-1000.0, -1000.0, w + 1000.0, h + 1000.0));
    form.resources().fonts().pair(canvas::PLAIN, plain).pair(canvas::BOLD, bold);
    form.finish();
    let mut rest = Chunk::new();
    for (page, [id, content]) in pages.into_iter().zip(ids) {
        let [w, h] = page.size.map(|s| (s * POINTS) as f32);
        let mut out = pdf.page(id);
        out.media_box(Rect::new(0.0, 0.0, w, h)).parent(tree).contents(content);
        let mut resources = out.resources();
        resources.fonts().pair(canvas::PLAIN, plain).pair(canvas::BOLD, bold);
        resources.x_objects().pair(canvas::SHEET, sheet);
        resources.finish();
        out.finish();
        rest.stream(content, &page.canvas.bytes());
    }
    pdf.extend(&rest);
    pdf.finish()
}
