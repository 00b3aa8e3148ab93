//! SVG of a pattern, in true scale: a unit is a millimetre.
//!
//! Each piece is a group under its name, each edge a path under its own; classes say what the other
//! lines are for, as the reader of drawings takes them: `allowance`, `grainline`, `notch`, `drill`,
//! `hole`, `mark`. Curves are kept as curves, arcs as cubic ones. Seams are numbered, the number
//! stands at each of their edges; the seams themselves stand in the file beside it.
//!
//! Cost: a millisecond a piece. Limits: a drawing has no places around the body, no layers, no
//! depths of notches, no purposes of lines inside pieces; each is told. No reader takes pieces of
//! less than 4 cm² for pieces.

mod names;
mod text;
pub mod words;

use crate::allowance::{CutLines, cut_lines};
use crate::error::{WriteError, writable};
use crate::flatten::loop_points;
use crate::inside::bounds;
use crate::label;
use crate::marks::{self, SeamMark};
use crate::names::{FileNames, PieceNames};
use crate::options::DrawingOptions;
use crate::parts::{EdgePart, parts};
use crate::shelf::pack;
use crate::sidecar;
use crate::written::Written;
use std::collections::BTreeSet;
use text::{PieceOnPage, escaped, number};
use toile_core::artifact::{Pattern, Piece, Point2, Vector2, polygon_area, polyline_length};

/// Between pieces and around all, mm.
const GAP: f64 = 20.0;
/// The drawing's width is about this times its height.
const ASPECT: f64 = 1.5;
/// Readers take a line whose ends are nearer than this for a closed one, metres.
const JOINT: f64 = 2e-4;
/// Readers leave out shorter lines: edges, and lines inside pieces, metres.
const NO_EDGE: f64 = 2e-7;
const NO_LINE: f64 = 2e-4;
/// Readers leave out smaller pieces, square metres.
const LEAST_AREA: f64 = 4e-4;
/// Outlines are measured by points as near as this, metres.
const TOLERANCE: f64 = 2e-5;
/// Half of a notch, and the radius of a drill hole, mm.
const NOTCH: f64 = 3.0;
const DRILL: f64 = 1.5;
/// How far a seam's number stands inside, and its size, mm.
const INSIDE: f64 = 6.0;
const NUMBER: f64 = 5.0;
/// How long the arrow heads of a grain line are, metres.
const ARROW: f64 = 5e-3;

/// A pattern as a drawing, with its seams in the file beside it.
///
/// Errors: a pattern that is not sound, that has no pieces, or with a piece beyond
/// [`FARTHEST`](crate::FARTHEST); a seam allowance that cannot be cut.
pub fn to_svg(pattern: &Pattern, options: &DrawingOptions) -> Result<Written, WriteError> {
    writable(pattern)?;
    let cut = cut_lines(pattern, &options.allowances)?;
    let CutLines { lines: cut, notes: mut warnings, .. } = cut;
    let mut notes = left_out(&pattern.pieces);
    let numbers = marks::seam_marks(pattern);
    let mut names = FileNames::default();
    let mut taken = BTreeSet::new();
    let mut drawn = Vec::with_capacity(pattern.pieces.len());
    for ((p, cut), numbers) in pattern.pieces.iter().zip(&cut).zip(&numbers) {
        let label = names::of_piece(&p.name, &mut taken);
        if label != p.name {
            notes.push(format!("piece \"{}\" is called \"{label}\" in the drawing", p.name));
        }
        let one = DrawnPiece::new(p, cut.as_deref(), numbers, &label);
        if one.area < LEAST_AREA {
            warnings.push(format!(
                "piece \"{}\" is smaller than 4 cm2: readers of drawings leave it out",
                p.name
            ));
        }
        names.insert(&p.name, one.names.clone());
        drawn.push(one);
    }
    let text = page(&drawn, options);
    let (seams, mut told) = sidecar::along(pattern, &names);
    warnings.append(&mut told);
    Ok(Written { bytes: text.into_bytes(), seams, notes, warnings })
}

/// What a drawing has no place for, a sentence for each kind.
fn left_out(pieces: &[Piece]) -> Vec<String> {
    let count = |what: &str, of: fn(&Piece) -> usize| {
        let n: usize = pieces.iter().map(of).sum();
        (n > 0).then(|| format!("{n} {what} are left out: a drawing has none"))
    };
    let all = [
        count("places around the body", |p| usize::from(p.pose.is_some())),
        count("layers of pieces", |p| usize::from(p.layer > 0)),
        count("depths of notches", |p| p.notches.iter().filter(|n| n.depth > 0.0).count()),
        count("purposes of lines inside pieces", |p| p.lines.len()),
    ];
    all.into_iter().flatten().collect()
}

/// A piece with all that is drawn of it.
struct DrawnPiece<'a> {
    piece: &'a Piece,
    cut: Option<&'a [Point2]>,
    numbers: &'a [SeamMark],
    names: PieceNames,
    parts: Vec<EdgePart>,
    /// Its outline.
    polygon: Vec<Point2>,
    area: f64,
    /// The box around what is cut, metres.
    low: Point2,
    high: Point2,
}

impl<'a> DrawnPiece<'a> {
    fn new(p: &'a Piece, cut: Option<&'a [Point2]>, numbers: &'a [SeamMark], label: &str) -> Self {
        let all = parts(&p.outer, |chord, length| chord <= JOINT && length > 4.0 * JOINT);
        let length =
            |part: &EdgePart| toile_core::artifact::EdgePath::new(part.start, part.end, &part.curve).length();
        let parts: Vec<EdgePart> = all.into_iter().filter(|part| length(part) > NO_EDGE).collect();
        let count = |k: usize| parts.iter().filter(|part| part.edge == k).count();
        let edges: Vec<(&str, usize)> =
            p.outer.edges.iter().enumerate().map(|(k, e)| (e.name.as_str(), count(k))).collect();
        let names = names::of_edges(label, &edges, &lines(p).map(|l| l.name.as_str()).collect::<Vec<_>>());
        let polygon = loop_points(&p.outer, TOLERANCE).0;
        let area = polygon_area(&polygon);
        let (low, high) = bounds(cut.unwrap_or(&polygon));
        DrawnPiece { piece: p, cut, numbers, names, parts, polygon, area, low, high }
    }

    fn size(&self) -> [f64; 2] {
        [(self.high.x - self.low.x) * 1e3, (self.high.y - self.low.y) * 1e3]
    }

    /// Draws it with the lower left corner of its box there, mm, y down.
    fn draw(&self, corner: [f64; 2], size: &str, out: &mut String) {
        let p = self.piece;
        let pen = PieceOnPage { low: self.low, corner };
        let label = escaped(&self.names.piece);
        out.push_str(&format!(
            "<g inkscape:label=\"{label}\" fill=\"none\" stroke=\"#000\" stroke-width=\"0.5\">\n"
        ));
        self.edges(&pen, out);
        if let Some(cut) = self.cut {
            let d = pen.polygon(cut);
            out.push_str(&format!("<path class=\"allowance\" stroke-width=\"0.7\" d=\"{d}\"/>\n"));
        }
        for h in &p.holes {
            let d = pen.polygon(&loop_points(h, TOLERANCE).0);
            out.push_str(&format!("<path class=\"hole\" d=\"{d}\"/>\n"));
        }
        for l in lines(p) {
            let d = pen.line(&l.points);
            out.push_str(&format!(
                "<path class=\"mark\" stroke-width=\"0.35\" stroke-dasharray=\"3 1.5\" d=\"{d}\"/>\n"
            ));
        }
        let grain = marks::grain(p, &self.polygon);
        out.push_str(&format!(
            "<path class=\"grainline\" stroke-width=\"0.35\" d=\"{}\"/>\n",
            pen.line(&grain)
        ));
        for (tip, way) in [(grain[1], -1.0), (grain[0], 1.0)] {
            let long = ARROW.min((grain[1].y - grain[0].y) / 3.0);
            let back = tip + Vector2::new(0.0, way * long);
            let across = Vector2::new(0.3 * long, 0.0);
            let d = pen.polygon(&[tip, back + across, back - across]);
            out.push_str(&format!("<path class=\"note\" fill=\"#000\" stroke=\"none\" d=\"{d}\"/>\n"));
        }
        for n in marks::notches(p) {
            let half = n.out * (NOTCH / 1e3);
            let d = pen.line(&[n.at - half, n.at + half]);
            out.push_str(&format!("<path class=\"notch\" d=\"{d}\"/>\n"));
        }
        for h in &p.drill_holes {
            let [x, y] = pen.at(*h).map(number);
            out.push_str(&format!("<circle class=\"drill\" cx=\"{x}\" cy=\"{y}\" r=\"{DRILL}\"/>\n"));
        }
        self.words(&pen, size, out);
        out.push_str("</g>\n");
    }

    fn edges(&self, pen: &PieceOnPage, out: &mut String) {
        let dash = if self.cut.is_some() { " stroke-dasharray=\"4 2\"" } else { "" };
        let mut used = std::collections::BTreeMap::new();
        for part in &self.parts {
            let k = used.entry(part.edge).or_insert(0_usize);
            let own = &self.piece.outer.edges[part.edge].name;
            let label = self.names.edges.get(own).and_then(|l| l.get(*k)).map_or("", String::as_str);
            *k += 1;
            out.push_str(&format!(
                "<path class=\"seam\" inkscape:label=\"{}\"{dash} d=\"{}\"/>\n",
                escaped(label),
                pen.curve(part)
            ));
        }
    }

    /// How often it is cut, its name and the numbers of its seams.
    fn words(&self, pen: &PieceOnPage, size: &str, out: &mut String) {
        let size = if size.is_empty() { String::new() } else { format!(", size {size}") };
        // The reader takes the first text that says how often a piece is cut.
        let words = [(format!("cut 1{size}"), 0.7, false), (self.names.piece.clone(), 1.0, false)];
        let ring: Vec<Point2> =
            loop_points(&self.piece.outer, label::ROUGH).0.iter().map(|q| q * 1e3).collect();
        let place = label::place(&words, &ring, &self.lines());
        let at = pen.at(place.at / 1e3);
        let turn = match place.upright {
            true => format!(" transform=\"rotate(-90 {} {})\"", number(at[0]), number(at[1])),
            false => String::new(),
        };
        let below = [at[0], at[1] + 0.9 * place.size];
        say(out, below, place.size * 0.7, "#000", &turn, &words[0].0);
        say(out, at, place.size, "#000", &turn, &words[1].0);
        for m in self.numbers {
            let [x, y] = pen.at(m.at + m.inwards * (INSIDE / 1e3));
            say(out, [x, y + 0.36 * NUMBER], NUMBER, "#8b1818", "", &m.number.to_string());
        }
    }

    /// All that is drawn on the piece and words are not to stand on, mm.
    fn lines(&self) -> Vec<[Point2; 2]> {
        let p = self.piece;
        let mut out = Vec::new();
        for ring in std::iter::once(&p.outer).chain(&p.holes).map(|l| loop_points(l, label::ROUGH).0) {
            out.extend((0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]));
        }
        out.extend(lines(p).flat_map(|l| l.points.windows(2).map(|w| [w[0], w[1]])));
        out.push(marks::grain(p, &self.polygon));
        out.into_iter().map(|line| line.map(|q| q * 1e3)).collect()
    }
}

/// A text, its middle there.
fn say(out: &mut String, [x, y]: [f64; 2], height: f64, fill: &str, turn: &str, text: &str) {
    out.push_str(&format!(
        "<text x=\"{}\" y=\"{}\"{turn} font-family=\"sans-serif\" font-size=\"{}\" text-anchor=\"middle\" fill=\"{fill}\" stroke=\"none\">{}</text>\n",
        number(x),
        number(y),
        number(height),
        escaped(text)
    ));
}

/// The lines inside a piece that are long enough to be drawn.
fn lines(p: &Piece) -> impl Iterator<Item = &toile_core::artifact::PieceLine> {
    p.lines.iter().filter(|l| polyline_length(&l.points) > NO_LINE)
}

/// The page with all pieces.
fn page(drawn: &[DrawnPiece<'_>], options: &DrawingOptions) -> String {
    let sizes: Vec<[f64; 2]> = drawn.iter().map(DrawnPiece::size).collect();
    let area: f64 = sizes.iter().map(|s| (s[0] + GAP) * (s[1] + GAP)).sum();
    let (places, [width, height]) = pack(&sizes, (area * ASPECT).sqrt(), GAP);
    let mut body = String::new();
    for (d, [x, y]) in drawn.iter().zip(&places) {
        d.draw([x + GAP, GAP - y], &options.size, &mut body);
    }
    let (w, h) = (number(width + 2.0 * GAP), number(height + 2.0 * GAP));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         width=\"{w}mm\" height=\"{h}mm\" viewBox=\"0 0 {w} {h}\">\n{body}</svg>\n"
    )
}
