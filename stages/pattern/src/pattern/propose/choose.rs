//! Which seams are taken: the likeliest first, each with its mirror image, until none is likely.
//!
//! Method: in every round the odds of all pairs and stretches are shared among those that would sew
//! an edge twice; the likeliest are taken, and what is free after them is compared again. Cost: a
//! round for the seams of about one likelihood, [`ROUNDS`] at most.

use super::around;
use super::border::Border;
use super::score::{self, Pair};
use super::sheet::Sheet;
use std::collections::{BTreeMap, BTreeSet};

/// Rounds; a garment of thirty pieces takes about twenty.
const ROUNDS: usize = 80;
/// Odds whose logarithms differ by less than this are a tie, of which this share is no rival.
const TIE: f64 = 0.03;
const TIED: f64 = 0.7;
/// How often edges tell each other how free they are.
const SAYINGS: usize = 16;
/// What is less likely than the likeliest by more than this waits for the next round.
const WAITS: f64 = 0.02;
/// Shorter edges, metres, are as likely as this share says until they go on where a seam ends.
const SHORT: f64 = 0.03;
const WAITING: f64 = 0.85;
/// Everything above this is taken in one round.
const CERTAIN: f64 = 0.97;

/// Edges that are sewn to each other, both sides counter-clockwise.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub(super) sides: [Vec<usize>; 2],
    pub(super) sure: f64,
}

/// Seams of one likelihood that are taken together.
struct Offer {
    sure: f64,
    seams: Vec<[Vec<usize>; 2]>,
}

/// The probability of odds, given as logarithms, that exclude each other with others.
fn shared(own: f64, others: f64) -> f64 {
    let odds = own.clamp(-30.0, 30.0).exp();
    odds / (1.0 + odds + others)
}

/// The logarithm of the odds of a probability.
fn logit(p: f64) -> f64 {
    let p = p.clamp(1e-6, 1.0 - 1e-6);
    (p / (1.0 - p)).ln()
}

/// A probability corrected by how often it came true: shift and slope of its odds.
fn calibrated(p: f64, [shift, slope]: [f64; 2]) -> f64 {
    1.0 / (1.0 + (-(shift + slope * logit(p))).exp())
}

/// Shift and slope of the odds by which proposals came true, read from the table of the tuned half
/// (see `scored`): of those that the scores call 97 % likely and more, 92 % were right.
const CAME_TRUE: [f64; 2] = [0.5, 0.5];

pub(super) fn choose(sheet: &Sheet, border: &mut Border, shortest: f64, least: f64) -> Vec<Found> {
    let pairs = score::pairs(sheet, shortest);
    let mut out: Vec<Found> = Vec::new();
    for _ in 0..ROUNDS {
        let mut offers = pair_offers(sheet, border, &pairs);
        offers.extend(stretch_offers(sheet, border, shortest));
        offers.retain(|o| o.sure >= least);
        offers.sort_by(|a, b| b.sure.total_cmp(&a.sure).then(a.seams.cmp(&b.seams)));
        let Some(top) = offers.first().map(|o| o.sure) else { break };
        let from = (top - WAITS).min(CERTAIN);
        for o in offers.iter().filter(|o| o.sure >= from) {
            let edges: Vec<usize> = o.seams.iter().flatten().flatten().copied().collect();
            let once = edges.iter().collect::<BTreeSet<_>>().len() == edges.len();
            if !once || edges.iter().any(|e| !border.free[*e]) || closes_early(sheet, border, &o.seams) {
                continue;
            }
            for [a, b] in &o.seams {
                border.sew(sheet, a, b);
                out.push(Found { sides: [a.clone(), b.clone()], sure: calibrated(o.sure, CAME_TRUE) });
            }
        }
    }
    out
}

/// Whether a seam would close a ring of equal pieces while another one of them is not in it yet.
fn closes_early(sheet: &Sheet, border: &Border, seams: &[[Vec<usize>; 2]]) -> bool {
    let [[a], [b]] = [&seams[0][0][..], &seams[0][1][..]] else { return false };
    let (a, b) = (*a, *b);
    let [p, q] = [a, b].map(|e| border.group_of(sheet.edges[e].piece));
    let other = |e: usize, partner: usize| {
        (0..sheet.edges.len()).any(|f| {
            border.free[f]
                && sheet.alike[f] == sheet.alike[e]
                && border.group_of(sheet.edges[f].piece) != border.group_of(sheet.edges[partner].piece)
        })
    };
    p == q && sheet.edges[a].piece != sheet.edges[b].piece && (other(a, b) || other(b, a))
}

/// Single edges that may be sewn to each other.
fn pair_odds(sheet: &Sheet, border: &Border, pairs: &[Pair]) -> BTreeMap<(usize, usize), f64> {
    let rivals = score::rivals(sheet, border, pairs);
    let free = pairs.iter().filter(|p| border.free[p.a] && border.free[p.b]);
    free.map(|p| ((p.a, p.b), score::log_odds(&score::features(sheet, border, &rivals, p)))).collect()
}

fn pair_offers(sheet: &Sheet, border: &Border, pairs: &[Pair]) -> Vec<Offer> {
    let own = pair_odds(sheet, border, pairs);
    let image = |a: usize, b: usize| {
        let (x, y) = (sheet.image[a]?, sheet.image[b]?);
        Some((x.min(y), x.max(y)))
    };
    // A pair and its image are as likely as each other.
    let odds: BTreeMap<(usize, usize), f64> = own
        .iter()
        .map(|(&(a, b), z)| {
            let other = image(a, b).and_then(|i| own.get(&i));
            ((a, b), other.map_or(*z, |o| (z + o) / 2.0))
        })
        .collect();
    let sure = marginals(sheet, &odds);
    let mut out = Vec::new();
    for &(a, b) in odds.keys() {
        let sure = sure[&(a, b)];
        // A short edge waits until what lies beside it is sewn.
        let short = sheet.edges[a].length.max(sheet.edges[b].length) < SHORT;
        let zips = border.next[a] == b || border.next[b] == a;
        let sure = if short && !zips { sure * WAITING } else { sure };
        let mut seams = vec![[vec![a], vec![b]]];
        if let Some((x, y)) = image(a, b).filter(|i| *i != (a, b)) {
            let apart = [x, y].iter().all(|e| *e != a && *e != b);
            if apart && odds.contains_key(&(x, y)) {
                if (x, y) < (a, b) {
                    continue;
                }
                seams.push([vec![x], vec![y]]);
            }
        }
        out.push(Offer { sure, seams });
    }
    out
}

/// The probability of each pair when every edge is sewn once or not at all.
fn marginals(sheet: &Sheet, odds: &BTreeMap<(usize, usize), f64>) -> BTreeMap<(usize, usize), f64> {
    // Both directions of each pair, those of an edge together: partner and odds.
    let mut of: Vec<Vec<(usize, f64)>> = vec![Vec::new(); sheet.edges.len()];
    for (&(a, b), z) in odds.iter().filter(|(_, z)| **z > -9.0) {
        let o = z.min(25.0).exp();
        of[a].push((b, o));
        of[b].push((a, o));
    }
    of.iter_mut().for_each(|all| all.sort_by_key(|x| x.0));
    // What an edge says to a partner: how free it is of all others.
    let mut says: Vec<Vec<f64>> = of.iter().map(|all| vec![1.0; all.len()]).collect();
    let heard = |says: &[Vec<f64>], a: usize, (b, o): (usize, f64)| {
        let k = of[b].binary_search_by_key(&a, |x| x.0).unwrap_or(0);
        o * says[b][k]
    };
    for _ in 0..SAYINGS {
        let mut next = says.clone();
        for a in 0..of.len() {
            // The best offer of every form of partner; exchangeable ones are no rivals.
            let mut best: BTreeMap<usize, f64> = BTreeMap::new();
            for &(b, o) in &of[a] {
                let x = heard(&says, a, (b, o));
                let known = best.entry(sheet.alike[b]).or_insert(0.0);
                *known = known.max(x);
            }
            let sum: f64 = best.values().sum();
            for (k, &(b, _)) in of[a].iter().enumerate() {
                let own = best[&sheet.alike[b]];
                // What fits just as well is likely exchangeable: a left sleeve and a right one.
                let as_good = of[a].iter().filter(|x| {
                    x.0 != b && sheet.alike[x.0] != sheet.alike[b] && (x.1 / of[a][k].1).ln().abs() < TIE
                });
                let equals: f64 = as_good.map(|x| best[&sheet.alike[x.0]]).sum();
                let others = (sum - own - TIED * equals).max(0.0);
                next[a][k] = (says[a][k] / (1.0 + others)).sqrt();
            }
        }
        says = next;
    }
    let mut out: BTreeMap<(usize, usize), f64> = odds.keys().map(|k| (*k, 0.0)).collect();
    for a in 0..of.len() {
        for (k, &(b, o)) in of[a].iter().enumerate().filter(|(_, x)| x.0 > a) {
            let back = of[b].binary_search_by_key(&a, |x| x.0).unwrap_or(0);
            let x = o * says[a][k] * says[b][back];
            out.insert((a, b), x / (1.0 + x));
        }
    }
    out
}

fn stretch_offers(sheet: &Sheet, border: &Border, shortest: f64) -> Vec<Offer> {
    let all = around::all_laid(sheet, border, shortest).into_iter();
    let found: Vec<(f64, around::Laid)> =
        all.map(|laid| (around::log_odds(&laid.features), laid)).filter(|(z, _)| *z > -4.0).collect();
    let edges: Vec<BTreeSet<usize>> =
        found.iter().map(|(_, l)| l.parts.iter().flatten().flatten().copied().collect()).collect();
    // Exchangeable stretches are no rivals: two sleeves of one form and two armholes of one form.
    let form = |l: &around::Laid| -> Vec<usize> {
        let first =
            |e: &usize| sheet.image[*e].map_or(sheet.alike[*e], |i| sheet.alike[*e].min(sheet.alike[i]));
        let mut all: Vec<usize> = l.parts.iter().flatten().flatten().map(first).collect();
        all.sort_unstable();
        all
    };
    let forms: Vec<Vec<usize>> = found.iter().map(|(_, laid)| form(laid)).collect();
    let mut out = Vec::new();
    for (i, (z, laid)) in found.iter().enumerate() {
        let other = (0..found.len()).filter(|j| *j != i && forms[*j] != forms[i]);
        let other: Vec<usize> = other.collect();
        // Rivals for one side, and for the other.
        let rest = [0, 1].map(|side| {
            let own: BTreeSet<usize> = laid.parts.iter().flat_map(|p| p[side].iter().copied()).collect();
            let rivals = other.iter().filter(|j| !own.is_disjoint(&edges[**j]));
            let sum: f64 = rivals.map(|j| found[*j].0.clamp(-30.0, 30.0).exp()).sum();
            logit(shared(*z, sum))
        });
        let sure = 1.0 / (1.0 + (z.clamp(-30.0, 30.0) - rest[0] - rest[1]).exp());
        let seams = laid.parts.clone();
        out.push(Offer { sure, seams });
    }
    out
}
