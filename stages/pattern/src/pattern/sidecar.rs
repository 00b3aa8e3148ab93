//! Seams from a file beside the pattern, for patterns that have none: RON that a person writes or
//! confirms.
//!
//! ```text
//!     (
//!         seams: [
//!             (name: "side", sides: [["front.edge_3"], ["-back.edge_3"]]),
//!             (name: "waist", kind: Gathered, sides: [["band.edge_0"], ["-left.edge_2", "-right.edge_2"]]),
//!         ],
//!     )
//! ```
//!
//! A side is a chain of edges, `piece.edge`; a minus before it runs along the edge from its end to
//! its start. All sides of a seam run the same way: their starts meet, and their ends.

use super::faults::PatternFault;
use super::propose::ProposedSeam;
use serde::Deserialize;
use std::fmt::Write;
use toile_core::nearest;
use toile_core::prelude::*;
use toile_pattern_files::kind_word;

/// Names of edges in a message.
const MOST_NAMES: usize = 12;

/// Bytes of one file.
const MOST_BYTES: usize = 4 << 20;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sidecar {
    seams: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    #[serde(default)]
    name: String,
    #[serde(default)]
    kind: WrittenSeamKind,
    sides: Vec<Vec<String>>,
}

/// A kind of seam as the file writes it.
#[derive(Deserialize, Default)]
enum WrittenSeamKind {
    #[default]
    Matched,
    Gathered,
    Dart,
    KnifePleat,
    BoxPleat,
    Elastic {
        ratio: f64,
        stiffness: f64,
    },
    Patch,
    Folded {
        angle: f64,
    },
}

impl WrittenSeamKind {
    fn seam(&self) -> SeamKind {
        match self {
            WrittenSeamKind::Matched => SeamKind::Matched,
            WrittenSeamKind::Gathered => SeamKind::Gathered,
            WrittenSeamKind::Dart => SeamKind::Dart,
            WrittenSeamKind::KnifePleat => SeamKind::Pleat(PleatFold::Knife),
            WrittenSeamKind::BoxPleat => SeamKind::Pleat(PleatFold::Box),
            WrittenSeamKind::Elastic { ratio, stiffness } => {
                SeamKind::Elastic { ratio: *ratio, stiffness: *stiffness }
            }
            WrittenSeamKind::Patch => SeamKind::Patch,
            WrittenSeamKind::Folded { angle } => SeamKind::Folded { angle: angle.to_radians() },
        }
    }
}

/// The seams of a file's bytes, along edges that the pieces have.
///
/// Errors: text that is no such RON, with line and column; every edge that does not exist, with the
/// number of its seam.
pub(super) fn read(bytes: &[u8], pieces: &[Piece]) -> Result<Vec<PatternSeam>, Vec<PatternFault>> {
    let fault = |what: String, remedy: Option<String>| PatternFault {
        code: ErrorCode::PatternLoading,
        param: "seams",
        what,
        remedy,
    };
    if bytes.len() > MOST_BYTES {
        return Err(vec![fault(format!("it has {} bytes, {MOST_BYTES} are the most", bytes.len()), None)]);
    }
    let text = std::str::from_utf8(bytes)
        .map_err(|_| vec![fault("it is not UTF-8 text".into(), Some("save it as UTF-8".into()))])?;
    let sidecar: Sidecar = ron::from_str(text).map_err(|e| {
        let what = format!("line {} column {}: {}", e.span.start.line, e.span.start.col, e.code);
        vec![fault(what, Some("write `(seams: [(sides: [[\"front.edge_3\"], [\"-back.edge_3\"]])])`".into()))]
    })?;
    let mut faults = Vec::new();
    let mut edge = |i: usize, text: &String| {
        let found = edge_use(text, pieces);
        found.map_err(|(what, near)| faults.push(fault(format!("seam {i}: {what}"), near))).ok()
    };
    let mut seams = Vec::with_capacity(sidecar.seams.len());
    for (i, entry) in sidecar.seams.iter().enumerate() {
        let sides = entry.sides.iter().map(|side| side.iter().filter_map(|u| edge(i, u)).collect());
        let sides: Vec<Vec<EdgeUse>> = sides.collect();
        let name = if entry.name.is_empty() { name(&sides) } else { entry.name.clone() };
        seams.push(PatternSeam { name, kind: entry.kind.seam(), sides });
    }
    if faults.is_empty() { Ok(seams) } else { Err(faults) }
}

/// What a seam without a name is called.
fn name(sides: &[Vec<EdgeUse>]) -> String {
    let side = |s: &Vec<EdgeUse>| s.iter().map(|u| u.edge.to_string()).collect::<Vec<_>>().join(" ");
    sides.iter().map(side).collect::<Vec<_>>().join(" + ")
}

/// An edge as it is written; else what is wrong, and what may be meant.
fn edge_use(text: &str, pieces: &[Piece]) -> Result<EdgeUse, (String, Option<String>)> {
    let (reversed, bare) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
    let edge = EdgeRef::try_from(bare.trim().to_owned()).map_err(|e| (e, None))?;
    let Some(piece) = pieces.iter().find(|p| p.name == edge.panel) else {
        let near = nearest(&edge.panel, pieces.iter().map(|p| p.name.as_str()));
        let hint = near.map(|n| format!("did you mean \"{n}\"?"));
        return Err((format!("there is no piece \"{}\"", edge.panel), hint));
    };
    if piece.path(&edge.edge).is_none() {
        let names = || piece.outer.edges.iter().map(|e| &e.name).chain(piece.lines.iter().map(|l| &l.name));
        let near = nearest(&edge.edge, names().map(String::as_str));
        let hint = match near {
            Some(n) => format!("did you mean \"{}.{n}\"?", edge.panel),
            None => format!("it has {}", list(names())),
        };
        let hint = Some(hint);
        return Err((format!("piece \"{}\" has no edge \"{}\"", edge.panel, edge.edge), hint));
    }
    Ok(EdgeUse { edge, reversed })
}

/// Names in a row, the first dozen.
fn list<'n>(names: impl Iterator<Item = &'n String>) -> String {
    let all: Vec<&str> = names.map(String::as_str).collect();
    let more =
        if all.len() > MOST_NAMES { format!(" and {} more", all.len() - MOST_NAMES) } else { String::new() };
    all[..all.len().min(MOST_NAMES)].join(", ") + &more
}

/// Seams as such a file, each with its confidence and the reason for it as a comment.
pub fn seams_file<'s>(seams: impl IntoIterator<Item = &'s ProposedSeam>) -> String {
    let mut out = String::from(
        "// Proposed seams. Look at each, take out what is wrong, and give this file as `seams`; nothing is sewn until then.\n\
         (\n    seams: [\n",
    );
    for ProposedSeam { seam, confidence, reason } in seams {
        let one = |u: &EdgeUse| format!("{:?}", format!("{}{}", if u.reversed { "-" } else { "" }, u.edge));
        let side = |s: &Vec<EdgeUse>| format!("[{}]", s.iter().map(one).collect::<Vec<_>>().join(", "));
        let sides = seam.sides.iter().map(side).collect::<Vec<_>>().join(", ");
        let _ = writeln!(
            out,
            "        // confidence {confidence:.2}: {reason}\n        (name: {:?}, kind: {}, sides: [{sides}]),",
            seam.name,
            kind_word(seam.kind)
        );
    }
    out + "    ],\n)\n"
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn pieces() -> Vec<Piece> {
        let corners = [[0.0, 0.0], [0.3, 0.0], [0.3, 0.4], [0.0, 0.4]].map(|[x, y]| Point2::new(x, y));
        let edges =
            ["hem", "right", "top", "left"].map(|n| PieceEdge { name: n.into(), curve: EdgeCurve::Line });
        let piece = |name: &str| Piece {
            name: name.into(),
            outer: PatternLoop { corners: corners.into(), edges: edges.clone().into() },
            ..Piece::default()
        };
        vec![piece("front"), piece("back")]
    }

    #[test]
    fn what_is_written_is_read_back() {
        let edge = |text: &str| edge_use(text, &pieces()).unwrap();
        let seam = |kind: SeamKind| PatternSeam {
            name: format!("a \"{}\" seam", kind.word()),
            kind,
            sides: vec![vec![edge("front.right"), edge("-front.top")], vec![edge("-back.left")]],
        };
        let proposed = |k| ProposedSeam { seam: seam(k), confidence: 0.9, reason: "why".to_owned() };
        let seams: Vec<ProposedSeam> = SeamKind::all().map(proposed).collect();
        let again = read(seams_file(&seams).as_bytes(), &pieces()).unwrap();
        assert_eq!(again, seams.into_iter().map(|p| p.seam).collect::<Vec<_>>());
    }

    #[test]
    fn what_is_wrong_is_named_with_its_place() {
        let all = |text: &str| {
            let faults = read(text.as_bytes(), &pieces()).unwrap_err().into_iter();
            faults.map(|f| (f.what, f.remedy.unwrap_or_default())).collect::<Vec<_>>()
        };
        let refused = |text: &str| all(text).remove(0);
        let seam = |a: &str, b: &str| format!("(seams: [(sides: [[\"{a}\"], [\"{b}\"]])])");
        assert_eq!(
            refused(&seam("front.right", "bakc.left")),
            ("seam 0: there is no piece \"bakc\"".into(), "did you mean \"back\"?".into())
        );
        assert_eq!(
            refused(&seam("front.rigth", "back.left")),
            ("seam 0: piece \"front\" has no edge \"rigth\"".into(), "did you mean \"front.right\"?".into())
        );
        assert_eq!(
            refused(&seam("front", "back.left")).0,
            "seam 0: \"front\" is not an edge; write \"panel.edge\", like \"front.hem\""
        );
        assert_eq!(all(&seam("front.rigth", "bakc.left")).len(), 2);
        let (message, hint) = refused("(\n  seams: [(side: [])])");
        assert!(message.starts_with("line 2 column "), "{message}");
        assert_eq!(hint, "write `(seams: [(sides: [[\"front.edge_3\"], [\"-back.edge_3\"]])])`");
    }
}
