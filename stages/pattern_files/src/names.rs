//! What a file calls the pieces, edges and lines of a pattern, as its reader will call them.

use std::collections::{BTreeMap, BTreeSet};
use toile_core::artifact::{EdgeRef, Piece};

/// The names of one piece in a file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct PieceNames {
    /// What the piece is called.
    pub piece: String,
    /// For each outer edge and inner line what its parts are called, from its start; none where the
    /// file does not have it.
    pub edges: BTreeMap<String, Vec<String>>,
}

/// The names of all pieces, by the names that they have in the pattern.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct FileNames(BTreeMap<String, PieceNames>);

impl FileNames {
    /// The names that the pattern itself has.
    pub(crate) fn own(pieces: &[Piece]) -> Self {
        let one = |p: &Piece| {
            let edges = p.outer.edges.iter().map(|e| &e.name).chain(p.lines.iter().map(|l| &l.name));
            let edges = edges.map(|n| (n.clone(), vec![n.clone()])).collect();
            (p.name.clone(), PieceNames { piece: p.name.clone(), edges })
        };
        FileNames(pieces.iter().map(one).collect())
    }

    /// Adds the names of the piece that the pattern calls so.
    pub(crate) fn insert(&mut self, piece: &str, names: PieceNames) {
        self.0.insert(piece.to_owned(), names);
    }

    /// The parts of an edge or line in the file, from its start; empty where the file has none.
    pub(crate) fn edge(&self, edge: &EdgeRef) -> Vec<EdgeRef> {
        let Some(names) = self.0.get(&edge.panel) else { return Vec::new() };
        let parts = names.edges.get(&edge.edge).map_or(&[][..], Vec::as_slice);
        parts.iter().map(|part| EdgeRef { panel: names.piece.clone(), edge: part.clone() }).collect()
    }
}

/// The name, with a number behind it where it is taken already.
pub(crate) fn unique(taken: &mut BTreeSet<String>, name: &str) -> String {
    let mut out = name.to_owned();
    let mut k = 1;
    while !taken.insert(out.clone()) {
        k += 1;
        out = format!("{name}_{k}");
    }
    out
}

/// A name in one line: control characters and characters that XML does not know become spaces, of
/// which none stand at its ends.
pub(crate) fn one_line(name: &str, most: usize) -> String {
    let plain = |c: char| {
        if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}' | '\u{2028}' | '\u{2029}') { ' ' } else { c }
    };
    let text: String = name.chars().map(plain).collect();
    text.trim().chars().take(most).collect::<String>().trim().to_owned()
}

/// A name of a piece that a file of seams can name: without points, not beginning with a minus, not
/// empty.
pub(crate) fn sewable(name: &str) -> String {
    let bare = name.replace('.', "_");
    let bare = match bare.strip_prefix('-') {
        Some(rest) => format!("_{rest}"),
        None => bare,
    };
    if bare.is_empty() { "piece".to_owned() } else { bare }
}
