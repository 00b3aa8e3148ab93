//! Measures the proposals on patterns whose seams are known.
//!
//!     TOILE_SHARED=... cargo test --release -p toile-pattern --lib proposals_are_scored -- \
//!         --ignored --nocapture
//!
//! Method: [`cases`] reads patterns with their seams and makes of them what a CAD file has: names
//! that say nothing, no place in space, the grain up, pieces in an order by lot. A proposed seam is
//! right where the truth sews its two sides to each other over 90 % of their length; a seam of the
//! truth is found where right proposals cover 90 % of it. Pieces of one shape are exchangeable, as
//! the panels of a skirt are: edges are compared by the shape of their piece, each as often as the
//! truth sews it. Half of the files, by [`is_tuned`], is for tuning; the figures of the other half
//! count.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod cases;
mod fit;

use super::{ProposedSeam, proposed_seams};
use cases::{Case, cases, is_tuned};
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// Places on a seam that are compared.
const PLACES: usize = 40;
/// Share of a seam's length that must agree.
const AGREE: f64 = 0.9;
/// Least confidences of the rows of the table.
const ROWS: [f64; 6] = [0.5, 0.6, 0.7, 0.8, 0.9, 0.97];

/// An edge by the shape of its piece: the number of the first piece of that shape, and of the edge.
type Shaped = (usize, usize);

/// Right and all seams.
#[derive(Default, Clone, Copy)]
struct Count {
    right: usize,
    all: usize,
}

impl Count {
    fn add(&mut self, right: bool) {
        self.right += usize::from(right);
        self.all += 1;
    }

    fn share(self) -> f64 {
        self.right as f64 / self.all.max(1) as f64
    }
}

/// What the proposals of some files are worth.
#[derive(Default)]
struct Tally {
    proposed: Count,
    found: Count,
    kinds: BTreeMap<&'static str, (Count, Count)>,
    rows: [Count; ROWS.len()],
}

impl Tally {
    fn f1(&self) -> f64 {
        let (p, r) = (self.proposed.share(), self.found.share());
        if p + r > 0.0 { 2.0 * p * r / (p + r) } else { 0.0 }
    }
}

/// For every piece the first piece of its shape, and how its edges are numbered there.
fn shapes(pieces: &[Piece]) -> Vec<(usize, usize)> {
    let corners = |p: &Piece| p.outer.corners.clone();
    // The shift of the second's edges at which the first lies on it, moved but not turned.
    let shift = |a: &Piece, b: &Piece| {
        let n = a.outer.edges.len();
        let fits = |s: &usize| {
            let by = b.outer.corners[*s] - a.outer.corners[0];
            (0..n).all(|k| {
                let (x, y) = (a.outer.path(k), b.outer.path((k + s) % n));
                let at = |t: f64| (x.at(t * x.length()) + by - y.at(t * y.length())).norm();
                [0.0, 0.25, 0.5, 0.75].into_iter().all(|t| at(t) < 2e-3)
            })
        };
        if corners(b).len() == n { (0..n).find(fits) } else { None }
    };
    (0..pieces.len())
        .map(|i| (0..i).find_map(|j| Some((j, shift(&pieces[i], &pieces[j])?))).unwrap_or((i, 0)))
        .collect()
}

/// The edge at each place along a side, and the length that a place stands for.
fn places(pieces: &[Piece], side: &[EdgeUse], forward: bool) -> (Vec<(usize, usize)>, f64) {
    let at = |u: &EdgeUse| {
        let i = pieces.iter().position(|p| p.name == u.edge.panel).unwrap();
        let k = pieces[i].edge_number(&u.edge.edge).unwrap();
        ((i, k), pieces[i].outer.path(k).length())
    };
    let mut edges: Vec<((usize, usize), f64)> = side.iter().map(at).collect();
    if !forward {
        edges.reverse();
    }
    let length: f64 = edges.iter().map(|e| e.1).sum();
    let one = |n: usize| {
        let mut left = (n as f64 + 0.5) / PLACES as f64 * length;
        for (edge, own) in &edges {
            if left < *own {
                return *edge;
            }
            left -= own;
        }
        edges[edges.len() - 1].0
    };
    ((0..PLACES).map(one).collect(), length / PLACES as f64)
}

/// The pairs of edges that meet along a seam, with their lengths.
fn meetings(pieces: &[Piece], shapes: &[(usize, usize)], seam: &PatternSeam) -> Vec<([Shaped; 2], f64)> {
    let shaped = |(i, k): (usize, usize)| {
        let (j, shift) = shapes[i];
        (j, (k + shift) % pieces[i].outer.edges.len())
    };
    let [a, b] = [0, 1].map(|s| places(pieces, &seam.sides[s], true));
    let pair = |(x, y): (&(usize, usize), &(usize, usize))| {
        let mut both = [shaped(*x), shaped(*y)];
        both.sort_unstable();
        (both, (a.1 + b.1) / 2.0)
    };
    a.0.iter().zip(&b.0).map(pair).collect()
}

/// Whether seams agree with others, each taking from these what it agrees with.
fn agreeing(
    seams: &[Vec<([Shaped; 2], f64)>],
    others: impl Iterator<Item = ([Shaped; 2], f64)>,
) -> Vec<bool> {
    let mut there: BTreeMap<[Shaped; 2], f64> = BTreeMap::new();
    others.for_each(|(pair, length)| *there.entry(pair).or_default() += length);
    let one = |seam: &Vec<([Shaped; 2], f64)>| {
        let mut own: BTreeMap<[Shaped; 2], f64> = BTreeMap::new();
        seam.iter().for_each(|(pair, length)| *own.entry(*pair).or_default() += length);
        let whole: f64 = own.values().sum();
        let met: f64 = own.iter().map(|(pair, l)| l.min(*there.get(pair).unwrap_or(&0.0))).sum();
        let agrees = met >= AGREE * whole;
        if agrees {
            own.iter().for_each(|(pair, l)| {
                there.entry(*pair).and_modify(|t| *t = (*t - l).max(0.0));
            });
        }
        agrees
    };
    seams.iter().map(one).collect()
}

fn score(case: &Case, tally: &mut Tally, talk: bool) {
    let shapes = shapes(&case.pieces);
    let found = proposed_seams(&case.pieces);
    let two = |s: &&PatternSeam| s.sides.len() == 2;
    let met = |s: &PatternSeam| meetings(&case.pieces, &shapes, s);
    let truth: Vec<_> = case.seams.iter().filter(two).map(met).collect();
    let proposed: Vec<_> = found.iter().map(|p| met(&p.seam)).collect();
    let right = agreeing(&proposed, truth.iter().flatten().copied());
    let kept = proposed.iter().zip(&right).filter(|(_, r)| **r).flat_map(|(p, _)| p.iter().copied());
    let recalled = agreeing(&truth, kept);
    for (ProposedSeam { seam, confidence, reason }, right) in found.iter().zip(&right) {
        tally.proposed.add(*right);
        tally.kinds.entry(case.kind(seam)).or_default().0.add(*right);
        if let Some(k) = ROWS.iter().rposition(|least| confidence >= least) {
            tally.rows[k].add(*right);
        }
        if talk && !right {
            println!(
                "  wrong {} {} {}: {confidence:.2}, {reason}",
                case.kind(seam),
                seam.name,
                case.words(seam)
            );
        }
    }
    for (seam, found) in case.seams.iter().filter(two).zip(&recalled) {
        tally.found.add(*found);
        tally.kinds.entry(case.kind(seam)).or_default().1.add(*found);
        if talk && !found {
            println!("  missed {} {}", case.kind(seam), case.words(seam));
        }
    }
}

fn print(name: &str, tally: &Tally) {
    println!(
        "{name}: precision {:.3} ({} of {}), recall {:.3} ({} of {}), F1 {:.3}",
        tally.proposed.share(),
        tally.proposed.right,
        tally.proposed.all,
        tally.found.share(),
        tally.found.right,
        tally.found.all,
        tally.f1()
    );
}

#[test]
#[ignore = "slow: .ci/wide"]
fn proposals_are_scored() {
    let Some(cases) = cases() else {
        println!("skipped: TOILE_SHARED is not set");
        return;
    };
    let talk = std::env::var_os("TOILE_SAY_ALL").is_some();
    let mut halves = [Tally::default(), Tally::default()];
    for case in &cases {
        let mut own = Tally::default();
        score(case, &mut own, talk);
        print(&case.name, &own);
        score(case, &mut halves[usize::from(!is_tuned(&case.name))], false);
    }
    for (name, tally) in ["tuned half", "other half"].into_iter().zip(&halves) {
        print(name, tally);
        for (kind, (proposed, found)) in &tally.kinds {
            println!(
                "  {kind:9} precision {:.3} of {:4}, recall {:.3} of {:4}",
                proposed.share(),
                proposed.all,
                found.share(),
                found.all
            );
        }
        for (least, row) in ROWS.iter().zip(&tally.rows) {
            println!("  confidence from {least:.2}: {:.3} right of {}", row.share(), row.all);
        }
        let sure = tally.rows.iter().zip(ROWS).filter(|(_, least)| *least >= 0.9);
        let sure =
            sure.fold(Count::default(), |c, (r, _)| Count { right: c.right + r.right, all: c.all + r.all });
        println!("  confidence .9 and more: {:.3} right of {}", sure.share(), sure.all);
    }
}
