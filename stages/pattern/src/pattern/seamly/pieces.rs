//! A drafted piece as a piece of the pattern.
//!
//! Method: the outline is split where it turns, and its edges are called by the points that they
//! run between. The grain is turned to y, a half piece unfolded at its fold, and everything drawn
//! on it goes along.

use super::super::copies::{MOST_COPIES, copies};
use super::super::marks::{hole, notched};
use super::super::side::{NotSimple, Side, check_simple, counter_clockwise, pattern_loop, points, split};
use super::super::unfold::{Fold, image_word};
use super::allowance;
use super::damage::DraftDamage;
use super::fold::along_grain;
use super::strokes::{label, side};
use std::collections::BTreeSet;
use toile_core::Remarks;
use toile_core::prelude::*;
use toile_seamly::{DraftedPiece, PieceFold};

/// Pieces of a garment.
const MOST_PIECES: usize = 500;
/// No smaller piece is one, square metres.
const LEAST: f64 = 1e-7;
/// A grain line this near to the horizontal says itself which end is up, as the sine of its angle.
const LEVEL: f64 = 0.02;
/// Ends of an inner path that meet, metres.
const CLOSED: f64 = 1e-4;

/// The pieces, each as often as it is cut.
///
/// Errors: all that is wrong with them.
pub(super) fn pieces(
    drafted: &[DraftedPiece],
    metres: f64,
    told: &mut Remarks,
) -> Result<Vec<Piece>, Vec<DraftDamage>> {
    let (mut out, mut faults, mut names): (Vec<Piece>, Vec<DraftDamage>, BTreeSet<String>) =
        Default::default();
    let mut widths = Vec::new();
    for piece in drafted {
        let name = unique(&mut names, &piece.name, "piece");
        match (DraftPlace { piece, name: &name, metres }).piece(&mut widths, told) {
            Ok(one) => {
                let (plain, turned) = cut(piece, &name, told);
                out.extend(copies(one, plain, turned, told));
            }
            Err(damage) => faults.push(damage),
        }
        if out.len() > MOST_PIECES {
            return Err(vec![DraftDamage::Many { count: out.len(), most: MOST_PIECES }]);
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    allowance::tell(drafted, &widths, told);
    Ok(out)
}

/// How often a piece is cut as drawn and mirrored: a pair, if it may be turned over and is not
/// symmetric already.
fn cut(piece: &DraftedPiece, name: &str, told: &mut Remarks) -> (usize, usize) {
    let count = usize::try_from(piece.quantity).unwrap_or(MOST_COPIES);
    if count > MOST_COPIES {
        told.warnings.push(format!("piece \"{name}\" is cut {count} times: {MOST_COPIES} are taken"));
    }
    let count = count.min(MOST_COPIES);
    match piece.turns && piece.fold == PieceFold::None {
        true => (count - count / 2, count / 2),
        false => (count, 0),
    }
}

/// A name that no other has, without the point at which a name would end where seams name an edge.
fn unique(names: &mut BTreeSet<String>, name: &str, otherwise: &str) -> String {
    let plain = name.trim().replace('.', "_");
    let plain = if plain.is_empty() { otherwise.to_owned() } else { plain };
    // The images of edges beyond a fold end so.
    let plain = if plain.ends_with("_m") || plain.ends_with("_m2") { plain + "_" } else { plain };
    let mut own = plain.clone();
    let mut count = 1;
    while !names.insert(own.clone()) {
        count += 1;
        own = format!("{plain}_{count}");
    }
    own
}

/// A drafted piece with its name, for errors, and the length of its unit.
struct DraftPlace<'a> {
    piece: &'a DraftedPiece,
    name: &'a str,
    metres: f64,
}

impl DraftPlace<'_> {
    /// The piece; the words for its seam allowance are added.
    fn piece(&self, widths: &mut Vec<String>, told: &mut Remarks) -> Result<Piece, DraftDamage> {
        let piece = self.piece;
        let turn = turn(piece.grain.map(|g| Vector2::new(g.x, g.y)));
        let up = move |p: Point2| Point2::new(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y);
        let sides = self.sides()?;
        widths.extend(allowance::widths(piece, &sides, self.name, self.metres));
        let mut sides: Vec<Side> = sides.iter().map(|s| s.moved(up, false)).collect();
        let point = |p: [f64; 2]| up(Point2::new(p[0] * self.metres, p[1] * self.metres));
        let mut marks = DraftMarks::of(piece, self.metres, up, &sides);
        let fold = match piece.fold {
            PieceFold::None => None,
            PieceFold::Line([a, b]) => {
                let fold = Fold::through(point([a.x, a.y]), point([b.x, b.y])).filter(|f| f.holds(&sides));
                Some(fold.ok_or_else(|| DraftDamage::Mirror { place: piece.place.clone() })?)
            }
            PieceFold::Unsaid => {
                let fold = along_grain(&sides, self.name, told);
                Some(fold.ok_or_else(|| DraftDamage::NoFold { place: piece.place.clone() })?)
            }
        };
        if let Some(fold) = fold {
            let word = image_word(0);
            let unfolded = fold.unfolded(&sides, &word);
            sides = unfolded.ok_or_else(|| DraftDamage::Mirror { place: piece.place.clone() })?.sides;
            marks.unfold(&fold, &word);
            told.notes.push(format!("piece \"{}\" is unfolded at its fold", self.name));
        }
        let sides = counter_clockwise(sides);
        self.simple(&sides, turn)?;
        let outer = pattern_loop(&sides);
        Ok(Piece {
            name: self.name.to_owned(),
            notches: notched(&outer, &marks.notches),
            grain: piece.grain.map(|_| middle(&points(&sides))),
            outer,
            holes: marks.holes.into_iter().enumerate().map(|(k, corners)| hole(k, corners)).collect(),
            lines: marks.lines,
            ..Piece::default()
        })
    }

    /// The outline split where it turns, its edges called by the points at their ends.
    fn sides(&self) -> Result<Vec<Side>, DraftDamage> {
        let outline = side(&self.piece.outline, self.metres);
        let mut sides = split(outline.start, &outline.parts);
        if sides.len() < 2 {
            return Err(self.fault("its outline is one curve"));
        }
        let mut names = BTreeSet::new();
        let at = |p: Point2| label(&self.piece.outline, self.metres, p);
        for s in &mut sides {
            let own = match [at(s.start), at(s.end())] {
                ["", _] | [_, ""] => String::new(),
                [a, b] => format!("{a}_{b}"),
            };
            s.name = unique(&mut names, &own, &s.name);
        }
        Ok(sides)
    }

    fn fault(&self, what: &'static str) -> DraftDamage {
        DraftDamage::Piece { place: self.piece.place.clone(), what }
    }

    fn simple(&self, sides: &[Side], turn: Vector2) -> Result<(), DraftDamage> {
        check_simple(sides, LEAST, turn).map_err(|e| match e {
            NotSimple::NoArea => self.fault("it encloses no area"),
            NotSimple::Crosses(p) => {
                let place = self.piece.place.clone();
                DraftDamage::Crosses { place, x: p.x / self.metres, y: -p.y / self.metres }
            }
        })
    }
}

/// Sine and cosine by which the grain is turned up: by the lesser angle, as it is drawn where it
/// lies level.
fn turn(grain: Option<Vector2>) -> Vector2 {
    let way = grain.and_then(|g| g.try_normalize(1e-9));
    let upwards = way.map(|d| if d.y < -LEVEL { -d } else { d });
    upwards.map_or_else(Vector2::x, |d| Vector2::new(d.y, d.x))
}

/// A grain line in the middle of a piece, half as long as it.
fn middle(outline: &[Point2]) -> [Point2; 2] {
    let span = |of: fn(&Point2) -> f64| {
        let all = || outline.iter().map(of);
        (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max))
    };
    let (x, y) = (span(|p| p.x), span(|p| p.y));
    let (centre, quarter) = (f64::midpoint(y.0, y.1), (y.1 - y.0) / 4.0);
    [-quarter, quarter].map(|d| Point2::new(f64::midpoint(x.0, x.1), centre + d))
}

/// What is drawn on a piece beside its outline.
struct DraftMarks {
    notches: Vec<(Point2, f64)>,
    holes: Vec<Vec<Point2>>,
    lines: Vec<PieceLine>,
}

impl DraftMarks {
    fn of(piece: &DraftedPiece, metres: f64, up: impl Fn(Point2) -> Point2 + Copy, sides: &[Side]) -> Self {
        let notches = piece.notches.iter().map(|p| (up(Point2::new(p.x * metres, p.y * metres)), 0.0));
        let mut marks = DraftMarks { notches: notches.collect(), holes: Vec::new(), lines: Vec::new() };
        let mut names: BTreeSet<String> = sides.iter().map(|s| s.name.clone()).collect();
        for inner in &piece.inner {
            let mut points = side(&inner.path, metres).moved(up, false).points();
            let closed = (points[0] - points[points.len() - 1]).norm() <= CLOSED;
            if inner.cut && closed && points.len() > 3 && polygon_area(&points).abs() > 1e-8 {
                points.pop();
                marks.holes.push(points);
                continue;
            }
            let purpose = if inner.cut { LinePurpose::Cut } else { LinePurpose::Mark };
            let otherwise = format!("line_{}", marks.lines.len());
            let name = unique(&mut names, &inner.name, &otherwise);
            marks.lines.push(PieceLine { name, purpose, points });
        }
        marks
    }

    /// Adds the image of each.
    fn unfold(&mut self, fold: &Fold, word: &str) {
        let to = |p: &Point2| fold.mirror(*p);
        self.notches.extend(self.notches.clone().iter().map(|(p, d)| (to(p), *d)));
        self.holes.extend(self.holes.clone().iter().map(|h| h.iter().map(to).collect()));
        let image = |l: &PieceLine| PieceLine {
            name: format!("{}{word}", l.name),
            points: l.points.iter().map(to).collect(),
            ..l.clone()
        };
        self.lines.extend(self.lines.clone().iter().map(image));
    }
}
