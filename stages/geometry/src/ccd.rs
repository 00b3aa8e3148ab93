//! When moving pieces of cloth first come near each other: continuous collision detection.
//!
//! Additive continuous collision detection (Li, Kaufman, Jiang 2021): step by step, each as long as
//! the distance divided by the fastest approach allows, so that no step can jump over a contact. No
//! roots of cubics are sought, whose rounding misses contacts. The answer is early by at most a
//! share [`NEARNESS`] of the starting distance, never late.
//!
//! Some ten distance evaluations where nothing is hit. Motion is straight and even over the step.

use crate::pair::{Kind, Pair};

use crate::Vec3;
/// Share of the starting distance at which pieces count as in contact. Smaller finds the contact
/// more exactly in more steps.
pub const NEARNESS: f64 = 0.1;

/// Steps after which the time reached is given as the answer: early, but safe.
const MOST_STEPS: usize = 200;

/// The fastest approach of the two sides, once what all share is taken away.
#[inline]
#[must_use]
pub fn approach(kind: Kind, moves: &[Vec3; 4]) -> f64 {
    let shared = moves.iter().sum::<Vec3>() * 0.25;
    let fastest =
        |moves: &[Vec3]| moves.iter().map(|m| (m - shared).norm_squared()).fold(0.0, f64::max).sqrt();
    let first = if kind == Kind::VertexTriangle { 1 } else { 2 };
    fastest(&moves[..first]) + fastest(&moves[first..])
}

/// Pieces nearer than this may hardly come nearer: much below it, rounding of places could turn the
/// sides about, m.
const CLOSEST: f64 = 1e-6;

/// Share of a place, m, that is surely more than its rounding and what sums and products make of
/// it.
const ROUNDING: f64 = 1e-14;

/// The distance that a pair which starts at `start` keeps through the step.
#[must_use]
pub fn kept(start: f64) -> f64 {
    (NEARNESS * start).max(CLOSEST.min(0.9 * start))
}

/// The time, 0 to 1, until which the pair surely keeps the distance [`kept`] of its start; `None`
/// for all of the step.
///
/// Zero where the two touch at the start or a coordinate is no finite number.
#[must_use]
pub fn impact(pair: &Pair, from: &[Vec3; 4], moves: &[Vec3; 4]) -> Option<f64> {
    let speed = approach(pair.kind, moves);
    let start = pair.kind.closest(from).distance;
    let least = kept(start);
    if speed <= start - least {
        return None;
    }
    let known = from.iter().chain(moves).all(|p| p.iter().all(|v| v.is_finite()));
    if start <= 0.0 || !known {
        return Some(0.0);
    }
    if stays_apart(pair.kind, from, moves, least) {
        return None;
    }
    let (mut time, mut left) = (0.0, start - least);
    for _ in 0..MOST_STEPS {
        let next = time + left / speed;
        if next >= 1.0 {
            return None;
        }
        let at = std::array::from_fn(|i| from[i] + moves[i] * next);
        left = pair.kind.closest(&at).distance - least;
        time = next;
        if left <= NEARNESS * (start - least).min(least) {
            return Some(time);
        }
    }
    Some(time)
}

/// Whether the lines of the two edges, or the vertex and the triangle's plane, keep a distance of
/// `least` for all of the step.
///
/// The distance is the volume that the pair spans over the area of its two sides: a cubic and a
/// quadratic of time, whose coefficients in Bernstein's form bound them. A pair that turns as one
/// spans the same volume, where the steps of [`impact`] see its ends come down and grow too short
/// to get anywhere, if it is close.
fn stays_apart(kind: Kind, from: &[Vec3; 4], moves: &[Vec3; 4], least: f64) -> bool {
    let sides = |x: &[Vec3; 4]| match kind {
        Kind::VertexTriangle => (x[0] - x[1], x[2] - x[1], x[3] - x[1]),
        Kind::EdgeEdge => (x[2] - x[0], x[1] - x[0], x[3] - x[2]),
    };
    let (r, a, b) = sides(from);
    let (s, c, d) = sides(&std::array::from_fn(|i| from[i] + moves[i]));
    let area = [a.cross(&b), (a.cross(&d) + c.cross(&b)) * 0.5, c.cross(&d)];
    let volume = [
        r.dot(&area[0]),
        (s.dot(&area[0]) + 2.0 * r.dot(&area[1])) / 3.0,
        (2.0 * s.dot(&area[1]) + r.dot(&area[2])) / 3.0,
        s.dot(&area[2]),
    ];
    let widest = area.iter().map(Vec3::norm_squared).fold(0.0, f64::max).sqrt();
    let thinnest = volume.iter().map(|v| v * volume[0].signum()).fold(f64::INFINITY, f64::min);
    // What rounding of the places makes of the volume.
    let far = from.iter().zip(moves).map(|(p, m)| p.amax() + m.amax()).fold(0.0, f64::max);
    let long = [a, b, c, d, r, s].iter().map(Vec3::norm_squared).fold(0.0, f64::max);
    thinnest > least * widest + ROUNDING * far * long
}
