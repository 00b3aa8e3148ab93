//! A block as a piece of the pattern.
//!
//! Method: the boundary's polylines are chained into a loop, each of them an edge (CAD programs
//! split the boundary where seams end); a boundary in one line is split at its turn points. The
//! grain is turned to y, a half piece unfolded at its mirror line, and everything drawn on it goes
//! along. Where a sew line (layer 14) closes, it is the outline: the boundary is then the cut line,
//! with the seam allowance. Limits: points of a polyline are joined by straight lines, those of
//! layer 84 where they are given.

use super::super::chain::{HAIR, JOINT, chained};
use super::super::marks::{hole, notched};
use super::super::side::{NotSimple, Side, check_simple, counter_clockwise, pattern_loop, split};
use super::super::unfold::{Fold, distinct, image_word, open_ring};
use super::damage::DxfDamage;
use super::entities::{Block, Stroke};
use toile_core::Remarks;
use toile_core::prelude::*;

/// No smaller piece is one, square metres.
const LEAST: f64 = 1e-7;

/// The piece of a block; `unit` is the length of the file's unit in metres.
pub(super) fn piece(block: &Block, name: &str, unit: f64, told: &mut Remarks) -> Result<Piece, DxfDamage> {
    let at = NamedBlock { block, name, unit };
    let mut sides = at.boundary(told)?;
    let grain = at.line(7).next();
    // The grain turned up.
    let turn = grain.and_then(|(a, b)| (b - a).try_normalize(1e-9)).map_or([1.0, 0.0], |d| [d.y, d.x]);
    let up = move |p: Point2| Point2::new(turn[0] * p.x - turn[1] * p.y, turn[1] * p.x + turn[0] * p.y);
    sides.iter_mut().for_each(|s| *s = s.moved(up, false));
    let mut lines = at.inner(up);
    let mut holes = at.holes(up)?;
    let mut drills: Vec<Point2> = block.points(&[13]).map(|(p, _)| up(p * unit)).collect();
    let mut notches: Vec<(Point2, f64)> =
        block.points(&[4, 80, 81, 82, 83]).map(|(p, d)| (up(p * unit), d * unit)).collect();
    let folds = at.line(6).filter_map(|(a, b)| Some((Fold::through(up(a), up(b))?, ())));
    let folds = distinct(folds);
    let whole = sides.clone();
    for (k, (fold, ())) in folds.iter().enumerate() {
        let word = image_word(k);
        let lies = fold.holds(&whole);
        if !lies && k > 0 {
            told.warnings.push(format!(
                "piece \"{name}\" (line {}): a mirror line beside the first does not lie on its boundary: left out",
                block.line
            ));
            continue;
        }
        let unfolded = fold.unfolded(&sides, &word).filter(|_| lies).ok_or_else(|| at.mirror())?;
        sides = unfolded.sides;
        let to = |p: Point2| fold.mirror(p);
        let doubled = |l: &PieceLine| PieceLine {
            name: format!("{}{word}", l.name),
            points: l.points.iter().map(|p| to(*p)).collect(),
            ..l.clone()
        };
        lines = lines.iter().cloned().chain(lines.iter().map(doubled)).collect();
        holes.extend(holes.clone().iter().map(|h| h.iter().map(|p| to(*p)).collect()));
        drills.extend(drills.clone().iter().map(|p| to(*p)));
        notches.extend(notches.clone().iter().map(|(p, d)| (to(*p), *d)));
        told.notes.push(format!("piece \"{name}\" is unfolded at its mirror line"));
        told.warnings.extend(unfolded.open.iter().map(|pair| open_ring(name, pair)));
    }
    let sides = counter_clockwise(sides);
    at.simple(&sides, turn)?;
    let outer = pattern_loop(&sides);
    let notches = notched(&outer, &notches);
    let grain = grain.map(|(a, b)| [up(a), up(b)]).filter(|[a, b]| b.y > a.y);
    let holes = holes.into_iter().enumerate().map(|(k, points)| hole(k, points)).collect();
    Ok(Piece {
        name: name.to_owned(),
        outer,
        holes,
        lines,
        notches,
        drill_holes: drills,
        grain,
        ..Piece::default()
    })
}

/// A block with its name, for errors, and its unit.
struct NamedBlock<'a> {
    block: &'a Block,
    name: &'a str,
    unit: f64,
}

impl NamedBlock<'_> {
    /// A line in metres, without segments that are too short.
    fn scaled(&self, stroke: &Stroke) -> Side {
        let to = |p: Point2| p * self.unit;
        let mut side = Side { name: String::new(), start: to(stroke.start), parts: Vec::new() };
        for (curve, end) in &stroke.parts {
            let (curve, end) = (curve.moved(to, false), to(*end));
            if EdgePath::new(side.end(), end, &curve).length() > 1e-6 {
                side.parts.push((curve, end));
            }
        }
        side
    }

    /// The lines of a layer, each from its first to its last point.
    fn line(&self, layer: i32) -> impl Iterator<Item = (Point2, Point2)> {
        let ends = self.block.lines(layer).map(|(_, s)| (s.start * self.unit, s.end() * self.unit));
        ends.filter(|(a, b)| (b - a).norm() > 1e-6)
    }

    fn inner(&self, up: impl Fn(Point2) -> Point2) -> Vec<PieceLine> {
        let all = self.block.lines(8).map(|(_, s)| self.scaled(s)).filter(|s| !s.parts.is_empty());
        let line = |(k, side): (usize, Side)| PieceLine {
            name: format!("line_{k}"),
            purpose: LinePurpose::Mark,
            points: side.points().into_iter().map(&up).collect(),
        };
        all.enumerate().map(line).collect()
    }

    /// Cut-outs, not repeating their first points.
    fn holes(&self, up: impl Fn(Point2) -> Point2) -> Result<Vec<Vec<Point2>>, DxfDamage> {
        let mut out = Vec::new();
        for (line, stroke) in self.block.lines(11) {
            let mut points = self.scaled(stroke).points();
            let gap = (points[0] - points[points.len() - 1]).norm();
            if gap <= HAIR && points.len() > 1 {
                points.pop();
            } else if !stroke.closed {
                let what = format!("a cut-out (line {line}) is open by {:.1} mm", gap * 1e3);
                return Err(self.fault(what));
            }
            if points.len() < 3 || polygon_area(&points).abs() < 1e-8 {
                return Err(self.fault(format!("a cut-out (line {line}) has no area")));
            }
            out.push(points.into_iter().map(&up).collect());
        }
        Ok(out)
    }

    fn fault(&self, what: String) -> DxfDamage {
        DxfDamage::Piece { piece: self.name.to_owned(), line: self.block.line, what }
    }

    fn mirror(&self) -> DxfDamage {
        DxfDamage::Mirror { piece: self.name.to_owned(), line: self.block.line }
    }

    /// The boundary, closed, its sides in order.
    fn boundary(&self, told: &mut Remarks) -> Result<Vec<Side>, DxfDamage> {
        if self.block.lines(14).next().is_some()
            && let Ok(sides) = self.around(14, &mut Remarks::default())
        {
            told.notes.push(format!(
                "piece \"{}\" is cut along its sew line; the boundary is its cut line",
                self.name
            ));
            return Ok(sides);
        }
        self.around(1, told)
    }

    fn around(&self, layer: i32, told: &mut Remarks) -> Result<Vec<Side>, DxfDamage> {
        let mut rest: Vec<Side> = Vec::new();
        let mut closed: Vec<(f64, usize, Side)> = Vec::new();
        for (line, stroke) in self.block.lines(layer) {
            let mut side = self.scaled(&self.finer(layer, stroke));
            let gap = (side.end() - side.start).norm();
            if side.parts.is_empty() {
                continue;
            }
            if stroke.closed || gap <= JOINT {
                match gap <= JOINT {
                    true => side.end_at(side.start),
                    false => side.parts.push((EdgeCurve::Line, side.start)),
                }
                closed.push((polygon_area(&side.points()).abs(), line, side));
            } else {
                rest.push(Side { name: format!("edge_{}", rest.len()), ..side });
            }
        }
        // The largest closed line is the outline.
        let outline = (0..closed.len()).max_by(|&i, &j| closed[i].0.total_cmp(&closed[j].0).then(j.cmp(&i)));
        if let Some(k) = outline.filter(|_| rest.is_empty()) {
            let (_, _, side) = closed.swap_remove(k);
            self.left_out(layer, closed.iter().map(|(_, line, _)| *line), told);
            let sides = split(side.start, &side.parts);
            return if side.parts.len() < 2 && sides.len() < 2 {
                Err(self.fault("it encloses no area".into()))
            } else {
                Ok(sides)
            };
        }
        self.left_out(layer, closed.iter().map(|(_, line, _)| *line), told);
        if rest.is_empty() {
            return Err(self.fault("it has no boundary".into()));
        }
        let sides = chained(rest, self.name, told).map_err(|gap| DxfDamage::Open {
            piece: self.name.to_owned(),
            line: self.block.line,
            gap_mm: gap.wide * 1e3,
            x: gap.at.x / self.unit,
            y: gap.at.y / self.unit,
        })?;
        match sides.len() {
            1 => Err(self.fault("its boundary is one open line".into())),
            _ => Ok(sides),
        }
    }

    /// Reports lines on the boundary's layer that are no part of the boundary.
    fn left_out(&self, layer: i32, lines: impl Iterator<Item = usize>, told: &mut Remarks) {
        let lines: Vec<String> = lines.map(|line| line.to_string()).collect();
        if !lines.is_empty() {
            told.warnings.push(format!(
                "piece \"{}\": beside its boundary there are closed lines on layer {layer} (line {}): left out",
                self.name,
                lines.join(", ")
            ));
        }
    }

    /// The quality curve (layer 84) that runs from end to end of a boundary line; the line itself
    /// where there is none.
    fn finer(&self, layer: i32, stroke: &Stroke) -> Stroke {
        let points = stroke.corners();
        let near = |a: &Point2, b: &Point2| (a - b).norm() * self.unit <= JOINT;
        let (a, b) = (points[0], points[points.len() - 1]);
        let length = polyline_length(&points);
        let alike = |fine: &Stroke| {
            fine.parts.len() > stroke.parts.len()
                && (polyline_length(&fine.corners()) - length).abs() <= 0.02 * length
        };
        let straight = layer == 1 && stroke.is_straight();
        let fine = self.block.lines(84).map(|(_, s)| s).filter(|s| straight && alike(s)).find_map(|s| {
            let (c, d) = (s.start, s.end());
            match (near(&a, &c) && near(&b, &d), near(&a, &d) && near(&b, &c)) {
                (true, _) => Some(s.clone()),
                (_, true) => {
                    let side = Side { name: String::new(), start: s.start, parts: s.parts.clone() }.turned();
                    Some(Stroke { start: side.start, parts: side.parts, closed: s.closed })
                }
                _ => None,
            }
        });
        fine.unwrap_or_else(|| stroke.clone())
    }

    fn simple(&self, sides: &[Side], turn: [f64; 2]) -> Result<(), DxfDamage> {
        check_simple(sides, LEAST, turn.into()).map_err(|e| match e {
            NotSimple::NoArea => self.fault("it encloses no area".into()),
            NotSimple::Crosses(p) => {
                let (piece, line) = (self.name.to_owned(), self.block.line);
                DxfDamage::Crosses { piece, line, x: p.x / self.unit, y: p.y / self.unit }
            }
        })
    }
}
