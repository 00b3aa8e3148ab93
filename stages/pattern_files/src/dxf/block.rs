//! What is drawn of a piece, millimetres.

use super::Standard;
use super::text::{Tags, encoded};
use crate::flatten::{flatten, loop_points};
use crate::inside::bounds;
use crate::marks::{self, NotchMark, SeamMark};
use crate::names::PieceNames;
use crate::parts::{EdgePart, parts};
use toile_core::artifact::{Piece, Point2, Vector2, polygon_area, polyline_length};

/// Curves are followed to this, metres.
pub(super) const TOLERANCE: f64 = 7e-6;
/// Readers take a line whose ends are nearer than this for a closed one, metres.
const JOINT: f64 = 2.01e-4;
/// Readers leave out shorter lines inside pieces, and refuse smaller cut-outs, metres and square
/// metres.
const NO_LINE: f64 = 1e-5;
const NO_HOLE: f64 = 1e-7;
/// A cut line is split where it turns by more than this, degrees.
const CORNER: f64 = 25.0;
/// How far a seam's number stands inside, metres.
const INSIDE: f64 = 6e-3;

/// A piece as a block.
pub(super) struct PieceBlock<'a> {
    pub name: String,
    pub names: PieceNames,
    pub notes: Vec<String>,
    piece: &'a Piece,
    /// The line that is sewn along, edge by edge.
    edges: Vec<Vec<Point2>>,
    /// The line that is cut along where that is another, from corner to corner.
    cut: Vec<Vec<Point2>>,
    polygon: Vec<Point2>,
    notches: Vec<NotchMark>,
    numbers: &'a [SeamMark],
}

impl<'a> PieceBlock<'a> {
    pub(super) fn new(
        p: &'a Piece,
        cut: Option<&[Point2]>,
        widths: &[f64],
        numbers: &'a [SeamMark],
        [name, label]: [String; 2],
    ) -> Self {
        let mut names = PieceNames { piece: label, ..PieceNames::default() };
        names.edges.extend(p.outer.edges.iter().map(|e| (e.name.clone(), Vec::new())));
        let mut edges: Vec<Vec<Point2>> = Vec::new();
        // Points of edges that are too short to be some of their own.
        let mut short = Vec::new();
        for EdgePart { edge, start, end, curve } in
            parts(&p.outer, |chord, length| chord <= JOINT && length > 4.0 * JOINT)
        {
            let points = flatten(start, end, &curve, TOLERANCE);
            match ((end - start).norm() > JOINT, edges.last_mut()) {
                (true, _) => {
                    let own = names.edges.entry(p.outer.edges[edge].name.clone()).or_default();
                    own.push(format!("edge_{}", edges.len()));
                    edges.push(points);
                }
                (false, Some(before)) => before.extend(&points[1..]),
                (false, None) => short.extend(&points[..points.len() - 1]),
            }
        }
        let first = edges.first().map(|points| points[0]);
        if let (Some(last), Some(first), false) = (edges.last_mut(), first, short.is_empty()) {
            last.extend(&short[1..]);
            last.push(first);
        }
        let lines = lines(p).enumerate().map(|(k, l)| (l.name.clone(), vec![format!("line_{k}")]));
        names.edges.extend(lines);
        let mut notes = Vec::new();
        if edges.len() < 2 {
            notes.push(format!("piece \"{}\" is smaller than 0.2 mm: readers refuse it", p.name));
        }
        let small = p.holes.iter().filter(|h| !is_hole(h)).count();
        if small > 0 {
            notes.push(format!("{small} holes of piece \"{}\" are smaller than 0.1 mm2: left out", p.name));
        }
        // Notches stand on the line that is cut.
        let notches = marks::notches(p).into_iter().map(|n| match cut.is_some() {
            true => NotchMark { at: n.at + n.out * widths[n.edge], ..n },
            false => n,
        });
        PieceBlock {
            name,
            names,
            notes,
            piece: p,
            edges,
            cut: cut.map_or_else(Vec::new, split),
            polygon: loop_points(&p.outer, TOLERANCE).0,
            notches: notches.collect(),
            numbers,
        }
    }

    fn boundary(&self) -> &[Vec<Point2>] {
        if self.cut.is_empty() { &self.edges } else { &self.cut }
    }

    fn bounds(&self) -> (Point2, Point2) {
        let all: Vec<Point2> = self.boundary().iter().flatten().chain(&self.polygon).copied().collect();
        bounds(&all)
    }

    /// Width and height, mm.
    pub(super) fn size(&self) -> [f64; 2] {
        let (lo, hi) = self.bounds();
        [(hi.x - lo.x) * 1e3, (hi.y - lo.y) * 1e3]
    }

    /// Its lower left corner, mm.
    pub(super) fn low(&self) -> [f64; 2] {
        mm(self.bounds().0)
    }

    pub(super) fn write(&self, tags: &mut Tags, standard: Standard, size: &str, ascii: bool) {
        tags.tag(0, "BLOCK").tag(8, 0).tag(2, &self.name).tag(70, 64).point(10, [0.0, 0.0]);
        self.texts(tags, standard, size, ascii);
        for line in self.boundary() {
            let line = all_mm(line);
            tags.polyline(1, &line);
            if standard == Standard::Astm {
                tags.polyline(84, &line);
            }
        }
        for line in self.boundary() {
            tags.dot(2, mm(line[0]), None);
            for p in &line[1..line.len() - 1] {
                tags.dot(3, mm(*p), None);
            }
        }
        if !self.cut.is_empty() {
            for line in &self.edges {
                tags.polyline(14, &all_mm(line));
            }
        }
        self.inside(tags);
        tags.tag(0, "ENDBLK").tag(8, 0);
    }

    /// The texts by which programs know a piece, and those for people.
    fn texts(&self, tags: &mut Tags, standard: Standard, size: &str, ascii: bool) {
        let (lo, hi) = self.bounds();
        let [x, y] = mm(nalgebra::center(&lo, &hi));
        let name = encoded(&self.names.piece, ascii);
        let quantity = match standard {
            Standard::Aama => "Quantity: 1",
            Standard::Astm => "Quantity: 1,0",
        };
        tags.text(1, [x, y], &format!("Piece Name: {name}"));
        tags.text(1, [x, y - 7.0], &format!("Size: {size}"));
        tags.text(1, [x, y - 14.0], quantity);
        for m in self.numbers {
            tags.text(15, mm(m.at + m.inwards * INSIDE), &format!("{}", m.number));
        }
    }

    fn inside(&self, tags: &mut Tags) {
        let p = self.piece;
        for n in &self.notches {
            let into: Vector2 = -n.out;
            tags.dot(4, mm(n.at), Some((n.depth * 1e3, into.y.atan2(into.x).to_degrees())));
        }
        let [foot, top] = marks::grain(p, &self.polygon);
        tags.line(7, mm(foot), mm(top));
        for l in lines(p) {
            tags.polyline(8, &all_mm(&l.points));
        }
        for h in p.holes.iter().filter(|h| is_hole(h)) {
            let mut points = loop_points(h, TOLERANCE).0;
            points.extend(points.first().copied());
            tags.polyline(11, &all_mm(&points));
        }
        for h in &p.drill_holes {
            tags.dot(13, mm(*h), None);
        }
    }
}

fn is_hole(h: &toile_core::artifact::PatternLoop) -> bool {
    polygon_area(&loop_points(h, TOLERANCE).0).abs() > NO_HOLE
}

/// The lines inside a piece that are long enough to be read.
fn lines(p: &Piece) -> impl Iterator<Item = &toile_core::artifact::PieceLine> {
    p.lines.iter().filter(|l| polyline_length(&l.points) > NO_LINE)
}

/// A closed line as open ones from corner to corner.
fn split(line: &[Point2]) -> Vec<Vec<Point2>> {
    let n = line.len();
    let turns = |k: &usize| {
        let (a, b, c) = (line[(k + n - 1) % n], line[*k], line[(k + 1) % n]);
        let (u, v) = (b - a, c - b);
        u.perp(&v).atan2(u.dot(&v)).abs() > CORNER.to_radians()
    };
    let mut stops: Vec<usize> = (0..n).filter(turns).collect();
    if stops.len() < 2 {
        stops = vec![0, n / 2];
    }
    let m = stops.len();
    let one = |k: usize| {
        let (from, to) = (stops[k], stops[(k + 1) % m]);
        let count = (to + n - from - 1) % n + 1;
        (0..=count).map(|i| line[(from + i) % n]).collect()
    };
    (0..m).map(one).collect()
}

fn mm(p: Point2) -> [f64; 2] {
    [p.x * 1e3, p.y * 1e3]
}

fn all_mm(points: &[Point2]) -> Vec<[f64; 2]> {
    points.iter().map(|p| mm(*p)).collect()
}
