//! What of a block is sewn to what.

use crate::style::block::template::flat::Flat;
use crate::style::block::template::form::Form;
use toile_core::prelude::*;

/// Edges that front and back pieces do not share a seam at: they stay open, or meet another piece.
const NOT_SHARED: [&str; 9] = ["hem", "neck", "waist", "cuff", "cap", "rise", "armhole", "joint", "middle"];

/// Edges of lengths that differ by more than this share are gathered.
const EASED: f64 = 0.02;

/// The seams of a block with these pieces.
pub(super) fn seams(pieces: &[Flat], form: &Form, fold: PleatFold) -> Vec<PatternSeam> {
    let fronts = pieces.iter().filter(|p| p.name.ends_with("front"));
    let mut found: Vec<PatternSeam> = fronts.flat_map(shared).collect();
    let opens = pieces.iter().any(|p| p.name == "left_front");
    if opens {
        let [left, right] = Hand::BOTH.map(|hand| (format!("{hand}_front"), hand.name("middle")));
        found.push(seam("middle", [&left.0, &left.1], [&right.0, &right.1]));
    }
    let places = ["front", "back"].iter().flat_map(|layer| Hand::BOTH.map(|hand| (*layer, hand)));
    if form.underarm().is_some() {
        found.extend(places.map(|(layer, hand)| match (layer, opens) {
            ("front", true) => set_in(pieces, &format!("{hand}_front"), layer, hand),
            _ => set_in(pieces, layer, layer, hand),
        }));
    }
    for band in pieces.iter().filter(|p| p.name.starts_with("band_")) {
        let skirt = band.name.trim_start_matches("band_");
        let gathers = seam("waist", [skirt, "waist"], [&band.name, "joint"]);
        found.push(PatternSeam { kind: SeamKind::Gathered, ..gathers });
    }
    found.extend(pieces.iter().flat_map(|p| pleats(p, fold)));
    if form.has_legs() {
        found.extend(["front", "back"].map(rise));
    }
    found
}

/// The seams of a front piece with the piece behind it.
fn shared(front: &Flat) -> Vec<PatternSeam> {
    // Both halves of a front meet one back.
    let back = match front.name.as_str() {
        "left_front" | "right_front" => "back".to_owned(),
        name => name.replace("front", "back"),
    };
    let is_shared = |name: &&String| !NOT_SHARED.contains(&Hand::split(name).0);
    let names = front.edges.iter().map(|(name, _)| name).filter(is_shared);
    names.map(|edge| seam(edge, [&front.name, edge], [&back, edge])).collect()
}

/// A sleeve's cap in its armhole; a longer cap is eased in.
fn set_in(pieces: &[Flat], trunk: &str, layer: &str, hand: Hand) -> PatternSeam {
    let (armhole, sleeve) = (hand.name("armhole"), format!("{hand}_sleeve_{layer}"));
    let length = |piece: &str, edge: &str| {
        let edges = pieces.iter().filter(|p| p.name == piece).flat_map(|p| &p.edges);
        edges.filter(|e| e.0 == edge).map(|e| e.1.length()).sum::<f64>()
    };
    let differ = (length(&sleeve, "cap") / length(trunk, &armhole).max(f64::MIN_POSITIVE) - 1.0).abs();
    let kind = if differ > EASED { SeamKind::Gathered } else { SeamKind::Matched };
    PatternSeam { kind, ..seam("armhole", [trunk, &armhole], [&sleeve, "cap"]) }
}

/// The pleats of a piece: of each, one line is laid on the other.
fn pleats(piece: &Flat, fold: PleatFold) -> impl Iterator<Item = PatternSeam> + '_ {
    let words = piece.lines.iter().filter_map(|(name, _)| name.strip_suffix("_a"));
    words.map(move |word| {
        let side = |end: &str| {
            let edge = EdgeRef { panel: piece.name.clone(), edge: format!("{word}_{end}") };
            vec![EdgeUse { edge, reversed: false }]
        };
        let name = format!("{word} of {}", piece.name);
        PatternSeam { name, kind: SeamKind::Pleat(fold), sides: vec![side("a"), side("b")] }
    })
}

/// The seam in the middle of trousers.
fn rise(layer: &str) -> PatternSeam {
    let [left, right] = Hand::BOTH.map(|hand| format!("{hand}_leg_{layer}"));
    seam("rise", [&left, "rise"], [&right, "rise"])
}

/// Two edges that run counter-clockwise and meet face to face: one of them is walked against its
/// direction.
fn seam(word: &str, a: [&str; 2], b: [&str; 2]) -> PatternSeam {
    let one = |[panel, edge]: [&str; 2], reversed: bool| {
        vec![EdgeUse { edge: EdgeRef { panel: panel.to_owned(), edge: edge.to_owned() }, reversed }]
    };
    let name = format!("{word} of {}", a[0]);
    PatternSeam { name, kind: SeamKind::Matched, sides: vec![one(a, false), one(b, true)] }
}
