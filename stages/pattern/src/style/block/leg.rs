//! A layer of a leg: inseam, hem, outseam, waist, and the rise along the middle of the garment.
//!
//! Trousers that lie flat hide what goes between the legs: the points of the fork lie folded under
//! the other leg. A block gives them 15 % of the seat's girth, a third of it before and two behind
//! (Aldrich 2008); what the fork shows beyond the seat's width is part of it. Short legs that touch
//! hide the fork itself, and all that is seen below is hem: the fork is cut as high as the
//! wearer's.

use crate::mesh::crossing::first_crossing;
use crate::style::block::template::curve::Curve;
use crate::style::block::template::fit::{SEAT, SHORT};
use crate::style::block::template::flat::{Flat, PARTS, Run, Side, straight};
use crate::style::block::template::piece_role::{Layer, PieceRole};
use toile_core::prelude::*;

/// Both points of the fork, as a share of the seat's girth.
const FORK: f64 = 0.15;
/// A fork that lies lower than this share of the way from hem to waist is hidden.
const HIDDEN: f64 = 0.15;
/// A hidden fork is cut higher than it is seen by at least this share of `HIDDEN`: legs of shorts
/// have some length.
const LEAST_INSEAM: f64 = 0.4;
/// Legs are long from so many times the length of the point on.
const LONG: f64 = 6.0;
/// The point behind lies no lower than this share of the way from hem to fork.
const LEAST_DROP: f64 = 0.7;
/// Controls of the rise: how far down it is straight, as a share of it, and how far out it is
/// there, of the point; and of the inseam below the point.
const STRAIGHT: f64 = 0.7;
const HOLLOW: f64 = 0.15;
const INNER: f64 = 0.15;
/// How much of its bend an inseam keeps, tried one after another.
const STRAIGHTENED: [f64; 3] = [1.0, 0.5, 0.0];

/// The edges of a leg as it lies, from the inseam's upper end on.
struct LyingLeg {
    /// The fork, the foot of the inseam, and the middle of the waist.
    fork: Point2,
    foot: Point2,
    waist: Point2,
    inseam: Curve,
    /// From the foot to the outseam.
    hem: Vec<Curve>,
    are_short: bool,
}

impl LyingLeg {
    fn of(side: &Side, rise: f64) -> Option<Self> {
        let (inseam, hem) = (side.edge(EdgeRole::Inseam)?, side.edge(EdgeRole::Hem)?);
        let [fork, .., foot] = inseam.0;
        let waist = side.edges.last()?.1.0[3];
        let outer = |role| side.edge(role).map_or(0.0, |c: Curve| c.length());
        let are_short = inseam.length() < SHORT * (outer(EdgeRole::Outseam) + outer(EdgeRole::Hip));
        let lying = LyingLeg { fork, foot, waist, inseam, hem: vec![hem], are_short };
        let high = HIDDEN * (waist.y - foot.y).max(0.0);
        let wearers = waist.y - rise;
        if fork.y - foot.y < high {
            let own = Point2::new(fork.x, wearers.clamp(fork.y + LEAST_INSEAM * high, fork.y + high));
            let (inseam, hem) = (straight(own, fork), vec![inseam, hem]);
            return Some(LyingLeg { fork: own, foot: fork, inseam, hem, are_short: true, ..lying });
        }
        Some(lying)
    }
}

/// One layer of a leg, for a wearer whose waist lies so high above the fork, metres. None of a form
/// without inseam and hem.
pub(super) fn leg(side: &Side, layer: Layer, rise: f64) -> Option<Flat> {
    let lying = LyingLeg::of(side, rise)?;
    let (low, high) = (lying.fork, lying.waist);
    let width = |share: f64| {
        let y = low.y + share * (high.y - low.y);
        let sides = [EdgeRole::Outseam, EdgeRole::Hip].into_iter().filter_map(|role| side.edge(role));
        // The one that passes there; at the corner between them both do.
        let passes = |c: &Curve| (c.0[0].y - y) * (c.0[3].y - y) <= 0.0;
        let mut all: Vec<Curve> = sides.collect();
        all.sort_by_key(|c| !passes(c));
        all.first().map_or(0.0, |c| at_height(c, y))
    };
    let (seat, fork) = (width(SEAT) - low.x, width(0.0) - low.x);
    // What the fork shows beyond the seat's width is the flare of short legs.
    let shown = if lying.are_short { 0.0 } else { 2.0 * (fork - seat).max(0.0) };
    let hidden = (FORK * 4.0 * seat - shown).max(0.0);
    let point = match layer {
        Layer::Front => hidden / 3.0,
        Layer::Back => hidden * (2.0 / 3.0),
    };
    let out = |share: f64| Vector2::new(-share * point, 0.0);
    // The point behind lies lower, so that both inseams are of one length; where that is too low,
    // the hem behind is the wider one.
    let up = low.y - lying.foot.y;
    let aside = wider_behind(lying.foot.x - low.x, up, hidden);
    let moved = match layer {
        Layer::Front => Vector2::new(aside, 0.0),
        Layer::Back => Vector2::new(-aside, 0.0),
    };
    let foot = lying.foot + moved;
    let before = (lying.foot.x + aside - low.x + hidden / 3.0).powi(2) + up * up;
    let drop = (before - (foot.x - low.x + point).powi(2)).max(0.0).sqrt();
    let tip = Point2::new(low.x - point, foot.y + drop.max(LEAST_DROP * up));
    // Legs that are short beside the point run straight from it.
    let share = ((foot - low).norm() / (LONG * point).max(1e-6)).min(1.0);
    let inner = |c: &Curve, share: f64| {
        let straight = tip + (foot - tip) / 3.0;
        straight + (c.0[1] + out(INNER) - straight) * share
    };
    // Straight down, then out to the point.
    let middle = Curve([high, high + (low - high) * STRAIGHT, low + out(HOLLOW), tip]);
    let mut hem = lying.hem.clone();
    if let Some(Curve([a, b, c, _])) = hem.first_mut() {
        (*a, *b, *c) = (foot, *b + moved * (2.0 / 3.0), *c + moved / 3.0);
    }
    let inseam = |kept: f64| {
        let (c, even) = (&lying.inseam, straight(tip, foot).0[2]);
        Curve([tip, inner(c, share * kept), even + (c.0[2] + moved - even) * kept, foot])
    };
    let edges = |kept: f64| -> Vec<(EdgeRole, Vec<Curve>)> {
        let changed = |&(role, c): &(EdgeRole, Curve)| match role {
            EdgeRole::Inseam => (role, vec![inseam(kept)]),
            EdgeRole::Hem => (role, hem.clone()),
            _ => (role, vec![c]),
        };
        side.edges.iter().map(changed).chain([(EdgeRole::Rise, vec![middle])]).collect()
    };
    // The inseam of a leg that lies bent is straightened until it meets no other edge. It leaves
    // the point downwards: the rise comes in level.
    let is_sound = |kept: &f64| inseam(*kept).0[1].y < tip.y && !crosses(&edges(*kept));
    let kept = STRAIGHTENED.into_iter().find(is_sound).unwrap_or(STRAIGHTENED[STRAIGHTENED.len() - 1]);
    let edges: Vec<_> = edges(kept).into_iter().map(|(role, curves)| (role, Run::of(curves))).collect();
    Some(Flat::of_trunk(PieceRole::Leg(layer, side.hand), side.alone(&edges)))
}

/// How far the hem of a leg is let out at the inseam behind, and taken in at it in front, so that
/// both inseams are of one length: beside short inseams the point behind is long, and dropping it
/// does not suffice. Of an inseam that lies so far across and up, and the length of both points.
fn wider_behind(across: f64, up: f64, points: f64) -> f64 {
    // (behind - before) (behind + before) = up^2 - (LEAST_DROP up)^2 of how far both run across.
    let sum = 2.0 * across + points;
    let dropped = (1.0 - LEAST_DROP.powi(2)) * up * up / sum.max(f64::MIN_POSITIVE);
    if sum > 0.0 { 0.5 * (points / 3.0 - dropped).max(0.0) } else { 0.0 }
}

/// Whether a closed line of curves crosses itself.
fn crosses(edges: &[(EdgeRole, Vec<Curve>)]) -> bool {
    let curves = edges.iter().flat_map(|(_, curves)| curves);
    let points: Vec<Point2> = curves.flat_map(|c| c.points(PARTS).into_iter().skip(1)).collect();
    let n = points.len() as u32;
    let segments: Vec<[u32; 2]> = (0..n).map(|k| [k, (k + 1) % n]).collect();
    first_crossing(&points, &segments).is_some()
}

/// How far out a curve lies at a height: where it passes it, or its end that is nearer.
fn at_height(c: &Curve, y: f64) -> f64 {
    let points = c.points(PARTS);
    let passes = points.windows(2).find(|w| (w[0].y - y) * (w[1].y - y) <= 0.0 && w[0].y != w[1].y);
    let nearer =
        || points.iter().min_by(|a, b| (a.y - y).abs().total_cmp(&(b.y - y).abs())).map_or(0.0, |p| p.x);
    passes.map_or_else(nearer, |w| w[0].x + (w[1].x - w[0].x) * (y - w[0].y) / (w[1].y - w[0].y))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// Shorts 35 cm high, whose fork and inseam are seen so high, metres.
    fn shorts(fork: f64) -> Side {
        let places = [[0.0, fork], [0.04, 0.0], [0.33, 0.06], [0.3, 0.2], [0.22, 0.35], [0.0, 0.35]];
        let roles = [EdgeRole::Inseam, EdgeRole::Hem, EdgeRole::Outseam, EdgeRole::Hip, EdgeRole::Waist];
        let place = |k: usize| Point2::new(places[k][0], places[k][1]);
        let edges = roles.iter().enumerate().map(|(k, role)| (*role, straight(place(k), place(k + 1))));
        Side { edges: edges.collect(), mirrored: false, hand: Hand::Right }
    }

    fn lengths(side: &Side, rise: f64) -> [[f64; 2]; 2] {
        Layer::BOTH.map(|layer| {
            let flat = leg(side, layer, rise).unwrap();
            let length = |role| flat.edges.iter().find(|e| e.role == role).unwrap().run.length();
            [EdgeRole::Inseam, EdgeRole::Hem].map(length)
        })
    }

    #[test]
    fn a_fork_that_touching_legs_hide_is_cut_as_high_as_the_wearers() {
        let inseam = |rise| lengths(&shorts(0.02), rise)[0][0];
        // The seen fork lies 33 cm below the waist: the wearer's 31 or 29 cm.
        assert!(inseam(0.29) > inseam(0.31) + 0.004);
        // No lower than 2 cm above what is seen, and no higher than 5.
        assert_eq!(inseam(0.4).to_bits(), inseam(0.5).to_bits());
        assert_eq!(inseam(0.1).to_bits(), inseam(0.2).to_bits());
    }

    #[test]
    fn what_is_seen_below_a_hidden_fork_is_hem() {
        let side = shorts(0.02);
        let [front, back] = lengths(&side, 0.3).map(|[_, hem]| hem);
        let seen: f64 = side.edges[..2].iter().map(|(_, c)| c.length()).sum();
        assert!((front + back - 2.0 * seen).abs() < 0.02, "{front} {back} {seen}");
    }

    #[test]
    fn both_inseams_are_of_one_length_however_high_the_fork_is() {
        for fork in [0.0, 0.03, 0.06, 0.1, 0.15] {
            let [front, back] = lengths(&shorts(fork), 0.28).map(|[inseam, _]| inseam);
            assert!((front / back - 1.0).abs() < 0.04, "{fork}: {front} {back}");
        }
    }
}
