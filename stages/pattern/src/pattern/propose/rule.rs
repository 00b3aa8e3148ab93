//! Seams in the middle of the body, tubes and bands in parts by rule: the files that the scores are
//! fitted to do not have them.
//!
//! Method: of a piece that is cut twice, edges and chains of two of one length on its two sides
//! make a tube; an edge along the grain is sewn to its image where nothing else fits it, on one
//! side of the piece alone where that is straight; two edges at the top that follow each other are
//! sewn to two edges of a band of the same lengths. Cost: edges squared. Limits: a sleeve that is
//! open at the bottom looks like a piece with a seam in the middle.

use super::border::Border;
use super::choose::Found;
use super::sheet::{Sheet, bulge};

/// The confidence of what is found by rule. It is assumed, since no file with known seams has
/// these.
const SURE: f64 = 0.6;
/// Shorter edges are no seam in the middle, metres.
const LEAST: f64 = 0.06;
/// An edge that bulges by more than this share is none either.
const BULGE: f64 = 0.2;
/// A piece this many times longer than wide is a band.
const SLENDER: f64 = 4.0;
/// Lengths agree to this share: of an edge and a rival, of an edge and a band, of two edges of one
/// piece.
const AGREE: [f64; 3] = [0.0015, 0.004, 0.01];

pub(super) fn by_rule(sheet: &Sheet, border: &mut Border) -> Vec<Found> {
    let mut out = tubes(sheet, border);
    for a in 0..sheet.edges.len() {
        if let Some(b) = sheet.image[a].filter(|b| *b > a && is_middle(sheet, border, a, *b)) {
            border.sew(sheet, &[a], &[b]);
            out.push(Found { sides: [vec![a], vec![b]], sure: SURE });
        }
    }
    let mut bands: Vec<usize> = (0..sheet.edges.len()).filter(|e| is_band(sheet, *e)).collect();
    // The lower edge of a band is sewn.
    bands.sort_by(|x, y| sheet.edges[*x].out.y.total_cmp(&sheet.edges[*y].out.y));
    for x in 0..sheet.edges.len() {
        let y = border.next[x];
        let top = |e: usize| border.free[e] && sheet.edges[e].out.y > 0.5 && !is_band(sheet, e);
        if x == y || !top(x) || !top(y) {
            continue;
        }
        let fits = |e: &&usize| {
            let f = sheet.next[**e];
            border.free[**e]
                && border.free[f]
                && agree(sheet, y, **e, AGREE[1])
                && agree(sheet, x, f, AGREE[1])
        };
        if let Some(&e) = bands.iter().find(fits) {
            for (own, of) in [(x, sheet.next[e]), (y, e)] {
                border.sew(sheet, &[own], &[of]);
                out.push(Found { sides: [vec![own], vec![of]], sure: SURE });
            }
        }
    }
    out
}

/// Sides of a piece, cut more than once, that are sewn to each other: an edge and an edge, or a
/// chain of two.
fn tubes(sheet: &Sheet, border: &mut Border) -> Vec<Found> {
    let mut out = Vec::new();
    let n = sheet.edges.len();
    for a in 0..n {
        let p = sheet.edges[a].piece;
        let often = sheet.block.iter().filter(|b| **b == sheet.block[p]).count() > 1;
        let own = &sheet.edges[a];
        if !often || sheet.unfolded[p] || own.out.x.abs() < 0.7 || own.length < LEAST {
            continue;
        }
        let chains =
            (0..n).filter(|b| sheet.edges[*b].piece == p).flat_map(|b| [vec![b], vec![b, sheet.next[b]]]);
        let fits = |chain: &Vec<usize>| {
            let free =
                chain.iter().all(|e| *e != a && border.free[*e] && sheet.edges[*e].out.x * own.out.x < -0.5);
            let length: f64 = chain.iter().map(|e| sheet.edges[*e].length).sum();
            free && (length - own.length).abs() <= AGREE[1] * own.length
        };
        if let Some(chain) = chains.into_iter().find(fits).filter(|_| border.free[a]) {
            border.sew(sheet, &[a], &chain);
            out.push(Found { sides: [vec![a], chain], sure: SURE });
        }
    }
    out
}

fn agree(sheet: &Sheet, a: usize, b: usize, share: f64) -> bool {
    let [x, y] = [a, b].map(|e| sheet.edges[e].length);
    (x - y).abs() <= share * x.max(y)
}

/// Whether an edge and its image in a copy of its piece are a seam in the middle.
fn is_middle(sheet: &Sheet, border: &Border, a: usize, b: usize) -> bool {
    let [p, q] = [a, b].map(|e| sheet.edges[e].piece);
    let edge = &sheet.edges[a];
    let copies = p != q && sheet.block[p] == sheet.block[q];
    let along = edge.out.x.abs() >= 0.5 && bulge(edge).abs() <= BULGE;
    let fits = |e: &usize| {
        let other = sheet.edges[*e].piece;
        let own = other == p && *e != a && agree(sheet, a, *e, AGREE[2]);
        let rival = border.free[*e] && sheet.block[other] != sheet.block[p] && agree(sheet, a, *e, AGREE[0]);
        (own && (sheet.edges[*e].out + edge.out).norm() < 0.6) || rival
    };
    // In the middle of the back, the other side is an armhole.
    let across = |e: usize| {
        let other = &sheet.edges[e];
        let [low, high] = sheet.boxes[p];
        let straight = bulge(other).abs() < 0.01 && other.out.y.abs() < 0.05;
        other.piece == p
            && straight
            && other.length > 0.4 * (high.y - low.y)
            && other.out.x * edge.out.x < 0.0
    };
    copies
        && !(0..sheet.edges.len()).any(across)
        && border.free[a]
        && border.free[b]
        && edge.length >= LEAST
        && along
        && sheet.slender(p) < SLENDER
        && !(0..sheet.edges.len()).any(|e| fits(&e))
}

/// Whether an edge lies along a band and goes straight on.
fn is_band(sheet: &Sheet, e: usize) -> bool {
    let f = sheet.next[e];
    sheet.slender(sheet.edges[e].piece) >= SLENDER
        && e != f
        && sheet.edges[e].out.dot(&sheet.edges[f].out) > 0.99
}
