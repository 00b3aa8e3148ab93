//! Seams that are sewn and opened by hand, and pieces that are taken out.

use super::names;
use toile_core::nearest;
use toile_core::prelude::*;

/// Threads of a pairing are this much longer than those of the other one where it is a wrong one.
const CROSSED: f64 = 1.25;
/// Points on an edge at which its threads are measured.
const THREADS: usize = 9;

/// Sews two edges together.
pub(super) fn sew(
    pattern: &mut Pattern,
    edges: [&EdgeRef; 2],
    reversed: bool,
    cx: &Context,
) -> Result<(), StageError> {
    for edge in edges {
        names::edge(pattern, edge)?;
        check_open(pattern, edge)?;
    }
    let [a, b] = edges;
    if a == b {
        return Err(StageError::invalid(format!("the edge \"{a}\" cannot be sewn to itself"))
            .hint("name two edges; a dart parts an edge"));
    }
    let name = free_name(pattern, &format!("{a} + {b}"));
    let [from, to] = edges.map(|e| places(pattern, e));
    if let (Some(from), Some(to)) = (from, to)
        && threads(&from, &to, reversed) > CROSSED * threads(&from, &to, !reversed)
    {
        cx.warn(format!(
            "as the pieces stand, the threads of the seam \"{name}\" cross: is `reversed: {}` meant?",
            !reversed
        ));
    }
    let side = |edge: &EdgeRef, reversed: bool| vec![EdgeUse { edge: edge.clone(), reversed }];
    pattern.seams.push(PatternSeam {
        name,
        kind: SeamKind::Matched,
        sides: vec![side(a, false), side(b, !reversed)],
    });
    Ok(())
}

/// An edge is sewn to nothing.
pub(super) fn check_open(pattern: &Pattern, edge: &EdgeRef) -> Result<(), StageError> {
    match pattern.seams.iter().find(|s| is_of(s, edge)) {
        Some(seam) => Err(StageError::invalid(format!(
            "the edge \"{edge}\" is sewn already, in the seam \"{}\"",
            seam.name
        ))
        .hint(format!("open it before: Unsew(edge: \"{edge}\")"))),
        None => Ok(()),
    }
}

/// Opens every seam of an edge or line.
pub(super) fn unsew(pattern: &mut Pattern, edge: &EdgeRef, cx: &Context) -> Result<(), StageError> {
    let (open, sewn): (Vec<PatternSeam>, Vec<PatternSeam>) =
        std::mem::take(&mut pattern.seams).into_iter().partition(|s| is_of(s, edge));
    pattern.seams = sewn;
    open.iter().for_each(|s| cx.note(format!("the seam \"{}\" is open", s.name)));
    match open.is_empty() {
        false => Ok(()),
        true => Err(unsewn(pattern, edge)),
    }
}

/// Takes a piece out of the pattern, with every seam that has it.
pub(super) fn remove(pattern: &mut Pattern, piece: &str, cx: &Context) -> Result<(), StageError> {
    let p = names::piece(pattern, piece)?;
    if pattern.pieces.len() == 1 {
        return Err(StageError::invalid(format!("\"{piece}\" is the only piece"))
            .hint("take the garment out of the pipeline's input instead"));
    }
    pattern.pieces.remove(p);
    let has = |s: &PatternSeam| s.sides.iter().flatten().any(|u| u.edge.panel == piece);
    pattern.seams.iter().filter(|s| has(s)).for_each(|s| cx.note(format!("the seam \"{}\" is open", s.name)));
    pattern.seams.retain(|s| !has(s));
    Ok(())
}

fn unsewn(pattern: &Pattern, edge: &EdgeRef) -> StageError {
    let piece = pattern.piece(&edge.panel);
    if piece.is_none_or(|p| p.path(&edge.edge).is_none())
        && let Err(unknown) = names::edge(pattern, edge)
    {
        return unknown;
    }
    let mut sewn: Vec<String> =
        pattern.seams.iter().flat_map(|s| s.sides.iter().flatten()).map(|u| u.edge.to_string()).collect();
    sewn.sort();
    sewn.dedup();
    let own: Vec<&str> = sewn
        .iter()
        .filter(|e| e.strip_prefix(&edge.panel).is_some_and(|e| e.starts_with('.')))
        .map(String::as_str)
        .collect();
    let hint = match nearest(&edge.to_string(), sewn.iter().map(String::as_str)) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None if own.is_empty() => format!("no edge of \"{}\" is sewn", edge.panel),
        None => format!("the edges of \"{}\" that are sewn are {}", edge.panel, own.join(", ")),
    };
    StageError::invalid(format!("no seam has the edge \"{edge}\"")).hint(hint)
}

fn is_of(seam: &PatternSeam, edge: &EdgeRef) -> bool {
    seam.sides.iter().flatten().any(|u| u.edge == *edge)
}

/// The name, numbered where a seam has it.
pub(super) fn free_name(pattern: &Pattern, name: &str) -> String {
    let is_taken = |name: &str| pattern.seams.iter().any(|s| s.name == name);
    let numbered = (2..).map(|n| format!("{name} {n}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|n| !is_taken(n)).unwrap_or_default()
}

/// Where points of an edge stand in space, evenly along it; none where its piece stands nowhere.
fn places(pattern: &Pattern, edge: &EdgeRef) -> Option<[Point3; THREADS]> {
    let piece = pattern.piece(&edge.panel)?;
    let (pose, path) = (piece.pose?, piece.path(&edge.edge)?);
    let at = |k: usize| path.length() * k as f64 / (THREADS - 1) as f64;
    Some(std::array::from_fn(|k| pose.at(path.at(at(k)))))
}

/// How long the threads between two edges are, the pieces moved onto each other.
fn threads(a: &[Point3; THREADS], b: &[Point3; THREADS], reversed: bool) -> f64 {
    let middle = |t: &[Point3; THREADS]| t.iter().map(|p| p.coords).sum::<Vector3>() / THREADS as f64;
    let apart = middle(b) - middle(a);
    (0..THREADS).map(|k| (b[if reversed { k } else { THREADS - 1 - k }] - a[k] - apart).norm()).sum()
}
