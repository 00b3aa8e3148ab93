//! Pieces as they lie flat, in the frame of the garment, and what they are made of.

use crate::style::block::template::curve::Curve;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Form;
use crate::style::block::template::piece_role::{Layer, PieceRole};
use nalgebra::Rotation2;
use toile_core::prelude::*;

/// Parts in which hem and neck are drawn.
pub(crate) const PARTS: usize = 24;

/// A piece in the frame of the garment's axis: u to the right as one looks at it, v up.
#[derive(Debug, Clone)]
pub(crate) struct Flat {
    pub role: PieceRole,
    /// Its edges, counter-clockwise; each starts where the one before ends.
    pub edges: Vec<FlatEdge>,
    /// Lines of its pleats.
    pub lines: Vec<(PleatLine, [Point2; 2])>,
    /// Where its own origin lies, and how far its own axes are turned, radians.
    pub origin: Point2,
    pub turn: f64,
}

/// An edge of such a piece.
#[derive(Debug, Clone)]
pub(crate) struct FlatEdge {
    pub role: EdgeRole,
    /// The wearer's, where the piece has such an edge on both sides.
    pub hand: Option<Hand>,
    pub run: Run,
}

impl FlatEdge {
    /// The only one of its kind in the piece.
    pub(crate) fn only(role: EdgeRole, run: Run) -> Self {
        FlatEdge { role, hand: None, run }
    }

    pub(crate) fn name(&self) -> String {
        self.role.name(self.hand)
    }
}

/// A line of the pleat of that number: those that are sewn to each other, and the folds and edges
/// of the laid cloth, with their own numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PleatLine {
    A(usize),
    B(usize),
    Fold(usize, usize),
    Edge(usize, usize),
}

impl PleatLine {
    pub(crate) fn name(self) -> String {
        match self {
            PleatLine::A(pleat) => format!("pleat_{pleat}_a"),
            PleatLine::B(pleat) => format!("pleat_{pleat}_b"),
            PleatLine::Fold(pleat, k) => format!("pleat_{pleat}_fold_{k}"),
            PleatLine::Edge(pleat, k) => format!("pleat_{pleat}_edge_{k}"),
        }
    }
}

/// How an edge runs.
#[derive(Debug, Clone)]
pub(crate) enum Run {
    Cubic(Curve),
    /// Curves, each of which starts where the one before ends.
    Chain(Vec<Curve>),
}

impl Run {
    pub(crate) fn of(curves: Vec<Curve>) -> Self {
        match curves[..] {
            [one] => Run::Cubic(one),
            _ => Run::Chain(curves),
        }
    }

    pub(crate) fn curves(&self) -> &[Curve] {
        match self {
            Run::Cubic(c) => std::slice::from_ref(c),
            Run::Chain(all) => all,
        }
    }

    pub(crate) fn length(&self) -> f64 {
        self.curves().iter().map(Curve::length).sum()
    }

    pub(crate) fn start(&self) -> Point2 {
        self.curves().first().map_or_else(Point2::origin, |c| c.0[0])
    }

    /// Each curve changed, and the last first where they are `turned`.
    pub(crate) fn changed(&self, turned: bool, to: impl Fn(Curve) -> Curve) -> Self {
        match self {
            Run::Cubic(c) => Run::Cubic(to(*c)),
            Run::Chain(all) => {
                let mut all: Vec<Curve> = all.iter().map(|c| to(*c)).collect();
                if turned {
                    all.reverse();
                }
                Run::Chain(all)
            }
        }
    }

    fn moved(&self, to: impl Fn(Point2) -> Point2) -> EdgeCurve {
        match self {
            Run::Cubic(Curve([_, b, c, _])) => EdgeCurve::Cubic { controls: [to(*b), to(*c)] },
            Run::Chain(all) => {
                let drawn = all.iter().flat_map(|c| c.points(PARTS).into_iter().skip(1));
                let mut points: Vec<Point2> = drawn.map(to).collect();
                points.pop();
                EdgeCurve::Polyline { points }
            }
        }
    }
}

impl Flat {
    /// A piece of the trunk in the garment's own frame.
    pub(crate) fn of_trunk(role: PieceRole, edges: Vec<FlatEdge>) -> Flat {
        Flat { role, edges, lines: Vec::new(), origin: Point2::origin(), turn: 0.0 }
    }

    /// The piece in its own coordinates; it stands nowhere yet.
    pub(crate) fn piece(&self) -> Piece {
        let to = |p: Point2| Point2::from(Rotation2::new(-self.turn) * (p - self.origin));
        let edge = |e: &FlatEdge| PieceEdge { name: e.name(), curve: e.run.moved(to) };
        let line = |(line, ends): &(PleatLine, [Point2; 2])| PieceLine {
            name: line.name(),
            purpose: LinePurpose::Pleat,
            points: ends.map(to).into(),
        };
        Piece {
            name: self.role.name(),
            outer: PatternLoop {
                corners: self.edges.iter().map(|e| to(e.run.start())).collect(),
                edges: self.edges.iter().map(edge).collect(),
            },
            lines: self.lines.iter().map(line).collect(),
            body_part: Some(self.role.part()),
            ..Piece::default()
        }
    }
}

/// One side of a template: its edges, as they lie (the second side's are mirrored back),
/// each from below to above.
pub(crate) struct Side {
    pub edges: Vec<(EdgeRole, Curve)>,
    pub mirrored: bool,
    pub hand: Hand,
}

fn flip(p: Point2) -> Point2 {
    Point2::new(-p.x, p.y)
}

impl Side {
    pub(crate) fn of(fit: &Fit, form: &Form, layer: Layer, k: usize) -> Side {
        let roles = form.edges.iter().map(|e| e.role);
        let edges = roles.zip(fit.sides[k].iter().map(|b| Curve::from(*b))).collect();
        Side { edges, mirrored: k == 1, hand: layer.hand(k) }
    }

    /// A curve as it lies, so that loops run counter-clockwise.
    pub(crate) fn laid(&self, c: Curve) -> Curve {
        if self.mirrored { c.moved(flip).turned() } else { c }
    }

    /// The curve of an edge.
    pub(crate) fn edge(&self, role: EdgeRole) -> Option<Curve> {
        self.edges.iter().find(|e| e.0 == role).map(|e| e.1)
    }

    /// Edges as they lie and in counter-clockwise order, the only ones of their piece.
    pub(crate) fn alone(&self, edges: &[(EdgeRole, Run)]) -> Vec<FlatEdge> {
        let one = |(role, run): &(EdgeRole, Run)| {
            FlatEdge::only(*role, run.changed(self.mirrored, |c| self.laid(c)))
        };
        let mut all: Vec<_> = edges.iter().map(one).collect();
        if self.mirrored {
            all.reverse();
        }
        all
    }

    /// The same of a piece that has the other side's as well.
    pub(crate) fn own(&self, edges: &[(EdgeRole, Run)]) -> Vec<FlatEdge> {
        self.alone(edges).into_iter().map(|e| FlatEdge { hand: Some(self.hand), ..e }).collect()
    }
}

/// The straight line as a cubic.
pub(crate) fn straight(a: Point2, b: Point2) -> Curve {
    Curve([a, a + (b - a) / 3.0, a + (b - a) * (2.0 / 3.0), b])
}
