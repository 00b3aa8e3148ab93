//! All pieces on one sheet, in true scale, millimetres, y up from the sheet's lower left corner.

use super::canvas::{Canvas, Style, TextAnchor, Type};
use crate::allowance::CutLines;
use crate::flatten::{flatten, loop_points};
use crate::inside::{bounds, contains, crosses, upright_parts};
use crate::label;
use crate::marks::{self, NotchMark, SeamMark};
use crate::options::DrawingOptions;
use crate::shelf::pack;
use toile_core::artifact::{LinePurpose, Pattern, Piece, PieceLine, Point2, Vector2};

/// Between pieces, mm.
pub(super) const GAP: f64 = 12.0;
/// Curves are followed to this, metres.
const TOLERANCE: f64 = 1e-5;
/// The line that is cut along, that is sewn along beside it, and others.
pub(super) const CUT: Style = Style::solid(0.5);
pub(super) const SEW: Style = Style::dashed(0.3, &[4.0, 2.0]);
pub(super) const THIN: Style = Style::solid(0.3);
pub(super) const FOLD: Style = Style::dashed(0.3, &[8.0, 2.0, 1.0, 2.0]);
pub(super) const DOTTED: Style = Style::dashed(0.3, &[1.0, 1.5]);
/// How far seams' numbers stand inside of the line that is sewn along, and how large their circles
/// are, mm; the first that fits.
const NUMBERS: [(f64, f64); 3] = [(6.5, 2.8), (4.5, 2.2), (2.6, 1.4)];
/// A notch is drawn from the line that is cut to this far inside of that which is sewn, mm.
const NOTCH: f64 = 3.0;
/// Of a triangle of a notch, mm.
const HALF: f64 = 2.0;
/// Of a grain line's arrow head, mm.
const ARROW: [f64; 2] = [5.0, 1.6];

/// A piece on the sheet.
pub(super) struct LaidPiece<'a> {
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
    size: [f64; 2],
    corner: [f64; 2],
}

/// All pieces at their places.
pub(super) struct PatternSheet<'a> {
    pub pieces: Vec<LaidPiece<'a>>,
    /// Width and height, mm.
    pub size: [f64; 2],
}

fn mm(p: Point2) -> Point2 {
    p * 1e3
}

impl<'a> PatternSheet<'a> {
    /// The pieces of a pattern, not yet at their places.
    pub(super) fn new(pattern: &'a Pattern, cut: &CutLines, options: &DrawingOptions) -> Self {
        let numbers = marks::seam_marks(pattern);
        let one = |(k, p): (usize, &'a Piece)| {
            let words = words(pattern, p, &cut.widths[k], options);
            LaidPiece::new(p, cut.lines[k].as_deref(), &cut.widths[k], &numbers[k], words)
        };
        PatternSheet { pieces: pattern.pieces.iter().enumerate().map(one).collect(), size: [0.0; 2] }
    }

    /// The sizes of the pieces, mm.
    pub(super) fn sizes(&self) -> Vec<[f64; 2]> {
        self.pieces.iter().map(|p| p.size).collect()
    }

    /// Puts the pieces on a sheet of that width or more, with so much around them, mm.
    pub(super) fn lay(&mut self, width: f64, around: f64) {
        let (places, [w, h]) = pack(&self.sizes(), width - 2.0 * around, GAP);
        self.size = [w + 2.0 * around, h + 2.0 * around];
        for (p, [x, y]) in self.pieces.iter_mut().zip(places) {
            p.corner = [x + around, h + y + around];
        }
    }

    pub(super) fn draw(&self, canvas: &mut Canvas) {
        self.pieces.iter().for_each(|p| p.draw(canvas));
    }

    /// Which boxes of a grid the pieces reach, `columns` in each row, mm: those that a line of
    /// theirs crosses, and those within a piece. The first box of the first row has its lower left
    /// corner at `low`.
    pub(super) fn reached(&self, low: [f64; 2], step: [f64; 2], columns: usize, rows: usize) -> Vec<bool> {
        let mut out = vec![false; columns * rows];
        let number = |x: f64, k: usize, most: usize| {
            (((x - low[k]) / step[k]).floor().max(0.0) as usize).min(most.saturating_sub(1))
        };
        let range =
            |a: f64, b: f64, k: usize, most: usize| number(a.min(b), k, most)..=number(a.max(b), k, most);
        let corner =
            |c: usize, r: usize| Point2::new(low[0] + c as f64 * step[0], low[1] + r as f64 * step[1]);
        let across = Vector2::new(step[0], step[1]);
        for p in &self.pieces {
            let at: Vec<Point2> = p.cut.iter().map(|q| Point2::from(p.at(*q))).collect();
            for k in 0..at.len() {
                let (a, b) = (at[k], at[(k + 1) % at.len()]);
                for r in range(a.y, b.y, 1, rows) {
                    for c in range(a.x, b.x, 0, columns) {
                        out[r * columns + c] |= crosses(a, b, (corner(c, r), corner(c, r) + across));
                    }
                }
            }
            for c in range(p.corner[0], p.corner[0] + p.size[0], 0, columns) {
                let inside = upright_parts(&at, corner(c, 0).x + step[0] / 2.0);
                for r in range(p.corner[1], p.corner[1] + p.size[1], 1, rows) {
                    let y = corner(c, r).y + step[1] / 2.0;
                    out[r * columns + c] |= inside.iter().any(|[a, b]| (*a..*b).contains(&y));
                }
            }
        }
        out
    }
}

/// What stands on a piece: its name, how often it is cut, the pattern and its size, the allowance.
fn words(pattern: &Pattern, p: &Piece, widths: &[f64], options: &DrawingOptions) -> Vec<label::LabelLine> {
    let mut out = vec![(p.name.clone(), 1.0, true), ("cut 1".to_owned(), 0.8, false)];
    let size = if options.size.is_empty() { String::new() } else { format!(", size {}", options.size) };
    out.push((format!("{}{size}", pattern.name), 0.6, false));
    out.push((allowance(widths), 0.6, false));
    out.retain(|(text, _, _)| !text.trim().is_empty());
    let short = |(text, share, bold): label::LabelLine| (text.chars().take(40).collect(), share, bold);
    out.into_iter().map(short).collect()
}

/// The seam allowance of a piece in words.
pub(super) fn allowance(widths: &[f64]) -> String {
    let mut all: Vec<f64> = widths.iter().map(|w| (w * 1e4).round() / 10.0).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    match all[..] {
        [0.0] => "no seam allowance".to_owned(),
        _ => {
            let each: Vec<String> = all.iter().map(|w| format!("{w}")).collect();
            format!("seam allowance {} mm", each.join(" / "))
        }
    }
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

    /// Moves it up the sheet, mm.
    pub(super) fn raise(&mut self, up: f64) {
        self.corner[1] += up;
    }

    /// Where a point of the piece lies on the sheet.
    pub(super) fn at(&self, p: Point2) -> [f64; 2] {
        [p.x - self.low.x + self.corner[0], p.y - self.low.y + self.corner[1]]
    }

    fn all(&self, points: &[Point2]) -> Vec<[f64; 2]> {
        points.iter().map(|p| self.at(*p)).collect()
    }

    fn draw(&self, canvas: &mut Canvas) {
        canvas.closed(&self.all(&self.cut), CUT);
        if self.sewn_inside {
            self.edges.iter().for_each(|e| canvas.line(&self.all(e), SEW));
        }
        self.holes.iter().for_each(|h| canvas.closed(&self.all(h), CUT));
        self.piece.lines.iter().for_each(|l| self.inner(canvas, l));
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

    fn inner(&self, canvas: &mut Canvas, l: &PieceLine) {
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
    fn notch(&self, canvas: &mut Canvas, n: &NotchMark, width: f64) {
        let (outer, inner) = (n.at + n.out * width, n.at - n.out * NOTCH.max(n.depth * 1e3));
        canvas.line(&self.all(&[outer, inner]), THIN);
        let along = Vector2::new(-n.out.y, n.out.x) * HALF;
        canvas.filled(&self.all(&[outer + along, outer - along, outer - n.out * (HALF * 1.6)]), 0.0);
    }

    fn arrow(&self, canvas: &mut Canvas) {
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

    fn label(&self, canvas: &mut Canvas, circles: &[(Point2, f64)]) {
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
