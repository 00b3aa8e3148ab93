//! Seams as stitches of the format, each of which joins one edge to one edge.
//!
//! Method: the curves of both sides of a seam are cut until they meet one to one, at the same
//! shares of the sides' lengths. The start of the first edge meets the end of the second, unless
//! `right_wrong` stands with the stitch. Cost: linear in the curves. Limits: the format has no seam
//! of three sides, none along a line inside a piece, and no edge in two of them; such a seam is
//! left out, which is told.

use super::curve::FileCurve;
use std::collections::BTreeSet;
use toile_core::artifact::{EdgeUse, Pattern, PatternSeam, SeamKind, lacking_stops};

/// Ends of curves on both sides of a seam that are this near to each other belong together, metres.
const NEAR: f64 = 2e-3;
/// As are those this share of the side apart.
const NEAR_SHARE: f64 = 0.01;

/// The curves of each edge of each piece.
pub(super) type CurvesOfEdges = Vec<Vec<Vec<FileCurve>>>;
/// An edge of a piece, both by their numbers, and whether a side runs along it from its end.
type EdgeLink = (usize, usize, bool);

/// A stitch between two curves: piece, edge, and which of the edge's curves.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct CurveStitch {
    pub sides: [(usize, usize, usize); 2],
    /// Whether start meets start.
    pub right_wrong: bool,
}

/// The stitches of all seams that the format holds; curves are cut for them, and what is left out
/// is told.
pub(super) fn stitches(
    pattern: &Pattern,
    curves: &mut CurvesOfEdges,
    told: &mut Vec<String>,
) -> Vec<CurveStitch> {
    let mut sewn = BTreeSet::new();
    let mut kept: Vec<(&PatternSeam, [Vec<EdgeLink>; 2])> = Vec::new();
    for seam in &pattern.seams {
        match sides(pattern, seam, &mut sewn) {
            Ok(sides) => kept.push((seam, sides)),
            Err(why) => told.push(format!("the seam \"{}\" is not among the stitches: {why}", seam.name)),
        }
    }
    for (_, [a, b]) in &kept {
        agree(curves, a, b);
    }
    kinds(&kept, told);
    kept.iter().flat_map(|(_, [a, b])| paired(curves, a, b)).collect()
}

/// The sides of a seam that the format holds; else why it does not.
fn sides(
    pattern: &Pattern,
    seam: &PatternSeam,
    sewn: &mut BTreeSet<(usize, usize)>,
) -> Result<[Vec<EdgeLink>; 2], String> {
    let [a, b] = &seam.sides[..] else {
        return Err(format!("it has {} sides, a stitch has 2", seam.sides.len()));
    };
    let link = |u: &EdgeUse| {
        let i = pattern.pieces.iter().position(|p| p.name == u.edge.panel);
        let found = i.and_then(|i| Some((i, pattern.pieces[i].edge_number(&u.edge.edge)?, u.reversed)));
        found.ok_or_else(|| format!("{} is a line inside its piece, a stitch joins outer edges", u.edge))
    };
    let links = |side: &[EdgeUse]| side.iter().map(link).collect::<Result<Vec<EdgeLink>, String>>();
    let sides = [links(a)?, links(b)?];
    let mut mine = BTreeSet::new();
    for (u, link) in a.iter().chain(b).zip(sides.iter().flatten()) {
        if sewn.contains(&(link.0, link.1)) || !mine.insert((link.0, link.1)) {
            return Err(format!("{} is sewn twice, a stitch joins an edge once", u.edge));
        }
    }
    sewn.extend(mine);
    Ok(sides)
}

/// Tells kinds of seams that are lost.
fn kinds(kept: &[(&PatternSeam, [Vec<EdgeLink>; 2])], told: &mut Vec<String>) {
    let lost = |k: SeamKind| !matches!(k, SeamKind::Matched | SeamKind::Dart | SeamKind::Gathered);
    let names: Vec<String> = kept
        .iter()
        .filter(|(s, _)| lost(s.kind))
        .map(|(s, _)| format!("\"{}\" ({})", s.name, s.kind.word()))
        .collect();
    if !names.is_empty() {
        told.push(format!("the format has no kinds of seams: {} are plain stitches in it", names.join(", ")));
    }
}

/// Cuts the curves of either side where only the other has an end of one.
fn agree(curves: &mut CurvesOfEdges, a: &[EdgeLink], b: &[EdgeLink]) {
    let [(sa, la), (sb, lb)] = [stops(curves, a), stops(curves, b)];
    let near = (NEAR / la.min(lb)).max(NEAR_SHARE);
    let (in_b, in_a) = lacking_stops(&sa, &sb, near);
    in_a.into_iter().for_each(|share| cut(curves, a, share * la));
    in_b.into_iter().for_each(|share| cut(curves, b, share * lb));
}

/// A curve as a link of a side.
#[derive(Debug, Clone, Copy)]
struct CurveLink {
    piece: usize,
    edge: usize,
    /// Which of the edge's curves.
    curve: usize,
    /// Whether the side runs along it from its end.
    reversed: bool,
}

/// The curves of a side, in its order.
fn chain(curves: &CurvesOfEdges, side: &[EdgeLink]) -> Vec<CurveLink> {
    let mut out = Vec::new();
    for &(piece, edge, reversed) in side {
        let n = curves[piece][edge].len();
        let number = |k: usize| if reversed { n - 1 - k } else { k };
        out.extend((0..n).map(|k| CurveLink { piece, edge, curve: number(k), reversed }));
    }
    out
}

fn length(curves: &CurvesOfEdges, s: &CurveLink) -> f64 {
    curves[s.piece][s.edge][s.curve].length()
}

/// Where the curves of a side meet as shares of its length, ascending, and its length, metres.
fn stops(curves: &CurvesOfEdges, side: &[EdgeLink]) -> (Vec<f64>, f64) {
    let (mut whole, mut stops) = (0.0, Vec::new());
    for step in chain(curves, side) {
        whole += length(curves, &step);
        stops.push(whole);
    }
    stops.pop();
    stops.iter_mut().for_each(|s| *s /= whole);
    (stops, whole)
}

/// Cuts the curve of a side at that length from the side's start, metres; never at an end of a
/// curve.
fn cut(curves: &mut CurvesOfEdges, side: &[EdgeLink], at: f64) {
    let mut before = 0.0;
    for step in chain(curves, side) {
        let length = length(curves, &step);
        if at < before + length {
            let from_start = if step.reversed { before + length - at } else { at - before };
            if from_start > 0.0 && from_start < length {
                let of_edge = &mut curves[step.piece][step.edge];
                let parts = of_edge[step.curve].cut(from_start);
                of_edge.splice(step.curve..=step.curve, parts);
            }
            return;
        }
        before += length;
    }
}

/// The curves of both sides, one to one.
fn paired(curves: &CurvesOfEdges, a: &[EdgeLink], b: &[EdgeLink]) -> Vec<CurveStitch> {
    let at = |s: &CurveLink| (s.piece, s.edge, s.curve);
    let pairs = chain(curves, a).into_iter().zip(chain(curves, b));
    pairs
        .map(|(x, y)| CurveStitch { sides: [at(&x), at(&y)], right_wrong: x.reversed == y.reversed })
        .collect()
}
