//! Quadrilaterals around segments.
//!
//! A side and the two that meet its ends are segments; the fourth is looked for between those two,
//! where a line lies on ridges along most of its length. Each quadrilateral is given its support:
//! how much of its outline lies on ridges, less how much its sides run on beyond the corners, as
//! those of boards, tiles and checks do.
//!
//! Cost: the meetings of each segment squared; they are bounded (`MEETINGS`).

use crate::ridges::SlopeRidges;
use crate::segments::Segment;
use nalgebra::{Point2, Vector2};
use rayon::prelude::*;

/// A convex quadrilateral, clockwise where y grows downwards.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quad {
    pub(crate) corners: [Point2<f64>; 4],
    /// Share of the outline on ridges, less that of what runs on.
    pub(crate) support: f64,
}

impl Quad {
    pub(crate) fn sides(&self) -> [f64; 4] {
        std::array::from_fn(|i| (self.corners[(i + 1) % 4] - self.corners[i]).norm())
    }
}

/// Area, positive for clockwise corners where y grows downwards.
pub(crate) fn area(corners: &[Point2<f64>; 4]) -> f64 {
    0.5 * (0..4).map(|i| corners[i].coords.perp(&corners[(i + 1) % 4].coords)).sum::<f64>()
}

/// The nearest meetings of an end that are followed.
const MEETINGS: usize = 12;
/// Of each segment so many pairs of meetings are looked at.
const PAIRS: usize = 9;
/// The least share of a side on ridges.
const ON_RIDGES: f64 = 0.5;

/// Where an end of a segment meets another segment, which leads away from it.
#[derive(Debug, Clone, Copy)]
struct SegmentMeeting {
    at: Point2<f64>,
    away: Vector2<f64>,
    /// How far the other segment reaches from there.
    reach: f64,
    gap: f64,
}

/// Quadrilaterals of sides of at least `least` pixels whose sides are about in the proportion
/// `aspect` (the long one over the short one, in the picture up to twice as much or half as much),
/// the best supported first.
pub(crate) fn quads(segments: &[Segment], ridges: &SlopeRidges, least: f64, aspect: f64) -> Vec<Quad> {
    let of = |i: usize| around(segments, ridges, i, least, aspect);
    let lists: Vec<Vec<Quad>> = (0..segments.len()).into_par_iter().map(of).collect();
    let mut found: Vec<Quad> = lists.into_iter().flatten().collect();
    found.sort_by(|a, b| b.support.total_cmp(&a.support));
    found
}

/// The quadrilaterals of which segment `i` is a side.
fn around(segments: &[Segment], ridges: &SlopeRidges, i: usize, least: f64, aspect: f64) -> Vec<Quad> {
    let [firsts, seconds] = [0, 1].map(|end| meetings(segments, i, end));
    let mut found: Vec<Quad> = Vec::new();
    let mut looked = 0;
    for (first, second) in pairs(&firsts, &seconds) {
        if looked < PAIRS {
            let side = second.at - first.at;
            if side.norm() < least || side.dot(&segments[i].along()) <= 0.0 {
                continue;
            }
            let (u, v) = (side.perp(&first.away), side.perp(&second.away));
            let like = first.away.dot(&second.away);
            if u * v > 0.0 && like > 0.8 && on_ridges(ridges, first.at, second.at) >= ON_RIDGES {
                looked += 1;
                let long = side.norm();
                let depths = [(0.55 * long / aspect).max(least), 1.2 * long * aspect];
                fourth(ridges, [first, second], [0.0; 2], depths, least, &mut found);
                // Where the sides are seen whole, the fourth lies between their ends.
                let reaches = [first.reach, second.reach];
                if reaches.iter().all(|r| (depths[0]..=depths[1]).contains(r)) {
                    fourth(ridges, [first, second], reaches, [-6.0, 6.0], least, &mut found);
                }
            }
        }
    }
    found
}

/// Meetings of both ends, the nearest first.
fn pairs<'a>(
    firsts: &'a [SegmentMeeting],
    seconds: &'a [SegmentMeeting],
) -> Vec<(&'a SegmentMeeting, &'a SegmentMeeting)> {
    let mut pairs: Vec<_> = firsts.iter().flat_map(|f| seconds.iter().map(move |s| (f, s))).collect();
    pairs.sort_by(|a, b| (a.0.gap + a.1.gap).total_cmp(&(b.0.gap + b.1.gap)));
    pairs
}

/// Depths, beyond some of the two sides each, at which a fourth side lies on ridges.
fn fourth(
    ridges: &SlopeRidges,
    [first, second]: [&SegmentMeeting; 2],
    beyond: [f64; 2],
    [from, to]: [f64; 2],
    least: f64,
    found: &mut Vec<Quad>,
) {
    let end = |m: &SegmentMeeting, depth: f64| m.at + m.away * depth;
    let ends = |depth: f64| (end(first, beyond[0] + depth), end(second, beyond[1] + depth));
    let share = |depth: f64| likely(ridges, ends(depth).0, ends(depth).1);
    let steps = (((to - from).max(0.0) / STEP) as usize).min(750);
    let shares: Vec<f64> = (0..=steps).map(|n| share(from + n as f64 * STEP)).collect();
    for n in 0..=steps {
        let before = if n > 0 { shares[n - 1] } else { 0.0 };
        let after = shares.get(n + 1).copied().unwrap_or(0.0);
        if shares[n] >= ON_RIDGES && before < shares[n] && after <= shares[n] {
            let depth = from + n as f64 * STEP;
            // The middle of the depths that are as good.
            let good: Vec<f64> = [-1.0, 0.0, 1.0, 2.0]
                .map(|d| depth + d)
                .into_iter()
                .filter(|d| share(*d) >= shares[n])
                .collect();
            let (p, q) = ends(good.iter().sum::<f64>() / good.len().max(1) as f64);
            found.extend(quad(ridges, [first.at, second.at, q, p], least));
        }
    }
}

/// Distance of the depths that are looked at: a ridge is seen from a pixel beside it.
const STEP: f64 = 2.0;

/// The quadrilateral, turned clockwise, if enough of it is seen and it is not known yet.
fn quad(ridges: &SlopeRidges, mut corners: [Point2<f64>; 4], least: f64) -> Option<Quad> {
    if area(&corners) < 0.0 {
        corners.reverse();
    }
    let mut quad = Quad { corners, support: 0.0 };
    let sides = quad.sides();
    let shares: [f64; 4] = std::array::from_fn(|i| on_ridges(ridges, corners[i], corners[(i + 1) % 4]));
    let worst = shares.iter().copied().fold(1.0, f64::min);
    if worst < ON_RIDGES || sides.iter().any(|s| *s < least) {
        return None;
    }
    let mean = shares.iter().sum::<f64>() / 4.0;
    quad.support = 0.5 * mean + 0.5 * worst - 0.5 * run_on(ridges, &corners);
    Some(quad)
}

/// Share of the eight continuations of the sides that lie on ridges.
fn run_on(ridges: &SlopeRidges, corners: &[Point2<f64>; 4]) -> f64 {
    let beyond = |a: Point2<f64>, b: Point2<f64>| {
        let d = b - a;
        seen(ridges, b + d * 0.08, b + d * 0.3, 6)
    };
    (0..4).map(|i| (corners[i], corners[(i + 1) % 4])).map(|(a, b)| beyond(a, b) + beyond(b, a)).sum::<f64>()
        / 8.0
}

/// Share of a side on ridges, its ends left out.
fn on_ridges(ridges: &SlopeRidges, a: Point2<f64>, b: Point2<f64>) -> f64 {
    let d = b - a;
    let count = (d.norm() as usize).clamp(8, 40);
    seen(ridges, a + d * 0.06, b - d * 0.06, count)
}

/// Share of the places between the ends with a ridge along the line; 0 as soon as it is too low.
fn likely(ridges: &SlopeRidges, a: Point2<f64>, b: Point2<f64>) -> f64 {
    let d = b - a;
    let few = seen(ridges, a + d * 0.1, b - d * 0.1, 4);
    if few < ON_RIDGES { 0.0 } else { seen(ridges, a + d * 0.06, b - d * 0.06, 12) }
}

/// Share of `count` places from `a` to `b` with a ridge along the line within a pixel.
fn seen(ridges: &SlopeRidges, a: Point2<f64>, b: Point2<f64>, count: usize) -> f64 {
    let d = b - a;
    let Some(along) = d.try_normalize(1e-9) else { return 0.0 };
    let normal = Vector2::new(-along.y, along.x);
    let twice = [normal.x * normal.x - normal.y * normal.y, 2.0 * normal.x * normal.y].map(|v| v as f32);
    let mut on = 0;
    for n in 0..count {
        let p = a + d * ((n as f64 + 0.5) / count as f64);
        on += usize::from([0.0, 1.0, -1.0].iter().any(|s| ridges.along(p + normal * *s, twice)));
    }
    on as f64 / count as f64
}

/// The nearest meetings of an end of segment `i`, those alike counted once.
fn meetings(segments: &[Segment], i: usize, end: usize) -> Vec<SegmentMeeting> {
    let mut list = Vec::new();
    for (other, s) in segments.iter().enumerate() {
        if other != i {
            list.extend((0..2).filter_map(|e| meeting(&segments[i], end, s, e)));
        }
    }
    list.sort_by(|a: &SegmentMeeting, b| a.gap.total_cmp(&b.gap));
    let mut kept: Vec<SegmentMeeting> = Vec::new();
    for m in list {
        let same = |k: &SegmentMeeting| (k.at - m.at).norm() < 1.0 && k.away.dot(&m.away) > 0.9995;
        if !kept.iter().any(same) {
            kept.push(m);
        }
        if kept.len() == MEETINGS {
            break;
        }
    }
    kept
}

/// The crossing of two segments' lines, if it is near those ends and the angle is large enough.
fn meeting(one: &Segment, end: usize, two: &Segment, e: usize) -> Option<SegmentMeeting> {
    let (p, q) = (if end == 0 { one.a } else { one.b }, if e == 0 { two.a } else { two.b });
    let (l1, l2) = (one.length(), two.length());
    let reach = 0.9 * (l1 + l2) + 8.0;
    if (p.x - q.x).abs() > reach || (p.y - q.y).abs() > reach {
        return None;
    }
    let (u, v) = (one.along(), two.along());
    let sine = u.perp(&v);
    if sine.abs() < 0.5 {
        return None;
    }
    let t = (two.a - one.a).perp(&v) / sine;
    let at = one.a + u * t;
    let outward = |v: Vector2<f64>, end: usize| if end == 0 { -v } else { v };
    let gaps = [gap(at, p, outward(u, end), l1)?, gap(at, q, outward(v, e), l2)?];
    let reach = (if e == 0 { two.b } else { two.a } - at).norm();
    Some(SegmentMeeting { at, away: -outward(v, e), reach, gap: gaps[0] + gaps[1] - 0.3 * l2.min(l1) })
}

/// How far a crossing lies from an end: outside of the segment by nine tenths of it, inside by a
/// quarter.
fn gap(at: Point2<f64>, end: Point2<f64>, outward: Vector2<f64>, length: f64) -> Option<f64> {
    let t = outward.dot(&(at - end));
    let allowed = if t > 0.0 { 0.9 * length + 4.0 } else { 0.25 * length + 2.0 };
    (t.abs() <= allowed).then_some(t.abs())
}
