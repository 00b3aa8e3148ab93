//! The lines of path data and basic shapes, in their own units, y down as the file has it.
//!
//! Arcs become cubic curves that leave them by less than a billionth of their radius. Cost: linear.

use kurbo::{Arc, PathEl, SvgArc, Vec2};
use svgtypes::{PathParser, PathSegment};
use toile_core::prelude::*;

/// How far the curves that stand for an arc leave it, as a share of its radius.
const NEAR: f64 = 1e-9;
/// Greater numbers are no drawing's.
const FAR: f64 = 1e9;
/// Curves of one element.
const MOST: usize = 200_000;

/// A line as it is drawn, from curve to curve.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub start: Point2,
    pub parts: Vec<(EdgeCurve, Point2)>,
    pub closed: bool,
}

impl Line {
    pub(super) fn end(&self) -> Point2 {
        self.parts.last().map_or(self.start, |(_, end)| *end)
    }

    fn finite(&self) -> bool {
        let near = |p: &Point2| p.coords.amax() <= FAR;
        let curve = |c: &EdgeCurve| match c {
            EdgeCurve::Quadratic { control } => near(control),
            EdgeCurve::Cubic { controls } => controls.iter().all(near),
            EdgeCurve::Line | EdgeCurve::Arc { .. } | EdgeCurve::Polyline { .. } => true,
        };
        near(&self.start) && self.parts.iter().all(|(c, end)| near(end) && curve(c))
    }
}

/// The pen that draws lines.
#[derive(Default)]
struct Pen {
    done: Vec<Line>,
    line: Option<Line>,
    at: Point2,
    /// The last control point of the curve before, for curves that go on smoothly: of a cubic, of a
    /// quadratic one.
    cubic: Option<Point2>,
    quadratic: Option<Point2>,
}

impl Pen {
    fn lift(&mut self) {
        self.done.extend(self.line.take().filter(|l| !l.parts.is_empty()));
    }

    fn move_to(&mut self, p: Point2) {
        self.lift();
        self.at = p;
    }

    fn draw(&mut self, curve: EdgeCurve, to: Point2) {
        let start = self.at;
        let line = self.line.get_or_insert_with(|| Line { start, parts: Vec::new(), closed: false });
        line.parts.push((curve, to));
        self.at = to;
    }

    fn close(&mut self) {
        if let Some(line) = &mut self.line {
            line.closed = true;
            self.at = line.start;
        }
        self.lift();
    }

    /// The control point that continues the last curve smoothly.
    fn reflected(&self, last: Option<Point2>) -> Point2 {
        last.map_or(self.at, |c| self.at + (self.at - c))
    }

    fn arc(&mut self, radii: [f64; 2], turn: f64, [large_arc, sweep]: [bool; 2], to: Point2) {
        let k = |p: Point2| kurbo::Point::new(p.x, p.y);
        let [rx, ry] = radii.map(f64::abs);
        let (from, x_rotation) = (k(self.at), turn.to_radians());
        let svg = SvgArc { from, to: k(to), radii: Vec2::new(rx, ry), x_rotation, large_arc, sweep };
        let Some(arc) = Arc::from_svg_arc(&svg).filter(|a| a.radii.x.max(a.radii.y) <= FAR) else {
            return self.draw(EdgeCurve::Line, to);
        };
        let p = |q: kurbo::Point| Point2::new(q.x, q.y);
        for part in arc.append_iter(NEAR * arc.radii.x.max(arc.radii.y)) {
            if let PathEl::CurveTo(a, b, end) = part {
                self.draw(EdgeCurve::Cubic { controls: [p(a), p(b)] }, p(end));
            }
        }
        // To the last bit where the file says.
        if let Some((_, end)) = self.line.as_mut().and_then(|l| l.parts.last_mut()) {
            (*end, self.at) = (to, to);
        }
    }

    fn segment(&mut self, segment: PathSegment) {
        let from = if segment.is_abs() { Vector2::zeros() } else { self.at.coords };
        let p = |x: f64, y: f64| Point2::new(x, y) + from;
        let (cubic, quadratic) = (self.cubic.take(), self.quadratic.take());
        match segment {
            PathSegment::MoveTo { x, y, .. } => self.move_to(p(x, y)),
            PathSegment::LineTo { x, y, .. } => self.draw(EdgeCurve::Line, p(x, y)),
            PathSegment::HorizontalLineTo { x, .. } => {
                self.draw(EdgeCurve::Line, Point2::new(x + from.x, self.at.y));
            }
            PathSegment::VerticalLineTo { y, .. } => {
                self.draw(EdgeCurve::Line, Point2::new(self.at.x, y + from.y));
            }
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => {
                self.curve_to([p(x1, y1), p(x2, y2)], p(x, y));
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                self.curve_to([self.reflected(cubic), p(x2, y2)], p(x, y));
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => self.bend_to(p(x1, y1), p(x, y)),
            PathSegment::SmoothQuadratic { x, y, .. } => self.bend_to(self.reflected(quadratic), p(x, y)),
            PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, x, y, .. } => {
                self.arc([rx, ry], x_axis_rotation, [large_arc, sweep], p(x, y));
            }
            PathSegment::ClosePath { .. } => self.close(),
        }
    }

    fn curve_to(&mut self, controls: [Point2; 2], to: Point2) {
        self.draw(EdgeCurve::Cubic { controls }, to);
        self.cubic = Some(controls[1]);
    }

    fn bend_to(&mut self, control: Point2, to: Point2) {
        self.draw(EdgeCurve::Quadratic { control }, to);
        self.quadratic = Some(control);
    }

    fn lines(mut self) -> Option<Vec<Line>> {
        self.lift();
        self.done.iter().all(Line::finite).then_some(self.done)
    }
}

/// The lines of path data; none where it is no path data.
pub(super) fn path(data: &str) -> Option<Vec<Line>> {
    let mut pen = Pen::default();
    if !matches!(data.trim(), "" | "none") {
        for (k, segment) in PathParser::from(data).enumerate() {
            pen.segment(segment.ok().filter(|_| k < MOST)?);
        }
    }
    pen.lines()
}

/// Straight from point to point.
pub(super) fn polyline(points: &[Point2], closed: bool) -> Option<Vec<Line>> {
    let mut pen = Pen::default();
    let (first, rest) = points.split_first()?;
    pen.move_to(*first);
    rest.iter().for_each(|p| pen.draw(EdgeCurve::Line, *p));
    if closed {
        pen.close();
    }
    pen.lines()
}

/// An ellipse, from its right counted with the file's y.
pub(super) fn ellipse(centre: Point2, [rx, ry]: [f64; 2]) -> Option<Vec<Line>> {
    let mut pen = Pen::default();
    let at = |x: f64, y: f64| centre + Vector2::new(x * rx, y * ry);
    pen.move_to(at(1.0, 0.0));
    for to in [at(0.0, 1.0), at(-1.0, 0.0), at(0.0, -1.0), at(1.0, 0.0)] {
        pen.arc([rx, ry], 0.0, [false, true], to);
    }
    pen.close();
    pen.lines()
}

/// A rectangle, its corners rounded by those radii.
pub(super) fn rectangle(corner: Point2, [w, h]: [f64; 2], [rx, ry]: [f64; 2]) -> Option<Vec<Line>> {
    let (rx, ry) = (rx.clamp(0.0, w / 2.0), ry.clamp(0.0, h / 2.0));
    let at = |x: f64, y: f64| corner + Vector2::new(x, y);
    if rx == 0.0 || ry == 0.0 {
        return polyline(&[at(0.0, 0.0), at(w, 0.0), at(w, h), at(0.0, h)], true);
    }
    let mut pen = Pen::default();
    pen.move_to(at(rx, 0.0));
    let turns = [
        [at(w - rx, 0.0), at(w, ry)],
        [at(w, h - ry), at(w - rx, h)],
        [at(rx, h), at(0.0, h - ry)],
        [at(0.0, ry), at(rx, 0.0)],
    ];
    for [to, around] in turns {
        pen.draw(EdgeCurve::Line, to);
        pen.arc([rx, ry], 0.0, [false, true], around);
    }
    pen.close();
    pen.lines()
}
