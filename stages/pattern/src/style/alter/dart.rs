//! A dart, cut out of an edge.
//!
//! Its legs run from both ends of its mouth on the edge to its tip, which lies square to the mouth.
//! The edge is parted: its parts keep its curve, and every seam of the edge runs on along both.

use super::held::fault;
use super::names;
use super::shown::Showing;
use kurbo::{CubicBez, ParamCurve, ParamCurveArclen, QuadBez};
use toile_core::prelude::*;

/// Parts of an edge and darts are no smaller than this, metres.
const LEAST: f64 = 1e-3;
/// The greatest error of a length along a curve, metres.
const ACCURACY: f64 = 1e-10;
/// Halvings that find the longest dart.
const HALVINGS: usize = 10;

/// A dart; lengths in metres.
#[derive(Clone, Copy)]
pub(super) struct CutDart {
    /// Where its middle lies, as a share of the edge.
    pub at: f64,
    pub width: f64,
    pub length: f64,
}

/// The names of the first part of the edge, the legs, and the second part.
type DartParts = [String; 4];

impl CutDart {
    /// Cuts it and sews its legs together.
    pub(super) fn cut(
        self,
        edge: &EdgeRef,
        pattern: &mut Pattern,
        showing: &mut Showing,
        cx: &Context,
    ) -> Result<(), StageError> {
        let (p, k) = names::edge(pattern, edge)?;
        let piece = &pattern.pieces[p];
        let mouth = self.mouth(edge, piece.outer.path(k).length())?;
        let names = parts(piece, &edge.edge);
        let (after, lost) = self.let_in(piece, k, mouth, &names);
        if let Some(what) = fault(piece, &after) {
            return Err(self.too_long(edge, piece, k, mouth, &what));
        }
        if lost > 0 {
            cx.note(format!("{lost} notches of \"{edge}\" lie in the mouth of the dart and are left out"));
        }
        showing.part(piece, &after, &edge.edge, &names, mouth.map(|m| m / piece.outer.path(k).length()));
        pattern.pieces[p] = after;
        hand_on(pattern, edge, &names);
        let leg = |name: &str, reversed: bool| {
            vec![EdgeUse { edge: EdgeRef { panel: edge.panel.clone(), edge: name.to_owned() }, reversed }]
        };
        pattern.seams.push(PatternSeam {
            name: format!("dart of {edge}"),
            kind: SeamKind::Dart,
            sides: vec![leg(&names[1], false), leg(&names[2], true)],
        });
        Ok(())
    }

    /// Where the mouth starts and ends on an edge of that length, metres.
    fn mouth(self, edge: &EdgeRef, length: f64) -> Result<[f64; 2], StageError> {
        let wrong = |text: String, hint: String| Err(StageError::invalid(text).hint(hint));
        let mm = |metres: f64| Length::m(metres);
        if self.width < LEAST || self.length < LEAST {
            let small = if self.width < LEAST { self.width } else { self.length };
            return wrong(
                format!("a dart of {} is too small", mm(small)),
                "20 mm wide and 90 mm long is usual".into(),
            );
        }
        let room = length - 2.0 * LEAST - self.width;
        if room <= 0.0 {
            return wrong(
                format!(
                    "a dart of {} is wider than \"{edge}\", which is {:.0} mm long",
                    mm(self.width),
                    length * 1e3
                ),
                "take a smaller `width`".into(),
            );
        }
        let mouth = [-0.5, 0.5].map(|half| self.at * length + half * self.width);
        if mouth[0] >= LEAST && mouth[1] <= length - LEAST {
            return Ok(mouth);
        }
        let least = ((0.5 * self.width + LEAST) / length * 100.0).ceil() / 100.0;
        let hint = match least < 0.5 {
            true => format!("it has room from at: {least} to at: {}", 1.0 - least),
            false => "at: 0.5 is its middle".to_owned(),
        };
        wrong(
            format!("a dart of {} at {} of \"{edge}\" reaches beyond its end", mm(self.width), self.at),
            hint,
        )
    }

    /// The piece with the dart let into its edge number `k`, and how many notches it takes away.
    fn let_in(self, piece: &Piece, k: usize, mouth: [f64; 2], names: &DartParts) -> (Piece, usize) {
        let mut after = piece.clone();
        let path = piece.outer.path(k);
        let [a, b] = mouth.map(|m| path.at(m));
        let chord = b - a;
        let inwards = Vector2::new(-chord.y, chord.x).try_normalize(1e-12).unwrap_or_else(Vector2::zeros);
        let tip = nalgebra::center(&a, &b) + inwards * self.length;
        let edge = |name: &str, curve: EdgeCurve| PieceEdge { name: name.to_owned(), curve };
        let edges = [
            edge(&names[0], part(piece, k, [0.0, mouth[0]])),
            edge(&names[1], EdgeCurve::Line),
            edge(&names[2], EdgeCurve::Line),
            edge(&names[3], part(piece, k, [mouth[1], path.length()])),
        ];
        after.outer.edges.splice(k..=k, edges);
        after.outer.corners.splice(k + 1..k + 1, [a, tip, b]);
        let is_lost =
            |n: &Notch| n.edge == piece.outer.edges[k].name && n.along > mouth[0] && n.along < mouth[1];
        let count = after.notches.len();
        after.notches.retain(|n| !is_lost(n));
        for n in after.notches.iter_mut().filter(|n| n.edge == piece.outer.edges[k].name) {
            (n.edge, n.along) = match n.along <= mouth[0] {
                true => (names[0].clone(), n.along),
                false => (names[3].clone(), n.along - mouth[1]),
            };
        }
        clamp_notches(&mut after, names);
        let lost = count - after.notches.len();
        (after, lost)
    }

    /// The refusal, with the longest dart that there is room for.
    fn too_long(self, edge: &EdgeRef, piece: &Piece, k: usize, mouth: [f64; 2], what: &str) -> StageError {
        let names = parts(piece, &edge.edge);
        let goes = |length: f64| {
            let (after, _) = CutDart { length, ..self }.let_in(piece, k, mouth, &names);
            fault(piece, &after).is_none()
        };
        let (mut low, mut high) = (0.0, self.length);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if goes(middle) { low = middle } else { high = middle }
        }
        let hint = match (low * 1e3).floor() {
            mm if mm >= 1.0 => format!("so long it goes: length: \"{mm:.0} mm\""),
            _ => "put it elsewhere: `at` is a share of the edge from its start".to_owned(),
        };
        StageError::invalid(format!(
            "a dart of {} from \"{edge}\" is longer than the piece has room for: {what}",
            Length::m(self.length)
        ))
        .hint(hint)
    }
}

/// Rounding leaves no notch beyond its edge.
fn clamp_notches(piece: &mut Piece, names: &DartParts) {
    for name in [&names[0], &names[3]] {
        let length = piece.path(name).map_or(0.0, |p| p.length());
        piece
            .notches
            .iter_mut()
            .filter(|n| n.edge == *name)
            .for_each(|n| n.along = n.along.clamp(0.0, length));
    }
}

/// Names of the parts of an edge that the piece does not have yet.
fn parts(piece: &Piece, edge: &str) -> DartParts {
    let is_taken = |name: &str| {
        let holes = piece.holes.iter().flat_map(|h| &h.edges);
        piece.outer.edges.iter().chain(holes).any(|e| e.name == name) || piece.line(name).is_some()
    };
    ["1", "dart_1", "dart_2", "2"].map(|word| {
        let mut name = format!("{edge}_{word}");
        while is_taken(&name) {
            name.push('\'');
        }
        name
    })
}

/// Every seam of the edge runs on along both its parts.
fn hand_on(pattern: &mut Pattern, edge: &EdgeRef, names: &DartParts) {
    for side in pattern.seams.iter_mut().flat_map(|s| &mut s.sides) {
        while let Some(i) = side.iter().position(|u| u.edge == *edge) {
            let reversed = side[i].reversed;
            let mut both = [&names[0], &names[3]].map(|name| EdgeUse {
                edge: EdgeRef { panel: edge.panel.clone(), edge: name.clone() },
                reversed,
            });
            if reversed {
                both.reverse();
            }
            side.splice(i..=i, both);
        }
    }
}

/// The curve of a part of an edge, between two lengths from its start.
fn part(piece: &Piece, k: usize, [from, to]: [f64; 2]) -> EdgeCurve {
    let corners = &piece.outer.corners;
    let [a, b] = [corners[k], corners[(k + 1) % corners.len()]].map(|p| kurbo::Point::new(p.x, p.y));
    let path = piece.outer.path(k);
    let point = |p: kurbo::Point| Point2::new(p.x, p.y);
    let bent = |p: &Point2| kurbo::Point::new(p.x, p.y);
    match &piece.outer.edges[k].curve {
        EdgeCurve::Line => EdgeCurve::Line,
        EdgeCurve::Arc { bulge } => {
            let share = (to - from) / path.length().max(f64::MIN_POSITIVE);
            EdgeCurve::Arc { bulge: (bulge.atan() * share).tan() }
        }
        EdgeCurve::Quadratic { control } => {
            let whole = QuadBez::new(a, bent(control), b);
            let [s, t] = [from, to].map(|l| parameter(&whole, l, path.length()));
            EdgeCurve::Quadratic { control: point(whole.subsegment(s..t).p1) }
        }
        EdgeCurve::Cubic { controls: [c, d] } => {
            let whole = CubicBez::new(a, bent(c), bent(d), b);
            let [s, t] = [from, to].map(|l| parameter(&whole, l, path.length()));
            let cut = whole.subsegment(s..t);
            EdgeCurve::Cubic { controls: [point(cut.p1), point(cut.p2)] }
        }
        EdgeCurve::Polyline { .. } => EdgeCurve::through(&path.between(from, to)),
    }
}

/// The parameter of a curve at a length from its start, metres.
fn parameter(curve: &impl ParamCurveArclen, length: f64, whole: f64) -> f64 {
    match length {
        l if l <= 0.0 => 0.0,
        l if l >= whole => 1.0,
        l => curve.inv_arclen(l, ACCURACY.max(1e-13 * whole)),
    }
}
