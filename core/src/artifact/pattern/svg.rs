//! A pattern as a drawing: pieces side by side, millimetres, every edge named and in the colour of
//! its seam, an arrow in the direction in which it runs.

use super::super::{Point2, polygon_area};
use super::{Pattern, Piece};
use crate::artifact::sewing::arrow::arrow;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Between pieces, mm.
const GAP: f64 = 40.0;
/// The drawing's width is about this times its height.
const ASPECT: f64 = 1.6;
/// Edges that no seam names.
const FREE: &str = "#333333";

pub(super) fn svg(pattern: &Pattern) -> String {
    let colours = colours(pattern);
    let drawn: Vec<SizedPiece<'_>> = pattern.pieces.iter().map(SizedPiece::new).collect();
    let area: f64 = drawn.iter().map(|d| (d.size[0] + GAP) * (d.size[1] + GAP)).sum();
    let widest = drawn.iter().map(|d| d.size[0] + GAP).fold(0.0, f64::max);
    let row = (area * ASPECT).sqrt().max(widest);
    let (mut body, mut x, mut y, mut height, mut width) = (String::new(), GAP, GAP, 0.0_f64, 0.0_f64);
    for d in &drawn {
        if x > GAP && x + d.size[0] > row {
            (x, y, height) = (GAP, y + height + GAP, 0.0);
        }
        d.draw(&mut body, [x, y], &colours);
        x += d.size[0] + GAP;
        (height, width) = (height.max(d.size[1]), width.max(x));
    }
    let size = format!("{width:.1} {:.1}", y + height + GAP);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {size}\" width=\"{width:.1}mm\" height=\"{:.1}mm\" \
         font-family=\"sans-serif\" font-size=\"9\">\n{body}</svg>\n",
        y + height + GAP
    )
}

/// A colour for every edge of every seam: hues a golden angle apart, so that neighbours in the list
/// differ.
fn colours(pattern: &Pattern) -> BTreeMap<(&str, &str), String> {
    let mut all = BTreeMap::new();
    for (i, s) in pattern.seams.iter().enumerate() {
        let colour = colour(i as f64 * 137.508, 0.32 + 0.1 * (i / 3 % 3) as f64);
        for u in s.sides.iter().flatten() {
            all.entry((u.edge.panel.as_str(), u.edge.edge.as_str())).or_insert_with(|| colour.clone());
        }
    }
    all
}

/// A colour of that hue in degrees, and lightness, as `#rrggbb`: not every viewer knows hues.
fn colour(hue: f64, lightness: f64) -> String {
    let strength = 0.7 * lightness.min(1.0 - lightness);
    let channel = |n: f64| {
        let k = (n + hue / 30.0) % 12.0;
        let x = lightness - strength * (k - 3.0).min(9.0 - k).clamp(-1.0, 1.0);
        (x * 255.0).round() as u8
    };
    format!("#{:02x}{:02x}{:02x}", channel(0.0), channel(8.0), channel(4.0))
}

/// A piece with its least corner, in metres, and its size in mm.
struct SizedPiece<'a> {
    piece: &'a Piece,
    low: Point2,
    size: [f64; 2],
}

impl<'a> SizedPiece<'a> {
    fn new(piece: &'a Piece) -> Self {
        let points = piece.outer.points().0;
        let (mut lo, mut hi) =
            (Point2::new(f64::INFINITY, f64::INFINITY), Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY));
        for p in &points {
            (lo, hi) = (lo.inf(p), hi.sup(p));
        }
        let size = if points.is_empty() { [0.0; 2] } else { [(hi.x - lo.x) * 1e3, (hi.y - lo.y) * 1e3] };
        SizedPiece { piece, low: lo, size }
    }

    /// Draws it with its upper left corner there.
    fn draw(&self, out: &mut String, [x, y]: [f64; 2], colours: &BTreeMap<(&str, &str), String>) {
        let at = |p: &Point2| [x + (p.x - self.low.x) * 1e3, y + self.size[1] - (p.y - self.low.y) * 1e3];
        let line = |points: &[Point2]| {
            let mut s = String::new();
            for (i, [x, y]) in points.iter().map(at).enumerate() {
                let _ = write!(s, "{}{x:.2},{y:.2}", if i == 0 { "M" } else { "L" });
            }
            s
        };
        let p = self.piece;
        let mut whole = String::new();
        for l in std::iter::once(&p.outer).chain(&p.holes) {
            whole += &line(&l.points().0);
            whole.push('Z');
        }
        let _ = writeln!(out, "<path d=\"{whole}\" fill=\"#f4ecd8\" fill-rule=\"evenodd\" stroke=\"none\"/>");
        let holes = p.holes.iter().flat_map(|h| (0..h.edges.len()).map(move |k| (&h.edges[k], h.path(k))));
        let edges = (0..p.outer.edges.len()).map(|k| (&p.outer.edges[k], p.outer.path(k)));
        for (e, path) in edges.chain(holes) {
            let colour = colours.get(&(p.name.as_str(), e.name.as_str()));
            let (stroke, width) = colour.map_or((FREE, 1.0), |c| (c.as_str(), 3.0));
            let _ = writeln!(
                out,
                "<path d=\"{}\" fill=\"none\" stroke=\"{stroke}\" stroke-width=\"{width}\"/>",
                line(&path.points())
            );
            let _ = writeln!(out, "<path d=\"{}Z\" fill=\"{stroke}\"/>", line(&arrow(&path.points())));
            let [tx, ty] = at(&path.at(path.length() / 2.0));
            let name = escaped(&e.name);
            let _ = writeln!(
                out,
                "<text x=\"{tx:.1}\" y=\"{ty:.1}\" fill=\"{stroke}\" text-anchor=\"middle\">{name}</text>"
            );
        }
        for c in &p.outer.corners {
            let [cx, cy] = at(c);
            let _ = writeln!(out, "<circle cx=\"{cx:.2}\" cy=\"{cy:.2}\" r=\"2\" fill=\"{FREE}\"/>");
        }
        for l in &p.lines {
            let colour = colours.get(&(p.name.as_str(), l.name.as_str())).map_or("#777777", String::as_str);
            let d = line(&l.points);
            let _ =
                writeln!(out, "<path d=\"{d}\" fill=\"none\" stroke=\"{colour}\" stroke-dasharray=\"6 4\"/>");
        }
        for n in &p.notches {
            if let Some(k) = p.edge_number(&n.edge) {
                let [cx, cy] = at(&p.outer.path(k).at(n.along));
                let _ = writeln!(out, "<path d=\"M{:.2},{:.2}l4,8l-8,0Z\" fill=\"#c0392b\"/>", cx, cy - 4.0);
            }
        }
        for h in &p.drill_holes {
            let [cx, cy] = at(h);
            let _ = writeln!(
                out,
                "<circle cx=\"{cx:.2}\" cy=\"{cy:.2}\" r=\"3\" fill=\"none\" stroke=\"{FREE}\"/>"
            );
        }
        if let Some(grain) = &p.grain {
            let _ = writeln!(out, "<path d=\"{}\" stroke=\"#777777\" stroke-width=\"1.5\"/>", line(grain));
        }
        let [tx, ty] = at(&middle(&p.outer.points().0));
        let name = escaped(&p.name);
        let _ = writeln!(
            out,
            "<text x=\"{tx:.1}\" y=\"{ty:.1}\" font-size=\"14\" text-anchor=\"middle\">{name}</text>"
        );
    }
}

/// The centroid of a closed polygon; its first point where it has no area.
fn middle(points: &[Point2]) -> Point2 {
    let (n, area) = (points.len(), polygon_area(points));
    let (mut x, mut y) = (0.0, 0.0);
    for k in 0..n {
        let (a, b) = (points[k], points[(k + 1) % n]);
        let cross = a.x * b.y - b.x * a.y;
        (x, y) = (x + (a.x + b.x) * cross, y + (a.y + b.y) * cross);
    }
    let whole = 6.0 * area;
    if whole.abs() > 1e-12 {
        Point2::new(x / whole, y / whole)
    } else {
        points.first().copied().unwrap_or_else(Point2::origin)
    }
}

/// A name as text of XML.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
