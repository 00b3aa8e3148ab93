//! One stitch, and how its sides lie to each other.

use super::panel::Made;
use super::read::RawStitch;

/// A stitch as it is read: its number, its edges and whether start meets end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stitch<'a> {
    pub(super) number: usize,
    pub(super) raw: &'a RawStitch,
    pub(super) start_to_end: bool,
}

/// How far the two sides run against the way in which they are sewn, by their chords in space: -1
/// where every thread has the same length, 1 where they cross most.
pub(super) fn leaning(s: &Stitch<'_>, made: &[Made]) -> f64 {
    let [a, b] = s.raw.sides.map(|(p, e)| made[p].ends[e][1] - made[p].ends[e][0]);
    let cosine = a.dot(&b) / (a.norm() * b.norm()).max(f64::MIN_POSITIVE);
    if s.start_to_end { cosine } else { -cosine }
}

/// The shorter of its two edges, from end to end, metres.
pub(super) fn shortest(s: &RawStitch, made: &[Made]) -> f64 {
    let length = |(p, e): (usize, usize)| (made[p].ends[e][1] - made[p].ends[e][0]).norm();
    length(s.sides[0]).min(length(s.sides[1]))
}
