//! The seams of a pattern as a file beside it: RON that the readers of drawings take as `seams`.
//!
//! ```text
//!     (
//!         seams: [
//!             (name: "side", kind: Matched, sides: [["front.edge_3"], ["-back.edge_3"]]),
//!         ],
//!     )
//! ```
//!
//! A side is a chain of edges, `piece.edge`; a minus before it runs along the edge from its end to
//! its start. Cost: linear. Limits: pieces are named without points and without a minus before
//! their name, and no name begins or ends with a space; a seam that cannot be named so is left out,
//! which is told.

use super::names::FileNames;
use std::fmt::Write;
use toile_core::artifact::{EdgeRef, EdgeUse, Pattern, PatternSeam, PleatFold, SeamKind};

/// All seams of a pattern along its own names, and a sentence for each that cannot be written.
pub fn sidecar(pattern: &Pattern) -> (String, Vec<String>) {
    along(pattern, &FileNames::own(&pattern.pieces))
}

/// The seams along the names that a file gives to pieces and edges.
pub(crate) fn along(pattern: &Pattern, names: &FileNames) -> (String, Vec<String>) {
    let mut told = Vec::new();
    let mut out = String::from("(\n    seams: [\n");
    for seam in &pattern.seams {
        match sides(seam, names) {
            Ok(sides) => {
                let kind = kind_word(seam.kind);
                let _ = writeln!(out, "        (name: {:?}, kind: {kind}, sides: [{sides}]),", seam.name);
            }
            Err(why) => {
                told.push(format!("the seam \"{}\" is left out of the file of seams: {why}", seam.name));
            }
        }
    }
    (out + "    ],\n)\n", told)
}

/// The sides of a seam as they are written; else why they cannot be.
fn sides(seam: &PatternSeam, names: &FileNames) -> Result<String, String> {
    let side = |uses: &Vec<EdgeUse>| {
        let links: Result<Vec<Vec<String>>, String> = uses.iter().map(|u| links(u, names)).collect();
        links.map(|l| format!("[{}]", l.concat().join(", ")))
    };
    let all: Result<Vec<String>, String> = seam.sides.iter().map(side).collect();
    all.map(|s| s.join(", "))
}

/// The links that an edge becomes.
fn links(u: &EdgeUse, names: &FileNames) -> Result<Vec<String>, String> {
    let mut parts = names.edge(&u.edge);
    if parts.is_empty() {
        return Err(format!("the pattern's file does not have {}", u.edge));
    }
    if u.reversed {
        parts.reverse();
    }
    parts.iter().map(|part| link(part, u.reversed)).collect()
}

fn link(part: &EdgeRef, reversed: bool) -> Result<String, String> {
    let panel = &part.panel;
    if panel.contains('.')
        || panel.starts_with('-')
        || panel.trim_start() != panel
        || part.edge.trim_end() != part.edge
    {
        return Err(format!("{part} cannot be named there"));
    }
    Ok(format!("{:?}", format!("{}{part}", if reversed { "-" } else { "" })))
}

/// A kind of seam as the file writes it, such as `Folded(angle: 90.0)`.
pub fn kind_word(kind: SeamKind) -> String {
    match kind {
        SeamKind::Matched => "Matched".into(),
        SeamKind::Gathered => "Gathered".into(),
        SeamKind::Dart => "Dart".into(),
        SeamKind::Pleat(PleatFold::Knife) => "KnifePleat".into(),
        SeamKind::Pleat(PleatFold::Box) => "BoxPleat".into(),
        SeamKind::Elastic { ratio, stiffness } => {
            format!("Elastic(ratio: {ratio:?}, stiffness: {stiffness:?})")
        }
        SeamKind::Patch => "Patch".into(),
        SeamKind::Folded { angle } => format!("Folded(angle: {:?})", angle.to_degrees()),
    }
}
