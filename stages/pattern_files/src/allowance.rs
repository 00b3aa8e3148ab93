//! Seam allowance: the line along which a piece is cut, outside of the line along which it is sewn.
//!
//! Method: the piece, a strip as wide as its allowance along each edge, and a mitre at each corner
//! that turns outwards are united; the outer boundary of the union is the cut line (`i_overlay`, on
//! a grid far below a micrometre). So it never crosses itself: at corners that turn inwards, and
//! where strips of edges that face each other meet, it is trimmed. A mitre that reaches farther
//! than [`MITRE`] allowances is cut off at right angles. Between unlike allowances of edges that
//! run on smoothly there is a step. A dart, two neighbouring edges that are sewn to each other, is
//! not cut out: the cut line runs over its mouth along the edges beside it as they lie when the
//! dart is folded.
//!
//! Cost: some milliseconds a piece. Limits: holes have no allowance; a dart whose fold would reach
//! out farther than its mouth is wide is closed straight.

use crate::error::WriteError;
use crate::flatten::flatten;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::float::simplify::SimplifyShape;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::artifact::{EdgeRef, Pattern, Piece, Point2, SeamKind, Vector2, polygon_area};

/// A mitre reaches no farther from its corner than this many allowances.
pub const MITRE: f64 = 4.0;
/// The greatest allowance, metres.
pub const MOST: f64 = 0.2;
/// Curves are followed to this, metres.
const TOLERANCE: f64 = 2e-5;
/// Points nearer to each other are one, metres.
const POINT: f64 = 1e-6;
/// Chords of a piece at which it is looked what is left of the allowance.
const LOOKED: usize = 200;
/// An edge of whose allowance less than this share is left is told.
const LEFT: f64 = 0.5;

/// How wide the seam allowance of each edge is, metres.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Allowances {
    /// Of edges that are sewn.
    pub sewn: f64,
    /// Of edges that are not, such as hems.
    pub free: f64,
    /// Of single edges of the outline, whatever they are.
    pub by_edge: BTreeMap<EdgeRef, f64>,
}

impl Allowances {
    /// Whether nothing is added anywhere.
    pub fn is_none(&self) -> bool {
        self.sewn == 0.0 && self.free == 0.0 && self.by_edge.values().all(|w| *w == 0.0)
    }

    /// Errors: a width that is below 0, above [`MOST`] or no number; an edge that there is none of.
    fn check(&self, pattern: &Pattern) -> Result<(), WriteError> {
        let sound = |place: String, width: f64| match (0.0..=MOST).contains(&width) {
            true => Ok(()),
            false => Err(WriteError::Allowance { place, mm: width * 1e3, most_mm: MOST * 1e3 }),
        };
        sound("edges that are sewn".into(), self.sewn)?;
        sound("edges that are not sewn".into(), self.free)?;
        for (edge, width) in &self.by_edge {
            let known = pattern.piece(&edge.panel).is_some_and(|p| p.edge_number(&edge.edge).is_some());
            if !known {
                return Err(WriteError::NoEdge { edge: edge.to_string() });
            }
            sound(edge.to_string(), *width)?;
        }
        Ok(())
    }
}

/// The cut lines of a pattern's pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct CutLines {
    /// For each piece, in the order of the pattern, its cut line: closed, counter-clockwise,
    /// metres, not repeating its first point; none where the piece is cut along its outline.
    pub lines: Vec<Option<Vec<Point2>>>,
    /// For each piece the allowance of each of its outer edges, metres.
    pub widths: Vec<Vec<f64>>,
    /// Where allowances are trimmed, in one sentence.
    pub notes: Vec<String>,
}

/// The cut lines of all pieces of a sound pattern.
///
/// Errors: an allowance that cannot be cut, or for an edge that there is none of.
pub fn cut_lines(pattern: &Pattern, allowances: &Allowances) -> Result<CutLines, WriteError> {
    allowances.check(pattern)?;
    let sewn: BTreeSet<&EdgeRef> =
        pattern.seams.iter().flat_map(|s| s.sides.iter().flatten()).map(|u| &u.edge).collect();
    let mut out = CutLines { lines: Vec::new(), widths: Vec::new(), notes: Vec::new() };
    let mut trimmed = Vec::new();
    for p in &pattern.pieces {
        let width = |name: &String| {
            let edge = EdgeRef { panel: p.name.clone(), edge: name.clone() };
            let plain = if sewn.contains(&edge) { allowances.sewn } else { allowances.free };
            allowances.by_edge.get(&edge).copied().unwrap_or(plain)
        };
        let widths: Vec<f64> = p.outer.edges.iter().map(|e| width(&e.name)).collect();
        out.lines.push(cut_line(p, &widths, &darts(pattern, p), &mut trimmed));
        out.widths.push(widths);
    }
    out.notes.extend(told(&trimmed));
    Ok(out)
}

/// An edge of whose allowance little is left: its name, its piece's, and the share.
struct Trimmed<'a> {
    edge: &'a str,
    piece: &'a str,
    left: f64,
}

/// One sentence of all edges whose allowance is trimmed.
fn told(trimmed: &[Trimmed<'_>]) -> Option<String> {
    let Trimmed { edge, piece, left } = trimmed.iter().reduce(|a, b| if b.left < a.left { b } else { a })?;
    let left = left * 100.0;
    Some(match trimmed.len() {
        1 => format!(
            "the allowance of edge \"{edge}\" of piece \"{piece}\" is trimmed where it meets that of others: {left:.0} % of it is left"
        ),
        n => format!(
            "the allowances of {n} edges are trimmed where they meet those of others: {left:.0} % is left of that of edge \"{edge}\" of piece \"{piece}\""
        ),
    })
}

/// The first edge of each dart of a piece: it and the next are sewn to each other, and the piece
/// turns inwards between them.
pub(crate) fn darts(pattern: &Pattern, p: &Piece) -> Vec<usize> {
    let n = p.outer.edges.len();
    let dart = |s: &toile_core::artifact::PatternSeam| {
        let [[a], [b]] = [s.sides.first()?.as_slice(), s.sides.get(1)?.as_slice()] else { return None };
        if s.kind != SeamKind::Dart || a.edge.panel != p.name || b.edge.panel != p.name {
            return None;
        }
        let (a, b) = (p.edge_number(&a.edge.edge)?, p.edge_number(&b.edge.edge)?);
        let first = if (a + 1) % n == b { a } else { b };
        let second = if first == a { b } else { a };
        let corner = |k: usize| p.outer.corners[k % n];
        let inwards = (corner(second) - corner(first)).perp(&(corner(second + 1) - corner(second))) < 0.0;
        (n > 3 && (first + 1) % n == second && inwards).then_some(first)
    };
    pattern.seams.iter().filter_map(dart).collect()
}

/// A straight piece of the line that is sewn along, with its allowance and the number of its edge.
#[derive(Debug, Clone, Copy)]
struct SewnSegment {
    a: Point2,
    b: Point2,
    width: f64,
    edge: usize,
}

impl SewnSegment {
    fn way(&self) -> Vector2 {
        (self.b - self.a).normalize()
    }

    /// From the line to the cut line: to the right of a loop that runs counter-clockwise.
    fn out(&self) -> Vector2 {
        let d = self.way();
        Vector2::new(d.y, -d.x) * self.width
    }
}

/// The cut line of a piece; none where nothing is added to it.
fn cut_line<'a>(
    p: &'a Piece,
    widths: &[f64],
    darts: &[usize],
    trimmed: &mut Vec<Trimmed<'a>>,
) -> Option<Vec<Point2>> {
    if widths.iter().all(|w| *w == 0.0) {
        return None;
    }
    let outline: Vec<SewnSegment> = (0..widths.len()).flat_map(|k| segments(p, k, widths)).collect();
    let base = folded(p, widths, darts);
    let ring = |s: &[SewnSegment]| s.iter().map(|s| [s.a.x, s.a.y]).collect::<Vec<_>>();
    let mut polygons = vec![ring(&outline), ring(&base)];
    let n = base.len();
    for k in 0..n {
        let (one, next) = (base[k], base[(k + 1) % n]);
        polygons.extend(strip(&one));
        polygons.extend(mitre(&one, &next));
    }
    let line = outer(&polygons).unwrap_or_else(|| outline.iter().map(|s| s.a).collect());
    tell(p, &base, &line, trimmed);
    Some(line)
}

/// The segments of an edge that have length.
fn segments(p: &Piece, edge: usize, widths: &[f64]) -> Vec<SewnSegment> {
    let n = p.outer.corners.len();
    let (start, end) = (p.outer.corners[edge], p.outer.corners[(edge + 1) % n]);
    let points = flatten(start, end, &p.outer.edges[edge].curve, TOLERANCE);
    let pairs = points.windows(2).filter(|w| (w[1] - w[0]).norm() > 1e-12);
    pairs.map(|w| SewnSegment { a: w[0], b: w[1], width: widths[edge], edge }).collect()
}

/// The segments of the outline, each dart folded away.
fn folded(p: &Piece, widths: &[f64], darts: &[usize]) -> Vec<SewnSegment> {
    let n = widths.len();
    let leg = |k: usize| darts.iter().any(|d| *d == k || (d + 1) % n == k);
    let mut out = Vec::new();
    for k in 0..n {
        if darts.contains(&k) {
            let (before, after) = ((k + n - 1) % n, (k + 2) % n);
            let beside = |other: usize| if leg(other) { widths[k] } else { widths[other] };
            let (a, b) = (p.outer.corners[k], p.outer.corners[after]);
            let one = SewnSegment { a, b, width: beside(before), edge: before };
            match roof(p, k) {
                Some(top) => {
                    out.push(SewnSegment { b: top, ..one });
                    out.push(SewnSegment { a: top, b, width: beside(after), edge: after });
                }
                None => out.push(one),
            }
        } else if !leg(k) {
            out.extend(segments(p, k, widths));
        }
    }
    out.retain(|s| (s.b - s.a).norm() > 1e-12);
    out
}

/// The point over a dart's mouth where its fold ends: there the edge beside it, mirrored at the
/// leg, meets the middle of the dart. None where that is not just outside the mouth.
fn roof(p: &Piece, first: usize) -> Option<Point2> {
    let n = p.outer.corners.len();
    let corner = |k: usize| p.outer.corners[k % n];
    let (a, tip, b) = (corner(first), corner(first + 1), corner(first + 2));
    let (to_a, to_b) = ((a - tip).try_normalize(1e-9)?, (b - tip).try_normalize(1e-9)?);
    let middle = (to_a + to_b).try_normalize(1e-9)?;
    let end = |k: usize, last: bool| {
        let k = k % n;
        let points = flatten(corner(k), corner(k + 1), &p.outer.edges[k].curve, TOLERANCE);
        let m = points.len();
        let way = if last { points[m - 2] - points[m - 1] } else { points[1] - points[0] };
        way.try_normalize(1e-9)
    };
    let mirrored = |v: Vector2, at: Vector2| at * (2.0 * v.dot(&at)) - v;
    let meets = |from: Point2, way: Vector2| {
        let det = way.perp(&middle);
        (det.abs() > 1e-9).then(|| (from - tip).perp(&way) / -det).map(|s| tip + middle * s)
    };
    let one = meets(a, mirrored(end(first + n - 1, true)?, to_a))?;
    let other = meets(b, mirrored(end(first + 2, false)?, to_b))?;
    let top = nalgebra::center(&one, &other);
    let (mouth, high) = ((b - a).norm(), (top - nalgebra::center(&a, &b)).dot(&middle));
    (high > 0.0 && high < mouth && (one - other).norm() < mouth).then_some(top)
}

/// The allowance along a segment.
fn strip(s: &SewnSegment) -> Option<Vec<[f64; 2]>> {
    let out = s.out();
    (s.width > 0.0).then(|| [s.a, s.a + out, s.b + out, s.b].map(|p| [p.x, p.y]).into())
}

/// The allowance at the corner between two segments where the line turns outwards.
fn mitre(one: &SewnSegment, next: &SewnSegment) -> Option<Vec<[f64; 2]>> {
    let (d, e) = (one.way(), next.way());
    let (sine, cosine) = (d.perp(&e), d.dot(&e));
    if (sine <= 1e-9 && cosine > 0.0) || (sine < 0.0) || one.width.max(next.width) == 0.0 {
        return None;
    }
    let (corner, a, b) = (one.b, one.b + one.out(), one.b + next.out());
    // How far both cut lines run on until they meet.
    let run = (next.width - one.width * cosine) / sine.max(1e-12);
    let back = (one.width - next.width * cosine) / sine.max(1e-12);
    let most = MITRE * one.width.max(next.width);
    let points = match (run >= 0.0 && back >= 0.0, run.max(back) <= most * 0.999) {
        (false, _) => vec![corner, a, b],
        (true, true) => vec![corner, a, a + d * run, b],
        (true, false) => {
            let (run, back) = (run.min(most), back.min(most));
            vec![corner, a, a + d * run, b - e * back, b]
        }
    };
    Some(points.into_iter().map(|p| [p.x, p.y]).collect())
}

/// The outer boundary of the union, counter-clockwise.
fn outer(polygons: &[Vec<[f64; 2]>]) -> Option<Vec<Point2>> {
    let shapes = polygons.to_vec().simplify_shape_as::<i64>(FillRule::NonZero);
    let rings = shapes.into_iter().filter_map(|shape| shape.into_iter().next());
    let rings = rings.map(|ring| ring.into_iter().map(|[x, y]| Point2::new(x, y)).collect::<Vec<_>>());
    let largest = rings.max_by(|a, b| polygon_area(a).abs().total_cmp(&polygon_area(b).abs()))?;
    let mut line: Vec<Point2> = Vec::with_capacity(largest.len());
    for p in largest {
        if line.last().is_none_or(|q| (p - q).norm() > POINT) {
            line.push(p);
        }
    }
    while line.len() > 1 && (line[0] - line[line.len() - 1]).norm() <= POINT {
        line.pop();
    }
    if polygon_area(&line) < 0.0 {
        line.reverse();
    }
    (line.len() >= 3).then_some(line)
}

/// Tells edges of whose allowance little is left, because that of others is in its way.
fn tell<'a>(p: &'a Piece, base: &[SewnSegment], line: &[Point2], trimmed: &mut Vec<Trimmed<'a>>) {
    let mut of_edge: BTreeMap<usize, (f64, f64, f64)> = BTreeMap::new();
    // Of a finely drawn curve every so manyth chord tells enough.
    for s in base.iter().step_by(base.len().div_ceil(LOOKED)).filter(|s| s.width > 0.0) {
        let length = (s.b - s.a).norm();
        let there = distance(line, nalgebra::center(&s.a, &s.b) + s.out()) < TOLERANCE;
        let (whole, left, width) = of_edge.entry(s.edge).or_default();
        *width = s.width;
        *whole += length;
        *left += if there { length } else { 0.0 };
    }
    for (edge, (whole, left, width)) in of_edge {
        let share = left / whole;
        // That of a very short edge is always lost at a corner.
        if share < LEFT && whole > width * LEFT {
            trimmed.push(Trimmed { edge: &p.outer.edges[edge].name, piece: &p.name, left: share });
        }
    }
}

/// The distance of a point from a closed line, metres.
fn distance(line: &[Point2], p: Point2) -> f64 {
    let n = line.len();
    let chord = |k: usize| {
        let (a, b) = (line[k], line[(k + 1) % n]);
        let d = b - a;
        let t = ((p - a).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (p - (a + d * t)).norm()
    };
    (0..n).map(chord).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use toile_core::artifact::{EdgeCurve, EdgeUse, PatternLoop, PatternSeam, PieceEdge};

    fn p(x: f64, y: f64) -> Point2 {
        Point2::new(x, y)
    }

    fn piece(corners: &[Point2]) -> Piece {
        let edge = |k: usize| PieceEdge { name: format!("edge_{k}"), curve: EdgeCurve::Line };
        let outer = PatternLoop { corners: corners.to_vec(), edges: (0..corners.len()).map(edge).collect() };
        Piece { name: "p".into(), outer, ..Piece::default() }
    }

    fn of(piece: Piece, seams: Vec<PatternSeam>, allowances: &Allowances) -> (Vec<Point2>, Vec<String>) {
        let pattern = Pattern { name: "t".into(), pieces: vec![piece], seams };
        let mut cut = cut_lines(&pattern, allowances).unwrap();
        (cut.lines.remove(0).unwrap(), cut.notes)
    }

    fn free(width: f64) -> Allowances {
        Allowances { free: width, ..Allowances::default() }
    }

    fn has(line: &[Point2], q: Point2) -> bool {
        line.iter().any(|p| (p - q).norm() < 1e-7)
    }

    fn rectangle() -> Piece {
        piece(&[p(0.0, 0.0), p(0.3, 0.0), p(0.3, 0.4), p(0.0, 0.4)])
    }

    #[test]
    fn corners_are_mitred_with_an_allowance_of_each_edge() {
        let mut widths = free(0.01);
        widths.by_edge.insert(EdgeRef { panel: "p".into(), edge: "edge_0".into() }, 0.04);
        widths.by_edge.insert(EdgeRef { panel: "p".into(), edge: "edge_3".into() }, 0.0);
        let (line, told) = of(rectangle(), vec![], &widths);
        assert_eq!((line.len(), told.len()), (4, 0), "{line:?}");
        for q in [p(0.0, -0.04), p(0.31, -0.04), p(0.31, 0.41), p(0.0, 0.41)] {
            assert!(has(&line, q), "{q} in {line:?}");
        }
    }

    #[test]
    fn a_sharp_corner_is_cut_off_and_a_concave_one_trimmed() {
        let (line, _) = of(piece(&[p(0.0, 0.0), p(1.0, 0.0), p(0.0, 0.1)]), vec![], &free(0.01));
        let tip = line.iter().map(|q| (q - p(1.0, 0.0)).norm()).fold(0.0, f64::max);
        assert!(line.iter().all(|q| q.x < 1.0 + (MITRE + 1.0) * 0.01) && tip > 0.01);
        let step = piece(&[p(0.0, 0.0), p(0.2, 0.0), p(0.2, 0.2), p(0.1, 0.2), p(0.1, 0.4), p(0.0, 0.4)]);
        let (line, told) = of(step, vec![], &free(0.01));
        assert!(has(&line, p(0.11, 0.21)) && line.len() == 6 && told.is_empty(), "{line:?}");
    }

    #[test]
    fn where_allowances_meet_they_are_trimmed_and_told() {
        // A slot of 10 mm, wholly filled by two allowances of 10 mm.
        let slot = piece(&[
            p(0.0, 0.0),
            p(0.2, 0.0),
            p(0.2, 0.3),
            p(0.105, 0.3),
            p(0.105, 0.1),
            p(0.095, 0.1),
            p(0.095, 0.3),
            p(0.0, 0.3),
        ]);
        let (line, told) = of(slot, vec![], &free(0.01));
        assert_eq!(line.len(), 4, "{line:?}");
        assert_eq!(
            told,
            [
                "the allowances of 3 edges are trimmed where they meet those of others: 0 % is left of that of edge \"edge_3\" of piece \"p\""
            ]
        );
    }

    #[test]
    fn a_dart_is_not_cut_out_and_its_fold_reaches_the_edge() {
        let corners =
            [p(0.0, 0.0), p(0.3, 0.0), p(0.3, 0.2), p(0.165, 0.2), p(0.15, 0.1), p(0.135, 0.2), p(0.0, 0.2)];
        let side = |edge: &str, reversed| {
            vec![EdgeUse { edge: EdgeRef { panel: "p".into(), edge: edge.into() }, reversed }]
        };
        let dart = PatternSeam {
            name: "dart".into(),
            kind: SeamKind::Dart,
            sides: vec![side("edge_3", false), side("edge_4", true)],
        };
        let (line, told) = of(piece(&corners), vec![dart], &free(0.01));
        assert!(told.is_empty() && line.iter().all(|q| q.y < 1e-9 || q.y > 0.2), "{line:?}");
        // The leg leans by atan(15 / 100), the edge mirrored at it rises by twice that.
        let top = line.iter().map(|q| q.y).fold(0.0, f64::max);
        let rise = 0.015 * (2.0 * 0.15_f64.atan()).tan();
        assert!((top - (0.2 + rise + 0.01 / (2.0 * 0.15_f64.atan()).cos())).abs() < 1e-6, "{top}");
    }

    #[test]
    fn what_cannot_be_cut_is_told_with_its_place() {
        let pattern = Pattern { name: "t".into(), pieces: vec![rectangle()], seams: vec![] };
        let refused = |allowances: &Allowances| {
            let e = cut_lines(&pattern, allowances).unwrap_err();
            (e.to_string(), e.remedy())
        };
        assert_eq!(
            refused(&free(-0.01)),
            (
                "the allowance of edges that are not sewn is -10 mm, it is at least 0 and at most 200 mm"
                    .into(),
                "give the allowance in metres, such as 0.01"
            )
        );
        let mut wrong = Allowances::default();
        wrong.by_edge.insert(EdgeRef { panel: "p".into(), edge: "hem".into() }, 0.01);
        assert_eq!(
            refused(&wrong),
            (
                "an allowance is given for p.hem, which is no edge of the pattern".into(),
                "name a piece and an edge of its outline, such as \"front.hem\""
            )
        );
    }
}
