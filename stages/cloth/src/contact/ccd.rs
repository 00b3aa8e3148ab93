//! When moving pieces of cloth first come near each other: continuous collision detection.
//!
//! Additive continuous collision detection (Li, Kaufman, Jiang 2021): step by step, each as long as the distance divided
//! by the fastest approach allows, so that no step can jump over a contact. No roots of cubics are sought, whose rounding
//! misses contacts. The answer is early by at most a share [`NEARNESS`] of the starting distance, never late.
//!
//! Some ten distance evaluations where nothing is hit. Motion is straight and even over the step.

use super::pair::{Kind, Pair};
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Share of the starting distance at which pieces count as in contact. Smaller finds the contact more exactly in more
/// steps.
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

/// Pieces nearer than this may hardly come nearer: much below it, rounding of places could turn the sides about, m.
const CLOSEST: f64 = 1e-6;

/// The distance that a pair which starts at `start` keeps through the step.
#[must_use]
pub fn kept(start: f64) -> f64 {
    (NEARNESS * start).max(CLOSEST.min(0.9 * start))
}

/// The time, 0 to 1, until which the pair surely keeps the distance [`kept`] of its start; `None` for all of the step.
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
