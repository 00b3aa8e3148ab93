//! Proposes seams for pieces that come without any, from the lengths of their edges, where they lie
//! along the grain, notches and symmetry; never for a person to trust blindly.
//!
//! Method: a candidate is a pair of edges, or an edge and a chain of two, of nearly equal lengths,
//! which may meet start to end as pieces do that are seen from outside; the edges must run alike
//! along the grain. Hems, necks and waists are left out: an end of a piece across the grain that
//! covers its middle is sewn to no end on the same side of another piece, unless one of them is a
//! band; a shoulder lies beside the middle. Of what is left the best is taken, then the best of
//! what that leaves; then [`rings`] finds what is sewn around. Cost: edges squared. Limits: lengths
//! must agree, so that gathers and long eases are not found; a piece that is drawn upside down is
//! not seen.

mod rings;

use std::collections::BTreeSet;
use toile_core::prelude::*;

/// Shorter edges are not told apart, metres.
const SHORTEST: f64 = 0.012;
/// Lengths agree to this, metres, or to [`LENGTH_TOLERANCE_SHARE`].
const LENGTH_TOLERANCE: f64 = 1e-3;
/// The share of the longer one to which lengths agree where that is more than [`LENGTH_TOLERANCE`].
const LENGTH_TOLERANCE_SHARE: f64 = 0.002;
/// An edge is an end of a piece if the sine of its angle to the cross grain is at most this.
const ACROSS: f64 = 0.45;
/// An end also lies within this share of the piece's length from its lowest or highest point.
const END: f64 = 0.12;
/// A piece this many times longer than wide is a band.
const BAND: f64 = 4.0;
/// The legs of a dart open by no more than this, degrees.
const NOTCH: f64 = 35.0;
/// Two edges that both run into their pieces by more than this share of their length are openings,
/// such as armholes.
const HOLLOW: f64 = 0.1;
/// An edge that bulges by more than this share is no seam in the middle: the cap of a sleeve.
const BULGE: f64 = 0.2;
/// An edge whose angle to the grain has a greater sine than this is no seam in the middle either.
const LEVEL: f64 = 0.5;
/// Confidence added for an edge of a band that continues where a seam of the band ends.
const GOES_ON: f64 = 0.02;
/// Edges and chains of a garment that are compared; with more nothing is proposed.
const MOST: usize = 2_000;
/// Edges that lie on each other to this are a slit, metres.
const SLIT: f64 = 2e-3;
/// The confidence of a slit.
const SURE: f64 = 0.99;
/// Nothing of less confidence is proposed.
const LEAST: f64 = 0.5;

/// Which end of its piece an edge is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Low,
    High,
    None,
}

/// An edge with what is compared.
#[derive(Debug, Clone)]
struct Candidate {
    piece: usize,
    /// The numbers of its edges, which follow each other in the loop: one, or two as a chain.
    edges: Vec<usize>,
    length: f64,
    /// From its start to its end, as a share of its length.
    way: Vector2,
    end: End,
    /// Whether it lies over or under the middle of its piece.
    middle: bool,
    band: bool,
    /// How far it runs into its piece, as a share of the distance of its ends; below 0 where it
    /// bulges out.
    hollow: f64,
    notches: Vec<f64>,
}

/// Seams, the surest first, each with its confidence and the reasons for it.
pub(super) fn propose(pieces: &[Piece]) -> Vec<(PatternSeam, String)> {
    let mut all: Vec<Candidate> = Vec::new();
    for (i, p) in pieces.iter().enumerate() {
        let n = p.outer.edges.len();
        all.extend((0..n).map(|k| candidate(i, p, vec![k])));
        if n > 3 {
            all.extend((0..n).map(|k| candidate(i, p, vec![k, (k + 1) % n])));
        }
    }
    all.retain(|c| c.length >= SHORTEST);
    if all.len() > MOST {
        return Vec::new();
    }
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for i in 0..all.len() {
        for j in i + 1..all.len() {
            if let Some(score) = score(&all[i], &all[j], pieces) {
                pairs.push((score, i, j));
            }
        }
    }
    let edges = |i: usize, j: usize| {
        let of = |c: &Candidate| c.edges.iter().map(|&e| (c.piece, e)).collect::<Vec<_>>();
        [of(&all[i]), of(&all[j])].concat()
    };
    let mut taken: BTreeSet<(usize, usize)> = BTreeSet::new();
    let mut out = Vec::new();
    for (i, j) in slits(&all, pieces) {
        taken.extend(edges(i, j));
        out.push(seam(&all[i], &all[j], SURE, pieces));
    }
    loop {
        pairs.retain(|&(score, i, j)| score >= LEAST && edges(i, j).iter().all(|e| !taken.contains(e)));
        // Surest first, that which goes on where another seam ends before others; then in the order
        // of the file.
        let goes_on = |&(_, i, j): &(f64, usize, usize)| {
            [i, j].into_iter().any(|k| all[k].band && straight_on(&all[k], &taken, &pieces[all[k].piece]))
        };
        let rank = |pair: &(f64, usize, usize)| pair.0 + if goes_on(pair) { GOES_ON } else { 0.0 };
        let better = |a: &&(f64, usize, usize), b: &&(f64, usize, usize)| {
            rank(a).total_cmp(&rank(b)).then((b.1, b.2).cmp(&(a.1, a.2)))
        };
        let Some(&(score, i, j)) = pairs.iter().max_by(better) else {
            out.extend(rings::attach(pieces, &out));
            return out;
        };
        taken.extend(edges(i, j));
        out.push(seam(&all[i], &all[j], score, pieces));
    }
}

/// Pairs of edges of a piece that lie on each other, one run through backwards: a ring that is cut
/// open to be sewn again.
fn slits(all: &[Candidate], pieces: &[Piece]) -> Vec<(usize, usize)> {
    let single = |i: &usize| all[*i].edges.len() == 1;
    let ends = |c: &Candidate| {
        let path = pieces[c.piece].outer.path(c.edges[0]);
        (path.at(0.0), path.at(path.length()))
    };
    let meet = |i: usize, j: usize| {
        let ((a, b), (c, d)) = (ends(&all[i]), ends(&all[j]));
        (a - d).norm() <= SLIT && (b - c).norm() <= SLIT && (all[i].length - all[j].length).abs() <= SLIT
    };
    let mut out = Vec::new();
    for i in (0..all.len()).filter(single) {
        let same = |j: &usize| all[*j].piece == all[i].piece && single(j);
        out.extend((i + 1..all.len()).filter(same).filter(|&j| meet(i, j)).map(|j| (i, j)));
    }
    out
}

/// Whether the edge before or behind it in its loop is sewn already and runs the same way.
fn straight_on(c: &Candidate, taken: &BTreeSet<(usize, usize)>, piece: &Piece) -> bool {
    let n = piece.outer.edges.len();
    let beside = [(c.edges[0] + n - 1) % n, (c.edges[c.edges.len() - 1] + 1) % n];
    beside.into_iter().any(|k| {
        let path = piece.outer.path(k);
        let way = (path.at(path.length()) - path.at(0.0)) / path.length();
        taken.contains(&(c.piece, k)) && way.dot(&c.way) > 0.95
    })
}

fn candidate(piece: usize, p: &Piece, edges: Vec<usize>) -> Candidate {
    let paths: Vec<EdgePath> = edges.iter().map(|&k| p.outer.path(k)).collect();
    let length: f64 = paths.iter().map(EdgePath::length).sum();
    let points = p.outer.points().0;
    let span = |of: fn(&Point2) -> f64| {
        let all = || points.iter().map(of);
        (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max))
    };
    let (x, y) = (span(|q| q.x), span(|q| q.y));
    let (wide, tall) = (x.1 - x.0, y.1 - y.0);
    let [start, end] = [paths[0].at(0.0), paths[paths.len() - 1].at(length)];
    let own: Vec<Point2> = paths.iter().flat_map(EdgePath::points).collect();
    let near = |at: f64| own.iter().all(|q| (q.y - at).abs() <= END * tall);
    let across = (end.y - start.y).abs() <= ACROSS * (end - start).norm();
    let end_of = match (across, near(y.0), near(y.1)) {
        (true, true, _) => End::Low,
        (true, _, true) => End::High,
        _ => End::None,
    };
    let middle = (x.0 + x.1) / 2.0;
    let left = own.iter().map(|q| q.x).fold(f64::INFINITY, f64::min);
    let right = own.iter().map(|q| q.x).fold(f64::NEG_INFINITY, f64::max);
    let mut before = 0.0;
    let mut notches = Vec::new();
    for (&k, path) in edges.iter().zip(&paths) {
        let on = p.notches.iter().filter(|m| m.edge == p.outer.edges[k].name);
        notches.extend(on.map(|m| before + m.along));
        before += path.length();
    }
    // Those at its ends mark corners.
    notches.retain(|n| *n > 0.01 && *n < length - 0.01);
    Candidate {
        piece,
        edges,
        length,
        way: (end - start) / length.max(1e-9),
        end: end_of,
        middle: left < middle && middle < right,
        band: wide.max(tall) >= BAND * wide.min(tall),
        hollow: hollow(start, end, &own),
        notches,
    }
}

/// The greatest way of points to the left of a line, where a piece's inside is, or to the right, as
/// a share of its length.
fn hollow(start: Point2, end: Point2, points: &[Point2]) -> f64 {
    let chord = end - start;
    let aside = points.iter().map(|p| chord.perp(&(p - start)) / chord.norm_squared().max(1e-12));
    aside.fold(0.0, |far: f64, d| if d.abs() > far.abs() { d } else { far })
}

/// The confidence of a pair; none where it cannot be a seam.
fn score(a: &Candidate, b: &Candidate, pieces: &[Piece]) -> Option<f64> {
    // Two chains are two seams.
    if a.edges.len() + b.edges.len() > 3 {
        return None;
    }
    let apart = (a.length - b.length).abs();
    let near = LENGTH_TOLERANCE.max(LENGTH_TOLERANCE_SHARE * a.length.max(b.length));
    let shared = a.piece == b.piece && a.edges.iter().any(|e| b.edges.contains(e));
    if apart > near || shared {
        return None;
    }
    if a.piece == b.piece && !within(a, b, &pieces[a.piece]) {
        return None;
    }
    let image = mirror_of(&pieces[a.piece].name, &pieces[b.piece].name);
    // A seam in the middle runs along the grain: waists, hems and caps meet their image there and
    // are not sewn to it.
    let opening = match image {
        true => a.hollow < -BULGE || a.way.y.abs() < LEVEL,
        false => a.hollow.min(b.hollow) > HOLLOW,
    };
    if opening {
        return None;
    }
    let ends = match (a.end, b.end) {
        (End::Low, End::Low) | (End::High, End::High) => a.band || b.band || !(a.middle || b.middle),
        (End::None, End::None) => true,
        // A free end, or one that is sewn to a side of another piece: a band's.
        _ if a.piece == b.piece => false,
        _ => a.band || b.band || (a.end != End::None && b.end != End::None && !image),
    };
    if !ends || (image && a.edges != mirrored_edges(b, pieces)) {
        return None;
    }
    // Both run along the grain alike when one is run through backwards.
    let alike = (a.way.y + b.way.y).abs() <= 0.35;
    let banded = a.band != b.band;
    if !alike && !banded {
        return None;
    }
    let exact = 1.0 - 0.25 * apart / near;
    let chain = if a.edges.len() + b.edges.len() > 2 { 0.9 } else { 1.0 };
    let notches = match agree(a, b) {
        Some(true) => 1.0,
        Some(false) => 0.8,
        None => 0.92,
    };
    // An edge always fits its own mirror image: a seam in the middle where nothing else fits.
    let own = if image {
        0.7
    } else if a.piece == b.piece {
        0.95
    } else {
        1.0
    };
    let sides = if symmetric(a, pieces) == symmetric(b, pieces) || banded { 1.0 } else { 0.3 };
    // What runs along the grain is a seam more often than what ends a piece.
    let end = if a.end == End::None && b.end == End::None { 1.0 } else { 0.85 };
    Some(0.98 * exact * chain * notches * own * sides * end)
}

/// Whether two edges of one piece may be sewn to each other: an edge of an unfolded piece is not
/// sewn to its image, one end of a piece not to itself, and edges that meet in a corner only as
/// narrow a notch as a dart.
fn within(a: &Candidate, b: &Candidate, piece: &Piece) -> bool {
    let n = piece.outer.edges.len();
    let name = |k: usize| piece.outer.edges[k].name.as_str();
    let images = |i: usize, j: usize| name(i).strip_suffix("_m") == Some(name(j));
    let image = a.edges.iter().any(|&i| b.edges.iter().any(|&j| images(i, j) || images(j, i)));
    let follows = |x: &Candidate, y: &Candidate| (x.edges[x.edges.len() - 1] + 1) % n == y.edges[0];
    let corner = follows(a, b) || follows(b, a);
    let opening = a.way.normalize().dot(&-b.way.normalize()).clamp(-1.0, 1.0).acos();
    let end = a.end != End::None && a.end == b.end;
    !image && !end && (!corner || opening <= NOTCH.to_radians())
}

/// Whether notches lie at the same lengths, one edge run through backwards; none where neither has
/// any.
fn agree(a: &Candidate, b: &Candidate) -> Option<bool> {
    if a.notches.is_empty() && b.notches.is_empty() {
        return None;
    }
    let met = |n: &f64| b.notches.iter().any(|m| (n - (b.length - m)).abs() <= 4e-3);
    Some(a.notches.len() == b.notches.len() && a.notches.iter().all(met))
}

/// Whether one piece is the other's mirror image, by their names.
fn mirror_of(a: &str, b: &str) -> bool {
    let is = |x: &str, y: &str| x.strip_suffix("_mirrored") == Some(y);
    is(a, b) || is(b, a)
}

/// The numbers that the edges of a mirror image have in the piece that it is the image of.
fn mirrored_edges(c: &Candidate, pieces: &[Piece]) -> Vec<usize> {
    let n = pieces[c.piece].outer.edges.len();
    let mut out: Vec<usize> = c.edges.iter().map(|&k| n - 1 - k).collect();
    out.reverse();
    out
}

/// Whether an edge runs across the middle of a piece that was unfolded: its image is itself.
fn symmetric(c: &Candidate, pieces: &[Piece]) -> bool {
    let edges = &pieces[c.piece].outer.edges;
    let has_image = |k: &usize| {
        let name = &edges[*k].name;
        edges
            .iter()
            .any(|e| e.name == format!("{name}_m") || name.strip_suffix("_m") == Some(e.name.as_str()))
    };
    let unfolded = edges.iter().any(|e| e.name.ends_with("_m"));
    unfolded && !c.edges.iter().all(has_image)
}

fn seam(a: &Candidate, b: &Candidate, score: f64, pieces: &[Piece]) -> (PatternSeam, String) {
    let side = |c: &Candidate, reversed: bool| {
        let one = |&k: &usize| EdgeUse {
            edge: EdgeRef {
                panel: pieces[c.piece].name.clone(),
                edge: pieces[c.piece].outer.edges[k].name.clone(),
            },
            reversed,
        };
        let mut uses: Vec<EdgeUse> = c.edges.iter().map(one).collect();
        if reversed {
            uses.reverse();
        }
        uses
    };
    let sides = vec![side(a, false), side(b, true)];
    let words = |s: &[EdgeUse]| s.iter().map(|u| u.edge.to_string()).collect::<Vec<_>>().join(" ");
    let name = format!("{} + {}", words(&sides[0]), words(&sides[1]));
    let notches = match agree(a, b) {
        Some(true) => ", notches agree",
        Some(false) => ", notches differ",
        None => "",
    };
    let (x, y) = (a.length * 1e3, b.length * 1e3);
    let reason = format!("confidence {score:.2}: {x:.1} mm to {y:.1} mm{notches}");
    (PatternSeam { name, kind: SeamKind::Matched, sides }, reason)
}
