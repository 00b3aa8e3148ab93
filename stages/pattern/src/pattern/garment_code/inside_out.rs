//! Panels that stand inside out: with their wrong side away from the wearer.
//!
//! A back that was copied from its front and moved behind the wearer, without turning it, looks at
//! the wearer, and every stitch of it runs side by side with the edge that it is sewn to. Both
//! together do not happen by chance: in 55 files of GarmentCode and its forerunner no panel is one
//! of these. Such a panel keeps its place and is turned over, and its stitches run with it. Cost:
//! stitches times panels.

use super::panel::{Made, mirrored};
use super::stitch::{Stitch, leaning, shortest};
use std::collections::BTreeSet;
use toile_core::artifact::{PatternLoop, PieceEdge, Pose};
use toile_core::prelude::*;

/// Edges whose directions in space agree by more than this cosine run clearly the same way.
const CLEAR: f64 = 0.5;
/// Shorter edges are placed too loosely to decide, metres.
const SHORTEST: f64 = 0.05;
/// Fewer stitches do not decide.
const LEAST: usize = 2;
/// A panel looks clearly at the wearer where the cosine to the way there is more.
const INWARDS: f64 = 0.5;

/// The panels that stand inside out.
pub(super) fn inside_out(stitches: &[Stitch<'_>], made: &[Made]) -> BTreeSet<usize> {
    let middle = |m: &Made| {
        m.ends.iter().flatten().fold(Vector3::zeros(), |sum, p| sum + p.coords)
            / (2 * m.ends.len().max(1)) as f64
    };
    let middles: Vec<Vector3> = made.iter().map(middle).collect();
    let wearer = middles.iter().sum::<Vector3>() / middles.len().max(1) as f64;
    let looks_inwards = |p: usize| {
        let mut away = middles[p] - wearer;
        away.y = 0.0;
        let outside = made[p].piece.pose.map_or_else(Vector3::zeros, |pose| pose.outside());
        outside.dot(&away) < -INWARDS * away.norm()
    };
    let of = |p: usize| {
        stitches.iter().filter(move |s| {
            let [(a, _), (b, _)] = s.raw.sides;
            a != b && (a == p || b == p)
        })
    };
    let runs_along = |s: &Stitch<'_>| leaning(s, made) > CLEAR && shortest(s.raw, made) > SHORTEST;
    let candidates = (0..made.len()).filter(|&p| of(p).count() >= LEAST && of(p).all(runs_along));
    candidates.filter(|&p| looks_inwards(p)).collect()
}

/// The panel where it is, seen from its other side.
pub(super) fn turned_over(made: &mut Made) {
    let n = made.piece.outer.edges.len();
    let PatternLoop { edges, corners } = mirrored(&made.piece.outer);
    // From the end of the last edge back to the start of the first.
    let corners = (0..n).map(|j| corners[(n - j) % n]).collect();
    let back = |e: &PieceEdge| PieceEdge { name: e.name.clone(), curve: e.curve.turned() };
    made.piece.outer = PatternLoop { edges: edges.iter().rev().map(back).collect(), corners };
    made.piece.pose = made.piece.pose.map(|pose| Pose { across: -pose.across, ..pose });
    for edge in made.edges.iter_mut().flatten() {
        *edge = (n - 1 - edge.0, !edge.1);
    }
}
