//! How much of a step each node may make so that nothing passes through anything.
//!
//! Pairs that would meet hold back only their own nodes; since that changes the motion of their
//! neighbours, all pairs of a node that was held back are tested again, until no pair meets. If
//! that does not settle in a few rounds, the whole step is shortened. What is returned has been
//! tested: every pair keeps a share of its distance. Pairs that were found for longer moves do not
//! answer for shorter ones: see [`hold_apart`].

use nalgebra::Vector3;
use rayon::prelude::*;
use toile_geometry::ccd::impact;
use toile_geometry::pair::Pair;

type Vec3 = Vector3<f64>;

/// Rounds before the whole step is shortened.
const ROUNDS: usize = 8;

/// Searches of pairs for moves that were shortened, before the whole step is.
const SEARCHES: usize = 8;

/// Share of the time to impact that is used.
const SAFETY: f64 = 0.9;

/// Shortens `moves` so that no pair of `pairs` meets; the number of pairs that would have.
pub fn limit(x: &[Vec3], moves: &mut [Vec3], pairs: &[Pair]) -> usize {
    limit_or_stop(x, moves, pairs).0
}

/// The same; besides, to what share the whole step was shortened.
fn limit_or_stop(x: &[Vec3], moves: &mut [Vec3], pairs: &[Pair]) -> (usize, f64) {
    let mut suspects: Vec<Pair> = pairs.to_vec();
    let mut first = 0;
    for round in 0..ROUNDS {
        let hits = hits(x, moves, &suspects);
        if round == 0 {
            first = hits.len();
        }
        if hits.is_empty() {
            return (first, 1.0);
        }
        let mut share = vec![1.0f64; x.len()];
        for (pair, time) in &hits {
            for i in pair.nodes {
                share[i as usize] = share[i as usize].min(SAFETY * time);
            }
        }
        moves.iter_mut().zip(&share).filter(|(_, s)| **s < 1.0).for_each(|(m, s)| *m *= *s);
        suspects =
            pairs.iter().filter(|p| p.nodes.iter().any(|&i| share[i as usize] < 1.0)).copied().collect();
    }
    (first, stop(x, moves, pairs).1)
}

/// Shortens `moves` until none of the pairs that `seek` finds for them meets, of those that count;
/// the pairs found last, and to what share the whole step was shortened: below 1, cloth that
/// touches nothing was held back as well.
///
/// What falls together meets nowhere until one of it is held back; so pairs are sought again for
/// the moves that are left, unless `seek` says that those known hold for all shorter moves.
pub fn hold_apart(
    x: &[Vec3],
    moves: &mut [Vec3],
    mut pairs: Vec<Pair>,
    counts: impl Fn(&Pair) -> bool,
    seek: impl Fn(&[Vec3]) -> Option<Vec<Pair>>,
) -> (Vec<Pair>, f64) {
    let mut whole = 1.0;
    for search in 0..=SEARCHES {
        let strict: Vec<Pair> = pairs.iter().filter(|p| counts(p)).copied().collect();
        let (hits, share) =
            if search < SEARCHES { limit_or_stop(x, moves, &strict) } else { stop(x, moves, &strict) };
        whole *= share;
        if hits == 0 {
            break;
        }
        match seek(moves) {
            Some(found) => pairs = found,
            None => break,
        }
    }
    (pairs, whole)
}

/// Ends the whole step before the first of `pairs` meets; how many would have, and the share that
/// is left.
fn stop(x: &[Vec3], moves: &mut [Vec3], pairs: &[Pair]) -> (usize, f64) {
    // Scaled as a whole, a step that is safe until some time is safe when it ends there.
    let hits = hits(x, moves, pairs);
    let least = hits.iter().map(|(_, t)| *t).fold(1.0, f64::min);
    let share = if least < 1.0 { SAFETY * least } else { 1.0 };
    if share < 1.0 {
        moves.iter_mut().for_each(|m| *m *= share);
    }
    (hits.len(), share)
}

/// The pairs that would meet.
pub fn meet(x: &[Vec3], moves: &[Vec3], pairs: &[Pair]) -> Vec<Pair> {
    hits(x, moves, pairs).into_iter().map(|(p, _)| p).collect()
}

/// The pairs that would meet, and when.
fn hits(x: &[Vec3], moves: &[Vec3], pairs: &[Pair]) -> Vec<(Pair, f64)> {
    let hit = |p: &Pair| impact(p, &p.at(x), &p.at(moves)).map(|t| (*p, t));
    pairs.par_iter().with_min_len(256).filter_map(hit).collect()
}
