//! Divides edges so that the sides of every seam have equally many links, which then meet one to
//! one.
//!
//! Method: the corners within a side are its *stops*. Stops of two sides that lie at the same share
//! of their lengths, to a hundredth or [`NEAR`], belong together; a stop that has no partner cuts
//! the other side there, by arc length proportion between the stops that have. A cut is a stop in
//! every other seam of its edge, so this is repeated until nothing is cut. Cost: rounds times seams
//! times stops. Limits: [`ROUNDS`] and [`MOST_CUTS`]; seams that would go on dividing each other
//! are an error.

use super::super::EdgeRef;
use super::{EdgeUse, LoweringError, Pattern};
use std::collections::BTreeMap;

/// Stops this near to each other belong together, metres.
const NEAR: f64 = 2e-3;
/// As are those this share of the side apart.
const NEAR_SHARE: f64 = 0.01;
/// Rounds after which seams are held to divide each other without end.
const ROUNDS: usize = 100;
/// Cuts of all edges together.
const MOST_CUTS: usize = 10_000;

/// Where every edge that is sewn is cut.
#[derive(Debug)]
pub(super) struct EdgeCuts<'a>(BTreeMap<&'a EdgeRef, EdgeCut>);

/// The length of an edge and where it is cut, ascending, metres from its start.
#[derive(Debug)]
struct EdgeCut {
    length: f64,
    at: Vec<f64>,
}

/// A part of an edge as one link of a side.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ChainLink<'a> {
    pub edge: &'a EdgeRef,
    /// Which of the parts between its cuts, from its start.
    pub part: usize,
    /// Whether the side runs along it from its end to its start.
    pub reversed: bool,
}

impl<'a> EdgeCuts<'a> {
    /// The cuts of a sound pattern.
    pub(super) fn of(pattern: &'a Pattern) -> Result<Self, LoweringError> {
        let uses = pattern.seams.iter().flat_map(|s| s.sides.iter().flatten());
        let length = |u: &EdgeUse| {
            pattern.piece(&u.edge.panel).and_then(|p| p.path(&u.edge.edge)).map_or(0.0, |p| p.length())
        };
        let mut cuts =
            EdgeCuts(uses.map(|u| (&u.edge, EdgeCut { length: length(u), at: Vec::new() })).collect());
        for _ in 0..ROUNDS {
            let before = cuts.count();
            for s in &pattern.seams {
                for other in &s.sides[1..] {
                    cuts.agree(&s.sides[0], other);
                    if cuts.count() > MOST_CUTS {
                        return Err(LoweringError::Endless { seam: s.name.clone() });
                    }
                }
            }
            if cuts.count() == before {
                return Ok(cuts);
            }
        }
        Err(LoweringError::Endless {
            seam: pattern.seams.first().map_or_else(String::new, |s| s.name.clone()),
        })
    }

    fn count(&self) -> usize {
        self.0.values().map(|c| c.at.len()).sum()
    }

    /// Where an edge is cut, metres from its start, ascending; its ends are not among them.
    pub(super) fn at(&self, edge: &EdgeRef) -> &[f64] {
        self.0.get(edge).map_or(&[], |c| &c.at)
    }

    /// The links of a side, in its order.
    pub(super) fn links(&self, side: &'a [EdgeUse]) -> Vec<ChainLink<'a>> {
        let parts = |u: &'a EdgeUse| {
            let n = self.at(&u.edge).len() + 1;
            let part = move |k| if u.reversed { n - 1 - k } else { k };
            (0..n).map(move |k| ChainLink { edge: &u.edge, part: part(k), reversed: u.reversed })
        };
        side.iter().flat_map(parts).collect()
    }

    fn length(&self, u: &EdgeUse) -> f64 {
        self.0.get(&u.edge).map_or(0.0, |c| c.length)
    }

    /// Cuts either side where only the other has a stop.
    fn agree(&mut self, a: &[EdgeUse], b: &[EdgeUse]) {
        let [(sa, la), (sb, lb)] = [self.stops(a), self.stops(b)];
        let near = (NEAR / la.min(lb)).max(NEAR_SHARE);
        let (in_b, in_a) = lacking_stops(&sa, &sb, near);
        in_a.into_iter().for_each(|share| self.cut(a, share * la));
        in_b.into_iter().for_each(|share| self.cut(b, share * lb));
    }

    /// The stops of a side as shares of its length, ascending, and its length.
    fn stops(&self, side: &[EdgeUse]) -> (Vec<f64>, f64) {
        let whole: f64 = side.iter().map(|u| self.length(u)).sum();
        let (mut before, mut stops) = (0.0, Vec::new());
        for (k, u) in side.iter().enumerate() {
            let (at, length) = (self.at(&u.edge), self.length(u));
            match u.reversed {
                true => stops.extend(at.iter().rev().map(|c| before + length - c)),
                false => stops.extend(at.iter().map(|c| before + c)),
            }
            before += length;
            if k + 1 < side.len() {
                stops.push(before);
            }
        }
        stops.iter_mut().for_each(|s| *s /= whole);
        (stops, whole)
    }

    /// Cuts a side at that length from its start.
    fn cut(&mut self, side: &[EdgeUse], at: f64) {
        let mut before = 0.0;
        for (k, u) in side.iter().enumerate() {
            let length = self.length(u);
            if at <= before + length || k + 1 == side.len() {
                let from_start = if u.reversed { before + length - at } else { at - before };
                if let Some(cut) = self.0.get_mut(&u.edge)
                    && from_start > 0.0
                    && from_start < length
                {
                    let i = cut.at.partition_point(|c| *c < from_start);
                    cut.at.insert(i, from_start);
                }
                return;
            }
            before += length;
        }
    }
}

/// The stops that two sides of a seam lack of each other: where the second lacks one of the first,
/// and the first one of the second. Both lists are shares of a side's length, ascending; stops
/// nearer than `near` are one, and the others are carried over in proportion between those.
pub fn lacking_stops(a: &[f64], b: &[f64], near: f64) -> (Vec<f64>, Vec<f64>) {
    let (mut i, mut j) = (0, 0);
    let (mut alone_a, mut alone_b, mut pairs) = (Vec::new(), Vec::new(), vec![(0.0, 0.0)]);
    while i < a.len() || j < b.len() {
        match (a.get(i), b.get(j)) {
            (Some(s), Some(t)) if (s - t).abs() <= near => {
                pairs.push((*s, *t));
                (i, j) = (i + 1, j + 1);
            }
            (Some(s), t) if t.is_none_or(|t| s < t) => {
                alone_a.push(*s);
                i += 1;
            }
            (_, Some(t)) => {
                alone_b.push(*t);
                j += 1;
            }
            (_, None) => break,
        }
    }
    pairs.push((1.0, 1.0));
    let carried = |s: &f64, from: fn(&(f64, f64)) -> f64, to: fn(&(f64, f64)) -> f64| {
        let k = pairs.partition_point(|p| from(p) < *s).clamp(1, pairs.len() - 1);
        let (p, q) = (&pairs[k - 1], &pairs[k]);
        let width = from(q) - from(p);
        let share = if width > 0.0 { (s - from(p)) / width } else { 0.5 };
        to(p) + (to(q) - to(p)) * share
    };
    let in_b = alone_a.iter().map(|s| carried(s, |p| p.0, |p| p.1)).collect();
    let in_a = alone_b.iter().map(|t| carried(t, |p| p.1, |p| p.0)).collect();
    (in_b, in_a)
}
