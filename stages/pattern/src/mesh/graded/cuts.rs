//! How the stretches of all panels are cut, the two sides of a seam alike.
//!
//! Method: sides that are sewn together are one *tie*: along it, by share of the length, edges are
//! as long as the panel with the shorter ones allows. So the edge length that one panel needs
//! enters the other panel's field, spreads from there, and may reach another seam; this is repeated
//! until nothing changes. A tie is then cut into parts of equal weight, the integral of one over
//! the length of its edges, once for all its sides. Cost: samples times rounds. Limits: seams of
//! edges that no panel has are left to the stage that sews.

use super::super::divide::Cuts;
use super::super::layout::Layout;
use super::super::polyline::{Polyline, place};
use super::field::SizeField;
use toile_core::artifact::{CHORD_TOLERANCE, EdgeRef, SewingPlan};
use toile_core::{Context, StageError};

/// Greatest number of rounds: in each, short edges at a seam shorten those of the neighbouring
/// panel.
const ROUNDS: usize = 8;
/// A size that falls by less than this share is as it was.
const SAME: f64 = 1e-3;
/// Samples of a tie for each edge of the shortest length.
const SAMPLES_PER_EDGE: f64 = 2.0;
/// The most samples of one tie.
const MOST_SAMPLES: f64 = 1e5;
/// A part is never shorter than this share of the longest edge for the sake of the curve.
const LEAST_SHARE: f64 = 1.0 / 8.0;

/// A panel with its sizes.
pub(crate) struct Sized<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its stretches and inner lines.
    pub layout: Layout<'a>,
    /// Its edge lengths.
    pub field: SizeField,
}

/// A stretch (numbered loop by loop) or, after these, an inner line of a panel; whether it runs
/// against its tie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct CutSide {
    panel: usize,
    chain: usize,
    against: bool,
}

impl Sized<'_> {
    fn chains(&self) -> usize {
        self.layout.stretches().count() + self.layout.lines.len()
    }

    /// The line of a stretch or inner line, its marks, and its fewest parts.
    fn chain(&self, k: usize) -> Option<(&Polyline, &[f64], usize)> {
        let n = self.layout.stretches().count();
        match k.checked_sub(n) {
            None => self.layout.stretches().nth(k).map(|s| (&s.line, &s.marks[..], s.least())),
            Some(k) => self.layout.lines.get(k).map(|l| (&l.path, &l.marks[..], l.marks.len() + 1)),
        }
    }

    fn named(&self, name: &str) -> Option<usize> {
        let n = self.layout.stretches().count();
        let line = || self.layout.lines.iter().position(|l| l.inner.name == name).map(|k| n + k);
        self.layout.stretches().position(|s| s.name == Some(name)).or_else(line)
    }
}

/// The cuts of every panel; fields are lowered to the lengths that the panels need of each other.
pub(crate) fn agree(
    panels: &mut [Sized<'_>],
    plan: Option<&SewingPlan>,
    cx: &Context,
) -> Result<Vec<Cuts>, StageError> {
    let ties = ties(panels, plan);
    for _ in 0..ROUNDS {
        cx.check()?;
        let mut changed: f64 = 0.0;
        for tie in ties.iter().filter(|t| t.len() > 1) {
            cx.check()?;
            changed = changed.max(lower_both(panels, tie));
        }
        for panel in panels.iter_mut() {
            cx.check()?;
            panel.field.spread();
        }
        if changed < SAME {
            break;
        }
    }
    let mut cuts: Vec<Vec<Vec<f64>>> = panels.iter().map(|p| vec![Vec::new(); p.chains()]).collect();
    for tie in &ties {
        cx.check()?;
        let shares = shares(panels, tie);
        for side in tie {
            cuts[side.panel][side.chain] = if side.against { mirrored(&shares) } else { shares.clone() };
        }
    }
    let split = |(p, mut stretches): (&Sized<'_>, Vec<Vec<f64>>)| {
        let lines = stretches.split_off(p.layout.stretches().count());
        Cuts { stretches, lines }
    };
    Ok(panels.iter().zip(cuts).map(split).collect())
}

/// Which chains are cut alike: the two sides of each seam, the legs of a dart; all others alone.
fn ties(panels: &[Sized<'_>], plan: Option<&SewingPlan>) -> Vec<Vec<CutSide>> {
    let alone = |panel: usize, chain: usize| vec![CutSide { panel, chain, against: false }];
    let each = panels.iter().enumerate().flat_map(|(i, p)| (0..p.chains()).map(move |k| alone(i, k)));
    let mut ties: Vec<Vec<CutSide>> = each.collect();
    let find = |side: &EdgeRef| {
        let panel = panels.iter().position(|p| p.name == side.panel)?;
        Some((panel, panels[panel].named(&side.edge)?))
    };
    for seam in plan.iter().flat_map(|p| &p.seams) {
        if let (Some(a), Some(b)) = (find(&seam.a), find(&seam.b)) {
            join(&mut ties, a, b, !seam.reversed);
        }
    }
    for (i, p) in panels.iter().enumerate() {
        let n = p.layout.stretches().count();
        for k in 0..p.layout.lines.len() {
            let legs = p.layout.legs(k).into_iter().filter(|j| *j > k);
            legs.for_each(|j| join(&mut ties, (i, n + k), (i, n + j), head_to_tail(p, k, j)));
        }
    }
    ties
}

/// Whether of two legs that meet one ends where the other begins.
fn head_to_tail(panel: &Sized<'_>, k: usize, j: usize) -> bool {
    let ends = |k: usize| {
        let points = &panel.layout.lines[k].path.points;
        (points[0], points[points.len() - 1])
    };
    let ((a, b), (c, d)) = (ends(k), ends(j));
    (b - c).norm().min((a - d).norm()) < (b - d).norm().min((a - c).norm())
}

/// Puts two chains into one tie; `against` where the share of one is what is left on the other.
fn join(ties: &mut Vec<Vec<CutSide>>, a: (usize, usize), b: (usize, usize), against: bool) {
    let of = |c: (usize, usize)| move |s: &CutSide| (s.panel, s.chain) == c;
    let place = |ties: &[Vec<CutSide>], c| ties.iter().position(|t| t.iter().any(of(c)));
    let (Some(i), Some(j)) = (place(ties, a), place(ties, b)) else { return };
    if i == j {
        return;
    }
    let runs = |t: &[CutSide], c| t.iter().find(|s| of(c)(s)).is_some_and(|s| s.against);
    let flip = runs(&ties[i], a) ^ runs(&ties[j], b) ^ against;
    let moved = std::mem::take(&mut ties[j]);
    ties[i].extend(moved.into_iter().map(|s| CutSide { against: s.against ^ flip, ..s }));
    ties.remove(j);
}

fn mirrored(shares: &[f64]) -> Vec<f64> {
    let last = shares.last().copied().unwrap_or_default();
    shares.iter().rev().map(|s| last - s).collect()
}

/// The greatest length of a tie's sides, metres.
fn length(panels: &[Sized<'_>], tie: &[CutSide]) -> f64 {
    let lengths = tie.iter().filter_map(|s| panels[s.panel].chain(s.chain)).map(|(line, _, _)| line.length());
    lengths.fold(0.0, f64::max)
}

/// Edge lengths at equal steps along a tie, metres: the least that any side requires.
fn profile(panels: &[Sized<'_>], tie: &[CutSide]) -> Vec<f64> {
    let (mut least, fine) = (Vec::new(), panels[tie[0].panel].field.range().fine);
    let n = (length(panels, tie) * SAMPLES_PER_EDGE / fine).clamp(4.0, MOST_SAMPLES).ceil() as usize;
    least.resize(n + 1, f64::INFINITY);
    for side in tie {
        let panel = &panels[side.panel];
        let Some((line, _, _)) = panel.chain(side.chain) else { continue };
        for (k, least) in least.iter_mut().enumerate() {
            let share = if side.against { n - k } else { k } as f64 / n as f64;
            *least = panel.field.at(line.at(share * line.length())).min(*least);
        }
    }
    least
}

/// Asks of every side of a tie what any of them asks; the greatest share by which a size fell.
fn lower_both(panels: &mut [Sized<'_>], tie: &[CutSide]) -> f64 {
    let least = profile(panels, tie);
    let n = least.len() - 1;
    let mut fell: f64 = 0.0;
    for side in tie {
        let panel = &mut panels[side.panel];
        let Some((line, _, _)) = panel.chain(side.chain) else { continue };
        let at = |k: usize| line.at(if side.against { n - k } else { k } as f64 / n as f64 * line.length());
        let points: Vec<_> = (0..=n).map(at).collect();
        for (p, size) in points.into_iter().zip(&least) {
            fell = fell.max(1.0 - size / panel.field.at(p));
            panel.field.lower(p, *size);
        }
    }
    fell
}

/// The shares of a tie's length at which it is cut: parts of equal weight, as many as the sizes ask
/// for, more where a side's chords would else leave it.
fn shares(panels: &[Sized<'_>], tie: &[CutSide]) -> Vec<f64> {
    let (sizes, length) = (profile(panels, tie), length(panels, tie));
    let weights = weights(&sizes, length);
    let chains: Vec<_> = tie.iter().filter_map(|s| Some((s, panels[s.panel].chain(s.chain)?))).collect();
    let least = chains.iter().map(|(_, (_, _, least))| *least).max().unwrap_or(1);
    let edge = panels[tie[0].panel].field.range().edge;
    let total = weights.last().copied().unwrap_or_default();
    let mut n = ((total - 1e-9).ceil() as usize).max(least);
    let most = ((length / (LEAST_SHARE * edge)).ceil() as usize).max(n);
    let leaves = |shares: &[f64]| {
        let off = |(side, (line, marks, _)): &(&CutSide, (&Polyline, &[f64], usize))| {
            let own = if side.against { mirrored(shares) } else { shares.to_vec() };
            line.deviation(&place(line.length(), &own, marks))
        };
        chains.iter().map(off).fold(0.0, f64::max)
    };
    loop {
        let shares = equal_parts(&weights, n);
        if n >= most || leaves(&shares) <= 0.5 * CHORD_TOLERANCE * edge {
            return shares;
        }
        n = (n + n.div_ceil(10)).min(most);
    }
}

/// The integral of one over the size from the start to every sample: about how many edges there are
/// up to it.
fn weights(sizes: &[f64], length: f64) -> Vec<f64> {
    let step = length / (sizes.len() - 1) as f64;
    let mut sum = 0.0;
    let ends = sizes.windows(2).map(|w| {
        sum += step * 2.0 / (w[0] + w[1]);
        sum
    });
    std::iter::once(0.0).chain(ends).collect()
}

/// The shares, 0 to 1, that cut the weights into `n` equal parts.
fn equal_parts(weights: &[f64], n: usize) -> Vec<f64> {
    let last = weights.len() - 1;
    let at = |j: usize| {
        let wanted = weights[last] * (j as f64 / n as f64);
        let k = weights.partition_point(|w| *w < wanted).clamp(1, last);
        let t = (wanted - weights[k - 1]) / (weights[k] - weights[k - 1]);
        (k as f64 - 1.0 + t) / last as f64
    };
    std::iter::once(0.0).chain((1..n).map(at)).chain([1.0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_equal_weight_are_as_long_as_the_sizes_there() {
        // From 5 mm at the start to 20 mm at the end of 30 cm: the integral is ln 4 / 0.05 = 27.7.
        let sizes: Vec<f64> = (0..=1000).map(|k| 0.005 + 0.015 * f64::from(k) / 1000.0).collect();
        let weights = weights(&sizes, 0.3);
        assert!((weights[1000] - 4f64.ln() / 0.05).abs() < 1e-3);
        let shares = equal_parts(&weights, 28);
        assert_eq!((shares.len(), shares[0], shares[28]), (29, 0.0, 1.0));
        for w in shares.windows(2) {
            let (long, middle) = (0.3 * (w[1] - w[0]), 0.005 + 0.015 * (w[0] + w[1]) / 2.0);
            assert!((long / middle - 27.726 / 28.0).abs() < 2e-3, "{long} at a size of {middle}");
        }
    }

    #[test]
    fn mirrored_twice_is_the_same() {
        let shares = [0.0, 0.25, 0.5, 1.0];
        assert_eq!(mirrored(&shares), [0.0, 0.5, 0.75, 1.0]);
        assert_eq!(mirrored(&mirrored(&shares)), shares);
    }
}
