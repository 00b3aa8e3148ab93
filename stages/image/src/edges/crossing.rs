//! Does a set of closed loops cross itself?
//!
//! Method: segments are put into the cells of a grid that they touch, and those that share a cell
//! are tested with exact orientation (J. Shewchuk, 1997, by the crate `robust`). Cost: about linear
//! for evenly spaced outlines.

use robust::{Coord, orient2d};
use std::collections::BTreeMap;
use toile_core::artifact::{Loop, Point2};

/// A place where two segments that are no neighbours meet, if there is one.
pub(crate) fn first<'a>(loops: impl Iterator<Item = &'a Loop>) -> Option<Point2> {
    let segments: Vec<[Point2; 2]> = loops
        .flat_map(|l| {
            let n = l.points.len();
            (0..n).map(move |i| [l.points[i], l.points[(i + 1) % n]])
        })
        .collect();
    let longest = segments.iter().map(|s| (s[1] - s[0]).norm()).fold(0.0, f64::max);
    let cell = (2.0 * longest).max(f64::MIN_POSITIVE);
    let mut cells: BTreeMap<(i64, i64), Vec<u32>> = BTreeMap::new();
    for (k, s) in segments.iter().enumerate() {
        let (lo, hi) = (s[0].inf(&s[1]), s[0].sup(&s[1]));
        let index = |v: f64| (v / cell).floor() as i64;
        for i in index(lo.x)..=index(hi.x) {
            for j in index(lo.y)..=index(hi.y) {
                cells.entry((i, j)).or_default().push(k as u32);
            }
        }
    }
    let hit = |list: &Vec<u32>| {
        list.iter().enumerate().find_map(|(n, &a)| {
            let meets = |&&b: &&u32| meet(&segments[a as usize], &segments[b as usize]);
            list[n + 1..].iter().find(meets).map(|_| segments[a as usize][0])
        })
    };
    cells.values().find_map(hit)
}

/// The loop without the small loops that it makes where it crosses itself within `reach` points.
pub(crate) fn without_small_loops(l: Loop, reach: usize) -> Loop {
    let n = l.points.len();
    let segment = |i: usize| [l.points[i % n], l.points[(i + 1) % n]];
    let mut kept = vec![true; n];
    let mut i = 0;
    while i < n {
        let crossed = (2..=reach.min(n / 4)).rev().find(|d| meet(&segment(i), &segment(i + d)));
        let end = i + crossed.unwrap_or(0);
        (i + 1..=end).for_each(|k| kept[k % n] = false);
        i = end + 1;
    }
    let index: Vec<usize> =
        kept.iter().scan(0, |at, k| Some(std::mem::replace(at, *at + usize::from(*k)))).collect();
    let corners = l.corners.iter().filter(|c| kept[**c]).map(|c| index[*c]).collect();
    let points = l.points.iter().zip(&kept).filter(|(_, k)| **k).map(|(p, _)| *p).collect();
    Loop { points, corners }
}

/// True where two segments without a common end meet.
fn meet(a: &[Point2; 2], b: &[Point2; 2]) -> bool {
    if a.iter().any(|p| b.contains(p)) {
        return false;
    }
    let side = |s: &[Point2; 2], p: Point2| {
        let c = |p: Point2| Coord { x: p.x, y: p.y };
        orient2d(c(s[0]), c(s[1]), c(p))
    };
    let apart = |s: &[Point2; 2], t: &[Point2; 2]| side(s, t[0]) * side(s, t[1]) > 0.0;
    !apart(a, b) && !apart(b, a) && boxes_meet(a, b)
}

/// Segments on one line meet only where their boxes do.
fn boxes_meet(a: &[Point2; 2], b: &[Point2; 2]) -> bool {
    let (al, ah, bl, bh) = (a[0].inf(&a[1]), a[0].sup(&a[1]), b[0].inf(&b[1]), b[0].sup(&b[1]));
    al.x <= bh.x && bl.x <= ah.x && al.y <= bh.y && bl.y <= ah.y
}
