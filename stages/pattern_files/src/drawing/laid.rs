//! A piece with all that is drawn of it, in true scale, millimetres.

use super::surface::{DrawingSurface, Style, TextAnchor, Type};
use super::words::words;
use crate::allowance::CutLines;
use crate::flatten::{flatten, loop_points};
use crate::inside::{bounds, contains};
use crate::label;
use crate::marks::{self, NotchMark, SeamMark};
use crate::options::DrawingOptions;
use toile_core::artifact::{LinePurpose, Pattern, Piece, PieceLine, Point2, Vector2};

/// Curves are followed to this, metres.
const TOLERANCE: f64 = 1e-5;
/// The line that is cut along, that is sewn along beside it, and others.
pub(crate) const CUT: Style = Style::solid(0.5).cut();
pub(crate) const SEW: Style = Style::dashed(0.3, &[4.0, 2.0]);
pub(crate) const THIN: Style = Style::solid(0.3);
pub(crate) const FOLD: Style = Style::dashed(0.3, &[8.0, 2.0, 1.0, 2.0]);
pub(crate) const DOTTED: Style = Style::dashed(0.3, &[1.0, 1.5]);
/// How far seams' numbers stand inside of the line that is sewn along, and how large their circles
/// are, mm; the first that fits.
const NUMBERS: [(f64, f64); 3] = [(6.5, 2.8), (4.5, 2.2), (2.6, 1.4)];
/// A notch is drawn from the line that is cut to this far inside of that which is sewn, mm.
const NOTCH: f64 = 3.0;
/// Of a triangle of a notch, mm.
const HALF: f64 = 2.0;
/// Of a grain line's arrow head, mm.
const ARROW: [f64; 2] = [5.0, 1.6];

/// A piece with its marks and its place on a sheet.
pub(crate) struct LaidPiece<'a> {
    piece: &'a Piece,
    /// What is cut: the cut line, or the outline.
    pub cut: Vec<Point2>,
    /// Whether it is sewn along another line.
    sewn_inside: bool,
    outline: Vec<Point2>,
    edges: Vec<Vec<Point2>>,
    holes: Vec<Vec<Point2>>,
    numbers: Vec<SeamMark>,
    notches: Vec<(NotchMark, f64)>,
    grain: [Point2; 2],
    words: Vec<label::LabelLine>,
    low: Point2,
    /// Width and height of what is cut.
    pub size: [f64; 2],
    /// Where the lower left corner of its box lies on the sheet; at the origin at first.
    pub corner: [f64; 2],
}

/// The pieces of a pattern, not yet at their places.
pub(crate) fn laid<'a>(pattern: &'a Pattern, cut: &CutLines, options: &DrawingOptions) -> Vec<LaidPiece<'a>> {
    let numbers = marks::seam_marks(pattern);
    let one = |(k, p): (usize, &'a Piece)| {
        let words = words(pattern, p, &cut.widths[k], options);
        LaidPiece::new(p, cut.lines[k].as_deref(), &cut.widths[k], &numbers[k], words)
    };
    pattern.pieces.iter().enumerate().map(one).collect()
}

fn mm(p: Point2) -> Point2 {
    p * 1e3
}

impl<'a> LaidPiece<'a> {
    fn new(
        p: &'a Piece,
        cut: Option<&[Point2]>,
        widths: &[f64],
        numbers: &[SeamMark],
        words: Vec<label::LabelLine>,
    ) -> Self {
        let outline = loop_points(&p.outer, TOLERANCE).0;
        let n = p.outer.corners.len();
        let edge = |k: usize| {
            let (a, b) = (p.outer.corners[k], p.outer.corners[(k + 1) % n]);
            flatten(a, b, &p.outer.edges[k].curve, TOLERANCE).into_iter().map(mm).collect()
        };
        let all_mm = |points: &[Point2]| points.iter().copied().map(mm).collect::<Vec<_>>();
        let line = all_mm(cut.unwrap_or(&outline));
        let (low, high) = bounds(&line);
        let width = |n: &NotchMark| if cut.is_some() { widths[n.edge] * 1e3 } else { 0.0 };
        LaidPiece {
            piece: p,
            sewn_inside: cut.is_some(),
            edges: (0..n).map(edge).collect(),
            holes: p.holes.iter().map(|h| all_mm(&loop_points(h, TOLERANCE).0)).collect(),
            numbers: numbers
                .iter()
                .map(|m| SeamMark { at: mm(m.at), length: m.length * 1e3, ..*m })
                .collect(),
            notches: marks::notches(p)
                .into_iter()
                .map(|n| (NotchMark { at: mm(n.at), ..n }, width(&n)))
                .collect(),
            grain: marks::grain(p, &outline).map(mm),
            outline: all_mm(&outline),
            cut: line,
            words,
            low,
            size: [high.x - low.x, high.y - low.y],
            corner: [0.0; 2],
        }
    }

    /// What the pattern calls the piece.
    pub(crate) fn name(&self) -> &str {
        &self.piece.name
    }

    /// Where a point of the piece lies on the sheet.
    pub(crate) fn at(&self, p: Point2) -> [f64; 2] {
        [p.x - self.low.x + self.corner[0], p.y - self.low.y + self.corner[1]]
    }

    fn all(&self, points: &[Point2]) -> Vec<[f64; 2]> {
        points.iter().map(|p| self.at(*p)).collect()
    }

    pub(crate) fn draw(&self, canvas: &mut impl DrawingSurface) {
        // What is cut inside comes first: a piece that is cut out moves under the knife.
        self.holes.iter().for_each(|h| canvas.closed(&self.all(h), CUT));
        self.piece.lines.iter().for_each(|l| self.inner(canvas, l));
        canvas.closed(&self.all(&self.cut), CUT);
        if self.sewn_inside {
            self.edges.iter().for_each(|e| canvas.line(&self.all(e), SEW));
        }
        self.notches.iter().for_each(|(n, width)| self.notch(canvas, n, *width));
        for h in &self.piece.drill_holes {
            let [x, y] = self.at(mm(*h));
            canvas.circle([x, y], 1.5, THIN);
            canvas.line(&[[x - 2.5, y], [x + 2.5, y]], THIN);
            canvas.line(&[[x, y - 2.5], [x, y + 2.5]], THIN);
        }
        self.arrow(canvas);
        let circles: Vec<(Point2, f64)> = self.numbers.iter().map(|m| self.number(m)).collect();
        for (m, (at, r)) in self.numbers.iter().zip(&circles) {
            let [x, y] = self.at(*at);
            canvas.circle([x, y], *r, Style::solid(0.2));
            let size = r * if m.number > 99 { 0.95 } else { 1.25 };
            canvas.text(
                [x, y - size * 0.36],
                Type::bold(size).held(TextAnchor::Middle),
                &m.number.to_string(),
            );
        }
        self.label(canvas, &circles);
    }

    fn inner(&self, canvas: &mut impl DrawingSurface, l: &PieceLine) {
        let style = match l.purpose {
            LinePurpose::Fold | LinePurpose::Pleat => FOLD,
            LinePurpose::Dart => SEW,
            LinePurpose::Placement => THIN,
            LinePurpose::Cut => CUT,
            LinePurpose::Mark => DOTTED,
        };
        let points: Vec<Point2> = l.points.iter().copied().map(mm).collect();
        canvas.line(&self.all(&points), style);
        let word = match l.purpose {
            LinePurpose::Fold => "fold line",
            LinePurpose::Pleat => "pleat",
            LinePurpose::Dart => "dart",
            LinePurpose::Placement => "placement",
            LinePurpose::Cut => "slit",
            LinePurpose::Mark => return,
        };
        let [a, b] = [points[0], points[points.len() - 1]];
        let [x, y] = self.at(nalgebra::center(&a, &b));
        let upright = (b.y - a.y).abs() > (b.x - a.x).abs();
        let at = if upright { [x - 1.0, y] } else { [x, y + 1.0] };
        canvas.text(at, Type::plain(2.4).held(TextAnchor::Middle).upright(upright), word);
    }

    /// A line across the allowance and a triangle on the line that is cut, its point inwards.
    fn notch(&self, canvas: &mut impl DrawingSurface, n: &NotchMark, width: f64) {
        let (outer, inner) = (n.at + n.out * width, n.at - n.out * NOTCH.max(n.depth * 1e3));
        canvas.line(&self.all(&[outer, inner]), THIN);
        let along = Vector2::new(-n.out.y, n.out.x) * HALF;
        canvas.filled(&self.all(&[outer + along, outer - along, outer - n.out * (HALF * 1.6)]), 0.0);
    }

    fn arrow(&self, canvas: &mut impl DrawingSurface) {
        let [foot, top] = self.grain;
        canvas.line(&self.all(&[foot, top]), THIN);
        let long = ARROW[0].min((top.y - foot.y) / 3.0);
        let half = ARROW[1] * long / ARROW[0];
        for (tip, way) in [(top, -1.0), (foot, 1.0)] {
            let back = tip + Vector2::new(0.0, way * long);
            let across = Vector2::new(half, 0.0);
            canvas.filled(&self.all(&[tip, back + across, back - across]), 0.0);
        }
        if top.y - foot.y > 30.0 {
            let [x, y] = self.at(nalgebra::center(&foot, &top));
            canvas.text([x - 1.0, y], Type::plain(2.4).held(TextAnchor::Middle).upright(true), "grain");
        }
    }

    /// Where the number of a seam stands, and the radius of its circle: inside, and no larger than
    /// its edge bears.
    fn number(&self, m: &SeamMark) -> (Point2, f64) {
        let fits = |(far, r): &(f64, f64)| {
            let at = m.at + m.inwards * *far;
            let around = [0.0, 0.25, 0.5, 0.75].map(|t: f64| (t * std::f64::consts::TAU).sin_cos());
            let clear = around.iter().all(|(s, c)| contains(&self.outline, at + Vector2::new(*c, *s) * *r));
            (*r * 2.0 < m.length || *r < 1.5) && clear
        };
        let (far, r) = NUMBERS.into_iter().find(|n| fits(n)).unwrap_or((0.0, NUMBERS[2].1));
        (m.at + m.inwards * far, r)
    }

    fn label(&self, canvas: &mut impl DrawingSurface, circles: &[(Point2, f64)]) {
        let mut lines: Vec<[Point2; 2]> = Vec::new();
        let rough = |l| loop_points(l, label::ROUGH).0.into_iter().map(mm).collect::<Vec<Point2>>();
        let outline = rough(&self.piece.outer);
        for ring in self.piece.holes.iter().map(rough).chain([outline.clone()]) {
            lines.extend((0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]));
        }
        for l in &self.piece.lines {
            lines.extend(l.points.windows(2).map(|w| [mm(w[0]), mm(w[1])]));
        }
        let left = Vector2::new(3.0, 0.0);
        lines.extend([[self.grain[0], self.grain[1]], [self.grain[0] - left, self.grain[1] - left]]);
        for (at, r) in circles {
            let across = Vector2::new(*r, 0.0);
            lines.push([at - across, at + across]);
        }
        let place = label::place(&self.words, &outline, &lines);
        let [x, y] = self.at(place.at);
        let mut down = -label::height(&self.words, place.size) / 2.0;
        for (text, share, bold) in &self.words {
            let step = label::leading(*share, place.size);
            down += step;
            let at = if place.upright { [x + down - 0.25 * step, y] } else { [x, y - down + 0.25 * step] };
            let kind = Type { bold: *bold, ..Type::plain(place.size * share) };
            canvas.text(at, kind.held(TextAnchor::Middle).upright(place.upright), text);
        }
    }
}
