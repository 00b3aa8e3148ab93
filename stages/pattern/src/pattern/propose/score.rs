//! How likely two free edges are sewn to each other: a logistic score of what a tailor compares.
//!
//! Method: [`features`] of a pair in the state of the garment, weighed by [`WEIGHTS`]. The odds are
//! then shared among the pairs that an edge is in, as it is sewn once. Cost: constant for a pair.

use super::border::Border;
use super::sheet::{Edge, Sheet, apart, bulge};

/// What is compared of two edges.
pub(super) const FEATURES: usize = 53;

/// What is compared of two edges and does not change while seams are taken.
#[derive(Debug, Clone)]
pub(super) struct Pair {
    pub(super) a: usize,
    pub(super) b: usize,
    /// The logarithm of the ratio of lengths.
    pub(super) ratio: f64,
    apart: [f64; 2],
}

/// Closeness: 1 where `x` is 0, less than half where it is `scale`.
pub(super) fn near(x: f64, scale: f64) -> f64 {
    (-x.abs() / scale).exp()
}

/// Pairs of edges of which neither is more than this many times as long as the other.
const LONGEST: f64 = 2.2;
/// The sum, over all edges, of the square of the number of their partners. Where there would be
/// more, the shortest edges are left out until there are not. A garment of thirty pieces has a
/// tenth of it.
const MOST_WORK: usize = 20_000_000;

/// For every edge whether it is a part of its piece's upper (1) or lower (-1) end: one across the
/// grain in the middle of a symmetric piece, or what lies as high beside that. Hems and waists are;
/// necks are hollow, so that shoulders are not.
fn ends(sheet: &Sheet) -> Vec<i8> {
    let looks = |e: usize| match sheet.edges[e].out.y {
        y if y > 0.9 => 1,
        y if y < -0.9 => -1,
        _ => 0,
    };
    // Across the line at which its piece is symmetric.
    let in_middle = |e: usize| sheet.image[e] == Some(e);
    let one = |e: usize| {
        let piece = sheet.edges[e].piece;
        let height = sheet.heights(e);
        let beside = |m: &usize| {
            let tall = (height[0] + height[1]).max(1e-6);
            let level = (sheet.heights(*m)[0] - height[0]).abs() <= 0.06 * tall;
            let straight = bulge(&sheet.edges[*m]).abs() < 0.06;
            sheet.edges[*m].piece == piece && looks(*m) == looks(e) && in_middle(*m) && level && straight
        };
        let is_end = sheet.slender(piece) < 4.0 && (0..sheet.edges.len()).any(|m| beside(&m));
        if is_end { looks(e) } else { 0 }
    };
    (0..sheet.edges.len()).map(one).collect()
}

/// The pairs of edges that may be sewn to each other, none of them shorter than `least`, metres.
pub(super) fn pairs(sheet: &Sheet, least: f64) -> Vec<Pair> {
    let ends = ends(sheet);
    let mut least = least;
    loop {
        let pairs = pairs_from(sheet, &ends, least);
        let mut partners = vec![0usize; sheet.edges.len()];
        pairs.iter().flat_map(|p| [p.a, p.b]).for_each(|e| partners[e] += 1);
        if partners.iter().map(|n| n * n).sum::<usize>() <= MOST_WORK {
            return pairs;
        }
        least *= 1.5;
    }
}

fn pairs_from(sheet: &Sheet, ends: &[i8], least: f64) -> Vec<Pair> {
    let mut order: Vec<usize> = (0..sheet.edges.len()).filter(|e| sheet.edges[*e].length >= least).collect();
    order.sort_by(|x, y| sheet.edges[*x].length.total_cmp(&sheet.edges[*y].length));
    let mut out = Vec::new();
    for (i, &x) in order.iter().enumerate() {
        for &y in &order[i + 1..] {
            let ratio = (sheet.edges[y].length / sheet.edges[x].length).ln();
            if ratio > LONGEST.ln() {
                break;
            }
            let (a, b) = (x.min(y), x.max(y));
            // Hems and waists are sewn to no other hem and waist.
            if ends[a] != 0 && ends[a] == ends[b] {
                continue;
            }
            out.push(Pair { a, b, ratio, apart: apart(&sheet.edges[a], &sheet.edges[b]) });
        }
    }
    out.sort_by_key(|p| (p.a, p.b));
    out
}

/// For every edge the ratios at which free edges of other forms fit it, ascending.
pub(super) fn rivals(sheet: &Sheet, border: &Border, pairs: &[Pair]) -> Vec<Vec<(f64, usize)>> {
    let mut out: Vec<Vec<(f64, usize)>> = vec![Vec::new(); sheet.edges.len()];
    let twins = |p: &Pair| {
        let [x, y] = [p.a, p.b].map(|e| sheet.edges[e].piece);
        sheet.image[p.a] == Some(p.b) || (x != y && sheet.block[x] == sheet.block[y])
    };
    for p in pairs.iter().filter(|p| border.free[p.a] && border.free[p.b] && p.ratio < 0.2 && !twins(p)) {
        out[p.a].push((p.ratio, sheet.alike[p.b]));
        out[p.b].push((p.ratio, sheet.alike[p.a]));
    }
    for all in &mut out {
        all.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let mut seen = std::collections::BTreeSet::new();
        all.retain(|r| seen.insert(r.1));
    }
    out
}

/// How many edges of other forms fit an edge as well as a partner or better.
fn better(rivals: &[(f64, usize)], ratio: f64, partner: usize) -> f64 {
    let upto = rivals.partition_point(|r| r.0 <= ratio * 1.2 + 1e-3);
    rivals[..upto].iter().filter(|r| r.1 != partner).count() as f64
}

/// Whether notches lie at the same places, one edge run through backwards; none where neither has
/// any.
pub(super) fn notches_agree(a: &Edge, b: &Edge) -> Option<bool> {
    if a.notches.is_empty() && b.notches.is_empty() {
        return None;
    }
    let to = a.length / b.length.max(1e-9);
    let met = |n: &f64| b.notches.iter().any(|m| (n - (b.length - m) * to).abs() <= 5e-3);
    Some(a.notches.len() == b.notches.len() && a.notches.iter().all(met))
}

/// What is compared, each about 0 to 1; the last two are notches that agree and that differ.
pub(super) fn features(
    sheet: &Sheet,
    border: &Border,
    rivals: &[Vec<(f64, usize)>],
    p: &Pair,
) -> [f64; FEATURES] {
    let (a, b) = (&sheet.edges[p.a], &sheet.edges[p.b]);
    let (next_a, next_b) = (border.next[p.a], border.next[p.b]);
    let same = a.piece == b.piece;
    let image = sheet.image[p.a] == Some(p.b);
    // Cloth at the two ends of the seam.
    let zips = [next_b == p.a, next_a == p.b];
    let cloth = [
        border.angle[p.a] + if zips[0] { 0.0 } else { border.angle[next_b] },
        border.angle[p.b] + if zips[1] { 0.0 } else { border.angle[next_a] },
    ];
    let open: Vec<f64> = cloth.iter().zip(zips).filter(|(_, z)| !z).map(|(c, _)| c - 180.0).collect();
    let flat = |scale: f64| open.iter().map(|c| near(*c, scale)).sum::<f64>() / 2.0;
    let tight = |f: &dyn Fn(f64) -> f64| {
        cloth.iter().zip(zips).filter(|(_, z)| *z).map(|(c, _)| f(*c)).fold(0.0, f64::max)
    };
    let up = |e: &Edge| e.out.y.max(0.0);
    let down = |e: &Edge| (-e.out.y).max(0.0);
    let level = (a.out.x.abs() * b.out.x.abs()).sqrt();
    let [ha, hb] = [sheet.heights(p.a), sheet.heights(p.b)];
    let long = a.length.max(b.length).max(1e-6);
    let shift = ((ha[0] - hb[0]).abs().min((ha[1] - hb[1]).abs()) / long).min(1.0);
    let (ra, rb) =
        (better(&rivals[p.a], p.ratio, sheet.alike[p.b]), better(&rivals[p.b], p.ratio, sheet.alike[p.a]));
    let crossing = [(p.a, next_b), (next_a, p.b)].map(|(x, y)| (border.crosses[x], border.crosses[y]));
    let both = crossing.iter().filter(|c| c.0 && c.1).count() as f64;
    let one = crossing.iter().filter(|c| c.0 != c.1).count() as f64;
    let length = |e: usize| sheet.edges[e].length.max(1e-6);
    let beside = [(next_a, border.last[p.b]), (border.last[p.a], next_b)];
    let goes_on = |&(x, y): &(usize, usize)| {
        x != y && ![p.a, p.b].contains(&x) && near((length(x) / length(y)).ln(), 0.004) > 0.3
    };
    let beside = beside.iter().filter(|b| goes_on(b)).count() as f64;
    let exact = near(p.ratio, 0.002);
    let (own, other) = (sheet.image[p.a], sheet.image[p.b]);
    // Mirrored the seam would take one of its edges again.
    let odd = !image
        && match (own, other) {
            (Some(x), Some(y)) => (x == p.a) != (y == p.b) || x == p.b || y == p.a,
            _ => false,
        };
    let opposed = (a.out + b.out).norm() / 2.0;
    let dart = same && zips != [false, false];
    let hollow = |e: &Edge| (-3.0 * bulge(e)).clamp(0.0, 1.0);
    let round = |e: &Edge| (3.0 * bulge(e)).clamp(0.0, 1.0);
    let notches = notches_agree(a, b);
    let straight = bulge(a).abs().max(bulge(b).abs()) < 0.005;
    // Along the grain, as in the middle of the body.
    let upright = if straight { near(a.out.y, 0.01) * near(b.out.y, 0.01) } else { 0.0 };
    let end = |e: &Edge| {
        let [h, d] = sheet.heights(if std::ptr::eq(e, a) { p.a } else { p.b });
        let tall = (h + d).max(1e-6);
        // An edge across the grain at the foot of its piece: a hem.
        down(e) * near(h / tall, 0.1)
    };
    // What lies beside the seam at its ends looks as high on one piece as on the other.
    let high = [(border.last[p.a], next_b), (next_a, border.last[p.b])].map(|(x, y)| {
        if x == p.b || y == p.a { 0.5 } else { near(sheet.edges[x].out.y - sheet.edges[y].out.y, 0.35) }
    });
    let beside_y = (high[0] + high[1]) / 2.0;
    let sides = (4.0 * a.out.x).tanh() * (4.0 * b.out.x).tanh();
    // Copies of one piece lie side by side in the middle of the body, or on each other.
    let copies = !same && sheet.block[a.piece] == sheet.block[b.piece];
    let count = |piece: usize| sheet.block.iter().filter(|x| **x == sheet.block[piece]).count();
    let tube = same && !dart && !sheet.unfolded[a.piece] && count(a.piece) > 1 && opposed < 0.3;
    let bands = (sheet.slender(a.piece) > 4.0) as u8 + (sheet.slender(b.piece) > 4.0) as u8;
    let mut f = [
        1.0,
        exact,
        near(p.ratio, 0.01),
        near(p.ratio, 0.05),
        p.ratio.min(1.0),
        near(p.apart[0], 0.004),
        near(p.apart[0], 0.03),
        near(p.apart[1], 0.004),
        near(p.apart[1], 0.03),
        f64::from(u8::from(straight)),
        (a.out.x + b.out.x).abs() / 2.0,
        up(a) * up(b),
        down(a) * down(b),
        shift * level,
        flat(10.0),
        flat(40.0),
        tight(&|c| near(c - 350.0, 25.0)),
        tight(&|c| 1.0 - near(c - 350.0, 25.0)),
        f64::from(u8::from(same)),
        f64::from(u8::from(image)),
        if image { level } else { 0.0 },
        (long / 0.1).ln() / 2.0,
        (1.0 + ra).ln() + (1.0 + rb).ln(),
        if ra + rb == 0.0 { 1.0 } else { 0.0 },
        both,
        one,
        up(a) * down(b) + down(a) * up(b),
        if border.group_of(a.piece) == border.group_of(b.piece) { 1.0 } else { 0.0 },
        beside,
        (a.out.x * b.out.x).max(0.0),
        f64::from(u8::from(odd)),
        exact * near(p.apart[1], 0.01),
        exact * (1.0 - opposed),
        if dart { exact } else { 0.0 },
        hollow(a).min(hollow(b)),
        end(a) * end(b),
        f64::from(bands) * (up(a) * down(b) + down(a) * up(b)),
        if image { upright } else { 0.0 },
        if image { 0.0 } else { upright },
        exact * level * near(shift, 0.02),
        shift * exact * level,
        beside_y,
        up(a).min(up(b)) * beside_y,
        sides,
        up(a).min(up(b)) * sides,
        exact * flat(20.0),
        f64::from(u8::from(copies)),
        if copies { upright } else { 0.0 },
        f64::from(u8::from(tube)),
        if tube { exact } else { 0.0 },
        (a.out.y + b.out.y).abs() / 2.0 * (1.0 - up(a) * up(b)),
        round(a).min(round(b)),
        match notches {
            Some(true) => 1.0,
            Some(false) => -1.0,
            None => 0.0,
        },
    ];
    if image || copies {
        // Edges that are each other's image agree in any case: what agrees says nothing of them.
        for k in [0, 1, 2, 3, 5, 6, 7, 8, 9, 22, 23, 28, 31, 32, 34, 40, 41, 42, 43, 46] {
            f[k] = 0.0;
        }
        // Something else fits them as well.
        let other = |e: usize| rivals[e].first().is_some_and(|r| r.0 < 0.006);
        f[22] = if other(p.a) || other(p.b) { 1.0 } else { 0.0 };
    }
    f
}

/// The odds of a pair as a logarithm.
pub(super) fn log_odds(f: &[f64; FEATURES]) -> f64 {
    f.iter().zip(WEIGHTS).map(|(x, w)| x * w).sum()
}

/// Fitted by `fit` to the tuned half of the files (see `scored`) and to nine labelled patterns of
/// CAD programs, which are not in the repository, each for one and a half; the last, of notches, is
/// set by hand.
pub(super) const WEIGHTS: [f64; FEATURES] = [
    0.772, 3.258, 0.316, 1.396, 0.057, -1.792, 1.235, -0.004, 0.351, 0.347, -4.439, -3.567, -2.920, -4.805,
    0.290, -1.163, 8.203, -0.232, -2.046, -2.349, -0.270, -0.756, -0.263, 0.486, -0.249, 0.245, -0.804,
    -1.229, 0.403, -1.072, -4.480, -1.352, -2.739, -2.036, -9.324, -3.844, 0.387, 3.253, -0.036, 1.053,
    7.242, 0.026, -0.145, 0.178, -5.329, 1.203, 0.000, -2.717, -0.106, 1.086, -2.825, -2.041, 1.500,
];
