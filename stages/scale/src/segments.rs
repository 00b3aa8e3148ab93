//! Straight segments of ridges.
//!
//! Ridge pixels of like direction are grown into regions (after Grompone von Gioi, Jakubowicz,
//! Morel and Randall, LSD, IEEE PAMI 32(4), 2010), each is fitted by a line, and is cut where it
//! bends. Then segments that follow each other on one line are joined.
//!
//! Cost: linear in the ridge pixels; the joining is quadratic in the segments, of which at most
//! `MOST` are kept.

use crate::ridges::SlopeRidges;
use nalgebra::{Point2, Vector2};

/// A straight segment at the reduced size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Segment {
    pub(crate) a: Point2<f64>,
    pub(crate) b: Point2<f64>,
    /// Length of its parts that lie on ridges, pixels.
    pub(crate) seen: f64,
}

impl Segment {
    pub(crate) fn length(&self) -> f64 {
        (self.b - self.a).norm()
    }

    /// Unit vector from `a` to `b`.
    pub(crate) fn along(&self) -> Vector2<f64> {
        (self.b - self.a) / self.length().max(1e-9)
    }

    /// Distance of a place from the segment's line.
    pub(crate) fn off(&self, p: Point2<f64>) -> f64 {
        self.along().perp(&(p - self.a)).abs()
    }
}

/// Segments beyond this number are left out, the shortest first.
const MOST: usize = 900;
/// Cosine of twice the largest angle between a pixel's direction and its region's (22.5 degrees).
const ALIKE: f32 = 0.707;
/// The largest mean distance of a region's pixels from its line, pixels.
const STRAIGHT: f64 = 0.75;

/// Segments of at least `least` pixels, the longest first.
pub(crate) fn segments(ridges: &SlopeRidges, least: f64) -> Vec<Segment> {
    let mut taken = vec![false; ridges.on.len()];
    let mut found = Vec::new();
    let mut region = Vec::new();
    for start in seeds(ridges) {
        if !taken[start] {
            grow(ridges, &mut taken, start, &mut region);
            split(ridges, &mut region, least, &mut found, 0);
        }
    }
    keep_longest(&mut found);
    let mut joined = join(&found);
    found.append(&mut joined);
    keep_longest(&mut found);
    found
}

fn keep_longest(found: &mut Vec<Segment>) {
    found.sort_by(|a, b| b.length().total_cmp(&a.length()));
    found.truncate(MOST);
}

/// Ridge pixels, the steepest first; in steps of size, so that the order is that of the rows within
/// one.
fn seeds(ridges: &SlopeRidges) -> Vec<usize> {
    let mut bins: Vec<Vec<usize>> = vec![Vec::new(); 64];
    for i in (0..ridges.on.len()).filter(|i| ridges.on[*i]) {
        bins[(ridges.slopes[i].size as usize).min(63)].push(i);
    }
    bins.into_iter().rev().flatten().collect()
}

/// The ridge pixels near `start` that have its direction and lie on the line of those before.
fn grow(ridges: &SlopeRidges, taken: &mut [bool], start: usize, region: &mut Vec<usize>) {
    region.clear();
    region.push(start);
    taken[start] = true;
    let place = |i: usize| Vector2::new((i % ridges.w) as f64, (i / ridges.w) as f64);
    let mut sum = ridges.slopes[start].twice;
    let mut sums = Sums::of(place(start));
    let mut next = 0;
    while next < region.len() {
        let (x, y) = (region[next] % ridges.w, region[next] / ridges.w);
        next += 1;
        let line = sums.line();
        for v in y.saturating_sub(2)..=(y + 2).min(ridges.h - 1) {
            for u in x.saturating_sub(2)..=(x + 2).min(ridges.w - 1) {
                let j = v * ridges.w + u;
                let like = ridges.on[j] && !taken[j] && alike(sum, ridges.slopes[j].twice);
                if like && line.is_none_or(|(m, d)| d.perp(&(place(j) - m)).abs() < BESIDE) {
                    taken[j] = true;
                    (0..2).for_each(|c| sum[c] += ridges.slopes[j].twice[c]);
                    sums.add(place(j));
                    region.push(j);
                }
            }
        }
    }
}

/// Pixels further from the line of a region are not of it: other edges that meet it at a small
/// angle.
const BESIDE: f64 = 1.7;
/// Pixels from which on a region has a line.
const LINE: f64 = 16.0;

/// Sums over places from the first of them.
#[derive(Debug, Clone, Copy)]
struct Sums {
    first: Vector2<f64>,
    n: f64,
    sum: Vector2<f64>,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Sums {
    fn of(first: Vector2<f64>) -> Self {
        Sums { first, n: 1.0, sum: Vector2::zeros(), xx: 0.0, xy: 0.0, yy: 0.0 }
    }

    fn add(&mut self, p: Vector2<f64>) {
        let d = p - self.first;
        self.n += 1.0;
        self.sum += d;
        self.xx += d.x * d.x;
        self.xy += d.x * d.y;
        self.yy += d.y * d.y;
    }

    /// Middle and direction, of enough places.
    fn line(&self) -> Option<(Vector2<f64>, Vector2<f64>)> {
        let m = self.sum / self.n;
        let (xx, yy) = (self.xx - self.n * m.x * m.x, self.yy - self.n * m.y * m.y);
        let angle = 0.5 * (2.0 * (self.xy - self.n * m.x * m.y)).atan2(xx - yy);
        (self.n >= LINE).then(|| (self.first + m, Vector2::new(angle.cos(), angle.sin())))
    }
}

fn alike(sum: [f32; 2], one: [f32; 2]) -> bool {
    sum[0] * one[0] + sum[1] * one[1] > ALIKE * sum[0].hypot(sum[1])
}

/// The region as a segment, or its halves where it bends.
fn split(ridges: &SlopeRidges, region: &mut [usize], least: f64, out: &mut Vec<Segment>, depth: usize) {
    if (region.len() as f64) < 0.6 * least {
        return;
    }
    let Some((middle, along)) = axis(ridges, region) else { return };
    let place = |i: usize| Vector2::new((i % ridges.w) as f64, (i / ridges.w) as f64) - middle;
    let rms =
        (region.iter().map(|i| along.perp(&place(*i)).powi(2)).sum::<f64>() / region.len() as f64).sqrt();
    region.sort_by(|i, j| along.dot(&place(*i)).total_cmp(&along.dot(&place(*j))));
    let ends = [region[0], region[region.len() - 1]].map(|i| along.dot(&place(i)));
    if rms <= STRAIGHT {
        let [a, b] = ends.map(|t| Point2::from(middle + along * t));
        // A region that is dense enough to be a line: a pixel for each 1.6 of its length at least.
        if ends[1] - ends[0] >= least && region.len() as f64 > 0.6 * (ends[1] - ends[0]) {
            out.push(Segment { a, b, seen: ends[1] - ends[0] });
        }
    } else if depth < 6 {
        let at = bend(region, ends, |i| (along.dot(&place(i)), along.perp(&place(i))));
        let (left, right) = region.split_at_mut(at);
        split(ridges, left, least, out, depth + 1);
        split(ridges, right, least, out, depth + 1);
    }
}

/// Middle and main direction of the pixels, weighted by slope.
fn axis(ridges: &SlopeRidges, region: &[usize]) -> Option<(Vector2<f64>, Vector2<f64>)> {
    let (mut total, mut first) = (0.0, Vector2::zeros());
    let place = |i: usize| Vector2::new((i % ridges.w) as f64, (i / ridges.w) as f64);
    for i in region {
        let weight = f64::from(ridges.slopes[*i].size);
        total += weight;
        first += place(*i) * weight;
    }
    let middle = first / total;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for i in region {
        let (d, weight) = (place(*i) - middle, f64::from(ridges.slopes[*i].size));
        xx += weight * d.x * d.x;
        xy += weight * d.x * d.y;
        yy += weight * d.y * d.y;
    }
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    (total > 0.0).then(|| (middle, Vector2::new(angle.cos(), angle.sin())))
}

/// Where to cut a bent region: at the pixel that is furthest from the line between its ends, or at
/// its half.
fn bend(region: &[usize], ends: [f64; 2], at: impl Fn(usize) -> (f64, f64)) -> usize {
    let (first, last) = (at(region[0]).1, at(region[region.len() - 1]).1);
    let chord = |t: f64| first + (last - first) * (t - ends[0]) / (ends[1] - ends[0]).max(1e-9);
    let (mut best, mut far) = (region.len() / 2, 0.0);
    for (n, i) in region.iter().enumerate() {
        let (t, off) = at(*i);
        if (off - chord(t)).abs() > far {
            (best, far) = (n, (off - chord(t)).abs());
        }
    }
    // A cut near an end would leave the bend where it is.
    best.clamp(region.len() / 8 + 1, region.len() - region.len() / 8 - 1).min(region.len())
}

/// Longer segments made of ones that follow each other on a line; the parts stay as they are.
fn join(parts: &[Segment]) -> Vec<Segment> {
    let mut joined = Vec::new();
    for (n, seed) in parts.iter().enumerate().take(MOST / 2) {
        let mut whole = *seed;
        for (m, other) in parts.iter().enumerate() {
            if m != n && follows(&whole, other) {
                whole = both(&whole, other);
            }
        }
        let grew = whole.length() > seed.length() + 1.0;
        if grew && !joined.iter().any(|s: &Segment| same(s, &whole)) {
            joined.push(whole);
        }
    }
    joined
}

/// Whether `other` lies on the line of `whole`, with a gap that is shorter than the shorter of
/// them.
fn follows(whole: &Segment, other: &Segment) -> bool {
    let along = whole.along();
    if along.perp(&other.along()).abs() > 0.08 + 1.2 / other.length() {
        return false;
    }
    let length = whole.length();
    let mut t = [along.dot(&(other.a - whole.a)), along.dot(&(other.b - whole.a))];
    t.sort_by(f64::total_cmp);
    let gap = (t[0] - length).max(-t[1]);
    let reach = 1.2 + 0.015 * length.max(other.length());
    let near = whole.off(other.a) < reach && whole.off(other.b) < reach;
    near && gap > -0.3 * other.length() && gap < (1.5 * other.length()).min(0.7 * length).max(4.0)
}

/// The segment from end to end of both.
fn both(whole: &Segment, other: &Segment) -> Segment {
    let along = whole.along();
    let mut ends = [whole.a, whole.b, other.a, other.b];
    ends.sort_by(|p, q| along.dot(&p.coords).total_cmp(&along.dot(&q.coords)));
    Segment { a: ends[0], b: ends[3], seen: whole.seen + other.seen }
}

fn same(a: &Segment, b: &Segment) -> bool {
    let near = |p: Point2<f64>, q: Point2<f64>| (p - q).norm() < 2.0;
    (near(a.a, b.a) && near(a.b, b.b)) || (near(a.a, b.b) && near(a.b, b.a))
}
