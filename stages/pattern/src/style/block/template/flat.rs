//! Pieces as they lie flat, in the frame of the garment, and what they are made of.

use crate::style::block::template::curve::Curve;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Form;
use nalgebra::Rotation2;
use toile_core::artifact::BodyPart;
use toile_core::prelude::*;

/// Parts in which hem and neck are drawn.
pub(crate) const PARTS: usize = 24;

/// A piece in the frame of the garment's axis: u to the right as one looks at it, v up.
#[derive(Debug, Clone)]
pub(crate) struct Flat {
    pub name: String,
    /// Its edges, counter-clockwise; each starts where the one before ends.
    pub edges: Vec<(String, Run)>,
    /// Lines of its pleats; `pleat_1_a` is sewn to `pleat_1_b`.
    pub lines: Vec<(String, [Point2; 2])>,
    pub part: BodyPart,
    /// Where its own origin lies, and how far its own axes are turned, radians.
    pub origin: Point2,
    pub turn: f64,
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
    pub(crate) fn of_trunk(name: String, edges: Vec<(String, Run)>) -> Flat {
        Flat { name, edges, lines: Vec::new(), part: BodyPart::Body, origin: Point2::origin(), turn: 0.0 }
    }

    /// The piece in its own coordinates; it stands nowhere yet.
    pub(crate) fn piece(&self) -> Piece {
        let to = |p: Point2| Point2::from(Rotation2::new(-self.turn) * (p - self.origin));
        let edge = |(name, run): &(String, Run)| PieceEdge { name: name.clone(), curve: run.moved(to) };
        let line = |(name, ends): &(String, [Point2; 2])| PieceLine {
            name: name.clone(),
            purpose: LinePurpose::Pleat,
            points: ends.map(to).into(),
        };
        Piece {
            name: self.name.clone(),
            outer: PatternLoop {
                corners: self.edges.iter().map(|(_, run)| to(run.start())).collect(),
                edges: self.edges.iter().map(edge).collect(),
            },
            lines: self.lines.iter().map(line).collect(),
            body_part: Some(self.part),
            ..Piece::default()
        }
    }
}

/// The layer of a garment: before the wearer or behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layer {
    Front,
    Back,
}

impl Layer {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Layer::Front => "front",
            Layer::Back => "back",
        }
    }

    /// The wearer's side that lies at positive u, or at negative.
    pub(crate) fn hand(self, k: usize) -> Hand {
        match (self, k) {
            (Layer::Front, 0) | (Layer::Back, 1) => Hand::Left,
            _ => Hand::Right,
        }
    }
}

/// One side of a template: its edges by name, as they lie (the second side's are mirrored back),
/// each from below to above.
pub(crate) struct Side {
    pub edges: Vec<(&'static str, Curve)>,
    pub mirrored: bool,
    pub hand: Hand,
}

fn flip(p: Point2) -> Point2 {
    Point2::new(-p.x, p.y)
}

impl Side {
    pub(crate) fn of(fit: &Fit, form: &Form, layer: Layer, k: usize) -> Side {
        let names = form.edges.iter().map(|e| e.name);
        let edges = names.zip(fit.sides[k].iter().map(|b| Curve::from(*b))).collect();
        Side { edges, mirrored: k == 1, hand: layer.hand(k) }
    }

    /// A curve as it lies, so that loops run counter-clockwise.
    pub(crate) fn laid(&self, c: Curve) -> Curve {
        if self.mirrored { c.moved(flip).turned() } else { c }
    }

    /// Named edges as they lie and in counter-clockwise order.
    pub(crate) fn named(&self, edges: &[(&'static str, Run)]) -> Vec<(&'static str, Run)> {
        let one = |(name, run): &(&'static str, Run)| (*name, run.changed(self.mirrored, |c| self.laid(c)));
        let mut all: Vec<_> = edges.iter().map(one).collect();
        if self.mirrored {
            all.reverse();
        }
        all
    }

    /// The same with the side in their names.
    pub(crate) fn own(&self, edges: &[(&'static str, Run)]) -> Vec<(String, Run)> {
        self.named(edges).into_iter().map(|(name, run)| (self.hand.name(name), run)).collect()
    }
}

/// The straight line as a cubic.
pub(crate) fn straight(a: Point2, b: Point2) -> Curve {
    Curve([a, a + (b - a) / 3.0, a + (b - a) * (2.0 / 3.0), b])
}
