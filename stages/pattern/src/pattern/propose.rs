//! Proposes seams for pieces that come without any; never for a person to trust blindly.
//!
//! Method: [`score`] says how likely two edges are sewn to each other, [`around`] the same of rings
//! and stretches of the free edges, and [`choose`] takes the likeliest first. What is left of
//! sleeves, bands and seams in the middle [`rings`] and [`rule`] find by rule. Cost: edges squared
//! a round, some hundredths of a second for a garment of twenty pieces. Limits: pieces are taken to
//! be seen from outside, the grain up; a piece that is drawn upside down, a pocket and a second
//! layer are not understood.

mod around;
mod border;
mod choose;
#[cfg(test)]
mod examples;
mod rings;
mod rule;
mod score;
#[cfg(test)]
mod scored;
mod sheet;

use border::Border;
use choose::Found;
use score::notches_agree;
use sheet::{PARTS, Sheet};
use toile_core::prelude::*;

/// Shorter edges are not told apart, metres.
const SHORTEST: f64 = 0.004;
/// Where an edge is longer than this, metres, nothing is proposed: the numbers are not of a
/// garment, and points on a curve of that length take minutes to find.
const LONGEST_EDGE: f64 = 100.0;
/// Edges of a garment that are compared; with more nothing is proposed.
const MOST: usize = 2_000;
/// Edges that lie on each other to this are a slit, metres.
const SLIT: f64 = 2e-3;
/// The confidence of a slit, and the greatest.
const SURE: f64 = 0.99;
/// Nothing of less confidence is proposed.
const LEAST: f64 = 0.5;
/// Sides whose lengths differ by more than this share are gathered.
const GATHERED: f64 = 0.1;

/// A seam that is proposed; [`proposed_seams`] gives them.
#[derive(Debug, Clone, PartialEq)]
pub struct ProposedSeam {
    /// The seam, by the edges of the pieces.
    pub seam: PatternSeam,
    /// How likely it is right, 0.5 to 0.99.
    pub confidence: f64,
    /// What it was judged by: the lengths of its sides, ease, notches.
    pub reason: String,
}

/// The seams that are proposed for pieces, the surest first; none for pieces that are larger or
/// more than those of a garment. Seams that the pieces have already are not known to it.
pub fn proposed_seams(pieces: &[Piece]) -> Vec<ProposedSeam> {
    let is_garment = |p: &Piece| (0..p.outer.edges.len()).all(|k| p.outer.path(k).length() <= LONGEST_EDGE);
    if !pieces.iter().all(is_garment) {
        return Vec::new();
    }
    let sheet = Sheet::of(pieces);
    if sheet.edges.len() > MOST {
        return Vec::new();
    }
    let mut border = Border::of(&sheet);
    let mut found = Vec::new();
    for (a, b) in slits(&sheet) {
        if border.free[a] && border.free[b] {
            border.sew(&sheet, &[a], &[b]);
            found.push(Found { sides: [vec![a], vec![b]], sure: SURE });
        }
    }
    found.extend(choose::choose(&sheet, &mut border, SHORTEST, LEAST));
    found.extend(rule::by_rule(&sheet, &mut border));
    found.sort_by(|a, b| b.sure.total_cmp(&a.sure));
    let mut out: Vec<ProposedSeam> = found.iter().map(|f| seam(f, &sheet, pieces)).collect();
    out.extend(rings::attach(pieces, &out));
    out
}

/// Pairs of edges of a piece that lie on each other, one run through backwards: a ring that is cut
/// open to be sewn again.
fn slits(sheet: &Sheet) -> Vec<(usize, usize)> {
    let ends = |e: usize| (sheet.edges[e].points[0], sheet.edges[e].points[PARTS]);
    let meet = |&(i, j): &(usize, usize)| {
        let ((a, b), (c, d)) = (ends(i), ends(j));
        let lengths = [i, j].map(|e| sheet.edges[e].length);
        let long = lengths[0].min(lengths[1]) > 3.0 * SLIT;
        long && (a - d).norm() <= SLIT && (b - c).norm() <= SLIT && (lengths[0] - lengths[1]).abs() <= SLIT
    };
    let n = sheet.edges.len();
    let same = |i: usize| (i + 1..n).take_while(move |j| sheet.edges[*j].piece == sheet.edges[i].piece);
    (0..n).flat_map(|i| same(i).map(move |j| (i, j))).filter(meet).collect()
}

/// Whether two edges of a piece are the legs of a dart: they meet where the piece turns inwards.
fn is_dart(sheet: &Sheet, [a, b]: &[Vec<usize>; 2]) -> bool {
    let ([a], [b]) = (&a[..], &b[..]) else { return false };
    let inwards = |x: usize, y: usize| sheet.next[x] == y && sheet.angle[y] > 180.0;
    inwards(*a, *b) != inwards(*b, *a)
}

fn seam(found: &Found, sheet: &Sheet, pieces: &[Piece]) -> ProposedSeam {
    let used = |e: &usize, reversed: bool| {
        let edge = &sheet.edges[*e];
        let piece = &pieces[edge.piece];
        let name = piece.outer.edges[edge.number].name.clone();
        EdgeUse { edge: EdgeRef { panel: piece.name.clone(), edge: name }, reversed }
    };
    let [a, b] = &found.sides;
    let sides: Vec<Vec<EdgeUse>> =
        vec![a.iter().map(|e| used(e, false)).collect(), b.iter().rev().map(|e| used(e, true)).collect()];
    let words = |s: &[EdgeUse]| s.iter().map(|u| u.edge.to_string()).collect::<Vec<_>>().join(" ");
    let name = format!("{} + {}", words(&sides[0]), words(&sides[1]));
    let length = |s: &[usize]| s.iter().map(|e| sheet.edges[*e].length).sum::<f64>();
    let (x, y) = (length(a), length(b));
    let more = x.max(y) / x.min(y).max(1e-9) - 1.0;
    let kind = if is_dart(sheet, &found.sides) {
        SeamKind::Dart
    } else if more > GATHERED {
        SeamKind::Gathered
    } else {
        SeamKind::Matched
    };
    let notches = match (&a[..], &b[..]) {
        ([a], [b]) => notches_agree(&sheet.edges[*a], &sheet.edges[*b]),
        _ => None,
    };
    let notches = match notches {
        Some(true) => ", notches agree",
        Some(false) => ", notches differ",
        None => "",
    };
    let eased = if more > 0.01 { format!(", {:+.1} % ease", (x / y - 1.0) * 1e2) } else { String::new() };
    let reason = format!("{:.1} mm to {:.1} mm{eased}{notches}", x * 1e3, y * 1e3);
    ProposedSeam { seam: PatternSeam { name, kind, sides }, confidence: found.sure.min(SURE), reason }
}
