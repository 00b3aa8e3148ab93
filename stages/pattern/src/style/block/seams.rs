//! What of a block is sewn to what.

use crate::style::block::template::flat::{Flat, PleatLine};
use crate::style::block::template::form::Form;
use crate::style::block::template::piece_role::{Layer, PieceRole};
use toile_core::prelude::*;

/// Edges that front and back pieces do not share a seam at: they stay open, or meet another piece.
const NOT_SHARED: [EdgeRole; 9] = [
    EdgeRole::Hem,
    EdgeRole::Neck,
    EdgeRole::Waist,
    EdgeRole::Cuff,
    EdgeRole::Cap,
    EdgeRole::Rise,
    EdgeRole::Armhole,
    EdgeRole::Joint,
    EdgeRole::Middle,
];

/// Edges of lengths that differ by more than this share are gathered.
const EASED: f64 = 0.02;

/// An edge of the block: of which piece, what it is, and on which side.
type BlockEdge = (PieceRole, EdgeRole, Option<Hand>);

/// The seams of a block with these pieces.
pub(super) fn seams(pieces: &[Flat], form: &Form, fold: PleatFold) -> Vec<PatternSeam> {
    let mut found: Vec<PatternSeam> = pieces.iter().flat_map(shared).collect();
    let half = |hand| PieceRole::Half(Layer::Front, hand);
    let opens = pieces.iter().any(|p| p.role == half(Hand::Left));
    if opens {
        let [left, right] = Hand::BOTH.map(|hand| (half(hand), EdgeRole::Middle, Some(hand)));
        found.push(seam(EdgeRole::Middle.word(), left, right));
    }
    if form.underarm().is_some() {
        let places = Layer::BOTH.into_iter().flat_map(|layer| Hand::BOTH.map(|hand| (layer, hand)));
        found.extend(places.map(|(layer, hand)| {
            let is_half = opens && layer == Layer::Front;
            let trunk = if is_half { half(hand) } else { PieceRole::Whole(layer) };
            set_in(pieces, trunk, PieceRole::Sleeve(layer, hand), hand)
        }));
    }
    for band in pieces {
        let PieceRole::Band(layer) = band.role else { continue };
        let skirt = (PieceRole::Whole(layer), EdgeRole::Waist, None);
        let gathers = seam(EdgeRole::Waist.word(), skirt, (band.role, EdgeRole::Joint, None));
        found.push(PatternSeam { kind: SeamKind::Gathered, ..gathers });
    }
    found.extend(pieces.iter().flat_map(|p| pleats(p, fold)));
    if form.ends_at(EdgeRole::Crown) {
        found.extend(hood(pieces));
    }
    if form.has_legs() {
        found.extend(Layer::BOTH.map(rise));
    }
    found
}

/// The seams of a front piece with the piece behind it.
fn shared(front: &Flat) -> impl Iterator<Item = PatternSeam> + '_ {
    let edges = front.edges.iter().filter(|e| !NOT_SHARED.contains(&e.role));
    let pairs = front.role.behind().into_iter().flat_map(move |back| edges.clone().map(move |e| (back, e)));
    pairs.map(|(back, e)| seam(&e.name(), (front.role, e.role, e.hand), (back, e.role, e.hand)))
}

/// A sleeve's cap in its armhole; a longer cap is eased in.
fn set_in(pieces: &[Flat], trunk: PieceRole, sleeve: PieceRole, hand: Hand) -> PatternSeam {
    let (armhole, cap) = ((trunk, EdgeRole::Armhole, Some(hand)), (sleeve, EdgeRole::Cap, None));
    let length = |(piece, role, hand): BlockEdge| {
        let edges = pieces.iter().filter(|p| p.role == piece).flat_map(|p| &p.edges);
        edges.filter(|e| (e.role, e.hand) == (role, hand)).map(|e| e.run.length()).sum::<f64>()
    };
    PatternSeam { kind: kind(length(cap), length(armhole)), ..seam(EdgeRole::Armhole.word(), armhole, cap) }
}

/// How edges of these lengths are sewn together.
fn kind(one: f64, other: f64) -> SeamKind {
    let differ = (one / other.max(f64::MIN_POSITIVE) - 1.0).abs();
    if differ > EASED { SeamKind::Gathered } else { SeamKind::Matched }
}

/// The pleats of a piece: of each, one line is laid on the other.
fn pleats(piece: &Flat, fold: PleatFold) -> impl Iterator<Item = PatternSeam> + '_ {
    let numbers = piece.lines.iter().filter_map(|(line, _)| match line {
        PleatLine::A(number) => Some(*number),
        _ => None,
    });
    numbers.map(move |number| {
        let side = |line: PleatLine| {
            let edge = EdgeRef { panel: piece.role.name(), edge: line.name() };
            vec![EdgeUse { edge, reversed: false }]
        };
        let name = format!("pleat_{number} of {}", piece.role.name());
        let sides = vec![side(PleatLine::A(number)), side(PleatLine::B(number))];
        PatternSeam { name, kind: SeamKind::Pleat(fold), sides }
    })
}

/// The seams of a hood: its halves along the crown, and each half to its half of the neck.
fn hood(pieces: &[Flat]) -> Vec<PatternSeam> {
    let length = |piece: PieceRole, role: EdgeRole, hand: Option<Hand>| -> f64 {
        let edges = pieces.iter().filter(|p| p.role == piece).flat_map(|p| &p.edges);
        edges.filter(|e| (e.role, e.hand) == (role, hand)).map(|e| e.run.length()).sum()
    };
    let used = |piece: PieceRole, role: EdgeRole, hand: Option<Hand>, reversed: bool| EdgeUse {
        edge: EdgeRef { panel: piece.name(), edge: role.name(hand) },
        reversed,
    };
    let half = PieceRole::Hood;
    let crown = PatternSeam {
        name: EdgeRole::Crown.word().to_owned(),
        kind: SeamKind::Matched,
        sides: vec![
            vec![used(half(Hand::Left), EdgeRole::Crown, None, false)],
            vec![used(half(Hand::Right), EdgeRole::Crown, None, true)],
        ],
    };
    let neck = |hand: Hand| {
        // From the throat to the nape: the left half of the trunk's neck runs the other way in
        // both layers, and so does that of the hood's right half.
        let turned = hand == Hand::Left;
        let trunk =
            Layer::BOTH.map(|layer| used(PieceRole::Whole(layer), EdgeRole::Neck, Some(hand), turned));
        let around: f64 =
            Layer::BOTH.iter().map(|l| length(PieceRole::Whole(*l), EdgeRole::Neck, Some(hand))).sum();
        let own = length(half(hand), EdgeRole::Joint, None);
        PatternSeam {
            name: format!("neck of {}", half(hand).name()),
            kind: kind(own, around),
            sides: vec![trunk.to_vec(), vec![used(half(hand), EdgeRole::Joint, None, !turned)]],
        }
    };
    [crown].into_iter().chain(Hand::BOTH.map(neck)).collect()
}

/// The seam in the middle of trousers.
fn rise(layer: Layer) -> PatternSeam {
    let [left, right] = Hand::BOTH.map(|hand| (PieceRole::Leg(layer, hand), EdgeRole::Rise, None));
    seam(EdgeRole::Rise.word(), left, right)
}

/// Two edges that run counter-clockwise and meet face to face: one of them is walked against its
/// direction.
fn seam(word: &str, a: BlockEdge, b: BlockEdge) -> PatternSeam {
    let one = |(piece, role, hand): BlockEdge, reversed: bool| {
        vec![EdgeUse { edge: EdgeRef { panel: piece.name(), edge: role.name(hand) }, reversed }]
    };
    let name = format!("{word} of {}", a.0.name());
    PatternSeam { name, kind: SeamKind::Matched, sides: vec![one(a, false), one(b, true)] }
}
