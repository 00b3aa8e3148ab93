//! Names as the reader of drawings takes them.
//!
//! The reader tells what a line is for by the words of its name, such as `fold` or `notch`; a name
//! with such a word would change what the line is. A label has at most 80 characters there, and no
//! point, which would end the name of a piece where seams name an edge.

use super::words::tells;
use crate::names::{PieceNames, one_line, sewable, unique};
use std::collections::BTreeSet;

/// Characters of a name; the reader takes 80, and numbers may be put behind.
const MOST: usize = 70;
/// The words of a name in small letters, and whether one of them says what a line is for.
fn words(name: &str) -> (usize, bool) {
    let parts = name.split(|c: char| !c.is_alphabetic()).filter(|w| !w.is_empty()).map(str::to_lowercase);
    let parts: Vec<String> = parts.collect();
    (parts.len(), parts.iter().any(|w| tells(w)))
}

/// The label of a piece's group, unlike those that are taken.
pub(super) fn of_piece(name: &str, taken: &mut BTreeSet<String>) -> String {
    let bare = sewable(&one_line(name, MOST));
    // A group of one or two words says what its lines are for.
    let (count, says) = words(&bare);
    let told = if says && count <= 2 { format!("{bare} of the garment") } else { bare };
    unique(taken, &told)
}

/// The label of an edge, unlike those that are taken: its own where that says nothing of a role,
/// else one by its number.
fn of_edge(name: &str, k: usize, taken: &mut BTreeSet<String>) -> String {
    let bare = one_line(name, MOST);
    let kept = bare == name && !words(name).1 && !name.contains('.') && !taken.contains(name);
    unique(taken, &if kept { name.to_owned() } else { format!("edge_{k}") })
}

/// The labels of a piece's edges, each with the number of its parts, and of its lines that are
/// drawn.
pub(super) fn of_edges(label: &str, edges: &[(&str, usize)], lines: &[&str]) -> PieceNames {
    let mut taken: BTreeSet<String> = (0..lines.len()).map(|k| format!("line_{k}")).collect();
    let mut names = PieceNames { piece: label.to_owned(), ..PieceNames::default() };
    // Names that can be kept come first, so that none is given to another edge.
    let keeps = |(name, parts): &(&str, usize)| {
        *parts == 1 && !words(name).1 && !name.contains('.') && one_line(name, MOST) == *name
    };
    let mut named: Vec<Vec<String>> = vec![Vec::new(); edges.len()];
    for keep in [true, false] {
        for (k, edge) in edges.iter().enumerate().filter(|(_, e)| keeps(e) == keep) {
            named[k] = (0..edge.1).map(|_| of_edge(edge.0, k, &mut taken)).collect();
        }
    }
    names.edges.extend(edges.iter().zip(named).map(|((name, _), parts)| ((*name).to_owned(), parts)));
    names
        .edges
        .extend(lines.iter().enumerate().map(|(k, name)| ((*name).to_owned(), vec![format!("line_{k}")])));
    names
}
