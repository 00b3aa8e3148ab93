//! Nodes joined to a path.
//!
//! Method: a path goes straight from point to point, and along curves. A curve whose neighbour is a
//! point that lies on it begins or ends there; one whose neighbour is a curve that it does not meet
//! end to end is cut where both cross. What does not meet is joined by a straight line, as Seamly2D
//! and Valentina do. Cost: linear, but for crossings.

use super::super::plane::{DraftCurve, DraftStroke, crossings};
use kurbo::Point;

/// A part of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct OutlinePart {
    /// The name of the point that it begins at; empty where there is none.
    pub from: String,
    /// How it runs; none where it is straight.
    pub stroke: Option<DraftStroke>,
    /// Where it ends.
    pub end: Point,
}

/// A path, y up, in the unit of the pattern.
#[derive(Debug, Clone, PartialEq)]
pub struct DraftedPath {
    /// Where it begins.
    pub start: Point,
    /// Its parts, in order.
    pub parts: Vec<OutlinePart>,
}

/// A node of a path.
#[derive(Debug, Clone)]
pub(super) enum PathNode {
    Point { name: String, at: Point },
    Curve(DraftCurve),
}

/// What is near, in the pattern's unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearness {
    /// Points of a curve.
    pub(super) on: f64,
    /// Ends that meet.
    pub(super) same: f64,
}

/// The nodes as a path; none where they have no length.
pub(super) fn joined(
    nodes: &[PathNode],
    closed: bool,
    near: Nearness,
    boxes: &mut usize,
) -> Option<DraftedPath> {
    let n = nodes.len();
    let mut joint = PathJoint { path: None, label: String::new(), same: near.same };
    for (k, node) in nodes.iter().enumerate() {
        match node {
            PathNode::Point { name, at } => joint.to(*at, name),
            PathNode::Curve(curve) => {
                let before = (closed || k > 0).then(|| &nodes[(k + n - 1) % n]);
                let behind = (closed || k + 1 < n).then(|| &nodes[(k + 1) % n]);
                joint.along(&between(curve, before, behind, near, boxes));
            }
        }
    }
    let mut path = joint.path.take()?;
    if closed && let Some(first) = path.parts.first().map(|p| p.from.clone()) {
        let end = path.parts.last().map_or(path.start, |p| p.end);
        if (end - path.start).hypot() > near.same {
            path.parts.push(OutlinePart { from: joint.label, stroke: None, end: path.start });
        } else if first.is_empty()
            && let Some(part) = path.parts.first_mut()
        {
            part.from = joint.label;
        }
    }
    (!path.parts.is_empty()).then_some(path)
}

/// A path while it grows.
struct PathJoint {
    path: Option<DraftedPath>,
    /// The name of the point at its end.
    label: String,
    same: f64,
}

impl PathJoint {
    /// Straight to a point.
    fn to(&mut self, at: Point, name: &str) {
        let from = std::mem::take(&mut self.label);
        self.label = if name.is_empty() { String::new() } else { name.to_owned() };
        let Some(path) = &mut self.path else {
            self.path = Some(DraftedPath { start: at, parts: Vec::new() });
            return;
        };
        let end = path.parts.last().map_or(path.start, |p| p.end);
        if (at - end).hypot() > self.same {
            path.parts.push(OutlinePart { from, stroke: None, end: at });
        } else if self.label.is_empty() {
            self.label = from;
        }
    }

    fn along(&mut self, curve: &DraftCurve) {
        let none = String::new();
        self.to(curve.start(), curve.labels.first().unwrap_or(&none));
        for (stroke, label) in curve.strokes.iter().zip(&curve.labels[1..]) {
            if stroke.length() <= self.same {
                continue;
            }
            if let Some(path) = &mut self.path {
                let from = std::mem::replace(&mut self.label, label.clone());
                path.parts.push(OutlinePart { from, stroke: Some(*stroke), end: stroke.at(1.0) });
            }
        }
    }
}

/// The part of a curve that lies between its neighbours.
fn between(
    curve: &DraftCurve,
    before: Option<&PathNode>,
    behind: Option<&PathNode>,
    near: Nearness,
    boxes: &mut usize,
) -> DraftCurve {
    let whole = curve.length();
    let label = |l: Option<&String>| l.cloned().unwrap_or_default();
    let own = (label(curve.labels.first()), label(curve.labels.last()));
    let mut cut = |neighbour: Option<&PathNode>, at_end: bool| match neighbour? {
        PathNode::Point { name, at } => {
            let (far, along) = curve.nearest(*at);
            (far <= near.on).then(|| (along, name.clone()))
        }
        PathNode::Curve(other) => {
            let [mine, its] =
                if at_end { [curve.end(), other.start()] } else { [curve.start(), other.end()] };
            if (mine - its).hypot() <= near.on {
                return None;
            }
            let met = crossings(curve, other, boxes).into_iter().map(|p| curve.nearest(p).1);
            let inner: Vec<f64> = met.filter(|s| *s > near.on && *s < whole - near.on).collect();
            let chosen = if at_end { inner.last() } else { inner.first() };
            chosen.map(|s| (*s, String::new()))
        }
    };
    let (from, first) = cut(before, false).unwrap_or((0.0, own.0));
    let (to, last) = cut(behind, true).unwrap_or((whole, own.1));
    if to - from <= near.same {
        return curve.clone();
    }
    curve.between([from, to], [&first, &last])
}
