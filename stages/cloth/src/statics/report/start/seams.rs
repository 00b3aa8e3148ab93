//! Seams that cannot be meant as they are: between pins at two places, or with one side reversed.
//!
//! The threads of a seam are the lines between the two vertices of each pair. If the second side is
//! reversed by mistake, they cross and are longer than those of the opposite order. A seam that is
//! twisted on purpose (a Möbius band) has crossing threads, too, but hardly longer ones if it
//! starts flat, since a band is at least 1.7 times longer than it is wide (Schwartz 2023). So
//! reversed seams are refused only on a body, where no panel is turned over. Elsewhere they are
//! named only if the seam does not close.
//!
//! Cost: O(n log n) for the outlines; for a closed seam, the square of its pairs.

use super::StartError;
use crate::scene::{Scene, Seam};
use std::collections::BTreeMap;
use toile_geometry::{Vec3, components::groups};

/// Least ratio of the thread lengths of a reversed seam to those of the opposite order. A flat band
/// that is sewn with a twist has at most 1.06.
const LONGER: f64 = 1.1;

/// The same where the distance of the sides is left out: edges at right angles may be sewn either
/// way.
const TURNED: f64 = 1.25;

/// The same for sides that are equal except for their order.
const MIRRORED: f64 = 4.0;

/// Greatest number of pairs of a closed seam whose orders are compared.
const MOST_ROUND: usize = 2000;

/// Refuses a seam between vertices that are pinned at two places.
pub(super) fn check_pins(scene: &Scene, join_gap: f64) -> Result<(), StartError> {
    let (point, points) = groups(scene.rest.len(), scene.seams.iter().flat_map(|s| &s.pairs).copied());
    let mut first = vec![None; points];
    for &v in &scene.pinned {
        let p = scene.positions[v as usize];
        let at = *first[point[v as usize] as usize].get_or_insert(p);
        let gap = (p - at).norm();
        if gap > join_gap {
            let has = |s: &&Seam| s.pairs.iter().any(|p| p.contains(&v));
            let seam = scene.seams.iter().find(has).map_or("?", |s| &s.name).to_string();
            return Err(StartError::PinnedApart { seam, gap });
        }
    }
    Ok(())
}

/// Refuses reversed seams.
pub(super) fn check_order(scene: &Scene, start: &[Vec3]) -> Result<(), StartError> {
    let outlines = Outlines::of(scene);
    let reversed = |s: &Seam| {
        let threads = Threads::of(&outlines, s, start, false)?;
        (threads.listed > LONGER * threads.turned).then(|| (s.name.clone(), threads))
    };
    let found: Vec<(String, Threads)> = scene.seams.iter().filter_map(reversed).collect();
    let Some((_, Threads { listed: apart, turned })) = found.first().cloned() else { return Ok(()) };
    Err(StartError::Reversed { seams: found.into_iter().map(|(name, _)| name).collect(), apart, turned })
}

/// Names of the seams whose sides run in opposite directions, which may be intended.
pub(crate) fn probably_reversed(scene: &Scene, start: &[Vec3]) -> Vec<String> {
    let outlines = Outlines::of(scene);
    let is_turned =
        |s: &&Seam| Threads::of(&outlines, s, start, true).is_some_and(|t| t.listed > TURNED * t.turned);
    scene.seams.iter().filter(is_turned).map(|s| s.name.clone()).collect()
}

/// Names of the seams that are reversed both at the start and with their sides moved onto each
/// other. Seams that are twisted on purpose, or whose sides start rotated, are not among them.
#[must_use]
pub fn surely_reversed(scene: &Scene, start: &[Vec3]) -> Vec<String> {
    let outlines = Outlines::of(scene);
    let is = |s: &Seam, laid: bool, times: f64| {
        Threads::of(&outlines, s, start, laid).is_some_and(|t| t.listed > times * t.turned)
    };
    let is_turned = |s: &&Seam| is(s, false, LONGER) && is(s, true, MIRRORED);
    scene.seams.iter().filter(is_turned).map(|s| s.name.clone()).collect()
}

/// Mean lengths of the threads of a seam, m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Threads {
    /// In the given order.
    listed: f64,
    /// With one side reversed.
    turned: f64,
}

impl Threads {
    /// The lengths for a seam of at least two pairs; with `laid` its sides are first moved onto
    /// each other. `None` where the order does not decide, because closed sides may be shifted
    /// along each other instead.
    fn of(outlines: &Outlines, seam: &Seam, x: &[Vec3], laid: bool) -> Option<Self> {
        let (pairs, is_round) = outlines.in_order(seam);
        let n = pairs.len();
        if n < 2 || is_round && n > MOST_ROUND {
            return None;
        }
        let [mut a, b] = [0, 1].map(|k| pairs.iter().map(|p| x[p[k] as usize]).collect::<Vec<Vec3>>());
        if laid {
            let middle = |side: &[Vec3]| side.iter().sum::<Vec3>() / n as f64;
            let apart = middle(&b) - middle(&a);
            a.iter_mut().for_each(|p| *p += apart);
        }
        let mean =
            |of: &dyn Fn(usize) -> usize| (0..n).map(|i| (a[i] - b[of(i)]).norm()).sum::<f64>() / n as f64;
        let least = |all: &mut dyn Iterator<Item = f64>| all.fold(f64::INFINITY, f64::min);
        let listed = mean(&|i| i);
        if !is_round {
            return Some(Self { listed, turned: mean(&|i| n - 1 - i) });
        }
        let turned = least(&mut (0..n).map(|r| mean(&|i| (2 * n + r - i) % n)));
        let shifted = least(&mut (0..n).map(|r| mean(&|i| (i + r) % n)));
        (shifted > LONGER * turned).then_some(Self { listed, turned })
    }
}

/// The outlines of a scene's pieces.
struct Outlines<'s> {
    scene: &'s Scene,
    /// The next vertex of each on its outline; `u32::MAX` inside.
    next: Vec<u32>,
}

impl<'s> Outlines<'s> {
    fn of(scene: &'s Scene) -> Self {
        let mut next = vec![u32::MAX; scene.rest.len()];
        if !scene.seams.is_empty() {
            let sides = scene.triangles.iter().flat_map(|t| (0..3).map(move |k| [t[k], t[(k + 1) % 3]]));
            let mut sides: Vec<[u32; 2]> = sides.collect();
            sides.sort_unstable();
            let is_inner = |s: &[u32; 2]| sides.binary_search(&[s[1], s[0]]).is_ok();
            sides.iter().filter(|s| !is_inner(s)).for_each(|s| next[s[0] as usize] = s[1]);
        }
        Self { scene, next }
    }

    /// The pairs of a seam in the order of its first side along the outline, and whether that side
    /// is closed. They stay as listed where that side is not on one outline.
    fn in_order(&self, seam: &Seam) -> (Vec<[u32; 2]>, bool) {
        let mut pairs = seam.pairs.clone();
        let along = pairs.first().and_then(|p| self.round(p[0]));
        let Some((along, length)) = along.filter(|(a, _)| pairs.iter().all(|p| a.contains_key(&p[0]))) else {
            return (pairs, false);
        };
        let place = |p: &[u32; 2]| along.get(&p[0]).copied().unwrap_or(0.0);
        pairs.sort_by(|p, q| place(p).total_cmp(&place(q)));
        let n = pairs.len();
        // The distance from each pair to the one before it, cyclically.
        let ways: Vec<f64> =
            (0..n).map(|i| (place(&pairs[i]) - place(&pairs[(i + n - 1) % n])).rem_euclid(length)).collect();
        let first = (0..n).fold(0, |best, i| if ways[i] > ways[best] { i } else { best });
        let second = (0..n).filter(|i| *i != first).map(|i| ways[i]).fold(0.0, f64::max);
        pairs.rotate_left(first);
        (pairs, n > 3 && ways[first] < 2.0 * second)
    }

    /// The distance of each vertex from `first` along the outline, and the length of the outline,
    /// m.
    fn round(&self, first: u32) -> Option<(BTreeMap<u32, f64>, f64)> {
        let rest = |v: u32| self.scene.rest[v as usize];
        let (mut along, mut length, mut at) = (BTreeMap::new(), 0.0, first);
        loop {
            let next = Some(self.next[at as usize]).filter(|n| *n != u32::MAX)?;
            if along.insert(at, length).is_some() {
                return None;
            }
            length += (rest(next) - rest(at)).norm();
            at = next;
            if at == first {
                return Some((along, length));
            }
        }
    }
}
