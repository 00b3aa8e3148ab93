//! One piece of a pattern: its loops, and what a tailor draws on it.

use super::super::{Point2, Point3, Vector3};
use super::curve::{EdgeCurve, EdgePath};

/// A stretch of a loop from one corner to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct PieceEdge {
    /// Its name within the piece, by which seams name it.
    pub name: String,
    /// How it runs.
    pub curve: EdgeCurve,
}

/// A closed loop: edge `k` runs from corner `k` to corner `k + 1`, the last one back to corner 0.
/// The outer loop runs counter-clockwise, holes clockwise, y up, as seen from outside the wearer.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PatternLoop {
    /// Corners, metres.
    pub corners: Vec<Point2>,
    /// As many edges as corners.
    pub edges: Vec<PieceEdge>,
}

impl PatternLoop {
    /// The edge of that number, with its ends; the loop is sound.
    pub fn path(&self, k: usize) -> EdgePath {
        let n = self.corners.len();
        EdgePath::new(self.corners[k], self.corners[(k + 1) % n], &self.edges[k].curve)
    }

    /// The whole loop as points, not repeating the first, and the index of each corner.
    pub fn points(&self) -> (Vec<Point2>, Vec<usize>) {
        let (mut points, mut corners) = (Vec::new(), Vec::new());
        for k in 0..self.edges.len() {
            corners.push(points.len());
            points.push(self.corners[k]);
            let drawn = self.path(k).points();
            points.extend(&drawn[1..drawn.len() - 1]);
        }
        (points, corners)
    }
}

/// What a line inside a piece is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinePurpose {
    /// A leg of a dart.
    Dart,
    /// A fold line of a pleat.
    Pleat,
    /// A fold.
    Fold,
    /// Where another piece is laid or sewn on.
    Placement,
    /// A slit.
    Cut,
    /// A stitch line, or anything else that is drawn and changes nothing.
    Mark,
}

impl LinePurpose {
    /// Every purpose with its word.
    pub(in super::super) const WORDS: [(&'static str, LinePurpose); 6] = [
        ("dart", LinePurpose::Dart),
        ("pleat", LinePurpose::Pleat),
        ("fold", LinePurpose::Fold),
        ("placement", LinePurpose::Placement),
        ("cut", LinePurpose::Cut),
        ("mark", LinePurpose::Mark),
    ];
}

/// A line inside a piece, straight from point to point.
#[derive(Debug, Clone, PartialEq)]
pub struct PieceLine {
    /// Its name within the piece; it differs from those of the edges.
    pub name: String,
    /// What it is for.
    pub purpose: LinePurpose,
    /// At least two points, metres.
    pub points: Vec<Point2>,
}

/// A mark on an edge that is matched with one of another piece.
#[derive(Debug, Clone, PartialEq)]
pub struct Notch {
    /// The edge of the outer loop.
    pub edge: String,
    /// How far it is from the edge's start along the edge, metres.
    pub along: f64,
    /// How far it is cut into the piece, metres; 0 where that is not said.
    pub depth: f64,
}

/// The part of the body that a piece covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyPart {
    /// The trunk.
    Body,
    /// An arm.
    Arm,
    /// A leg.
    Leg,
    /// Head or neck.
    Head,
}

impl BodyPart {
    /// Every part with its word.
    pub const WORDS: [(&'static str, BodyPart); 4] =
        [("body", BodyPart::Body), ("arm", BodyPart::Arm), ("leg", BodyPart::Leg), ("head", BodyPart::Head)];
}

/// A flat piece in space: its point `p` is at `origin + p.x * across + p.y * along`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Where the piece's origin lies, metres.
    pub origin: Point3,
    /// The direction of the piece's x axis: to the right as seen from outside the wearer. Of
    /// length 1.
    pub across: Vector3,
    /// The direction of the piece's y axis, along the grain. Of length 1, at right angles to
    /// `across`.
    pub along: Vector3,
}

impl Pose {
    /// Where a flat point lies in space.
    pub fn at(&self, p: Point2) -> Point3 {
        self.origin + self.across * p.x + self.along * p.y
    }

    /// The direction in which the piece's outside looks.
    pub fn outside(&self) -> Vector3 {
        self.across.cross(&self.along)
    }
}

/// One piece of a pattern, flat, metres, as seen from outside the wearer; y runs up along the
/// grain.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Piece {
    /// Its name, by which seams and panels name it.
    pub name: String,
    /// The outer boundary, counter-clockwise.
    pub outer: PatternLoop,
    /// Holes, clockwise.
    pub holes: Vec<PatternLoop>,
    /// Lines inside it.
    pub lines: Vec<PieceLine>,
    /// Marks on its edges.
    pub notches: Vec<Notch>,
    /// Holes that mark a point, such as a dart's tip.
    pub drill_holes: Vec<Point2>,
    /// The grain line as it is drawn, from its foot up along y; none where the pattern draws none
    /// and y is taken for it.
    pub grain: Option<[Point2; 2]>,
    /// The part of the body that it covers, where the pattern says.
    pub body_part: Option<BodyPart>,
    /// Where it stands in space, where the pattern says.
    pub pose: Option<Pose>,
    /// Pieces of a higher layer are worn outside those of a lower one.
    pub layer: u32,
}

impl Piece {
    /// The number of the outer loop's edge of that name.
    pub fn edge_number(&self, name: &str) -> Option<usize> {
        self.outer.edges.iter().position(|e| e.name == name)
    }

    /// The inner line of that name.
    pub fn line(&self, name: &str) -> Option<&PieceLine> {
        self.lines.iter().find(|l| l.name == name)
    }

    /// The outer edge or inner line of that name, from its start.
    pub fn path(&self, name: &str) -> Option<EdgePath> {
        let edge = self.edge_number(name).map(|k| self.outer.path(k));
        edge.or_else(|| self.line(name).map(|l| EdgePath::polyline(l.points.clone())))
    }
}
