//! What of a block is sewn to what.

use super::form::Form;
use super::pieces::Flat;
use toile_core::prelude::*;

/// Edges that stay open.
const OPEN: [&str; 4] = ["hem", "neck", "waist", "cuff"];

/// The seams of a block with these pieces.
pub(super) fn seams(pieces: &[Flat], form: &Form) -> Vec<PatternSeam> {
    let mut found = Vec::new();
    for front in pieces.iter().filter(|p| p.name.ends_with("front")) {
        let back = front.name.replace("front", "back");
        for (edge, _) in &front.edges {
            let apart = edge.starts_with("armhole") && form.underarm().is_some();
            if !OPEN.contains(&edge.as_str())
                && !apart
                && edge != "cap"
                && edge != "rise"
                && !is_open(edge, form)
            {
                found.push(seam(edge, (&front.name, edge), (&back, edge), &front.name));
            }
        }
    }
    for layer in ["front", "back"] {
        for side in ["left", "right"] {
            if form.underarm().is_some() {
                let (armhole, sleeve) = (format!("armhole_{side}"), format!("{side}_sleeve_{layer}"));
                found.push(seam("armhole", (layer, &armhole), (&sleeve, "cap"), &sleeve));
            }
        }
        if form.edges[0].name == "inseam" {
            let leg = |side: &str| format!("{side}_leg_{layer}");
            found.push(seam("rise", (&leg("left"), "rise"), (&leg("right"), "rise"), layer));
        }
    }
    found
}

/// An armhole without a sleeve stays open.
fn is_open(edge: &str, form: &Form) -> bool {
    edge.starts_with("armhole") && form.underarm().is_none()
}

/// Two edges that run counter-clockwise and meet face to face: one of them runs against its direction.
fn seam(word: &str, a: (&str, &str), b: (&str, &str), of: &str) -> PatternSeam {
    let one = |(panel, edge): (&str, &str), reversed: bool| {
        vec![EdgeUse { edge: EdgeRef { panel: panel.to_owned(), edge: edge.to_owned() }, reversed }]
    };
    PatternSeam {
        name: format!("{word} of {of}"),
        kind: SeamKind::Matched,
        sides: vec![one(a, false), one(b, true)],
    }
}
