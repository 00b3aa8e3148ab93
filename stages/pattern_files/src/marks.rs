//! What is drawn on a piece beside its outline: grain line, seam numbers, notches.
//!
//! A piece without a grain line of its own gets one: y is its grain. Cost: points of the outline
//! times some dozen. Limits: a number stands at the middle of its edge, also where that edge is one
//! of several of its side.

use crate::inside::{bounds, upright_parts};
use toile_core::artifact::{EdgePath, Pattern, Piece, Point2, Vector2};

/// Upright lines that are looked at for a grain line.
const TRIED: usize = 31;
/// A grain line is as long as this share of the piece there.
const SHARE: f64 = 0.7;
/// No grain line that is drawn for a piece is longer, metres.
const LONGEST: f64 = 0.4;
/// A line nearer to the middle is taken though another is longer by this share.
const MIDDLE: f64 = 0.35;

/// The grain line of a piece, from its foot up; the polygon is its outline.
pub(crate) fn grain(p: &Piece, polygon: &[Point2]) -> [Point2; 2] {
    if let Some([a, b]) = p.grain {
        return [a, Point2::new(a.x, b.y)];
    }
    let (lo, hi) = bounds(polygon);
    let mut best = ([lo, Point2::new(lo.x, hi.y)], f64::NEG_INFINITY);
    for k in 0..TRIED {
        let share = (k as f64 + 0.5) / TRIED as f64;
        let x = lo.x + (hi.x - lo.x) * share;
        for [a, b] in upright_parts(polygon, x) {
            let worth = (b - a) * (1.0 - MIDDLE * (2.0 * share - 1.0).abs());
            if worth > best.1 {
                let (middle, half) = (f64::midpoint(a, b), ((b - a) * SHARE).min(LONGEST) / 2.0);
                best = ([Point2::new(x, middle - half), Point2::new(x, middle + half)], worth);
            }
        }
    }
    best.0
}

/// The number of a seam at one of its edges or lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SeamMark {
    /// The number of the seam, from 1.
    pub number: usize,
    /// The middle of the edge.
    pub at: Point2,
    /// From there into the piece, of length 1.
    pub inwards: Vector2,
    /// How long the edge is, metres.
    pub length: f64,
}

/// The seam numbers of each piece, in the order of the pattern.
pub(crate) fn seam_marks(pattern: &Pattern) -> Vec<Vec<SeamMark>> {
    let mut out = vec![Vec::new(); pattern.pieces.len()];
    for (i, seam) in pattern.seams.iter().enumerate() {
        for u in seam.sides.iter().flatten() {
            let Some(k) = pattern.pieces.iter().position(|p| p.name == u.edge.panel) else { continue };
            let Some(path) = pattern.pieces[k].path(&u.edge.edge) else { continue };
            let (at, way) = middle(&path);
            let inwards = Vector2::new(-way.y, way.x);
            out[k].push(SeamMark { number: i + 1, at, inwards, length: path.length() });
        }
    }
    out
}

/// The middle of an edge and the direction in which it runs there.
pub(crate) fn middle(path: &EdgePath) -> (Point2, Vector2) {
    along(path, path.length() / 2.0)
}

/// The point of an edge at that length, metres, and the direction in which it runs there.
fn along(path: &EdgePath, length: f64) -> (Point2, Vector2) {
    let step = (path.length() * 1e-3).min(1e-4);
    let way = path.at(length + step) - path.at(length - step);
    (path.at(length), way.try_normalize(0.0).unwrap_or_else(Vector2::x))
}

/// A notch on the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NotchMark {
    /// Where it stands on the line that is sewn along.
    pub at: Point2,
    /// From there out of the piece, of length 1.
    pub out: Vector2,
    /// The number of its edge.
    pub edge: usize,
    /// How far it is cut in, metres, 0 where that is not said.
    pub depth: f64,
}

/// The notches of a piece.
pub(crate) fn notches(p: &Piece) -> Vec<NotchMark> {
    let one = |n: &toile_core::artifact::Notch| {
        let edge = p.edge_number(&n.edge)?;
        let (at, way) = along(&p.outer.path(edge), n.along);
        Some(NotchMark { at, out: Vector2::new(way.y, -way.x), edge, depth: n.depth.max(0.0) })
    };
    p.notches.iter().filter_map(one).collect()
}
