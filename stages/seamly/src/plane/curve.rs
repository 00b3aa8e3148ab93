//! A curve as a chain of strokes, with the names of the points that it goes through.

use super::arc::DraftArc;
use super::stroke::DraftStroke;
use super::{ELLIPSE, accuracy, angle, direction};
use kurbo::{Affine, CubicBez, Point, Vec2};

/// A curve; where one stroke ends, the next one begins.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DraftCurve {
    /// At least one.
    pub(crate) strokes: Vec<DraftStroke>,
    /// The names of the points at the start of the first stroke and at the end of each; empty where
    /// there is no point.
    pub(crate) labels: Vec<String>,
}

impl DraftCurve {
    pub(crate) fn new(strokes: Vec<DraftStroke>, labels: Vec<String>) -> Self {
        DraftCurve { strokes, labels }
    }

    /// A curve of one stroke.
    pub(crate) fn single(stroke: DraftStroke, from: &str, to: &str) -> Self {
        DraftCurve::new(vec![stroke], vec![from.to_owned(), to.to_owned()])
    }

    /// An arc of a circle, counter-clockwise from one angle to the other, degrees; clockwise where
    /// the radius is below 0.
    pub(crate) fn arc(centre: Point, radius: f64, [from, to]: [f64; 2]) -> Self {
        let sweep = swept(from, to, radius < 0.0);
        let arc = DraftArc { centre, radius: radius.abs(), start: from.rem_euclid(360.0), sweep };
        DraftCurve::single(DraftStroke::Arc(arc), "", "")
    }

    /// An arc of a circle from an angle on, as long as that.
    pub(crate) fn arc_of_length(centre: Point, radius: f64, from: f64, length: f64) -> Self {
        let turned = (length / radius.abs()).to_degrees().abs().min(360.0);
        let sweep = if (length < 0.0) != (radius < 0.0) { -turned } else { turned };
        let arc = DraftArc { centre, radius: radius.abs(), start: from.rem_euclid(360.0), sweep };
        DraftCurve::single(DraftStroke::Arc(arc), "", "")
    }

    /// An arc of an ellipse, turned by an angle; its ends lie at the angles as seen from the centre
    /// before it is turned.
    pub(crate) fn ellipse(centre: Point, radii: [f64; 2], [from, to]: [f64; 2], turned: f64) -> Self {
        let backwards = radii[0] < 0.0 || radii[1] < 0.0;
        let sweep = swept(from, to, backwards);
        let radii = Vec2::new(radii[0].abs(), radii[1].abs());
        // The parameter of an ellipse runs ahead of the angle within a quarter.
        let parameter = |degrees: f64| {
            let quarter = (degrees / 90.0).floor() * 90.0;
            let way = direction(degrees);
            let within = angle(Vec2::new(way.x / radii.x, way.y / radii.y));
            let ahead = (within - quarter).rem_euclid(360.0);
            quarter + if ahead > 180.0 { ahead - 360.0 } else { ahead }
        };
        let (start, end) = (parameter(from), parameter(from + sweep));
        let arc = kurbo::Arc::new(
            centre,
            radii,
            start.to_radians(),
            (end - start).to_radians(),
            turned.to_radians(),
        );
        let mut at = centre + (Affine::rotate(turned.to_radians()) * ellipse_point(radii, start)).to_vec2();
        let mut strokes = Vec::new();
        arc.to_cubic_beziers(accuracy(ELLIPSE, radii.hypot()), |a, b, end| {
            strokes.push(DraftStroke::Cubic(CubicBez::new(at, a, b, end)));
            at = end;
        });
        let labels = vec![String::new(); strokes.len() + 1];
        DraftCurve::new(strokes, labels)
    }

    pub(crate) fn start(&self) -> Point {
        self.strokes.first().map_or(Point::ZERO, |s| s.at(0.0))
    }

    pub(crate) fn end(&self) -> Point {
        self.strokes.last().map_or(Point::ZERO, |s| s.at(1.0))
    }

    pub(crate) fn length(&self) -> f64 {
        self.strokes.iter().map(DraftStroke::length).sum()
    }

    /// The angle in which it leaves its start, degrees.
    pub(crate) fn start_angle(&self) -> f64 {
        self.strokes.first().map_or(0.0, |s| angle(s.leaves()))
    }

    /// The angle from its end back into it, degrees.
    pub(crate) fn end_angle(&self) -> f64 {
        self.strokes.last().map_or(0.0, |s| angle(s.reversed().leaves()))
    }

    /// The place at a length from its start: the number of a stroke, and its parameter there.
    fn place(&self, length: f64) -> (usize, f64) {
        let mut before = 0.0;
        for (k, stroke) in self.strokes.iter().enumerate() {
            let own = stroke.length();
            if length <= before + own || k + 1 == self.strokes.len() {
                return (k, stroke.parameter(length - before));
            }
            before += own;
        }
        (0, 0.0)
    }

    /// The point at a length from its start.
    pub(crate) fn at(&self, length: f64) -> Point {
        let (k, t) = self.place(length);
        self.strokes.get(k).map_or(Point::ZERO, |s| s.at(t))
    }

    /// Both parts of it when it is cut at a length, at a point of that name.
    pub(crate) fn cut(&self, length: f64, label: &str) -> [DraftCurve; 2] {
        let (k, t) = self.place(length);
        let Some(stroke) = self.strokes.get(k) else { return [self.clone(), self.clone()] };
        let label = label.to_owned();
        let mut first = self.strokes[..k].to_vec();
        let mut first_labels = self.labels[..=k].to_vec();
        let mut second = self.strokes[k + 1..].to_vec();
        let mut second_labels = self.labels[k + 1..].to_vec();
        if t > 0.0 || first.is_empty() {
            first.push(stroke.part(0.0, t));
            first_labels.push(label.clone());
        } else if let Some(last) = first_labels.last_mut() {
            last.clone_from(&label);
        }
        if t < 1.0 || second.is_empty() {
            second.insert(0, stroke.part(t, 1.0));
            second_labels.insert(0, label);
        } else if let Some(own) = second_labels.first_mut() {
            *own = label;
        }
        [DraftCurve::new(first, first_labels), DraftCurve::new(second, second_labels)]
    }

    /// The part of it between two lengths, at points of those names.
    pub(crate) fn between(&self, [from, to]: [f64; 2], [first, last]: [&str; 2]) -> Self {
        let [start, _] = self.cut(to, last);
        let [_, part] = start.cut(from, first);
        part
    }

    /// How far it is from a point, and the length along it there.
    pub(crate) fn nearest(&self, p: Point) -> (f64, f64) {
        let (mut best, mut before) = ((f64::INFINITY, 0.0), 0.0);
        for stroke in &self.strokes {
            let t = stroke.nearest(p);
            let far = (stroke.at(t) - p).hypot();
            if far < best.0 {
                best = (far, before + stroke.part(0.0, t).length());
            }
            before += stroke.length();
        }
        best
    }

    pub(crate) fn reversed(&self) -> Self {
        let strokes = self.strokes.iter().rev().map(DraftStroke::reversed).collect();
        DraftCurve::new(strokes, self.labels.iter().rev().cloned().collect())
    }

    /// Moved by what keeps lengths; its points are others then.
    pub(crate) fn moved(&self, by: Affine, suffix: &str) -> Self {
        let label = |l: &String| if l.is_empty() { String::new() } else { format!("{l}{suffix}") };
        DraftCurve::new(
            self.strokes.iter().map(|s| s.moved(by)).collect(),
            self.labels.iter().map(label).collect(),
        )
    }
}

fn ellipse_point(radii: Vec2, degrees: f64) -> Point {
    let way = direction(degrees);
    Point::new(radii.x * way.x, radii.y * way.y)
}

/// The angle from one to another, degrees; a whole turn where they are one.
fn swept(from: f64, to: f64, backwards: bool) -> f64 {
    let ahead = (to - from).rem_euclid(360.0);
    match (backwards, !(1e-9..=360.0 - 1e-9).contains(&ahead)) {
        (false, true) => 360.0,
        (true, true) => -360.0,
        (false, false) => ahead,
        (true, false) => ahead - 360.0,
    }
}
