//! What is sewn around: a sleeve into an armhole, a band along a waist, a collar along a neck, a
//! gathered skirt to its band.
//!
//! Method: the free edges around what is sewn so far form rings. A ring, or a stretch of one
//! between two sharp corners, is laid on another one so that as many corners as possible meet at
//! the same share of the length: a shortest path over pairs of corners. Rings are turned until they
//! fit best. A logistic score then says how likely it is, as for a pair of edges. Cost: the product
//! of the corners of two stretches, for each place at which two rings may begin. Limits: rings of
//! more than [`MOST`] edges are left out, and the shortest stretches of garments that have more
//! than [`MOST_STRETCHES`] or ask for more than [`MOST_WORK`].

use super::border::Border;
use super::score::near;
use super::sheet::{PARTS, Sheet, bulge};
use std::f64::consts::LN_2;

/// Edges of a stretch.
const MOST: usize = 48;
/// Stretches of a garment.
const MOST_STRETCHES: usize = 100;
/// Pairs of corners that are looked at in a round, on all stretches together.
const MOST_WORK: usize = 2_000_000;
/// Corners that are passed by between two that meet.
const PASSED: usize = 6;
/// A corner that meets none costs this share of the length, where a seam ends there this.
const ALONE: [f64; 2] = [0.02, 0.03];
/// A corner where a seam ends that meets one where none does costs this.
const UNLIKE: f64 = 0.01;
/// A low corner that meets a high one costs this.
const TURNED: f64 = 0.03;
/// A corner that turns by more than this ends a stretch, degrees.
const SHARP: f64 = 38.0;
/// Neither stretch is this many times as long as the other.
const LONGEST: f64 = 4.0;

/// What is compared of two stretches.
pub(super) const FEATURES: usize = 28;

/// Edges that follow each other, and whether they are a whole ring.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    pub(super) edges: Vec<usize>,
    pub(super) ring: bool,
}

/// Two stretches that are laid on each other.
#[derive(Debug, Clone)]
pub(super) struct Laid {
    /// The edges of one and of the other between corners that meet; those of the first follow each
    /// other counter-clockwise, those of the second too, and its parts in the other order.
    pub(super) parts: Vec<[Vec<usize>; 2]>,
    pub(super) features: [f64; FEATURES],
}

/// The rings of free edges, and their stretches between sharp corners.
pub(super) fn stretches(border: &Border) -> Vec<Stretch> {
    let mut out = Vec::new();
    for ring in border.rings() {
        let n = ring.len();
        let closed = border.next[ring[n - 1]] == ring[0];
        let sharp: Vec<usize> = (0..n).filter(|k| (border.angle[ring[*k]] - 180.0).abs() > SHARP).collect();
        for (i, &from) in sharp.iter().enumerate() {
            let to = sharp[(i + 1) % sharp.len()];
            let count = if sharp.len() == 1 { n } else { (to + n - from) % n };
            if closed && count < n && count <= MOST {
                let edges = (0..count).map(|k| ring[(from + k) % n]).collect();
                out.push(Stretch { edges, ring: false });
            }
        }
        // The whole outline of one piece is sewn around nothing.
        let joined = ring.iter().any(|e| border.crosses[*e]);
        if closed && n <= MOST && (joined || n == 1) {
            out.push(Stretch { edges: ring, ring: true });
        }
    }
    out
}

/// A stretch as shares of its length: at every corner the share, whether a seam ends there, and how
/// low it lies, from -1 to 1.
struct Ruler {
    at: Vec<f64>,
    crosses: Vec<bool>,
    low: Vec<f64>,
    total: f64,
}

fn length(sheet: &Sheet, s: &[usize]) -> f64 {
    s.iter().map(|e| sheet.edges[*e].length).sum()
}

/// The corners of edges in this order, beginning with the start of the first; `backwards` is
/// whether the edges are run through backwards, from the end of the last.
fn ruler(sheet: &Sheet, border: &Border, edges: &[usize], backwards: bool) -> Ruler {
    let total = length(sheet, edges).max(1e-9);
    let n = edges.len();
    let half = |e: usize, from: usize, to: usize| {
        let edge = &sheet.edges[e];
        (edge.points[to].y - edge.points[from].y) / edge.length.max(1e-9) * 2.0
    };
    let (mut at, mut crosses, mut low) = (vec![0.0], Vec::new(), Vec::new());
    let mut sum = 0.0;
    for k in 0..=n {
        let [before, after] = [edges[(k + n - 1) % n], edges[k % n]];
        crosses.push(border.crosses[if k == n { border.next[edges[n - 1]] } else { edges[k] }]);
        low.push(((half(after, 0, PARTS / 2) - half(before, PARTS / 2, PARTS)) / 2.0).clamp(-1.0, 1.0));
        if k < n {
            sum += sheet.edges[edges[k]].length;
            at.push((sum / total).min(1.0));
        }
    }
    if backwards {
        at = at.iter().rev().map(|a| 1.0 - a).collect();
        crosses.reverse();
        low.reverse();
    }
    Ruler { at, crosses, low, total }
}

/// The pairs of corners that meet, from the starts to the ends.
type Steps = Vec<(usize, usize)>;

/// The corners that meet, and their cost.
fn path(a: &Ruler, b: &Ruler) -> (f64, Steps) {
    let (n, m) = (a.at.len(), b.at.len());
    let alone = |r: &Ruler, from: usize, to: usize| -> f64 {
        (from + 1..to).map(|k| ALONE[usize::from(r.crosses[k])]).sum()
    };
    let meet = |i: usize, j: usize| {
        let unlike = if a.crosses[i] == b.crosses[j] { 0.0 } else { UNLIKE };
        (a.at[i] - b.at[j]).abs() + unlike + TURNED * (-a.low[i] * b.low[j]).max(0.0)
    };
    let mut cost = vec![f64::INFINITY; n * m];
    let mut from = vec![0; n * m];
    cost[0] = meet(0, 0);
    for i in 1..n {
        for j in 1..m {
            let own = meet(i, j);
            for x in i.saturating_sub(PASSED + 1)..i {
                for y in j.saturating_sub(PASSED + 1)..j {
                    let c = cost[x * m + y] + own + alone(a, x, i) + alone(b, y, j);
                    if c < cost[i * m + j] {
                        (cost[i * m + j], from[i * m + j]) = (c, x * m + y);
                    }
                }
            }
        }
    }
    let mut at = n * m - 1;
    let mut steps = vec![(n - 1, m - 1)];
    while at > 0 && cost[at].is_finite() {
        at = from[at];
        steps.push((at / m, at % m));
    }
    steps.reverse();
    (cost[n * m - 1], steps)
}

/// All pairs of stretches that can be laid on each other, the longest first.
pub(super) fn all_laid(sheet: &Sheet, border: &Border, shortest: f64) -> Vec<Laid> {
    let all = stretches(border);
    let lengths: Vec<f64> = all.iter().map(|s| length(sheet, &s.edges)).collect();
    let mut order: Vec<usize> = (0..all.len()).filter(|k| lengths[*k] >= shortest).collect();
    order.sort_by(|x, y| lengths[*y].total_cmp(&lengths[*x]));
    order.truncate(MOST_STRETCHES);
    let (mut work, mut out) = (0, Vec::new());
    for j in 0..order.len() {
        for i in 0..j {
            let (a, b) = (&all[order[i].min(order[j])], &all[order[i].max(order[j])]);
            if !may_meet(sheet, a, b) {
                continue;
            }
            let turns = starts(border, a).len() * if b.ring { b.edges.len() } else { 1 };
            work += turns * (a.edges.len() + 1) * (b.edges.len() + 1);
            if work > MOST_WORK {
                return out;
            }
            out.extend(laid(sheet, border, a, b));
        }
    }
    out
}

fn may_meet(sheet: &Sheet, a: &Stretch, b: &Stretch) -> bool {
    let ratio = (length(sheet, &a.edges) / length(sheet, &b.edges).max(1e-9)).ln();
    // The left half of a garment fits its right half in any case.
    let images = a.edges.iter().filter(|e| sheet.image[**e].is_some_and(|i| b.edges.contains(&i))).count();
    let twins = 3 * images >= a.edges.len().max(2);
    let shares = a.edges.iter().any(|e| b.edges.contains(e));
    !twins && !shares && ratio.abs() <= LONGEST.ln() && a.edges.len() + b.edges.len() >= 3
}

/// The edges with which a stretch may begin: those of a ring after a seam, where it has seams. Of
/// more than [`PASSED`] corners in a row one meets another.
fn starts(border: &Border, s: &Stretch) -> Vec<usize> {
    if !s.ring {
        return vec![0];
    }
    let seams: Vec<usize> = (0..s.edges.len()).filter(|k| border.crosses[s.edges[*k]]).collect();
    if seams.is_empty() { (0..s.edges.len().min(PASSED + 1)).collect() } else { seams }
}

/// Two stretches laid on each other in the best way; none where that cannot be.
pub(super) fn laid(sheet: &Sheet, border: &Border, a: &Stretch, b: &Stretch) -> Option<Laid> {
    if !may_meet(sheet, a, b) {
        return None;
    }
    let turned = |s: &Stretch, by: usize| [&s.edges[by..], &s.edges[..by]].concat();
    let mut best: Option<(f64, [Vec<usize>; 2], Steps)> = None;
    for i in starts(border, a) {
        let x = turned(a, i);
        let rx = ruler(sheet, border, &x, false);
        let all_b: Vec<usize> = if b.ring { (0..b.edges.len()).collect() } else { vec![0] };
        for j in all_b {
            let y = turned(b, j);
            let ry = ruler(sheet, border, &y, true);
            let (cost, steps) = path(&rx, &ry);
            if cost.is_finite() && best.as_ref().is_none_or(|known| cost < known.0 - 1e-9) {
                best = Some((cost, [x.clone(), y], steps));
            }
        }
    }
    let (_, [x, y], steps) = best?;
    let (rx, ry) = (ruler(sheet, border, &x, false), ruler(sheet, border, &y, true));
    let m = y.len();
    let part = |w: &[(usize, usize)]| {
        let [(i, j), (k, l)] = [w[0], w[1]];
        [x[i..k].to_vec(), y[m - l..m - j].to_vec()]
    };
    let parts: Vec<[Vec<usize>; 2]> = steps.windows(2).map(part).collect();
    let features = features(sheet, border, (a, b), (&rx, &ry), &steps, &parts);
    Some(Laid { parts, features })
}

fn features(
    sheet: &Sheet,
    border: &Border,
    (a, b): (&Stretch, &Stretch),
    (rx, ry): (&Ruler, &Ruler),
    steps: &[(usize, usize)],
    parts: &[[Vec<usize>; 2]],
) -> [f64; FEATURES] {
    let ratio = (rx.total / ry.total).ln().abs();
    let inner = &steps[usize::from(!(a.ring && b.ring)).min(steps.len() - 1)..steps.len() - 1];
    let met = inner.len() as f64;
    let error = inner.iter().map(|(i, j)| (rx.at[*i] - ry.at[*j]).abs()).sum::<f64>() / met.max(1.0);
    let alone = (rx.at.len() + ry.at.len()) as f64 - 2.0 * steps.len() as f64;
    let both = inner.iter().filter(|(i, j)| rx.crosses[*i] && ry.crosses[*j]).count() as f64;
    let one = inner.iter().filter(|(i, j)| rx.crosses[*i] != ry.crosses[*j]).count() as f64;
    let mean = |s: &Stretch, f: &dyn Fn(usize) -> f64| {
        s.edges.iter().map(|e| f(*e) * sheet.edges[*e].length).sum::<f64>()
            / length(sheet, &s.edges).max(1e-9)
    };
    let [ua, ub] = [a, b].map(|s| mean(s, &|e| sheet.edges[e].out.y));
    let [ca, cb] = [a, b].map(|s| mean(s, &|e| bulge(&sheet.edges[e])));
    let ends = if a.ring || b.ring {
        0.0
    } else {
        let after = |s: &Stretch| border.next[s.edges[s.edges.len() - 1]];
        let [x, y] = [(a.edges[0], after(b)), (b.edges[0], after(a))];
        let flat = |(p, q): (usize, usize)| near(border.angle[p] + border.angle[q] - 180.0, 20.0);
        (flat(x) + flat(y)) / 2.0
    };
    let group = |s: &Stretch| border.group_of(sheet.edges[s.edges[0]].piece);
    let apart = group(a) != group(b);
    let slender = |s: &Stretch| s.edges.iter().all(|e| sheet.slender(sheet.edges[*e].piece) > 3.0);
    let flag = |x: bool| if x { 1.0 } else { 0.0 };
    let twins = parts.iter().all(|[x, y]| {
        let own: Vec<Option<usize>> = x.iter().rev().map(|e| sheet.image[*e]).collect();
        own.iter().zip(y).all(|(i, e)| *i == Some(*e)) && own.len() == y.len()
    });
    let single = parts.iter().filter(|[x, y]| x.len() == 1 && y.len() == 1).count() as f64;
    let local = parts.iter().map(|[x, y]| {
        let own = (length(sheet, x) / length(sheet, y).max(1e-9)).ln().abs();
        (own - ratio).abs() * length(sheet, x) / rx.total
    });
    [
        1.0,
        near(ratio, 0.01),
        near(ratio, 0.06),
        ratio,
        (1.0 + met).ln(),
        (1.0 + alone.max(0.0)).ln(),
        near(error, 0.003),
        near(error, 0.02),
        (-ua * ub).max(0.0),
        (-ua).max(0.0) * (-ub).max(0.0),
        ua.max(0.0) * ub.max(0.0),
        flag(a.ring && b.ring),
        flag(a.ring != b.ring),
        ends,
        both,
        one,
        flag(apart),
        flag(slender(a) != slender(b)),
        (rx.total.min(ry.total) / 0.3).ln(),
        if ca * cb < 0.0 { (-ca * cb).sqrt().min(0.3) * 5.0 } else { 0.0 },
        if ca * cb > 0.0 { (ca * cb).sqrt().min(0.3) * 5.0 } else { 0.0 },
        flag(twins),
        single / parts.len().max(1) as f64,
        near(local.sum(), 0.03) * (1.0 + met).ln() / LN_2,
        (-ua * ub).max(0.0) * near(error, 0.02) * flag(apart),
        flag(ca * cb < -1e-3) * near(ratio, 0.06) * flag(a.ring && b.ring),
        (-ua * ub).max(0.0) * both.min(3.0),
        flag(a.ring && b.ring) * both.min(3.0) * flag(apart) * near(error, 0.02),
    ]
}

/// The odds of two stretches as a logarithm.
pub(super) fn log_odds(f: &[f64; FEATURES]) -> f64 {
    f.iter().zip(WEIGHTS).map(|(x, w)| x * w).sum()
}

/// Fitted like those of single edges.
pub(super) const WEIGHTS: [f64; FEATURES] = [
    -0.959, -0.769, 1.758, -2.006, 0.862, -2.771, -0.762, -0.756, -0.475, -3.228, -0.260, -3.942, -1.474,
    -0.429, -0.330, 0.819, 0.083, -0.458, -0.386, 2.079, -2.863, 0.000, -0.843, 2.168, 2.009, 0.005, 0.127,
    1.085,
];
