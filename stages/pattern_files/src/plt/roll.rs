//! Where pieces lie on a roll: in rows across it, one behind the other, on one plot or on pages.

use super::plotter::{Plotter, Track};
use super::{Along, Plot};
use crate::drawing::LaidPiece;
use crate::error::WriteError;
use crate::inside::bounds;
use crate::shelf::pack;
use toile_core::artifact::Point2;

/// Between pieces, mm.
const GAP: f64 = 10.0;
/// By so much sums of lengths differ from what they are, mm.
const ROUNDING: f64 = 1e-6;

/// A piece with its lines: first along the roll from the beginning of its page, then across, mm.
pub(super) struct OnRoll {
    /// Its number in the pattern.
    pub piece: usize,
    pub tracks: Vec<Track>,
    /// Where it begins and ends along the roll.
    from: f64,
    to: f64,
}

/// A length of the roll that is plotted at once: rows of pieces, and how long it is, mm.
#[derive(Default)]
pub(super) struct PlotPage {
    pub rows: Vec<Vec<OnRoll>>,
    pub length: f64,
}

/// The pages of a roll.
///
/// Errors: a piece that is wider than the roll or longer than a page.
pub(super) fn lay(pieces: &[LaidPiece<'_>], plot: &Plot) -> Result<Vec<PlotPage>, WriteError> {
    let lying: Vec<LyingPiece> = pieces.iter().map(|p| LyingPiece::new(p, plot.along)).collect();
    let (width, most) = (plot.width * 1e3, plot.page_length.map(|l| l * 1e3));
    for (piece, LyingPiece { size: [across, along], .. }) in pieces.iter().zip(&lying) {
        let piece = piece.name().to_owned();
        if !fits(*across, width) {
            return Err(WriteError::Roll { piece, needed: *across, width });
        }
        if let Some(length) = most.filter(|length| !fits(*along, *length)) {
            return Err(WriteError::PlotPage { piece, needed: *along, length });
        }
    }
    let sizes: Vec<[f64; 2]> = lying.iter().map(|l| l.size).collect();
    let (places, _) = pack(&sizes, width, GAP);
    let placed = lying.into_iter().zip(places).enumerate().map(|(k, (l, at))| l.placed(k, at));
    Ok(pages(rows(placed.collect()), most.unwrap_or(f64::INFINITY)))
}

/// Whether a size is no greater but for rounding; false also where the room is no number.
fn fits(size: f64, room: f64) -> bool {
    size <= room + ROUNDING
}

/// A piece as it lies on the roll.
struct LyingPiece {
    tracks: Vec<Track>,
    /// Across and along the roll, mm, with all that is drawn of the piece.
    size: [f64; 2],
}

impl LyingPiece {
    fn new(piece: &LaidPiece<'_>, along: Along) -> Self {
        let mut plotter = Plotter::default();
        piece.draw(&mut plotter);
        let mut tracks = plotter.0;
        let points: Vec<Point2> =
            tracks.iter().flat_map(|t| &t.points).map(|[x, y]| Point2::new(*x, *y)).collect();
        let (lo, hi) = bounds(&points);
        let [wide, high] = [hi.x - lo.x, hi.y - lo.y];
        // The grain runs upwards on a piece; a turned one is not mirrored.
        let is_turned = along == Along::Grain || high >= wide;
        for point in tracks.iter_mut().flat_map(|t| &mut t.points) {
            let [x, y] = *point;
            *point = if is_turned { [y - lo.y, hi.x - x] } else { [x - lo.x, y - lo.y] };
        }
        LyingPiece { tracks, size: if is_turned { [wide, high] } else { [high, wide] } }
    }

    /// With its lower corner there: across the roll, and down from its beginning.
    fn placed(mut self, piece: usize, [across, down]: [f64; 2]) -> OnRoll {
        let from = -(down + self.size[1]);
        for point in self.tracks.iter_mut().flat_map(|t| &mut t.points) {
            *point = [point[0] + from, point[1] + across];
        }
        OnRoll { piece, tracks: self.tracks, from, to: from + self.size[1] }
    }
}

/// Pieces in the rows across the roll in which they lie.
fn rows(mut pieces: Vec<OnRoll>) -> Vec<Vec<OnRoll>> {
    pieces.sort_by(|a, b| a.from.total_cmp(&b.from));
    let mut rows: Vec<Vec<OnRoll>> = Vec::new();
    for piece in pieces {
        match rows.last_mut() {
            // Rows are farther from each other than the pieces of one are.
            Some(row) if piece.from < end(row) + GAP / 2.0 => row.push(piece),
            _ => rows.push(vec![piece]),
        }
    }
    rows.iter_mut().for_each(|row| row.sort_by_key(|p| p.piece));
    rows
}

/// Where a row begins.
fn start(row: &[OnRoll]) -> f64 {
    row.iter().map(|p| p.from).fold(f64::INFINITY, f64::min)
}

/// Where a row ends.
fn end(row: &[OnRoll]) -> f64 {
    row.iter().map(|p| p.to).fold(0.0, f64::max)
}

/// As many rows a page as fit on that length, each page from its own beginning.
fn pages(rows: Vec<Vec<OnRoll>>, most: f64) -> Vec<PlotPage> {
    let mut pages: Vec<PlotPage> = Vec::new();
    let mut begin = 0.0;
    for mut row in rows {
        if pages.is_empty() || end(&row) - begin > most {
            begin = start(&row);
            pages.push(PlotPage::default());
        }
        let points = row.iter_mut().flat_map(|p| &mut p.tracks).flat_map(|t| &mut t.points);
        points.for_each(|point| point[0] -= begin);
        if let Some(page) = pages.last_mut() {
            page.length = end(&row) - begin;
            page.rows.push(row);
        }
    }
    pages
}
