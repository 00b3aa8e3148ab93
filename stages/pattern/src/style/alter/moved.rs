//! Corners of a piece moved, its edges with them.
//!
//! An edge follows its ends by a similarity: turned and scaled as a whole, so that a smooth edge
//! stays smooth and every share of its length stays that share. One both of whose ends go the same
//! way is only moved.

use crate::mesh::predicates::distance_to_segment;
use toile_core::prelude::*;

/// Ends of lines nearer than this to an edge lie on it, metres.
const ON: f64 = 5e-4;
/// Ends of an edge nearer to each other have no direction, metres.
const APART: f64 = 1e-6;
/// No edge is shorter than this, metres.
const LEAST: f64 = 1e-3;

/// The piece with each corner of its outline moved `by` so much, metres.
pub(super) fn moved(piece: &Piece, by: impl Fn(usize) -> Vector2) -> Piece {
    let n = piece.outer.corners.len();
    let mut after = piece.clone();
    for (k, corner) in after.outer.corners.iter_mut().enumerate() {
        *corner += by(k);
    }
    let ends = |l: &PatternLoop, k: usize| [l.corners[k], l.corners[(k + 1) % n]];
    let changed: Vec<usize> =
        (0..n).filter(|k| [*k, (k + 1) % n].iter().any(|c| by(*c) != Vector2::zeros())).collect();
    for &k in &changed {
        let to = similarity(ends(&piece.outer, k), ends(&after.outer, k));
        after.outer.edges[k].curve = piece.outer.edges[k].curve.moved(to, false);
        carry_notches(piece, &mut after, k);
    }
    carry_lines(piece, &mut after, &changed);
    after
}

/// The similarity that takes two points to two others; a move where those have no direction.
fn similarity([a, b]: [Point2; 2], [c, d]: [Point2; 2]) -> impl Fn(Point2) -> Point2 {
    let (from, to) = (b - a, d - c);
    let scale = from.norm_squared();
    let is_moved = (to - from).norm() < 1e-12 || scale < APART * APART;
    let (cos, sin) = match is_moved {
        true => (1.0, 0.0),
        false => (from.dot(&to) / scale, from.perp(&to) / scale),
    };
    move |p| {
        let v = p - a;
        c + Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
    }
}

/// Notches of an edge stay at their shares of its length.
fn carry_notches(before: &Piece, after: &mut Piece, k: usize) {
    let [was, is] = [before.outer.path(k).length(), after.outer.path(k).length()];
    let name = &before.outer.edges[k].name;
    for n in after.notches.iter_mut().filter(|n| n.edge == *name) {
        n.along = if was > 0.0 { (n.along / was * is).clamp(0.0, is) } else { 0.0 };
    }
}

/// Points of lines that lie on an edge that changed go with it.
fn carry_lines(before: &Piece, after: &mut Piece, changed: &[usize]) {
    if before.lines.is_empty() {
        return;
    }
    let drawn: Vec<(EdgePath, EdgePath)> =
        changed.iter().map(|k| (before.outer.path(*k), after.outer.path(*k))).collect();
    let points: Vec<Vec<Point2>> = drawn.iter().map(|(was, _)| was.points()).collect();
    for p in after.lines.iter_mut().flat_map(|l| &mut l.points) {
        let on = points.iter().zip(&drawn).find_map(|(points, (was, is))| {
            let share = share_at(points, *p)?;
            Some(is.at(share * is.length())).filter(|_| was.length() > 0.0)
        });
        *p = on.unwrap_or(*p);
    }
}

/// The share of a line's length at which a point lies on it; none where it lies off it.
fn share_at(points: &[Point2], p: Point2) -> Option<f64> {
    let (mut along, mut best) = (0.0, None::<(f64, f64)>);
    for w in points.windows(2) {
        let (off, t) = distance_to_segment(p, w[0], w[1]);
        let step = (w[1] - w[0]).norm();
        if off <= ON && best.is_none_or(|(least, _)| off < least) {
            best = Some((off, along + t * step));
        }
        along += step;
    }
    best.filter(|_| along > 0.0).map(|(_, at)| at / along)
}

/// Refuses to make an edge longer that has no direction, or shorter than it is long.
pub(super) fn can_lengthen(piece: &Piece, k: usize, by: f64) -> Result<(), StageError> {
    let name = format!("{}.{}", piece.name, piece.outer.edges[k].name);
    let (length, chord) = (piece.outer.path(k).length(), chord(piece, k));
    if chord.norm() < APART {
        return Err(StageError::invalid(format!("\"{name}\" ends where it starts, so it has no direction"))
            .hint("move one of its corners: MoveCorner"));
    }
    if length + by >= LEAST {
        return Ok(());
    }
    let most = ((length - LEAST) * 1e3 + 1e-6).floor();
    Err(StageError::invalid(format!("\"{name}\" is only {:.1} mm long", length * 1e3))
        .hint(format!("it can be made shorter by {most:.0} mm at most: by: \"-{most:.0} mm\"")))
}

fn chord(piece: &Piece, k: usize) -> Vector2 {
    let corners = &piece.outer.corners;
    corners[(k + 1) % corners.len()] - corners[k]
}

/// The piece with an edge that is longer by so much, metres: scaled along its chord, at the lower
/// end where it is more upright than level, else at both ends by half.
pub(super) fn lengthened(piece: &Piece, k: usize, by: f64) -> Piece {
    let next = (k + 1) % piece.outer.corners.len();
    let chord = chord(piece, k);
    let grows = chord * (by / piece.outer.path(k).length().max(f64::MIN_POSITIVE));
    let [start, end] = match chord.y.abs() > chord.x.abs() {
        true if chord.y > 0.0 => [-grows, Vector2::zeros()],
        true => [Vector2::zeros(), grows],
        false => [-0.5 * grows, 0.5 * grows],
    };
    moved(piece, |c| match c {
        _ if c == k => start,
        _ if c == next => end,
        _ => Vector2::zeros(),
    })
}
