//! Numbers, names and path data as text of an SVG.

use crate::parts::EdgePart;
use std::fmt::Write;
use toile_core::artifact::{EdgeCurve, Point2, Vector2};

/// An arc whose height over its chord is less than this is drawn straight, metres.
const FLAT: f64 = 1e-9;
/// A cubic curve stands for no more of an arc than this, radians.
const LARGEST: f64 = 0.35;

/// A number with six decimals at most.
pub(super) fn number(n: f64) -> String {
    let text = format!("{n:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A name as text or attribute of XML.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// From a piece's coordinates, metres, to the page's, mm, y down.
pub(super) struct PieceOnPage {
    /// The lower left corner of the piece's box.
    pub low: Point2,
    /// Where that lies on the page.
    pub corner: [f64; 2],
}

impl PieceOnPage {
    pub(super) fn at(&self, p: Point2) -> [f64; 2] {
        [self.corner[0] + (p.x - self.low.x) * 1e3, self.corner[1] - (p.y - self.low.y) * 1e3]
    }

    fn point(&self, p: Point2) -> String {
        let [x, y] = self.at(p).map(number);
        format!("{x},{y}")
    }

    /// Straight from point to point.
    pub(super) fn line(&self, points: &[Point2]) -> String {
        let mut out = String::new();
        for (k, p) in points.iter().enumerate() {
            let _ = write!(out, "{}{}", if k == 0 { "M" } else { "L" }, self.point(*p));
        }
        out
    }

    /// The same, closed.
    pub(super) fn polygon(&self, points: &[Point2]) -> String {
        self.line(points) + "Z"
    }

    /// A part of an edge.
    pub(super) fn curve(&self, part: &EdgePart) -> String {
        let (start, end) = (self.point(part.start), self.point(part.end));
        let chord = (part.end - part.start).norm();
        match &part.curve {
            EdgeCurve::Quadratic { control } => format!("M{start}Q{} {end}", self.point(*control)),
            EdgeCurve::Cubic { controls: [a, b] } => {
                format!("M{start}C{} {} {end}", self.point(*a), self.point(*b))
            }
            EdgeCurve::Arc { bulge } if bulge.abs() * chord > FLAT => {
                let parts = arc(part.start, part.end, *bulge);
                let one = |c: &[Point2; 3]| format!("C{}", c.map(|p| self.point(p)).join(" "));
                format!("M{start}{}", parts.iter().map(one).collect::<String>())
            }
            EdgeCurve::Line | EdgeCurve::Arc { .. } => format!("M{start}L{end}"),
            EdgeCurve::Polyline { points } => {
                self.line(&[&[part.start], points.as_slice(), &[part.end]].concat())
            }
        }
    }
}

/// An arc as cubic curves, each by its control points and its end, that leave it by less than a
/// billionth of its radius. Arcs of SVG are told by their radius, of which near a half circle the
/// last digits decide.
fn arc(start: Point2, end: Point2, bulge: f64) -> Vec<[Point2; 3]> {
    let chord = end - start;
    let left = |v: Vector2| Vector2::new(-v.y, v.x);
    let centre = nalgebra::center(&start, &end) + left(chord) * ((1.0 - bulge * bulge) / (4.0 * bulge));
    let angle = 4.0 * bulge.atan();
    let count = (angle.abs() / LARGEST).ceil().max(1.0) as usize;
    let step = angle / count as f64;
    let pull = 4.0 / 3.0 * (step / 4.0).tan();
    let at = |k: usize| match k {
        0 => start,
        _ if k == count => end,
        _ => centre + nalgebra::Rotation2::new(step * k as f64) * (start - centre),
    };
    let part = |k: usize| {
        let (a, b) = (at(k), at(k + 1));
        [a + left(a - centre) * pull, b - left(b - centre) * pull, b]
    };
    (0..count).map(part).collect()
}
