//! A block as a piece of the pattern.
//!
//! Method: the boundary's polylines are chained into a loop, each of them an edge (CAD programs split the boundary where seams
//! end); a boundary in one line is split at its turn points. The grain is turned to y, a half piece unfolded at its mirror line,
//! and everything drawn on it goes along. Where a sew line (layer 14) closes, it is the outline: the boundary is then the cut
//! line, with the seam allowance. Limits: curve points are joined by straight lines, those of layer 84 where they are given.

use super::super::chain::{HAIR, JOINT, chained};
use super::super::marks::{hole, notched};
use super::super::side::{Side, counter_clockwise, pattern_loop, points, split};
use super::super::unfold::Fold;
use super::damage::Damage;
use super::entities::Block;
use crate::mesh::crossing::first_crossing;
use toile_core::prelude::*;

/// The piece of a block; `unit` is the length of the file's unit in metres.
pub(super) fn piece(block: &Block, name: &str, unit: f64, told: &mut Vec<String>) -> Result<Piece, Damage> {
    let at = Place { block, name, unit };
    let mut sides = at.boundary(told)?;
    let grain = at.line(7);
    // The grain turned up.
    let turn = grain.and_then(|(a, b)| (b - a).try_normalize(1e-9)).map_or([1.0, 0.0], |d| [d.y, d.x]);
    let up = move |p: Point2| Point2::new(turn[0] * p.x - turn[1] * p.y, turn[1] * p.x + turn[0] * p.y);
    sides.iter_mut().for_each(|s| *s = s.moved(up, false));
    let mut lines = at.inner(up);
    let mut holes = at.holes(up)?;
    let mut drills: Vec<Point2> = block.points(&[13]).map(|(p, _)| up(p * unit)).collect();
    let mut notches: Vec<(Point2, f64)> =
        block.points(&[4, 80, 81, 82, 83]).map(|(p, d)| (up(p * unit), d * unit)).collect();
    if let Some((a, b)) = at.line(6).map(|(a, b)| (up(a), up(b))) {
        let fold = Fold::through(a, b).ok_or_else(|| at.mirror())?;
        sides = fold.unfolded(&sides).ok_or_else(|| at.mirror())?;
        let to = |p: Point2| fold.mirror(p);
        let doubled = |l: &PieceLine| PieceLine {
            name: format!("{}_m", l.name),
            points: l.points.iter().map(|p| to(*p)).collect(),
            ..l.clone()
        };
        lines = lines.iter().cloned().chain(lines.iter().map(doubled)).collect();
        holes.extend(holes.clone().iter().map(|h| h.iter().map(|p| to(*p)).collect()));
        drills.extend(drills.clone().iter().map(|p| to(*p)));
        notches.extend(notches.clone().iter().map(|(p, d)| (to(*p), *d)));
        told.push(format!("piece \"{name}\" is unfolded at its mirror line"));
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
struct Place<'a> {
    block: &'a Block,
    name: &'a str,
    unit: f64,
}

impl Place<'_> {
    fn scaled(&self, points: &[Point2]) -> Vec<Point2> {
        let mut out: Vec<Point2> = Vec::with_capacity(points.len());
        for p in points.iter().map(|p| p * self.unit) {
            if out.last().is_none_or(|q| (p - q).norm() > 1e-6) {
                out.push(p);
            }
        }
        out
    }

    /// The first line of a layer, from its first to its last point.
    fn line(&self, layer: i32) -> Option<(Point2, Point2)> {
        let (_, points, _) = self.block.lines(layer).next()?;
        let (a, b) = (points[0] * self.unit, points[points.len() - 1] * self.unit);
        ((b - a).norm() > 1e-6).then_some((a, b))
    }

    fn inner(&self, up: impl Fn(Point2) -> Point2) -> Vec<PieceLine> {
        let all = self.block.lines(8).map(|(_, points, _)| self.scaled(points)).filter(|p| p.len() >= 2);
        let line = |(k, points): (usize, Vec<Point2>)| PieceLine {
            name: format!("line_{k}"),
            purpose: LinePurpose::Mark,
            points: points.into_iter().map(&up).collect(),
        };
        all.enumerate().map(line).collect()
    }

    /// Cut-outs, not repeating their first points.
    fn holes(&self, up: impl Fn(Point2) -> Point2) -> Result<Vec<Vec<Point2>>, Damage> {
        let mut out = Vec::new();
        for (line, points, closed) in self.block.lines(11) {
            let mut points = self.scaled(points);
            let gap = (points[0] - points[points.len() - 1]).norm();
            if gap <= HAIR && points.len() > 1 {
                points.pop();
            } else if !closed {
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

    fn fault(&self, what: String) -> Damage {
        Damage::Piece { piece: self.name.to_owned(), line: self.block.line, what }
    }

    fn mirror(&self) -> Damage {
        Damage::Mirror { piece: self.name.to_owned(), line: self.block.line }
    }

    /// The boundary, closed, its sides in order.
    fn boundary(&self, told: &mut Vec<String>) -> Result<Vec<Side>, Damage> {
        if self.block.lines(14).next().is_some()
            && let Ok(sides) = self.around(14, &mut Vec::new())
        {
            told.push(format!(
                "piece \"{}\" is cut along its sew line; the boundary is its cut line",
                self.name
            ));
            return Ok(sides);
        }
        self.around(1, told)
    }

    fn around(&self, layer: i32, told: &mut Vec<String>) -> Result<Vec<Side>, Damage> {
        let mut rest: Vec<Side> = Vec::new();
        let mut whole = None;
        for (_, points, closed) in self.block.lines(layer) {
            let mut points = self.scaled(&self.finer(layer, points));
            if points.len() < 2 {
                continue;
            }
            let ends = (points[0] - points[points.len() - 1]).norm();
            if closed || ends <= JOINT {
                if ends <= JOINT {
                    points.pop();
                }
                // The largest closed line is the outline.
                let area = polygon_area(&points).abs();
                if whole.as_ref().is_none_or(|(a, _)| area > *a) {
                    whole = Some((area, points));
                }
            } else {
                rest.push(Side::polyline(format!("edge_{}", rest.len()), &points));
            }
        }
        if let Some((_, points)) = whole.filter(|(_, p)| p.len() >= 3 && rest.is_empty()) {
            let around = Side::polyline(String::new(), &[points.as_slice(), &points[..1]].concat());
            return Ok(split(around.start, &around.parts));
        }
        if rest.is_empty() {
            return Err(self.fault("it has no boundary".into()));
        }
        let sides = chained(rest, self.name, told).map_err(|gap| Damage::Open {
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

    /// The points of the quality curve (layer 84) that runs from end to end of a boundary line; its own where there is none.
    fn finer(&self, layer: i32, points: &[Point2]) -> Vec<Point2> {
        let near = |a: &Point2, b: &Point2| (a - b).norm() * self.unit <= JOINT;
        let (a, b) = (points[0], points[points.len() - 1]);
        let length = polyline_length(points);
        let alike = |fine: &[Point2]| {
            fine.len() > points.len() && (polyline_length(fine) - length).abs() <= 0.02 * length
        };
        let fine = self.block.lines(84).map(|(_, p, _)| p).filter(|p| layer == 1 && alike(p)).find_map(|p| {
            let (c, d) = (p[0], p[p.len() - 1]);
            match (near(&a, &c) && near(&b, &d), near(&a, &d) && near(&b, &c)) {
                (true, _) => Some(p.to_vec()),
                (_, true) => Some(p.iter().rev().copied().collect()),
                _ => None,
            }
        });
        fine.unwrap_or_else(|| points.to_vec())
    }

    fn simple(&self, sides: &[Side], turn: [f64; 2]) -> Result<(), Damage> {
        let points = points(sides);
        let n = points.len() as u32;
        if n < 3 || polygon_area(&points).abs() < 1e-7 {
            return Err(self.fault("it encloses no area".into()));
        }
        let segments: Vec<[u32; 2]> = (0..n).map(|i| [i, (i + 1) % n]).collect();
        let Some([_, other]) = first_crossing(&points, &segments) else { return Ok(()) };
        let p = points[other];
        // Back to how the file has it.
        let (x, y) = (turn[0] * p.x + turn[1] * p.y, turn[0] * p.y - turn[1] * p.x);
        let (piece, line) = (self.name.to_owned(), self.block.line);
        Err(Damage::Crosses { piece, line, x: x / self.unit, y: y / self.unit })
    }
}
