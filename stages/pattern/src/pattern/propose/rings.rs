//! Proposes what is sewn into a ring of edges: a sleeve into an armhole, a band along a waist.
//!
//! Method: the free edges that meet end to end once the seams before are sewn form rings: an edge
//! is followed by the next of its piece, across a seam by the next of the other piece. A tube's
//! ring of one edge (the cap of a sleeve) is sewn into a ring of several; it begins where the
//! tube's own seam ends, there at the lowest corner. Notches decide between two armholes. A long
//! edge of a band is sewn along a ring that is no hem. Lengths differ by the ease that tailors
//! give. Cost: rings squared. Limits: tubes of one piece; a band around an open front is not found.

use super::ProposedSeam;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::prelude::*;

/// By how much a length may differ from that of what it is sewn along.
struct LengthTolerance {
    /// Shorter by this share of the other length at most.
    shorter: f64,
    /// Longer by this share of the other length at most.
    longer: f64,
}

/// A cap may be shorter and longer than its armhole by these shares.
const CAP: LengthTolerance = LengthTolerance { shorter: 0.02, longer: 0.08 };
/// A band may be shorter and longer than what it is sewn along by these shares.
const BAND: LengthTolerance = LengthTolerance { shorter: 0.02, longer: 0.02 };
/// A long edge of a band is longer than this share of the band's outline.
const LONG: f64 = 0.4;
/// Notches that are farther apart than this say nothing, metres.
const NOTCHES: f64 = 0.03;

/// An edge is an end of a piece if the sine of its angle to the cross grain is at most this.
const ACROSS: f64 = 0.45;
/// An end also lies within this share of the piece's length from its lowest or highest point.
const END: f64 = 0.12;
/// A piece this many times longer than wide is a band.
const SLENDER: f64 = 4.0;

/// An edge with what is compared.
struct Candidate {
    length: f64,
    /// Whether it ends its piece below.
    low: bool,
    band: bool,
}

fn candidate(p: &Piece, k: usize) -> Candidate {
    let path = p.outer.path(k);
    let length = path.length();
    let corners = p.outer.points().0;
    let least = corners.iter().fold(Point2::new(f64::MAX, f64::MAX), |a, q| a.inf(q));
    let most = corners.iter().fold(Point2::new(f64::MIN, f64::MIN), |a, q| a.sup(q));
    let [wide, tall] = [most.x - least.x, most.y - least.y];
    let (start, end) = (path.at(0.0), path.at(length));
    let near = path.points().iter().all(|q| (q.y - least.y).abs() <= END * tall);
    let across = (end.y - start.y).abs() <= ACROSS * (end - start).norm();
    Candidate { length, low: across && near, band: wide.max(tall) >= SLENDER * wide.min(tall) }
}

/// Whether one piece is the other's mirror image, by their names.
fn mirror_of(a: &str, b: &str) -> bool {
    let is = |x: &str, y: &str| x.strip_suffix("_mirrored") == Some(y);
    is(a, b) || is(b, a)
}

/// An edge: the numbers of its piece and of it.
type At = (usize, usize);

/// A ring of free edges, counter-clockwise in each piece, and whether it crosses a seam before each
/// of them.
struct Ring {
    edges: Vec<At>,
    hops: Vec<bool>,
    length: f64,
}

/// Seams that attach tubes and bands to rings, the surest first.
pub(super) fn attach(pieces: &[Piece], sewn: &[ProposedSeam]) -> Vec<ProposedSeam> {
    let rings = rings(pieces, sewn);
    let one = |&(i, k): &At| candidate(&pieces[i], k);
    let around: Vec<&Ring> =
        rings.iter().filter(|r| r.edges.len() > 1 && r.hops.iter().any(|h| *h)).collect();
    // What ends a garment below, and what is no tube's, takes no sleeve.
    let is_hem = |r: &Ring| r.edges.iter().all(|e| one(e).low);
    let mut found: Vec<(f64, At, usize, Vec<At>)> = Vec::new();
    let caps = rings.iter().filter(|r| r.edges.len() == 1 && !one(&r.edges[0]).low);
    for cap in caps {
        for (n, ring) in around.iter().enumerate().filter(|(_, r)| !is_hem(r)) {
            let own = ring.edges.iter().any(|e| e.0 == cap.edges[0].0);
            if let Some(exact) = fits(cap.length, ring.length, &CAP).filter(|_| !own) {
                let from = lowest(pieces, ring);
                let told = notches(pieces, cap.edges[0], &from);
                let sure = told.map_or(0.6, |apart| 0.95 - 0.3 * (apart / NOTCHES).min(1.0));
                found.push((exact * sure, cap.edges[0], n, from));
            }
        }
    }
    let free: BTreeSet<At> = rings.iter().flat_map(|r| r.edges.iter().copied()).collect();
    let bands = free.iter().filter(|e| {
        let c = one(e);
        c.band && c.length > LONG * perimeter(&pieces[e.0])
    });
    for band in bands {
        for (n, ring) in around.iter().enumerate().filter(|(_, r)| !is_hem(r)) {
            let own = ring.edges.iter().any(|e| e.0 == band.0);
            if let Some(exact) = fits(one(band).length, ring.length, &BAND).filter(|_| !own) {
                found.push((0.8 * exact, *band, n, opening(pieces, ring)));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let (mut used, mut taken) = (BTreeSet::new(), BTreeSet::new());
    let mut out = Vec::new();
    for (score, edge, n, ring) in found {
        // One edge of a piece, and one piece a ring.
        if score >= super::LEAST && !used.contains(&edge.0) && taken.insert(n) {
            used.insert(edge.0);
            out.push(seam(pieces, edge, &ring, score, &one(&edge)));
        }
    }
    out
}

fn perimeter(piece: &Piece) -> f64 {
    (0..piece.outer.edges.len()).map(|k| piece.outer.path(k).length()).sum()
}

/// How well a length fits another, between 0.75 and 1; none where it is too short or too long.
fn fits(own: f64, other: f64, tolerance: &LengthTolerance) -> Option<f64> {
    let more = own / other - 1.0;
    let share = if more < 0.0 { -more / tolerance.shorter } else { more / tolerance.longer };
    (share <= 1.0).then_some(1.0 - 0.25 * share)
}

/// The rings of the edges that no seam takes.
fn rings(pieces: &[Piece], sewn: &[ProposedSeam]) -> Vec<Ring> {
    let after = partners(pieces, sewn);
    let all = pieces.iter().enumerate().flat_map(|(i, p)| (0..p.outer.edges.len()).map(move |k| (i, k)));
    let free: BTreeSet<At> = all.filter(|at| !after.contains_key(at)).collect();
    let next = |(i, k): At| (i, (k + 1) % pieces[i].outer.edges.len());
    let mut seen: BTreeSet<At> = BTreeSet::new();
    let mut out = Vec::new();
    for &first in &free {
        let mut ring = Ring { edges: Vec::new(), hops: Vec::new(), length: 0.0 };
        let mut at = first;
        let mut crossed = false;
        while seen.insert(at) {
            ring.edges.push(at);
            ring.hops.push(crossed);
            ring.length += pieces[at.0].outer.path(at.1).length();
            at = next(at);
            crossed = false;
            for _ in 0..after.len() {
                let Some(Some(last)) = after.get(&at) else { break };
                at = next(*last);
                crossed = true;
            }
            if !free.contains(&at) {
                break;
            }
        }
        if at == first && !ring.edges.is_empty() {
            ring.hops[0] = crossed;
            out.push(ring);
        }
    }
    out
}

/// For every sewn edge with which a side of a seam begins, the edge with which the other side ends;
/// none for the other sewn edges.
fn partners(pieces: &[Piece], sewn: &[ProposedSeam]) -> BTreeMap<At, Option<At>> {
    let at = |u: &EdgeUse| {
        let i = pieces.iter().position(|p| p.name == u.edge.panel)?;
        Some((i, pieces[i].edge_number(&u.edge.edge)?))
    };
    // Counter-clockwise in the piece.
    let run = |side: &Vec<EdgeUse>| {
        let mut edges: Vec<At> = side.iter().filter_map(at).collect();
        if side.first().is_some_and(|u| u.reversed) {
            edges.reverse();
        }
        edges
    };
    let mut out = BTreeMap::new();
    for ProposedSeam { seam, .. } in sewn {
        let sides: Vec<Vec<At>> = seam.sides.iter().map(run).collect();
        let [a, b] = &sides[..] else { continue };
        for (one, other) in [(a, b), (b, a)] {
            out.extend(one.iter().map(|e| (*e, None)));
            if let (Some(first), Some(last)) = (one.first(), other.last()) {
                out.insert(*first, Some(*last));
            }
        }
    }
    out
}

/// The edges of a ring, beginning with the one of that number.
fn from(ring: &Ring, k: usize) -> Vec<At> {
    [&ring.edges[k..], &ring.edges[..k]].concat()
}

/// The ring from where two pieces meet lowest: under the arm.
fn lowest(pieces: &[Piece], ring: &Ring) -> Vec<At> {
    let height = |k: &usize| {
        let (i, e) = ring.edges[*k];
        pieces[i].outer.corners[e].y
    };
    let hops = (0..ring.edges.len()).filter(|k| ring.hops[*k]);
    from(ring, hops.min_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or(0))
}

/// The ring from where a piece meets its mirror image, else from where two pieces meet.
fn opening(pieces: &[Piece], ring: &Ring) -> Vec<At> {
    let before = |k: usize| ring.edges[(k + ring.edges.len() - 1) % ring.edges.len()].0;
    let twins = |k: &usize| mirror_of(&pieces[before(*k)].name, &pieces[ring.edges[*k].0].name);
    let hops = || (0..ring.edges.len()).filter(|k| ring.hops[*k]);
    let apart = |k: &usize| before(*k) != ring.edges[*k].0;
    from(ring, hops().find(twins).or_else(|| hops().find(apart)).unwrap_or(0))
}

/// The mean distance between the notches of an edge and those of a ring that is sewn to it, both
/// from their start; none where their numbers differ.
fn notches(pieces: &[Piece], edge: At, ring: &[At]) -> Option<f64> {
    let along = |(i, k): At| {
        let p = &pieces[i];
        let on = p.notches.iter().filter(move |n| n.edge == p.outer.edges[k].name);
        on.map(|n| n.along).collect::<Vec<f64>>()
    };
    let own = along(edge);
    let mut other = Vec::new();
    let mut before = 0.0;
    // The ring runs the other way.
    for &at in ring.iter().rev() {
        let length = pieces[at.0].outer.path(at.1).length();
        other.extend(along(at).iter().map(|n| before + length - n));
        before += length;
    }
    let length = pieces[edge.0].outer.path(edge.1).length();
    // Ease lies between the notches: from either end they are as far.
    let near = |n: &f64| {
        let apart = |m: &f64| (n - m).abs().min(((length - n) - (before - m)).abs());
        other.iter().map(apart).fold(f64::INFINITY, f64::min)
    };
    (!own.is_empty() && own.len() <= other.len())
        .then(|| own.iter().map(near).sum::<f64>() / own.len() as f64)
}

fn seam(pieces: &[Piece], edge: At, ring: &[At], score: f64, c: &Candidate) -> ProposedSeam {
    let used = |(i, k): At, reversed: bool| EdgeUse {
        edge: EdgeRef { panel: pieces[i].name.clone(), edge: pieces[i].outer.edges[k].name.clone() },
        reversed,
    };
    let sides =
        vec![vec![used(edge, false)], ring.iter().rev().map(|at| used(*at, true)).collect::<Vec<_>>()];
    let words = |s: &[EdgeUse]| s.iter().map(|u| u.edge.to_string()).collect::<Vec<_>>().join(" ");
    let name = format!("{} + {}", words(&sides[0]), words(&sides[1]));
    let whole: f64 = ring.iter().map(|at| pieces[at.0].outer.path(at.1).length()).sum();
    let (x, y) = (c.length * 1e3, whole * 1e3);
    let reason = format!("{x:.1} mm to {y:.1} mm around, {:+.1} % ease", (x / y - 1.0) * 1e2);
    let seam = PatternSeam { name, kind: SeamKind::Matched, sides };
    ProposedSeam { seam, confidence: score, reason }
}
