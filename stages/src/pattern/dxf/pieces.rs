//! A block as a piece of the pattern.
//!
//! Method: the boundary's polylines are chained into a loop, each of them an edge (CAD programs split the boundary where seams
//! end); a boundary in one line is split at its turn points. The grain is turned to y, a half piece unfolded at its mirror line,
//! and everything drawn on it goes along. Where a sew line (layer 14) closes, it is the outline: the boundary is then the cut
//! line, with the seam allowance. Limits: curve points are joined by straight lines, those of layer 84 where they are given.

use super::damage::Damage;
use super::entities::Block;
use crate::mesh::crossing::first_crossing;
use toile_core::prelude::*;

/// Gaps of up to this are no gaps, metres.
const JOINT: f64 = 2e-4;
/// Gaps of up to this are closed and told, metres.
const HAIR: f64 = 5e-3;
/// A boundary in one line is split where it turns by more than this, degrees.
const CORNER: f64 = 25.0;

/// A stretch of the boundary: its name and its points, both ends included, in metres.
#[derive(Debug, Clone)]
struct Side {
    name: String,
    points: Vec<Point2>,
}

impl Side {
    fn start(&self) -> Point2 {
        self.points[0]
    }

    fn end(&self) -> Point2 {
        self.points[self.points.len() - 1]
    }
}

/// The piece of a block; `unit` is the length of the file's unit in metres.
pub(super) fn piece(block: &Block, name: &str, unit: f64, told: &mut Vec<String>) -> Result<Piece, Damage> {
    let at = Place { block, name, unit };
    let mut sides = at.boundary(told)?;
    let grain = at.line(7);
    // The grain turned up.
    let turn = grain.and_then(|(a, b)| (b - a).try_normalize(1e-9)).map_or([1.0, 0.0], |d| [d.y, d.x]);
    let up = move |p: Point2| Point2::new(turn[0] * p.x - turn[1] * p.y, turn[1] * p.x + turn[0] * p.y);
    for side in &mut sides {
        side.points.iter_mut().for_each(|p| *p = up(*p));
    }
    let mut lines = at.inner(up);
    let mut holes = at.holes(up)?;
    let mut drills: Vec<Point2> = block.points(&[13]).map(|(p, _)| up(p * unit)).collect();
    let mut notches: Vec<(Point2, f64)> =
        block.points(&[4, 80, 81, 82, 83]).map(|(p, d)| (up(p * unit), d * unit)).collect();
    if let Some((a, b)) = at.line(6).map(|(a, b)| (up(a), up(b))) {
        sides = unfolded(sides, a, b).ok_or_else(|| at.mirror())?;
        let to = |p: Point2| mirror(p, a, b);
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
    if polygon_area(&corners_and_all(&sides)) < 0.0 {
        sides.reverse();
        sides.iter_mut().for_each(|s| s.points.reverse());
    }
    at.simple(&sides, turn)?;
    let outer = PatternLoop {
        corners: sides.iter().map(Side::start).collect(),
        edges: sides.iter().map(|s| PieceEdge { name: s.name.clone(), curve: curve(&s.points) }).collect(),
    };
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

fn curve(points: &[Point2]) -> EdgeCurve {
    match &points[1..points.len() - 1] {
        [] => EdgeCurve::Line,
        inner => EdgeCurve::Polyline { points: inner.to_vec() },
    }
}

fn corners_and_all(sides: &[Side]) -> Vec<Point2> {
    sides.iter().flat_map(|s| &s.points[..s.points.len() - 1]).copied().collect()
}

fn hole(k: usize, points: Vec<Point2>) -> PatternLoop {
    let mut corners = points;
    if polygon_area(&corners) > 0.0 {
        corners.reverse();
    }
    let edge = |i: usize| PieceEdge { name: format!("hole_{k}_{i}"), curve: EdgeCurve::Line };
    PatternLoop { edges: (0..corners.len()).map(edge).collect(), corners }
}

/// A point mirrored about the line through `a` and `b`.
fn mirror(p: Point2, a: Point2, b: Point2) -> Point2 {
    let d = (b - a).try_normalize(0.0).unwrap_or_else(Vector2::y);
    let foot = a + d * (p - a).dot(&d);
    foot + (foot - p)
}

/// The whole loop of a half one whose mirror line is an edge of it; an edge that runs smoothly into its image becomes one with
/// it. None where no edge lies along the line.
fn unfolded(sides: Vec<Side>, a: Point2, b: Point2) -> Option<Vec<Side>> {
    let d = (b - a).try_normalize(1e-9)?;
    let foot = |p: Point2| a + d * (p - a).dot(&d);
    let fold = sides.iter().position(|s| s.points.iter().all(|p| (p - foot(*p)).norm() <= 1e-3))?;
    let (n, m) = (sides.len(), sides.len() - 1);
    let mut half: Vec<Side> = (1..n).map(|k| sides[(fold + k) % n].clone()).collect();
    // Its ends to the last bit on the line, so that the images meet them.
    if let Some(p) = half.first_mut().and_then(|s| s.points.first_mut()) {
        *p = foot(*p);
    }
    if let Some(p) = half.last_mut().and_then(|s| s.points.last_mut()) {
        *p = foot(*p);
    }
    let image = |s: &Side| Side {
        name: format!("{}_m", s.name),
        points: s.points.iter().rev().map(|p| mirror(*p, a, b)).collect(),
    };
    let whole: Vec<Side> = half.iter().cloned().chain(half.iter().rev().map(image)).collect();
    // The last side of the half meets its image, and the first one's image the first.
    let smooth = [whole.get(m - 1..=m)?, &[whole.last()?.clone(), whole.first()?.clone()]].map(|pair| {
        let (u, v) = (&pair[0].points, &pair[1].points);
        let (u, v) = (u[u.len() - 1] - u[u.len() - 2], v[1] - v[0]);
        u.perp(&v).atan2(u.dot(&v)).abs() <= 2.0 * CORNER.to_radians()
    });
    let joined = |one: &Side, other: &Side, name: &str| Side {
        name: name.to_owned(),
        points: one.points.iter().chain(&other.points[1..]).copied().collect(),
    };
    let mut out: Vec<Side> = Vec::new();
    for (k, side) in whole.iter().enumerate() {
        match k {
            _ if k == m && smooth[0] => {
                let before = out.pop()?;
                out.push(joined(&before, side, &before.name));
            }
            _ if k == 2 * m - 1 && smooth[1] && out.len() > 1 => {
                out[0] = joined(side, &out[0], &out[0].name.clone())
            }
            _ => out.push(side.clone()),
        }
    }
    (out.len() >= 2).then_some(out)
}

/// Each notch on the edge that it is nearest to.
fn notched(outer: &PatternLoop, notches: &[(Point2, f64)]) -> Vec<Notch> {
    let paths: Vec<EdgePath> = (0..outer.edges.len()).map(|k| outer.path(k)).collect();
    let mut out: Vec<Notch> = Vec::new();
    for (p, depth) in notches {
        let feet = paths.iter().enumerate().map(|(k, path)| (k, nearest(path, *p)));
        let Some((k, (_, along))) = feet.min_by(|x, y| x.1.0.total_cmp(&y.1.0)) else { continue };
        let notch = Notch { edge: outer.edges[k].name.clone(), along, depth: *depth };
        let same = |n: &Notch| n.edge == notch.edge && (n.along - along).abs() < 1e-3;
        if !out.iter().any(same) {
            out.push(notch);
        }
    }
    out
}

/// The distance of a point from a path, and the length along it there.
fn nearest(path: &EdgePath, p: Point2) -> (f64, f64) {
    let (mut best, mut before) = ((f64::INFINITY, 0.0), 0.0);
    for w in path.points().windows(2) {
        let d = w[1] - w[0];
        let t = ((p - w[0]).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let distance = (p - (w[0] + d * t)).norm();
        if distance < best.0 {
            best = (distance, (before + t * d.norm()).min(path.length()));
        }
        before += d.norm();
    }
    best
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
            && let Ok(sides) = self.chained(14, &mut Vec::new())
        {
            told.push(format!(
                "piece \"{}\" is cut along its sew line; the boundary is its cut line",
                self.name
            ));
            return Ok(sides);
        }
        self.chained(1, told)
    }

    fn chained(&self, layer: i32, told: &mut Vec<String>) -> Result<Vec<Side>, Damage> {
        let mut rest: Vec<(usize, Vec<Point2>)> = Vec::new();
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
                rest.push((rest.len(), points));
            }
        }
        if let Some((_, points)) = whole.filter(|(_, p)| p.len() >= 3 && rest.is_empty()) {
            return Ok(split(points));
        }
        if rest.is_empty() {
            return Err(self.fault("it has no boundary".into()));
        }
        let named = |(k, points): (usize, Vec<Point2>)| Side { name: format!("edge_{k}"), points };
        let mut sides = vec![named(rest.remove(0))];
        while !rest.is_empty() {
            let here = sides[sides.len() - 1].end();
            let gap = |p: &[Point2]| (here - p[0]).norm().min((here - p[p.len() - 1]).norm());
            let next =
                (0..rest.len()).min_by(|&i, &j| gap(&rest[i].1).total_cmp(&gap(&rest[j].1))).unwrap_or(0);
            let (k, mut points) = rest.remove(next);
            if (here - points[0]).norm() > (here - points[points.len() - 1]).norm() {
                points.reverse();
            }
            sides.push(named((k, points)));
        }
        self.close(&mut sides, told)?;
        Ok(sides)
    }

    /// Lets each side begin where the one before ends.
    fn close(&self, sides: &mut [Side], told: &mut Vec<String>) -> Result<(), Damage> {
        let n = sides.len();
        for k in 0..n {
            let end = sides[k].end();
            let next = (k + 1) % n;
            let gap = (end - sides[next].start()).norm();
            if gap > HAIR || (n == 1 && gap > JOINT) {
                return Err(Damage::Open {
                    piece: self.name.to_owned(),
                    line: self.block.line,
                    gap_mm: gap * 1e3,
                    x: end.x / self.unit,
                    y: end.y / self.unit,
                });
            }
            if gap > JOINT {
                told.push(format!(
                    "the boundary of piece \"{}\" was open by {:.2} mm between \"{}\" and \"{}\": closed",
                    self.name,
                    gap * 1e3,
                    sides[k].name,
                    sides[next].name
                ));
            }
            sides[next].points[0] = end;
        }
        match n {
            1 => Err(self.fault("its boundary is one open line".into())),
            _ => Ok(()),
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
        let points = corners_and_all(sides);
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

/// A closed line split where it turns.
fn split(points: Vec<Point2>) -> Vec<Side> {
    let n = points.len();
    let turns = |k: usize| {
        let (u, v) = (points[k] - points[(k + n - 1) % n], points[(k + 1) % n] - points[k]);
        u.perp(&v).atan2(u.dot(&v)).abs() > CORNER.to_radians()
    };
    let mut stops: Vec<usize> = (0..n).filter(|&k| turns(k)).collect();
    if stops.len() < 2 {
        stops = vec![0, n / 2];
    }
    let m = stops.len();
    let side = |k: usize| {
        let (from, to) = (stops[k], stops[(k + 1) % m]);
        let count = (to + n - from - 1) % n + 1;
        Side { name: format!("edge_{k}"), points: (0..=count).map(|i| points[(from + i) % n]).collect() }
    };
    (0..m).map(side).collect()
}
