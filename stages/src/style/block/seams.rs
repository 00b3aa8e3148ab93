//! What of a block is sewn to what.

use super::form::Form;
use super::pieces::Flat;
use toile_core::prelude::*;

/// Edges that front and back pieces do not share a seam at: they stay open, or meet another piece.
const NOT_SHARED: [&str; 8] = ["hem", "neck", "waist", "cuff", "cap", "rise", "armhole", "joint"];

/// Edges of lengths that differ by more than this share are gathered.
const EASED: f64 = 0.02;

/// The seams of a block with these pieces.
pub(super) fn seams(pieces: &[Flat], form: &Form) -> Vec<PatternSeam> {
    let fronts = pieces.iter().filter(|p| p.name.ends_with("front"));
    let mut found: Vec<PatternSeam> = fronts.flat_map(shared).collect();
    let places = ["front", "back"].iter().flat_map(|layer| ["left", "right"].map(|side| (*layer, side)));
    if form.underarm().is_some() {
        found.extend(places.map(|(layer, side)| set_in(pieces, layer, side)));
    }
    for band in pieces.iter().filter(|p| p.name.starts_with("band_")) {
        let skirt = band.name.trim_start_matches("band_");
        let gathers = seam("waist", [skirt, "waist"], [&band.name, "joint"]);
        found.push(PatternSeam { kind: SeamKind::Gathered, ..gathers });
    }
    if form.has_legs() {
        found.extend(["front", "back"].map(rise));
    }
    found
}

/// The seams of a front piece with the piece behind it.
fn shared(front: &Flat) -> Vec<PatternSeam> {
    let back = front.name.replace("front", "back");
    let is_shared = |name: &&String| {
        let word = name.trim_end_matches("_left").trim_end_matches("_right");
        !NOT_SHARED.contains(&word)
    };
    let names = front.edges.iter().map(|(name, _)| name).filter(is_shared);
    names.map(|edge| seam(edge, [&front.name, edge], [&back, edge])).collect()
}

/// A sleeve's cap in its armhole; a longer cap is eased in.
fn set_in(pieces: &[Flat], layer: &str, side: &str) -> PatternSeam {
    let (armhole, sleeve) = (format!("armhole_{side}"), format!("{side}_sleeve_{layer}"));
    let length = |piece: &str, edge: &str| {
        let edges = pieces.iter().filter(|p| p.name == piece).flat_map(|p| &p.edges);
        edges.filter(|e| e.0 == edge).map(|e| e.1.length()).sum::<f64>()
    };
    let differ = (length(&sleeve, "cap") / length(layer, &armhole).max(f64::MIN_POSITIVE) - 1.0).abs();
    let kind = if differ > EASED { SeamKind::Gathered } else { SeamKind::Matched };
    PatternSeam { kind, ..seam("armhole", [layer, &armhole], [&sleeve, "cap"]) }
}

/// The seam in the middle of trousers.
fn rise(layer: &str) -> PatternSeam {
    let leg = |side: &str| format!("{side}_leg_{layer}");
    seam("rise", [&leg("left"), "rise"], [&leg("right"), "rise"])
}

/// Two edges that run counter-clockwise and meet face to face: one of them is walked against its direction.
fn seam(word: &str, a: [&str; 2], b: [&str; 2]) -> PatternSeam {
    let one = |[panel, edge]: [&str; 2], reversed: bool| {
        vec![EdgeUse { edge: EdgeRef { panel: panel.to_owned(), edge: edge.to_owned() }, reversed }]
    };
    let name = format!("{word} of {}", a[0]);
    PatternSeam { name, kind: SeamKind::Matched, sides: vec![one(a, false), one(b, true)] }
}
